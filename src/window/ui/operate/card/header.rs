//! The head of the card: name, link, and the menu to connect or disconnect.

use egui::{Align2, Color32, Popup, Rect, Stroke, StrokeKind, Ui, pos2, vec2};

use super::{Card, Cursor};
use crate::{
    contract::{
        antenna::{Answers, AntennaModel},
        driver::{Command, Intent, LinkState},
    },
    model::{Model, UiCommand},
    station::Mount,
    ui::{
        bar,
        confirm::Question,
        dialogs::MaintenanceDialog,
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        tokens::Tokens,
        widgets::{link_chip, menu, paint},
    },
};

/// Side length of the button that opens the link menu, points.
const MENU_SIZE: f32 = 24.0;

/// Returns `true` if this console has no link to the unit and wants none.
pub(super) fn is_released(antenna: &AntennaModel) -> bool {
    antenna.held_by.is_none() && antenna.snapshot.link == LinkState::Off
}

pub(super) fn show(
    ui: &Ui,
    cursor: &mut Cursor,
    card: &mut Card<'_>,
    maintenance: &mut Option<MaintenanceDialog>,
) {
    let (model, antenna, is_short) = (card.model, card.antenna, cursor.is_short());
    let (name, link) = (&antenna.config.name, bar::glyph(model, antenna));
    let t = theme::tokens(ui);
    let row = cursor.take(if is_short { 44.0 } else { 56.0 });
    ui.painter().hline(cursor.card.x_range(), row.bottom() - 0.5, (1.0, t.line));
    let y = row.center().y;
    let (icon, colour) = link.look(t);
    let glyph = paint::square(pos2(row.left() + 8.0, y), 15.0);
    icons::paint(ui.painter(), glyph, icon, colour);

    let mut end = row;
    let has_menu = !is_released(antenna) || antenna.snapshot.lock_out.is_none();
    if has_menu && antenna.held_by.is_none() {
        let key = paint::square(pos2(row.right() - MENU_SIZE / 2.0 + 4.0, y), MENU_SIZE);
        show_link_menu(ui, key, card, maintenance);
        end = row.with_max_x(key.left() - 2.0);
    }
    let room = end.with_min_x(row.left() + 24.0);
    // Put the tags on the upper line: the second line keeps the whole width.
    let upper = if is_short { end } else { end.translate(vec2(0.0, -8.0)) };
    let (status, colour) = status(model, antenna, t);
    let tag = show_right_tag(ui, upper, status, colour);
    paint::name_text(ui, "reach", tag, status);
    let mut tag_left = tag.left();
    if let Some(alarm) = bar::alarm(model, antenna) {
        tag_left = show_alarm_tag(ui, upper.with_max_x(tag_left - 4.0), &alarm);
    }
    let name_room = room.with_max_x(tag_left - 6.0);
    let description = second_line(antenna);
    let recorded = model.replay.as_ref().map(|replay| {
        let time = format::moment(replay.time, replay.time);
        format!("as recorded at {time}")
    });
    if is_short {
        paint::text_in(ui, name_room, Align2::LEFT_CENTER, name, text::value(), t.t1);
    } else {
        let up = name_room.translate(vec2(0.0, -8.0));
        paint::text_in(ui, up, Align2::LEFT_CENTER, name, text::value(), t.t1);
        let down = room.translate(vec2(0.0, 11.0));
        let (second_line, colour) =
            recorded.as_deref().map_or((&*description, t.t2), |recorded| (recorded, t.warn));
        paint::text_in(ui, down, Align2::LEFT_CENTER, second_line, text::small(), colour);
    }
    let recorded = recorded.map(|recorded| format!(", {recorded}")).unwrap_or_default();
    let words = format!("{name}{recorded}, {description}, link {}", link.word());
    let named = paint::name_text(ui, "header", name_room, &words);
    // A short card has no second line.
    let is_whole = paint::fits(ui, name, text::value(), name_room)
        && !is_short
        && paint::fits(ui, &description, text::small(), room);
    if !is_whole {
        named.on_hover_text(format!("{name}\n{description}"));
    }
}

