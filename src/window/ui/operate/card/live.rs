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
const ROW: f32 = 22.0;
const TAG: f32 = 44.0;
/// Room below, before the lock of the controls, points.
const GAP: f32 = 6.0;
/// Max number of listed antennas; the bar at the top shows all.
const MOST: usize = 4;

pub(super) fn show(ui: &Ui, at: &mut Cursor, live: &Model) {
    let t = theme::tokens(ui);
    let head = at.take(ROW);
    let words = "Live now, not recorded";
    paint::text_in(ui, head, Align2::LEFT_CENTER, words, text::body_medium(), t.t1);
    let tag =
        Rect::from_center_size(pos2(head.right() - TAG / 2.0, head.center().y), vec2(TAG, 18.0));
    ui.painter().rect_stroke(tag, 3.0, (1.0, t.ok), StrokeKind::Inside);
    paint::text_in(ui, tag, Align2::CENTER_CENTER, "LIVE", text::caption(), t.ok);
    paint::name_text(ui, "live now", head, words);
    for antenna in live.antennas.iter().take(MOST) {
        let look = bar::glyph(live, antenna).look(t);
        line(ui, at.take(ROW), look, &antenna.config.name, &does(live, antenna));
    }
    let more = live.antennas.len().saturating_sub(MOST);
    if more > 0 {
        let words = format!("{more} more in the bar at the top");
        line(ui, at.take(ROW), (Icon::Dash, t.t3), "And", &words);
    }
    line(ui, at.take(ROW), (Icon::Clock, t.t2), "Next", &next(live));
    if !at.is_short() {
        let width = at.width();
        let words = ends();
        let place = paint::paragraph(ui, at.at(), width, &words, text::small(), t.t2);
        paint::name_text(ui, "the end of the replay", place, &words);
        at.skip(place.height());
    }
    at.skip(GAP);
}

/// Returns the activity and position of an antenna, with their age.
fn does(live: &Model, antenna: &AntennaModel) -> String {
    let can = antenna.variant().capabilities;
    let measured = antenna.snapshot.state.measured;
    let at = measured.map(|measured| format!(" at {}", format::pointing(measured.pointing, can)));
    let activity = format!("{}{}", bar::activity(live, antenna), at.unwrap_or_default());
    link_chip::with_age(&activity, &bar::age(live, antenna), bar::glyph(live, antenna))
}

/// Describes the next planned pass of any antenna.
fn next(live: &Model) -> String {
    let entries = live.schedule.schedule.entries.iter();
    let next = entries.filter(|entry| entry.start > live.now).min_by_key(|entry| entry.start);
    let Some(next) = next else { return "no pass is planned".to_owned() };
    let name = words::schedule::satellite_name(live, next.pass.satellite);
    let at = format::moment(next.start, live.now);
    format!("{name} at {at}, in {}", format::time_left(live.now, next.start))
}

/// Describes when a replay ends automatically.
fn ends() -> String {
    let minutes = ENDS_BEFORE_PASS_S / 60.0;
    format!(
        "The replay ends by itself {minutes} min before the next planned pass, on a top-priority \
         alarm and on STOP."
    )
}

fn line(ui: &Ui, row: Rect, (icon, colour): (Icon, egui::Color32), name: &str, words: &str) {
    let t = theme::tokens(ui);
    let at = pos2(row.left() + 7.0, row.center().y);
    icons::paint(ui.painter(), paint::square(at, 12.0), icon, colour);
    let rest = row.with_min_x(row.left() + 22.0);
    let drawn = paint::text_in(ui, rest, Align2::LEFT_CENTER, name, text::body(), t.t1);
    let room = rest.with_min_x(drawn.right() + 8.0);
    paint::text_in(ui, room, Align2::RIGHT_CENTER, words, text::small(), t.t2);
    let all = format!("{name}: {words}");
    let named = paint::name_text(ui, ("live", name), row, &all);
    if !paint::fits(ui, words, text::small(), room) {
        named.on_hover_text(all);
    }
}
