//! Live antennas in a replay, in place of the controls for moving by hand.

use egui::{Align2, Rect, StrokeKind, Ui, pos2, vec2};

use super::Cursor;
use crate::{
    contract::antenna::AntennaModel,
    model::{Model, replay::ENDS_BEFORE_PASS_S},
    ui::{
        bar, format,
        icons::{self, Icon},
        text, theme,
        widgets::{link_chip, paint},
        words,
    },
};

/// Height of a line, points.
const ROW_HEIGHT: f32 = 22.0;
const TAG_WIDTH: f32 = 44.0;
/// Room below, before the lock of the controls, points.
const GAP: f32 = 6.0;
/// Max number of listed antennas; the bar at the top shows all.
const MAX_LISTED: usize = 4;

pub(super) fn show(ui: &Ui, cursor: &mut Cursor, live: &Model) {
    let t = theme::tokens(ui);
    let head = cursor.take(ROW_HEIGHT);
    let words = "Live now, not recorded";
    paint::text_in(ui, head, Align2::LEFT_CENTER, words, text::body_medium(), t.t1);
    let tag = Rect::from_center_size(
        pos2(head.right() - TAG_WIDTH / 2.0, head.center().y),
        vec2(TAG_WIDTH, 18.0),
    );
    ui.painter().rect_stroke(tag, 3.0, (1.0, t.ok), StrokeKind::Inside);
    paint::text_in(ui, tag, Align2::CENTER_CENTER, "LIVE", text::caption(), t.ok);
    paint::name_text(ui, "live now", head, words);
    for antenna in live.antennas.iter().take(MAX_LISTED) {
        let look = bar::glyph(live, antenna).look(t);
        show_line(
            ui,
            cursor.take(ROW_HEIGHT),
            look,
            &antenna.config.name,
            &activity(live, antenna),
        );
    }
    let more = live.antennas.len().saturating_sub(MAX_LISTED);
    if more > 0 {
        let words = format!("{more} more in the bar at the top");
        show_line(ui, cursor.take(ROW_HEIGHT), (Icon::Dash, t.t3), "And", &words);
    }
    show_line(ui, cursor.take(ROW_HEIGHT), (Icon::Clock, t.t2), "Next", &next_pass(live));
    if !cursor.is_short() {
        let width = cursor.width();
        let words = end_note();
        let place = paint::paragraph(ui, cursor.position(), width, &words, text::small(), t.t2);
        paint::name_text(ui, "the end of the replay", place, &words);
        cursor.skip(place.height());
    }
    cursor.skip(GAP);
}

/// Returns the activity and position of an antenna, with their age.
fn activity(live: &Model, antenna: &AntennaModel) -> String {
    let capabilities = antenna.variant().capabilities;
    let measured = antenna.snapshot.state.measured;
    let position = measured
        .map(|measured| format!(" at {}", format::pointing(measured.pointing, capabilities)));
    let activity = format!("{}{}", bar::activity(live, antenna), position.unwrap_or_default());
    link_chip::with_age(&activity, &bar::age(live, antenna), bar::glyph(live, antenna))
}

/// Describes the next planned pass of any antenna.
fn next_pass(live: &Model) -> String {
    let entries = live.schedule.schedule.entries.iter();
    let next = entries.filter(|entry| entry.start > live.now).min_by_key(|entry| entry.start);
    let Some(next) = next else { return "no pass is planned".to_owned() };
    let name = words::schedule::satellite_name(live, next.pass.satellite);
    let time = format::moment(next.start, live.now);
    format!("{name} at {time}, in {}", format::time_left(live.now, next.start))
}

/// Describes when a replay ends automatically.
fn end_note() -> String {
    let minutes = ENDS_BEFORE_PASS_S / 60.0;
    format!(
        "The replay ends by itself {minutes} min before the next planned pass, on a top-priority \
         alarm and on STOP."
    )
}

fn show_line(ui: &Ui, row: Rect, (icon, colour): (Icon, egui::Color32), name: &str, words: &str) {
    let t = theme::tokens(ui);
    let center = pos2(row.left() + 7.0, row.center().y);
    icons::paint(ui.painter(), paint::square(center, 12.0), icon, colour);
    let rest = row.with_min_x(row.left() + 22.0);
    let drawn = paint::text_in(ui, rest, Align2::LEFT_CENTER, name, text::body(), t.t1);
    let room = rest.with_min_x(drawn.right() + 8.0);
    paint::text_in(ui, room, Align2::RIGHT_CENTER, words, text::small(), t.t2);
    let label = format!("{name}: {words}");
    let named = paint::name_text(ui, ("live", name), row, &label);
    if !paint::fits(ui, words, text::small(), room) {
        named.on_hover_text(label);
    }
}
