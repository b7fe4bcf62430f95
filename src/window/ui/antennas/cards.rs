//! Cards of a unit, in up to three columns.

pub(super) mod service;

use egui::{
    Align, Frame, Layout, Margin, RichText, Role, Sense, Stroke, Ui, UiBuilder,
    style::ScrollAnimation, vec2,
};

use super::{
    field_row,
    form::Form,
    row,
    section::{Column, Section},
    unit::ShownUnit,
};
use crate::{
    contract::driver::{Command, LinkState},
    device::settings::{Access, Field},
    model::{UiCommand, View},
    ui::{
        icons::Icon,
        text, theme,
        widgets::button::{Button, HEIGHT},
    },
};

const NONE: &str = "This unit keeps no settings that can be read or changed over its link. Mount, \
                    limits and connection are in Preferences.";

/// Gap between the columns and around them, points.
const GAP: f32 = 16.0;
const PADDING: i8 = 12;
/// Max width of a card, points: its fields need no more.
const WIDEST: f32 = 760.0;

/// Actions of a card other than editing its fields.
pub(super) struct CardEffects<'a> {
    pub(super) commands: &'a mut Vec<UiCommand>,
    /// Flag: open the dialog that unlocks the service functions.
    pub(super) unlock: &'a mut bool,
}

/// Shows all cards and scrolls to the card of `scroll_to`.
pub(super) fn show(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    scroll_to: &mut Option<Section>,
    effects: &mut CardEffects<'_>,
) {
    let room = ui.available_width();
    let all = Section::new(&unit.antenna.config.connection);
    if all.is_empty() {
        return none(ui, unit, effects.commands);
    }
    let min = row::MIN_WIDTH + 2.0 * f32::from(PADDING) + 2.0;
    let fitting = ((room + GAP) / (min + GAP)) as usize;
    let columns = columns(&all, fitting);
    let count = columns.len() as f32;
    let width = ((room - GAP * (count - 1.0)) / count).min(WIDEST);
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for sections in &columns {
            let size = vec2(width, 0.0);
            ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
                ui.spacing_mut().item_spacing.x = 8.0;
                column(ui, size.x, unit, form, sections, (&mut *scroll_to, &mut *effects));
            });
        }
    });
}

/// Explains where to find the settings of a unit without groups, and offers buttons that lead
/// there.
fn none(ui: &mut Ui, unit: &ShownUnit<'_>, commands: &mut Vec<UiCommand>) {
    row::note(ui, Some(Icon::Info), NONE, theme::tokens(ui).t2);
    ui.add_space(8.0);
    let (line, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let preferences = Button::normal("Open Preferences");
    let place = line.with_max_x(line.left() + preferences.width(ui));
    if preferences.show(ui, "open preferences", place).clicked() {
        commands.push(UiCommand::Show(View::Preferences));
    }
    if unit.antenna.snapshot.link == LinkState::Off {
        let connect = Button::primary("Connect");
        let left = place.right() + 8.0;
        let place = line.with_min_x(left).with_max_x(left + connect.width(ui));
        if connect.show(ui, "connect", place).clicked() {
            commands.push(UiCommand::antenna(unit.antenna.id(), Command::Connect));
        }
    }
}

/// Splits the cards into at most `fitting` columns. A third column takes the lower cards of the
/// left one.
fn columns(all: &[Section], fitting: usize) -> Vec<Vec<Section>> {
    if fitting < 2 {
        return vec![all.to_vec()];
    }
    let places = all.iter().enumerate().map(|(place, section)| {
        let turn = if place % 2 == 0 { Column::Left } else { Column::Right };
        (section.column.unwrap_or(turn), *section)
    });
    let (left, right): (Vec<_>, Vec<_>) = places.partition(|(column, _)| *column == Column::Left);
    let sections = |column: Vec<(Column, Section)>| {
        column.into_iter().map(|(_, kind)| kind).collect::<Vec<_>>()
    };
    let (mut left, right) = (sections(left), sections(right));
    if fitting < 3 || left.len() < 2 {
        return vec![left, right];
    }
    let lower = left.split_off(left.len().div_ceil(2));
    vec![left, lower, right]
}

fn column(
    ui: &mut Ui,
    width: f32,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    sections: &[Section],
    (scroll_to, effects): (&mut Option<Section>, &mut CardEffects<'_>),
) {
    ui.spacing_mut().item_spacing.y = 0.0;
    for section in sections {
        let card = card(ui, width, |ui| fill(ui, unit, form, section, effects));
        if *scroll_to == Some(*section) {
            ui.scroll_to_rect_animation(card, Some(Align::TOP), ScrollAnimation::none());
            *scroll_to = None;
        }
        ui.add_space(GAP);
    }
}

fn card(ui: &mut Ui, width: f32, content: impl FnOnce(&mut Ui)) -> egui::Rect {
    let t = theme::tokens(ui);
    let frame = Frame::new()
        .fill(t.bg1)
        .stroke(Stroke::new(1.0, t.line))
        .corner_radius(6)
        .inner_margin(Margin::same(PADDING));
    let shown = frame.show(ui, |ui| {
        ui.set_width(width - 2.0 * f32::from(PADDING) - 2.0);
        content(ui);
    });
    shown.response.rect
}

fn fill(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    section: &Section,
    effects: &mut CardEffects<'_>,
) {
    // The salt separates cards that have the same controls.
    let group = UiBuilder::new()
        .id_salt(section.title)
        .accessibility_role(Role::Group)
        .accessibility_label(section.title);
    ui.scope_builder(group, |ui| {
        if !section.is_service {
            title(ui, section.title);
        }
        (section.content)(ui, unit, form, section, effects);
    });
}

fn title(ui: &mut Ui, words: &str) {
    ui.label(RichText::new(words).font(text::value()));
    ui.add_space(4.0);
}

/// Draws a heading within a card.
pub(super) fn subtitle(ui: &mut Ui, words: &str) {
    let t = theme::tokens(ui);
    ui.add_space(8.0);
    ui.label(RichText::new(words).font(text::small_strong()).color(t.t2));
    ui.add_space(2.0);
}

/// Shows the fields of a group for which `is_wanted` is true.
pub(super) fn fields(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    key: &'static str,
    is_wanted: fn(&Field) -> bool,
) {
    let Some(group) = unit.description(key) else { return };
    let mut is_revealed = form.is_revealed;
    field_row::show_all(ui, unit, group, form.draft(group.key), &mut is_revealed, is_wanted);
    form.is_revealed = is_revealed;
}

pub(super) fn is_reported(field: &Field) -> bool {
    field.access != Access::Write
}
