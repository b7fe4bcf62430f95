//! The head of the page: which station, which hours, and how good the schedule is known to be.

use super::HandOverSheet;
use crate::ui::{
    format,
    sheet::{
        LEFT, RIGHT, place,
        svg::{Anchor, Face, Svg},
    },
    words,
};

impl HandOverSheet<'_> {
    /// Returns where the head ends.
    pub(super) fn head(&self, svg: &mut Svg, y: f64) -> f64 {
        const BODY: Face = Face::of(8.0);
        const ON_RIGHT: f64 = 140.0;
        let on_left = RIGHT - LEFT - ON_RIGHT - 8.0;
        let right = BODY.anchored(Anchor::End);
        svg.text([LEFT, y + 13.0], on_left, Face::of(15.0).bold(), &self.station.name);
        let title = Face::of(11.0).anchored(Anchor::End);
        svg.text([RIGHT, y + 13.0], ON_RIGHT, title, "Hand-over sheet");
        svg.line([LEFT, y + 19.0], [RIGHT, y + 19.0], 1.2);

        let minute = |at| format!("{} {}Z", format::date(at), format::minute_of_day(at));
        let span = format!("{} to {} (UTC)", minute(self.from), minute(self.until));
        svg.text([LEFT, y + 30.0], on_left, BODY.bold(), &span);
        let printed = format!("Printed {}", minute(self.printed));
        svg.text([RIGHT, y + 30.0], ON_RIGHT, right, &printed);

        let rule = words::schedule::choose_by(self.station.scheduling.choose_by);
        let proof = words::schedule::proof(self.schedule);
        svg.text([LEFT, y + 41.0], on_left, BODY, &format!("{rule}. {proof}"));
        let place = place(self.station.site);
        svg.text([RIGHT, y + 41.0], ON_RIGHT, right, &place);
        y + 43.0
    }
}
