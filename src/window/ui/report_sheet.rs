//! The report of a recorded pass as a page to print.

mod causes;
mod curves;
mod facts;
mod path;
#[cfg(test)]
mod tests;

use jiff::Timestamp;
use maud::{Markup, html};

use super::{
    format,
    page::{self, section},
    words::record,
};
use crate::contract::record::OpenedPass;

/// Returns the page of a pass as HTML, printed at `printed`. Times without a day belong to the day
/// on which the pass began.
pub fn html(opened: &OpenedPass, printed: Timestamp) -> String {
    let report = &opened.pass.report;
    let word = record::verdict(report.report.verdict).to_lowercase();
    let sentence = record::verdict_sentence(report, report.start);
    let content = html! {
        (head(opened, printed))
        (section("verdict", &format!("Verdict: {word}"), "", &html! { p { (sentence) } }))
        div.beside {
            (path::html(opened))
            (facts::html(report))
        }
        (curves::html(opened))
        (causes::html(opened))
        p.quiet.program { "Azel " (env!("CARGO_PKG_VERSION")) }
    };
    page::whole(&format!("Pass report, {}", report.elements.label()), &content)
}

fn head(opened: &OpenedPass, printed: Timestamp) -> Markup {
    let report = &opened.pass.report;
    let when = format!(
        "{} {}, {}, max {}",
        format::date(report.start),
        format::stretch(report.start, report.end, report.start),
        format::duration(report.report.counted_s),
        format::degrees(report.max_elevation_deg, 1)
    );
    let printed = format!("Printed {}", format::dated(printed));
    let name = format!(
        "{}, {}, {}",
        report.elements.catalog_number(),
        opened.pass.antenna_name,
        record::tracked_by(report.track.tracked_by)
    );
    let place = report.site.map(page::place).unwrap_or_default();
    let lines = [[&*when, &*printed], [&*name, &*place]];
    page::head(report.elements.name(), "Pass report", lines)
}
