//! Conditions of the track, beside the path.

use super::path;
use crate::{
    record::RecordedReport,
    ui::{
        sheet::{
            BODY, LEFT, RIGHT, SECTION_HEAD, SMALL,
            svg::{Anchor, Svg, wrapped},
        },
        words::flown_with::{FactKind, clock_first, facts},
    },
};

const LINE: f64 = 13.0;
const NOTE: f64 = 9.0;

/// Draws below the head of the path's section, and returns where the facts end.
pub(super) fn draw(svg: &mut Svg, y: f64, report: &RecordedReport) -> f64 {
    const NAME: f64 = 120.0;
    let left = LEFT + path::WIDTH + 16.0;
    let mut y = y + SECTION_HEAD + 2.0;
    for fact in facts(report, report.from) {
        y += LINE;
        svg.text([left, y], NAME, BODY.quiet(), fact.name);
        let face = BODY.anchored(Anchor::End);
        let face = if matches!(fact.kind, FactKind::Caution) { face.bold() } else { face };
        svg.text([RIGHT, y], RIGHT - left - NAME, face, &fact.value);
        svg.line([left, y + 3.5], [RIGHT, y + 3.5], 0.2);
    }
    if let Some(words) = clock_first(report) {
        y += 6.0;
        for line in wrapped(words, RIGHT - left, SMALL.bold(), 3) {
            y += NOTE;
            svg.text([left, y], RIGHT - left, SMALL.bold(), &line);
        }
    }
    y
}
