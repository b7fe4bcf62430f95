//! The hours of the sheet, a lane for each antenna.

use jiff::{Timestamp, ToSpan as _};

use super::HandOverSheet;
use crate::{
    astro::time::{add_seconds, seconds_between},
    engine::automatic,
    ui::{
        format,
        sheet::{
            BODY, CAPTION, LEFT, RIGHT, section,
            svg::{Anchor, SHADE, Svg},
        },
    },
};

const LABEL: f64 = 74.0;
const LANE: f64 = 13.0;
/// More antennas than this are counted.
const LANES: usize = 8;

impl HandOverSheet<'_> {
    /// Returns where the time line ends.
    pub(super) fn time_line(&self, svg: &mut Svg, y: f64) -> f64 {
        let said = "Box: pass; line before it: slew and set-up; grey: night";
        let top = section(svg, y, "Time line (UTC)", said);
        let antennas = &self.station.antennas;
        let shown = antennas.len().min(LANES);
        let bottom = top + LANE * shown as f64;
        for [from, to] in self.nights() {
            let (from, to) = (self.x(from), self.x(to));
            svg.filled([from, top], [to - from, bottom - top], SHADE);
        }
        for hour in self.hours() {
            svg.line([self.x(hour), top], [self.x(hour), bottom], 0.25);
            let words = format::hour_of_day(hour);
            let face = if words == "00" { CAPTION.bold() } else { CAPTION };
            let x = self.x(hour).min(RIGHT - 4.5);
            svg.text([x, bottom + 7.5], 20.0, face.anchored(Anchor::Middle), &words);
        }
        for (antenna, lane) in antennas.iter().take(shown).zip(0..) {
            let y = top + LANE * f64::from(lane);
            svg.line([LEFT, y + LANE], [RIGHT, y + LANE], 0.25);
            svg.text([LEFT, y + 9.0], LABEL - 6.0, BODY, &antenna.name);
            for entry in self.entries().into_iter().filter(|it| it.antenna == antenna.id) {
                let go_at = automatic::sets_out(entry, antenna.automatic.between);
                let moves_from = go_at.max(add_seconds(entry.from, -entry.slew_s - entry.set_up_s));
                let [before, from, to] = [moves_from, entry.from, entry.to].map(|at| self.x(at));
                svg.line([before, y + LANE / 2.0], [from, y + LANE / 2.0], 0.8);
                svg.bar([from, y + 3.0], [(to - from).max(0.6), LANE - 6.0]);
            }
        }
        let more = antennas.len() - shown;
        if more > 0 {
            let words = format!("and {more} more");
            svg.text([LEFT, bottom + 7.5], LABEL - 6.0, CAPTION, &words);
        }
        bottom + 9.0
    }

    /// The place of a time that is within the sheet, or of the nearer end of it.
    fn x(&self, at: Timestamp) -> f64 {
        let share = seconds_between(self.from, at) / seconds_between(self.from, self.until);
        let begin = LEFT + LABEL;
        begin + (RIGHT - begin) * share.clamp(0.0, 1.0)
    }

    /// Full hours within the sheet.
    fn hours(&self) -> Vec<Timestamp> {
        let hour = jiff::TimestampRound::new().smallest(jiff::Unit::Hour);
        let first = self.from.round(hour.mode(jiff::RoundMode::Ceil)).unwrap_or(self.from);
        let hours = first.series(1.hour());
        hours.take_while(|hour| *hour <= self.until).collect()
    }
}
