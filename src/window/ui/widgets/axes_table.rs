//! Command, actual, error and rate of the axes of an antenna.

use egui::{Align2, FontId, Rect, Sense, Ui, pos2, vec2};

use super::{copy_menu, paint};
use crate::ui::{
    format,
    icons::{self, Icon},
    text::{self, Weight},
    theme,
    tokens::Tokens,
};

/// Placeholder for an unknown value.
pub const UNKNOWN: &str = "–";
const HEAD_HEIGHT: f32 = 18.0;
const ROW_HEIGHT: f32 = 26.0;
/// Right ends of the columns as parts of the width: command, actual, error, rate.
const COLUMNS: [f32; 4] = [0.325, 0.55, 0.77, 1.0];
/// Index of the column of measured values.
const ACTUAL: usize = 1;

/// Content of the second column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WantedColumn {
    /// The position commanded to the unit.
    #[default]
    Command,
    /// The predicted position of the satellite, for on-board track.
    Predicted,
}

impl WantedColumn {
    fn word(self) -> &'static str {
        match self {
            Self::Command => "Command",
            Self::Predicted => "Predicted",
        }
    }

    /// Returns the number of decimals of this column, for a unit whose angles have `of_unit`
    /// decimals.
    pub fn decimals(self, of_unit: usize, predicted: usize) -> usize {
        match self {
            Self::Command => of_unit,
            Self::Predicted => predicted,
        }
    }
}

#[derive(Debug, Clone, Copy, Default)]
pub struct AxisRow<'a> {
    /// Short name, such as Az.
    pub name: &'a str,
    pub wanted_deg: Option<f64>,
    pub actual_deg: Option<f64>,
    /// Measured minus commanded or predicted angle, degrees.
    pub error_deg: Option<f64>,
    pub rate_deg_s: Option<f64>,
}

/// The axes of an antenna.
#[derive(Debug, Clone, Copy, Default)]
pub struct AxesTable<'a> {
    pub wanted_column: WantedColumn,
    /// Decimals of measured and commanded values.
    pub decimals: usize,
    pub predicted_decimals: usize,
    /// Age of the measured values, such as `4.9 s`, while the unit does not answer in time.
    pub age: Option<&'a str>,
    pub axes: &'a [AxisRow<'a>],
}

/// Returns the height of the table for a number of axes, points.
pub fn height(axes: usize) -> f32 {
    HEAD_HEIGHT + ROW_HEIGHT * axes as f32
}

/// Shows the table in `rect`. Empty columns keep their place. A hollow ring marks old measured
/// values.
pub fn show(ui: &Ui, rect: Rect, table: &AxesTable<'_>) {
    let t = theme::tokens(ui);
    let wanted_word = table.wanted_column.word();
    let actual_word = match table.age {
        Some(age) => format!("{age} old °"),
        None => "Actual °".to_owned(),
    };
    let y = rect.top() + HEAD_HEIGHT / 2.0;
    let head = |x: f32, anchor: Align2, word: &str| {
        paint::text(ui, pos2(x, y), anchor, word, text::caption(), t.t3);
    };
    head(rect.left(), Align2::LEFT_CENTER, "Axis");
    let heads = [format!("{wanted_word} °"), actual_word, "Error °".into(), "Rate °/s".into()];
    for (part, word) in COLUMNS.iter().zip(heads) {
        head(rect.left() + part * rect.width(), Align2::RIGHT_CENTER, &word);
    }
    for (index, axis) in table.axes.iter().enumerate() {
        let top = rect.top() + HEAD_HEIGHT + ROW_HEIGHT * index as f32;
        let row = Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), ROW_HEIGHT));
        show_row(ui, row, table, axis, t);
    }
    let response = ui.interact(rect, ui.make_persistent_id("axes"), Sense::CLICK);
    copy_menu::offer(ui, &response, "the measured angles", || measured(table));
}

/// Returns the measured angles as text, such as `Az 143.17° El 30.02°`, with their age if they are
/// old.
fn measured(table: &AxesTable<'_>) -> String {
    let axes = table.axes.iter();
    let angles =
        axes.map(|axis| format!("{} {}°", axis.name, angle(axis.actual_deg, table.decimals)));
    let age = table.age.map(|age| format!("({age} old)"));
    angles.chain(age).collect::<Vec<_>>().join(" ")
}

