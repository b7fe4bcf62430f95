//! In a replay: where the live antennas are, in place of the controls for moving by hand.

use egui::{Align2, Rect, StrokeKind, Ui, pos2, vec2};

use super::Cursor;
use crate::{
    model::replay::ENDS_BEFORE_PASS_S,
    ui::{
        icons::{self, Icon},
        text, theme,
        widgets::{link_chip::LinkGlyph, paint},
    },
};

/// Height of a line.
const ROW: f32 = 22.0;
const TAG: f32 = 44.0;
/// Room below, before the lock of the controls.
const GAP: f32 = 6.0;
/// Most antennas that are listed; the bar at the top has them all.
const MOST: usize = 4;

/// The live station while the record is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveNow {
    pub antennas: Vec<LiveAntenna>,
    /// The next pass that an antenna is to track.
    pub next: String,
}

/// An antenna as it is now.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveAntenna {
    pub name: String,
    pub link: LinkGlyph,
    /// Its activity, its position, and the age of both.
    pub does: String,
}

pub(super) fn show(ui: &Ui, at: &mut Cursor, live: &LiveNow, short: bool) {
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
        let (icon, colour) = antenna.link.look(t);
        line(ui, at.take(ROW), (icon, colour), &antenna.name, &antenna.does);
    }
    let more = live.antennas.len().saturating_sub(MOST);
    if more > 0 {
        let words = format!("{more} more in the bar at the top");
        line(ui, at.take(ROW), (Icon::Dash, t.t3), "And", &words);
    }
    line(ui, at.take(ROW), (Icon::Clock, t.t2), "Next", &live.next);
    if !short {
        let width = at.width();
        let words = ends();
        let place = paint::paragraph(ui, at.at(), width, &words, text::small(), t.t2);
        paint::name_text(ui, "the end of the replay", place, &words);
        at.skip(place.height());
    }
    at.skip(GAP);
}

/// Says when a replay ends by itself.
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
