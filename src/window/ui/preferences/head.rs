//! The bar above a page: its subject, and the actions for an antenna.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{HEAD, PADDING, PreferencesState, draft::Draft, page::Page};
use crate::{
    contract,
    model::{Model, UiCommand},
    station::{Antenna, AntennaId, Mount},
    ui::{
        icons::Icon,
        preferences::antenna_fields::has_elevation,
        text, theme,
        widgets::{
            button::{self, Button, HEIGHT},
            paint,
        },
    },
};

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    draft: &mut Draft,
    state: &mut PreferencesState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let (title, description) = (state.page.title(draft), page_summary(state.page, model, draft));
    let right = match state.page {
        Page::Antenna(id) => buttons(ui, rect, id, model, draft, state, commands),
        Page::Rules => add_rule(ui, rect, draft, state),
        _ => rect.right() - PADDING,
    };
    let room = rect.with_min_x(rect.left() + PADDING).with_max_x(right - PADDING);
    let up = room.translate(vec2(0.0, -9.0));
    let font = if rect.height() < HEAD[0] { text::value() } else { text::title() };
    paint::text_in(ui, up, Align2::LEFT_CENTER, &title, font, t.t1);
    let down = room.translate(vec2(0.0, rect.height() * 0.23));
    paint::text_in(ui, down, Align2::LEFT_CENTER, &description, text::small(), t.t2);
    let named = paint::name_text(ui, "page", room, &format!("{title}. {description}"));
    if !paint::fits(ui, &description, text::small(), down) {
        named.on_hover_text(&description);
    }
}

fn page_summary(page: Page, model: &Model, draft: &Draft) -> String {
    let description = match page {
        Page::Antenna(id) => {
            let index = draft.index(id);
            let antenna = index.and_then(|index| draft.antennas.get(index));
            let is_removed = index.is_some_and(|index| draft.is_removed(index));
            let end = if is_removed { ". It is removed when you save." } else { "" };
            return antenna.map_or_else(String::new, |typed| kind(&typed.read().0) + end);
        }
        Page::Site if model.demo => "For your new station; the demo is not changed",
        Page::Site => "Where the station is, and which passes it lists",
        Page::Horizon => "Obstructions of the sky, and where no antenna may point",
        Page::Satellites => "Which passes come first, and which are taken at all",
        Page::Rules => "The first matching rule applies, in the plan and in automatic operation",
        Page::Notices => "What is announced on the desktop, and when",
        Page::Appearance => "For this window, applied at once",
    };
    description.to_owned()
}

/// Returns make and mount of an antenna, and whether the unit tracks on its own or follows
/// positions from Azel.
fn kind(antenna: &Antenna) -> String {
    let mount = match antenna.mount {
        Mount::Xy { .. } => "X/Y mount",
        Mount::AzEl { .. } if has_elevation(antenna) => "az/el mount",
        Mount::AzEl { .. } => "azimuth only",
    };
    let can = antenna.connection.variant().capabilities;
    let tracks = match (can.has_program, can.takes_positions) {
        (true, _) => "; tracks by itself",
        (false, true) => "; follows positions sent by Azel",
        (false, false) => "",
    };
    format!("{}, {mount}{tracks}", antenna.connection.spec().name)
}

/// Shows the button that adds a rule. Returns its left end.
fn add_rule(ui: &Ui, rect: Rect, draft: &mut Draft, state: &mut PreferencesState) -> f32 {
    let add = Button::normal("Add rule").icon(Icon::Plus);
    let right_centre = pos2(rect.right() - PADDING, rect.center().y);
    let size = vec2(add.width(ui), HEIGHT);
    let place = Rect::from_min_size(right_centre - vec2(size.x, size.y / 2.0), size);
    if add.show(ui, "add rule", place).clicked() {
        let added = draft.rules.add();
        state.form.rules.choose(added);
    }
    place.left()
}

/// Shows the buttons of an antenna at the right. Returns their left end.
fn buttons(
    ui: &mut Ui,
    rect: Rect,
    id: AntennaId,
    model: &Model,
    draft: &mut Draft,
    state: &mut PreferencesState,
    commands: &mut Vec<UiCommand>,
) -> f32 {
    let Some(index) = draft.index(id) else { return rect.right() };
    let is_removed = draft.is_removed(index);
    let as_typed = draft.antenna(index).filter(|_| !is_removed);
    let test = Button::normal("Test link").locked(as_typed.is_none());
    let duplicate = Button::normal("Duplicate").locked(is_removed);
    // Both labels have the same width, so that the button stays under the pointer.
    let remove_width = Button::quiet("Remove antenna").width(ui);
    let word = if is_removed { "Undo: keep it" } else { "Remove antenna" };
    let right = rect.right_center() - vec2(PADDING, 0.0);
    let widths = [test.width(ui), duplicate.width(ui), remove_width];
    let [of_test, of_duplicate, of_remove] = button::row(right, widths);
    if let (true, Some(antenna)) = (test.show(ui, "test link", of_test).clicked(), as_typed) {
        commands.push(UiCommand::Station(contract::Command::TestLink(Box::new(antenna))));
    }
    if duplicate.show(ui, "duplicate", of_duplicate).clicked()
        && let Some(added) = draft.duplicate(index, model.now)
    {
        state.page = Page::Antenna(added);
    }
    if Button::quiet(word).show(ui, "remove antenna", of_remove).clicked() {
        draft.toggle_removed(index);
    }
    of_test.left() - button::GAP
}
