//! Conditions of the track, next to the path.

use maud::{Markup, html};

use crate::{
    contract::record::RecordedReport,
    ui::words::flown_with::{FactKind, clock_first, facts},
};

pub(super) fn html(report: &RecordedReport) -> Markup {
    html! {
        div.facts {
            dl {
                @for fact in facts(report, report.start) {
                    div {
                        dt { (fact.name) }
                        dd.bold[matches!(fact.kind, FactKind::Caution)] { (fact.value) }
                    }
                }
            }
            @if let Some(words) = clock_first(report) { p { (words) } }
        }
    }
}
