//! The head of the card: name, link, and the menu to connect or disconnect.

use egui::{Align2, Color32, Popup, Rect, Stroke, StrokeKind, Ui, pos2, vec2};

use super::{CardAction, Cursor};
use crate::ui::{
    icons::{self, Icon},
    text::{self, Weight},
    theme,
    widgets::{
        link_chip::{self, LinkGlyph},
        menu, paint,
    },
};

/// Side of the button that opens the link menu.
const MENU: f32 = 24.0;

/// Status of the link, as the card names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkStatus {
    Connected,
    /// The unit is locked out for maintenance.
    InMaintenance,
    Connecting,
    /// Replies are late or missing.
    Late,
    /// No reply comes.
    NoReply,
    /// This console has no link and is not trying to connect.
    NotConnected,
    /// Another Azel drives the unit.
    Elsewhere,
}

/// The head of the card.
#[derive(Debug, Clone, Copy)]
pub struct HeaderModel<'a> {
    pub name: &'a str,
    /// Size, mount and abilities.
    pub second_line: &'a str,
    pub link: LinkGlyph,
    pub status: LinkStatus,
    /// A connection takes the front panel from a person at the unit.
    pub takes_panel: bool,
    /// The unit is locked out for maintenance.
    pub in_maintenance: bool,
    /// The gravest red alarm that stands for the antenna, in words.
    pub alarm: Option<&'a str>,
    /// It is shown as recorded at this time, in words, and commands nothing.
    pub recorded: Option<&'a str>,
}

impl HeaderModel<'_> {
    pub(super) fn is_replayed(&self) -> bool {
        self.recorded.is_some()
    }
}

pub(super) fn show(
    ui: &Ui,
    at: &mut Cursor,
    model: &HeaderModel<'_>,
    card: Rect,
    short: bool,
    actions: &mut Vec<CardAction>,
) {
    let t = theme::tokens(ui);
    let row = at.take(if short { 44.0 } else { 56.0 });
    ui.painter().hline(card.x_range(), row.bottom() - 0.5, (1.0, t.line));
    let y = row.center().y;
    let (icon, colour) = model.link.look(t);
    let glyph = paint::square(pos2(row.left() + 8.0, y), 15.0);
    icons::paint(ui.painter(), glyph, icon, colour);

    let mut end = row;
    let has_menu = model.status != LinkStatus::NotConnected || !model.in_maintenance;
    if has_menu && model.status != LinkStatus::Elsewhere {
        let key = paint::square(pos2(row.right() - MENU / 2.0 + 4.0, y), MENU);
        link_menu(ui, key, model, actions);
        end = row.with_max_x(key.left() - 2.0);
    }
    let room = end.with_min_x(row.left() + 24.0);
    // The second line has the width for itself.
    let upper = if short { end } else { end.translate(vec2(0.0, -8.0)) };
    let mut tag_left = status_tag(ui, upper, model.status);
    if let Some(alarm) = model.alarm {
        tag_left = alarm_tag(ui, upper.with_max_x(tag_left - 4.0), alarm);
    }
    let name_room = room.with_max_x(tag_left - 6.0);
    if short {
        paint::text_in(ui, name_room, Align2::LEFT_CENTER, model.name, text::value(), t.t1);
    } else {
        let up = name_room.translate(vec2(0.0, -8.0));
        paint::text_in(ui, up, Align2::LEFT_CENTER, model.name, text::value(), t.t1);
        let down = room.translate(vec2(0.0, 11.0));
        let (second_line, colour) =
            model.recorded.map_or((model.second_line, t.t2), |recorded| (recorded, t.warn));
        paint::text_in(ui, down, Align2::LEFT_CENTER, second_line, text::small(), colour);
    }
    let recorded = model.recorded.map(|recorded| format!(", {recorded}")).unwrap_or_default();
    let (about, link) = (model.second_line, model.link.word());
    let words = format!("{}{recorded}, {about}, link {link}", model.name);
    let named = paint::name_text(ui, "header", name_room, &words);
    // A short card has no second line.
    let is_whole = paint::fits(ui, model.name, text::value(), name_room)
        && !short
        && paint::fits(ui, model.second_line, text::small(), room);
    if !is_whole {
        named.on_hover_text(format!("{}\n{}", model.name, model.second_line));
    }
}

/// Shows the button with the link menu.
fn link_menu(ui: &Ui, rect: Rect, model: &HeaderModel<'_>, actions: &mut Vec<CardAction>) {
    let t = theme::tokens(ui);
    let name = format!("Link of {}", model.name);
    let response = paint::icon_control(ui, "link menu", rect, &name);
    if response.hovered() {
        ui.painter().rect_filled(rect, 4.0, t.bg3);
    }
    icons::paint(ui.painter(), paint::square(rect.center(), 12.0), Icon::ChevronDown, t.t2);
    paint::focus_ring(ui, &response, 4);
    menu::show(&response, Popup::menu(&response).accessible_name(name), |ui| {
        let about = "Closes the link, so that another program can use the unit.";
        if model.status != LinkStatus::NotConnected
            && ui.button("Disconnect").on_hover_text(about).clicked()
        {
            actions.push(CardAction::Disconnect);
        }
        let about = "For work at the antenna: only queries and STOP go to the unit.";
        if !model.in_maintenance && ui.button("Lock out…").on_hover_text(about).clicked() {
            actions.push(CardAction::Maintenance);
        }
    });
}

/// Paints the status and returns its left end.
fn status_tag(ui: &Ui, row: Rect, status: LinkStatus) -> f32 {
    let t = theme::tokens(ui);
    let (words, colour) = match status {
        LinkStatus::Connected => ("Connected", t.ok),
        LinkStatus::InMaintenance => ("In maintenance", t.warn),
        LinkStatus::Connecting => ("Connecting", t.t3),
        LinkStatus::Late => ("Answers late", t.warn),
        LinkStatus::NoReply => ("No reply", t.warn),
        LinkStatus::NotConnected => ("Not connected", t.t3),
        LinkStatus::Elsewhere => ("Driven elsewhere", t.warn),
    };
    let tag = tag_at_right(ui, row, words, colour);
    paint::name_text(ui, "reach", tag, words);
    tag.left()
}

/// Paints the tag of an antenna in alarm and returns its left end.
fn alarm_tag(ui: &Ui, row: Rect, alarm: &str) -> f32 {
    let tag = tag_at_right(ui, row, link_chip::ALARM, theme::tokens(ui).bad);
    let words = format!("{}: {alarm}", link_chip::ALARM);
    paint::name_text(ui, "alarm", tag, &words).on_hover_text(alarm);
    tag.left()
}

fn tag_at_right(ui: &Ui, row: Rect, words: &str, colour: Color32) -> Rect {
    let font = text::sized(11.0, Weight::SemiBold);
    let width = (paint::text_width(ui, words, font.clone()) + 12.0).min(0.5 * row.width());
    let size = vec2(width.ceil(), 18.0);
    let min = pos2(row.right() - size.x, row.center().y - size.y / 2.0);
    let tag = Rect::from_min_size(min, size);
    ui.painter().rect_stroke(tag, 3.0, Stroke::new(1.0, colour), StrokeKind::Inside);
    let room = tag.shrink2(vec2(4.0, 0.0));
    paint::text_in(ui, room, Align2::CENTER_CENTER, words, font, colour);
    tag
}
