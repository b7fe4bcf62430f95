//! The table of what would explain the error.

use super::TEXT;
use crate::{
    record::OpenedPass,
    ui::{
        format,
        sheet::{
            CAPTION, LEFT, RIGHT, section,
            svg::{Anchor, SHADE, Svg, wrapped},
        },
        words::record as words,
    },
};

const ROW: f64 = 11.5;
/// Where the columns end.
const CAUSE: f64 = LEFT + 130.0;
const SIZE: f64 = LEFT + 300.0;
const REST: f64 = LEFT + 370.0;
const SHARE_BAR: f64 = 100.0;

/// Draws the table with as many rows as there are.
pub(super) fn draw(svg: &mut Svg, y: f64, opened: &OpenedPass) {
    let explanations = &opened.pass.report.causes;
    let said = words::fitted_to(opened.track.len());
    let mut y = section(svg, y, "Causes of the error", &said);
    let right = CAPTION.anchored(Anchor::End);
    svg.text([LEFT, y + 5.0], CAUSE - LEFT, CAPTION, "Cause");
    svg.text([SIZE, y + 5.0], SIZE - CAUSE, right, "Best value");
    svg.text([REST, y + 5.0], REST - SIZE, right, "Residual °");
    svg.text([RIGHT, y + 5.0], RIGHT - REST, right, "Explained");
    y += 7.0;
    let rms = opened.pass.report.report.rms;
    let rms = rms.map_or_else(|| "–".to_owned(), |rms| format::number(rms.off_deg, 3));
    row(svg, &mut y, ["As recorded", "–", &rms, ""], None);
    if explanations.is_empty() {
        let words = words::not_explained(opened);
        y += ROW;
        svg.text([LEFT, y], RIGHT - LEFT, TEXT, words);
    }
    for of in explanations {
        let left = format::number(of.left_deg, 3);
        let share = words::whole_share(of.share);
        let size = words::size(&of.cause);
        row(svg, &mut y, [words::cause(&of.cause), &size, &left, &share], Some(of.share));
        if let Some(with) = &of.with {
            let (cause, size) = (words::second_cause(with), words::size(with));
            row(svg, &mut y, [&cause, &size, "", ""], None);
        }
    }
    if let Some(words) = words::alike(explanations) {
        y += 2.0;
        for line in wrapped(&words, RIGHT - LEFT, CAPTION, 2) {
            y += 9.0;
            svg.text([LEFT, y], RIGHT - LEFT, CAPTION, &line);
        }
    }
}

fn row(svg: &mut Svg, y: &mut f64, [cause, size, left, share]: [&str; 4], part: Option<f64>) {
    *y += ROW;
    let right = TEXT.anchored(Anchor::End);
    svg.text([LEFT, *y], CAUSE - LEFT, TEXT.bold(), cause);
    svg.text([SIZE, *y], SIZE - CAUSE, right, size);
    svg.text([REST, *y], REST - SIZE, right, left);
    if let Some(part) = part {
        let bar = [REST + 16.0, *y - 6.0];
        svg.filled(bar, [SHARE_BAR, 6.0], SHADE);
        svg.bar(bar, [SHARE_BAR * part.clamp(0.0, 1.0), 6.0]);
    }
    svg.text([RIGHT, *y], 40.0, right, share);
    svg.line([LEFT, *y + 3.0], [RIGHT, *y + 3.0], 0.2);
}