fn show_row(ui: &Ui, row: Rect, table: &AxesTable<'_>, axis: &AxisRow<'_>, t: &Tokens) {
    let &AxesTable { wanted_column, decimals, predicted_decimals, age, .. } = table;
    let y = row.center().y;
    let strong = text::sized(15.0, Weight::SemiBold);
    paint::text(ui, pos2(row.left(), y), Align2::LEFT_CENTER, axis.name, strong.clone(), t.t1);
    let wanted_colour = match wanted_column {
        WantedColumn::Command => t.cmd,
        WantedColumn::Predicted => t.sat,
    };
    let wanted_decimals = wanted_column.decimals(decimals, predicted_decimals);
    let texts = [
        angle(axis.wanted_deg, wanted_decimals),
        angle(axis.actual_deg, decimals),
        signed(axis.error_deg, wanted_decimals),
        signed(axis.rate_deg_s, 2),
    ];
    let is_old = age.is_some() && axis.actual_deg.is_some();
    let actual_look = if is_old { (text::axis(), t.t3) } else { (strong, t.t1) };
    let looks: [(FontId, _); 4] =
        [(text::axis(), wanted_colour), actual_look, (text::axis(), t.t1), (text::axis(), t.t2)];
    for (index, ((part, words), (font, colour))) in
        COLUMNS.iter().zip(&texts).zip(looks).enumerate()
    {
        let position = pos2(row.left() + part * row.width(), y);
        let place = paint::text(ui, position, Align2::RIGHT_CENTER, words, font, colour);
        if is_old && index == ACTUAL {
            let ring = paint::square(pos2(place.left() - 8.0, y), 9.0);
            icons::paint(ui.painter(), ring, Icon::OpenRing, t.t3);
        }
    }
    let spoken = texts.map(|words| if words == UNKNOWN { "not known".to_owned() } else { words });
    let [wanted_text, actual, error, rate] = spoken;
    let old = age.filter(|_| is_old).map(|age| format!(", {age} old")).unwrap_or_default();
    let name = format!(
        "{}: {} {wanted_text}, actual {actual}{old}, error {error}, rate {rate}",
        axis.name,
        wanted_column.word()
    );
    paint::name_text(ui, ("axis", axis.name), row, &name);
}

/// Returns an angle with a typographic minus sign, or a dash.
pub fn angle(degrees: Option<f64>, decimals: usize) -> String {
    degrees.map_or_else(|| UNKNOWN.to_owned(), |value| format::number(value, decimals))
}

/// Returns a number that always shows its sign, or a dash.
fn signed(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), |value| format::signed(value, decimals))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn missing_numbers_are_dashes_and_small_errors_have_no_negative_zero() {
        assert_eq!(angle(None, 2), "–");
        assert_eq!(angle(Some(-3.456), 2), "−3.46");
        assert_eq!(signed(Some(-0.001), 2), "+0.00");
        assert_eq!(signed(Some(-0.04), 2), "−0.04");
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
            let table = AxesTable {
                wanted_column: WantedColumn::Predicted,
                decimals: 2,
                predicted_decimals: 2,
                age: None,
                axes: &axes,
            };
            show(ui, rect, &table);
        });
        window.get_by_label("Az: Predicted not known, actual 185.51, error −0.04, rate not known");
        let window = testing::window([400.0, 200.0], (), |ui, ()| {
            let axes = [AxisRow { name: "Az", actual_deg: Some(185.51), ..AxisRow::default() }];
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(312.0, height(1)));
            let table =
                AxesTable { decimals: 2, age: Some("4.9 s"), axes: &axes, ..AxesTable::default() };
            show(ui, rect, &table);
        });
        window.get_by_label(
            "Az: Command not known, actual 185.51, 4.9 s old, error not known, rate not known",
        );
    }

    #[test]
    fn only_what_is_predicted_has_more_decimals_than_the_unit() {
        for (wanted_column, spoken) in [
            (WantedColumn::Command, "Az: Command 173, actual 172, error −1, rate −0.25"),
            (WantedColumn::Predicted, "Az: Predicted 173.00, actual 172, error −1.00, rate −0.25"),
        ] {
            let window = testing::window([400.0, 200.0], wanted_column, |ui, wanted_column| {
                let axes = [AxisRow {
                    name: "Az",
                    wanted_deg: Some(173.0),
                    actual_deg: Some(172.0),
                    error_deg: Some(-1.0),
                    rate_deg_s: Some(-0.25),
                }];
                let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(312.0, height(1)));
                let table = AxesTable {
                    wanted_column: *wanted_column,
                    predicted_decimals: 2,
                    axes: &axes,
                    ..AxesTable::default()
                };
                show(ui, rect, &table);
            });
            window.get_by_label(spoken);
        }
    }
}
