//! Command, actual, error and rate of the axes of an antenna.

use egui::{Align2, FontId, Rect, Ui, pos2, vec2};

use super::paint;
use crate::ui::{
    text::{self, Weight},
    theme,
    tokens::Tokens,
};

/// What a value is shown as when it is not known.
pub const UNKNOWN: &str = "–";
const HEAD_HEIGHT: f32 = 18.0;
const ROW_HEIGHT: f32 = 26.0;
/// Right ends of the columns as parts of the width: command, actual, error, rate.
const COLUMNS: [f32; 4] = [0.325, 0.55, 0.77, 1.0];

/// What the second column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WantedColumn {
    /// What the unit was told.
    #[default]
    Command,
    /// Where the satellite is predicted, for a unit that tracks by itself.
    Predicted,
}

/// One axis.
#[derive(Debug, Clone, Copy, Default)]
pub struct AxisRow<'a> {
    /// Short name, such as Az.
    pub name: &'a str,
    /// Wanted, in degrees.
    pub wanted_deg: Option<f64>,
    /// Measured, in degrees.
    pub actual_deg: Option<f64>,
    /// Measured minus wanted, in degrees.
    pub error_deg: Option<f64>,
    /// Measured, in degrees per second.
    pub rate_deg_s: Option<f64>,
}

/// Height of the table for a number of axes.
pub fn height(axes: usize) -> f32 {
    HEAD_HEIGHT + ROW_HEIGHT * axes as f32
}

/// Shows the table in `rect`. Every column keeps its place whatever it holds.
pub fn show(ui: &Ui, rect: Rect, wanted: WantedColumn, axes: &[AxisRow<'_>]) {
    let t = theme::tokens(ui);
    let wanted_word = match wanted {
        WantedColumn::Command => "Command",
        WantedColumn::Predicted => "Predicted",
    };
    let y = rect.top() + HEAD_HEIGHT / 2.0;
    let head = |x: f32, anchor: Align2, word: &str| {
        paint::text(ui, pos2(x, y), anchor, word, text::caption(), t.t3);
    };
    head(rect.left(), Align2::LEFT_CENTER, "Axis");
    let heads =
        [format!("{wanted_word} °"), "Actual °".into(), "Error °".into(), "Rate °/s".into()];
    for (part, word) in COLUMNS.iter().zip(heads) {
        head(rect.left() + part * rect.width(), Align2::RIGHT_CENTER, &word);
    }
    for (index, axis) in axes.iter().enumerate() {
        let top = rect.top() + HEAD_HEIGHT + ROW_HEIGHT * index as f32;
        let row = Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), ROW_HEIGHT));
        show_row(ui, row, wanted, wanted_word, axis, t);
    }
}

fn show_row(
    ui: &Ui,
    row: Rect,
    wanted: WantedColumn,
    wanted_word: &str,
    axis: &AxisRow<'_>,
    t: &Tokens,
) {
    let y = row.center().y;
    let strong = text::sized(15.0, Weight::SemiBold);
    paint::text(ui, pos2(row.left(), y), Align2::LEFT_CENTER, axis.name, strong.clone(), t.t1);
    let wanted_colour = match wanted {
        WantedColumn::Command => t.cmd,
        WantedColumn::Predicted => t.sat,
    };
    let texts = [
        angle(axis.wanted_deg),
        angle(axis.actual_deg),
        signed(axis.error_deg),
        signed(axis.rate_deg_s),
    ];
    let looks: [(FontId, _); 4] =
        [(text::axis(), wanted_colour), (strong, t.t1), (text::axis(), t.t1), (text::axis(), t.t2)];
    for ((part, words), (font, colour)) in COLUMNS.iter().zip(&texts).zip(looks) {
        let at = pos2(row.left() + part * row.width(), y);
        paint::text(ui, at, Align2::RIGHT_CENTER, words, font, colour);
    }
    let spoken = texts.map(|words| if words == UNKNOWN { "not known".to_owned() } else { words });
    let [wanted, actual, error, rate] = spoken;
    let name = format!(
        "{}: {wanted_word} {wanted}, actual {actual}, error {error}, rate {rate}",
        axis.name
    );
    paint::name_text(ui, ("axis", axis.name), row, &name);
}

/// Two decimals, with a true minus sign, or a dash.
pub fn angle(degrees: Option<f64>) -> String {
    degrees.map_or_else(|| UNKNOWN.to_owned(), |value| format!("{value:.2}").replace('-', "−"))
}

/// Two decimals with their sign, or a dash.
fn signed(value: Option<f64>) -> String {
    value.map_or_else(
        || UNKNOWN.to_owned(),
        // Adding zero turns a negative zero into the usual one.
        |value| format!("{:+.2}", (value * 100.0).round() / 100.0 + 0.0).replace('-', "−"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn missing_numbers_are_dashes_and_small_errors_have_no_negative_zero() {
        assert_eq!(angle(None), "–");
        assert_eq!(angle(Some(-3.456)), "−3.46");
        assert_eq!(signed(Some(-0.001)), "+0.00");
        assert_eq!(signed(Some(-0.04)), "−0.04");
    }

    #[test]
    fn each_axis_can_be_read_aloud() {
        let window = testing::window([400.0, 200.0], (), |ui, ()| {
            let axes = [AxisRow {
                name: "Az",
                actual_deg: Some(185.51),
                error_deg: Some(-0.04),
                ..AxisRow::default()
            }];
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(312.0, height(1)));
            show(ui, rect, WantedColumn::Predicted, &axes);
        });
        window.get_by_label("Az: Predicted not known, actual 185.51, error −0.04, rate not known");
    }
}
