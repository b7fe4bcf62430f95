//! The report of a recorded pass as a page to print, as SVG.

mod causes;
mod curves;
mod facts;
mod path;
#[cfg(test)]
mod tests;

use jiff::Timestamp;

use super::{
    format,
    sheet::{
        BOTTOM, CAPTION, LEFT, MARGIN, RIGHT, place, section,
        svg::{Anchor, Face, Svg, wrapped},
    },
    words::record,
};
use crate::record::OpenedPass;

/// Between two sections.
const GAP: f64 = 12.0;
const TEXT: Face = Face::of(8.0);

/// The page of a pass, printed at `printed`. Its times are of the day on which the pass began,
/// unless they carry a day.
pub fn svg(opened: &OpenedPass, printed: Timestamp) -> String {
    let report = &opened.pass.report;
    let mut svg = Svg::new(&format!("Pass report, {}", report.elements.label()));
    let mut y = head(&mut svg, MARGIN, opened, printed) + GAP;
    y = verdict(&mut svg, y, opened) + GAP;
    let path_end = path::draw(&mut svg, y, opened);
    y = path_end.max(facts::draw(&mut svg, y, report)) + GAP;
    y = curves::draw(&mut svg, y, opened) + GAP;
    causes::draw(&mut svg, y, opened);
    let program = concat!("Azel ", env!("CARGO_PKG_VERSION"));
    svg.text([LEFT, BOTTOM], RIGHT - LEFT, CAPTION, program);
    svg.finish()
}

/// Returns where the head ends.
fn head(svg: &mut Svg, y: f64, opened: &OpenedPass, printed: Timestamp) -> f64 {
    const ON_RIGHT: f64 = 170.0;
    let on_left = RIGHT - LEFT - ON_RIGHT - 8.0;
    let right = TEXT.anchored(Anchor::End);
    let report = &opened.pass.report;
    svg.name([LEFT, y + 13.0], on_left, Face::of(15.0).bold(), report.elements.name());
    let title = Face::of(11.0).anchored(Anchor::End);
    svg.text([RIGHT, y + 13.0], ON_RIGHT, title, "Pass report");
    svg.line([LEFT, y + 19.0], [RIGHT, y + 19.0], 1.2);

    let when = format!(
        "{} {}, {}, max {}",
        format::date(report.from),
        format::stretch(report.from, report.until, report.from),
        format::duration(report.report.counted_s),
        format::degrees(report.max_elevation_deg, 1)
    );
    svg.text([LEFT, y + 30.0], on_left, TEXT.bold(), &when);
    let printed = format!("Printed {}", format::dated(printed));
    svg.text([RIGHT, y + 30.0], ON_RIGHT, right, &printed);

    let by = format!(
        "{}, {}, {}",
        report.elements.catalog_number(),
        opened.pass.antenna_name,
        record::tracked_by(report.about.tracked_by)
    );
    svg.text([LEFT, y + 41.0], on_left, TEXT, &by);
    let place = report.site.map(place).unwrap_or_default();
    svg.text([RIGHT, y + 41.0], ON_RIGHT, right, &place);
    y + 43.0
}

/// Returns where the verdict ends.
fn verdict(svg: &mut Svg, y: f64, opened: &OpenedPass) -> f64 {
    const LINES: usize = 4;
    const LINE: f64 = 10.5;
    let pass = &opened.pass;
    let word = record::verdict(pass.report.report.verdict);
    let mut y = section(svg, y, &format!("Verdict: {}", word.to_lowercase()), "");
    let sentence = record::verdict_sentence(&pass.report, pass.report.from);
    for line in wrapped(&sentence, RIGHT - LEFT, TEXT, LINES) {
        y += LINE;
        svg.text([LEFT, y], RIGHT - LEFT, TEXT, &line);
    }
    y
}