/// Returns the kind and name of the unit, or its address.
fn second_line(antenna: &AntennaModel) -> String {
    let kind = match antenna.config.mount {
        Mount::AzEl { .. } => antenna.spec().name,
        Mount::Xy { .. } => "X/Y mount",
    };
    match (&antenna.snapshot.state.unit_name, antenna.config.mount) {
        (Some(name), _) => format!("{kind}, {name}"),
        (None, Mount::AzEl { .. }) => kind.to_owned(),
        (None, Mount::Xy { .. }) => format!("{kind} at {}", antenna.config.connection.address),
    }
}

/// Shows the button with the link menu.
fn show_link_menu(
    ui: &Ui,
    rect: Rect,
    card: &mut Card<'_>,
    maintenance: &mut Option<MaintenanceDialog>,
) {
    let t = theme::tokens(ui);
    let name = format!("Link of {}", card.antenna.config.name);
    let response = paint::icon_control(ui, "link menu", rect, &name);
    if response.hovered() {
        ui.painter().rect_filled(rect, 4.0, t.bg3);
    }
    icons::paint(ui.painter(), paint::square(rect.center(), 12.0), Icon::ChevronDown, t.t2);
    paint::focus_ring(ui, &response, 4);
    menu::show(&response, Popup::menu(&response).accessible_name(name), |ui| {
        let hint = "Closes the link, so that another program can use the unit.";
        if !is_released(card.antenna) && ui.button("Disconnect").on_hover_text(hint).clicked() {
            disconnect(card);
        }
        let hint = "For work at the antenna: only queries and STOP go to the unit.";
        let is_locked_out = card.antenna.snapshot.lock_out.is_some();
        if !is_locked_out && ui.button("Lock out…").on_hover_text(hint).clicked() {
            *maintenance = Some(MaintenanceDialog::default());
        }
    });
}

/// Disconnects. Asks first if a motion or a track would go on unwatched.
fn disconnect(card: &mut Card<'_>) {
    let snapshot = &card.antenna.snapshot;
    let moving = snapshot.state.measured.is_some_and(|measured| measured.moving());
    let program = snapshot.state.program.is_some_and(|program| program.enabled);
    if !(moving || program || snapshot.intent == Intent::Track) {
        return card.queue(Command::Disconnect);
    }
    let text = format!(
        "Disconnect from {}? It is moving or tracking, and nobody will be watching it from here.",
        card.antenna.config.name
    );
    let command = UiCommand::antenna(card.antenna.id(), Command::Disconnect);
    *card.question = Some(Question { text, yes: "Disconnect", command });
}

/// Returns the status of the link in words, with its colour.
fn status(model: &Model, antenna: &AntennaModel, t: &Tokens) -> (&'static str, Color32) {
    match antenna.answers(model.steady) {
        _ if antenna.held_by.is_some() => ("Driven elsewhere", t.warn),
        Answers::Off => ("Not connected", t.t3),
        _ if antenna.snapshot.lock_out.is_some() => ("In maintenance", t.warn),
        Answers::InTime => ("Connected", t.ok),
        Answers::Connecting => ("Connecting", t.t3),
        Answers::Late(_) => ("Answers late", t.warn),
        Answers::Silent(_) | Answers::Lost(_) => ("No reply", t.warn),
    }
}

/// Paints the tag of an antenna in alarm and returns its left end.
fn show_alarm_tag(ui: &Ui, row: Rect, alarm: &str) -> f32 {
    let tag = show_right_tag(ui, row, link_chip::ALARM, theme::tokens(ui).bad);
    let words = format!("{}: {alarm}", link_chip::ALARM);
    paint::name_text(ui, "alarm", tag, &words).on_hover_text(alarm);
    tag.left()
}

fn show_right_tag(ui: &Ui, row: Rect, words: &str, colour: Color32) -> Rect {
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
