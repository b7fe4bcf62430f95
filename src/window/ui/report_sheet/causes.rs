//! The table of possible causes of the error.

use maud::{Markup, html};

use crate::{
    contract::record::OpenedPass,
    ui::{
        format,
        page::{plot, section},
        words::record as words,
    },
};

pub(super) fn html(opened: &OpenedPass) -> Markup {
    let explanations = &opened.pass.report.causes;
    let rms = opened.pass.report.report.rms;
    let rms = rms.map_or_else(|| "–".to_owned(), |rms| format::number(rms.off_deg, 3));
    let content = html! {
        ul {
            li.heads {
                span.cause { "Cause" }
                span.number { "Best value" }
                span.number { "Residual °" }
                span {}
                span.number { "Explained" }
            }
            (row(["As recorded", "–", &rms], None))
            @for explanation in explanations {
                @let size = words::size(&explanation.cause);
                @let left = format::number(explanation.left_deg, 3);
                (row([words::cause(&explanation.cause), &size, &left], Some(explanation.share)))
                @if let Some(second) = &explanation.partner {
                    (row([&words::second_cause(second), &words::size(second), ""], None))
                }
            }
        }
        @if explanations.is_empty() { p { (words::not_explained(opened)) } }
        @if let Some(words) = words::alike(explanations) { p.quiet { (words) } }
    };
    section("causes", "Causes of the error", &words::fitted_to(opened.track.len()), &content)
}

fn row([cause, size, left]: [&str; 3], share: Option<f64>) -> Markup {
    html! {
        li {
            span.cause { (cause) }
            span.number { (size) }
            span.number { (left) }
            @if let Some(share) = share {
                svg viewBox="0 0 100 6" preserveAspectRatio="none" {
                    (plot::filled("shade", [0.0, 0.0], [100.0, 6.0]))
                    (plot::filled("filled", [0.0, 0.0], [100.0 * share.clamp(0.0, 1.0), 6.0]))
                }
                span.number { (words::whole_share(share)) }
            }
        }
    }
}
