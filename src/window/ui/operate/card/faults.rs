//! Checks of a unit: a summary line and a list with remedies.

use egui::{Align2, Color32, Popup, PopupCloseBehavior, Rect, Sense, Ui, pos2, vec2};

use super::Cursor;
use crate::{
    contract::antenna::AntennaModel,
    device::panel::{Check, CheckState},
    model::Model,
    ui::{
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        tokens::Tokens,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            close_key, paint,
        },
    },
};

const LIST_WIDTH: f32 = 340.0;
const DETAILS_WIDTH: f32 = 58.0;

fn icon(state: CheckState) -> Icon {
    match state {
        CheckState::Good => Icon::Check,
        CheckState::Caution => Icon::Warning,
        CheckState::Fault => Icon::Cross,
        CheckState::Unknown => Icon::Dash,
    }
}

fn word(state: CheckState) -> &'static str {
    match state {
        CheckState::Good => "good",
        CheckState::Caution => "caution",
        CheckState::Fault => "fault",
        CheckState::Unknown => "not known",
    }
}

fn colour(state: CheckState, t: &Tokens) -> Color32 {
    match state {
        CheckState::Good => t.ok,
        CheckState::Caution => t.warn,
        CheckState::Fault => t.bad,
        CheckState::Unknown => t.t3,
    }
}

/// Checks of a unit that reports some.
pub(super) struct Faults<'a> {
    /// Flag: the unit answers, so its last report is current.
    is_known: bool,
    checks: &'a [Check],
    /// Time of the unit's last report, as text; empty before the first report.
    checked_at: String,
}

impl<'a> Faults<'a> {
    pub(super) fn from_antenna(model: &Model, antenna: &'a AntennaModel) -> Option<Self> {
        let state = &antenna.snapshot.state;
        (!state.checks.is_empty()).then(|| Self {
            is_known: antenna.answers(model.steady).is_current(),
            checks: &state.checks,
            checked_at: state
                .checked_at
                .map_or_else(String::new, |time| format::moment(time, model.now)),
        })
    }
}

impl Faults<'_> {
    fn count(&self, state: CheckState) -> usize {
        self.checks.iter().filter(|check| check.state == state).count()
    }

    /// Returns the worst result; unknown while the unit does not answer.
    fn worst(&self) -> CheckState {
        if self.is_known { self.worst_reported() } else { CheckState::Unknown }
    }

    /// Returns the worst result of the last report. A fault weighs most; unknown weighs more than
    /// good.
    fn worst_reported(&self) -> CheckState {
        [CheckState::Fault, CheckState::Caution, CheckState::Unknown]
            .into_iter()
            .find(|state| self.count(*state) > 0)
            .unwrap_or(CheckState::Good)
    }

    /// Returns the result in a few words, and the sentence below it.
    fn summary(&self) -> (String, String) {
        if self.is_known || self.checked_at.is_empty() {
            return self.reported();
        }
        let (last, _) = self.reported();
        let last = format!("Last report {}: {}", self.checked_at, last.to_lowercase());
        ("Not known".into(), last)
    }

    /// Returns the summary of the last report, as if the report were current.
    fn reported(&self) -> (String, String) {
        let (all, worst) = (self.checks.len(), self.worst_reported());
        let named = || {
            let rows = self.checks.iter().filter(|check| check.state == worst);
            rows.map(|check| check.name).collect::<Vec<_>>().join(", ")
        };
        let time = if self.checked_at.is_empty() {
            String::new()
        } else {
            format!(", {}", self.checked_at)
        };
        match (worst, self.count(worst)) {
            (CheckState::Good, 1) => ("No faults".into(), format!("The only check passed{time}")),
            (CheckState::Good, _) => ("No faults".into(), format!("All {all} checks passed{time}")),
            (CheckState::Unknown, 1) if all == 1 => {
                ("Not known".into(), format!("The only check has no answer{time}"))
            }
            (CheckState::Unknown, count) => {
                let verb = if count == 1 { "has" } else { "have" };
                ("Not known".into(), format!("{count} of {all} checks {verb} no answer{time}"))
            }
            (CheckState::Caution, 1) => ("1 caution".into(), named()),
            (CheckState::Caution, count) => (format!("{count} cautions"), named()),
            (CheckState::Fault, 1) => ("1 fault".into(), named()),
            (CheckState::Fault, count) => (format!("{count} faults"), named()),
        }
    }

    /// Returns the result for the folded line.
    pub(super) fn folded_summary(&self, ui: &Ui) -> (String, (Icon, Color32)) {
        let worst = self.worst();
        let (good, all) = (self.count(CheckState::Good), self.checks.len());
        let words = match worst {
            CheckState::Good => format!("none, {good} of {all} passed"),
            CheckState::Unknown => "not known".to_owned(),
            CheckState::Caution | CheckState::Fault => {
                let (first, named) = self.summary();
                format!("{first}: {named}")
            }
        };
        (words, (icon(worst), colour(worst, theme::tokens(ui))))
    }

    /// Shows the line of the checks with its button.
    pub(super) fn show(&self, ui: &Ui, cursor: &mut Cursor) {
        let t = theme::tokens(ui);
        let row = cursor.take(47.0);
        for y in [row.top(), row.bottom()] {
            ui.painter().hline(cursor.card.x_range(), y, (1.0, t.line));
        }
        let worst = self.worst();
        let colour = colour(worst, t);
        let glyph = paint::square(pos2(row.left() + 9.0, row.center().y), 18.0);
        icons::paint(ui.painter(), glyph, icon(worst), colour);
        let button = Button::normal("Details");
        let min = pos2(row.right() - DETAILS_WIDTH, row.center().y - SMALL_HEIGHT / 2.0);
        let place = Rect::from_min_size(min, vec2(DETAILS_WIDTH, SMALL_HEIGHT));
        let room = row.with_min_x(row.left() + 26.0).with_max_x(place.left() - 8.0);
        let (first, second) = self.summary();
        let ink = if worst == CheckState::Good { t.t1 } else { colour };
        let up = room.translate(vec2(0.0, -8.0));
        paint::text_in(ui, up, Align2::LEFT_CENTER, &first, text::body_medium(), ink);
        let down = room.translate(vec2(0.0, 9.0));
        paint::text_in(ui, down, Align2::LEFT_CENTER, &second, text::small(), t.t2);
        paint::name_text(ui, "faults", room, &format!("{first}. {second}."));
        let response =
            button.show(ui, "fault details", place).accessible_name("Details of the checks");
        Popup::from_toggle_button_response(&response)
            .width(LIST_WIDTH)
            .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
            .accessible_name("Checks")
            .show(|ui| {
                self.show_list(ui);
                close_key::show(ui);
            });
    }

    fn show_list(&self, ui: &mut Ui) {
        let t = theme::tokens(ui);
        ui.spacing_mut().item_spacing.y = 0.0;
        for (index, check) in self.checks.iter().enumerate() {
            let advice = Some(check.advice)
                .filter(|advice| check.state != CheckState::Good && !advice.is_empty());
            let galley = advice.map(|advice| {
                ui.painter().layout(advice.to_owned(), text::small(), t.t2, LIST_WIDTH - 32.0)
            });
            let extra = galley.as_ref().map_or(0.0, |galley| galley.size().y + 4.0);
            let size = vec2(LIST_WIDTH, 26.0 + extra);
            let (row, _) = ui.allocate_exact_size(size, Sense::hover());
            if index > 0 {
                ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
            }
            let y = row.top() + 13.0;
            let shown = if self.is_known { check.state } else { CheckState::Unknown };
            let colour = colour(shown, t);
            let glyph = paint::square(pos2(row.left() + 10.0, y), 14.0);
            icons::paint(ui.painter(), glyph, icon(shown), colour);
            let was_reported = !self.is_known && check.state != CheckState::Unknown;
            let last = if was_reported { "last " } else { "" };
            let result = format!("{last}{}", word(check.state));
            let name_position = pos2(row.left() + 26.0, y);
            paint::text(
                ui,
                name_position,
                Align2::LEFT_CENTER,
                check.name,
                text::body_medium(),
                t.t1,
            );
            let result_position = pos2(row.right() - 4.0, y);
            let font = text::sized(12.0, Weight::Medium);
            paint::text(ui, result_position, Align2::RIGHT_CENTER, &result, font, colour);
            if let Some(galley) = galley {
                ui.painter().galley(pos2(row.left() + 26.0, row.top() + 24.0), galley, t.t2);
            }
            let advice = advice.unwrap_or_default();
            let name = format!("{}: {result}. {advice}", check.name);
            paint::name_text(ui, ("check", check.name), row, name.trim_end());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(name: &'static str, state: CheckState) -> Check {
        Check::new(name, state, "")
    }

    #[test]
    fn the_worst_finding_names_the_line() {
        let good = check("Power", CheckState::Good);
        let fault = check("Drive X", CheckState::Fault);
        let unknown = check("Clock", CheckState::Unknown);
        let summary = |checks: &[Check]| {
            Faults { is_known: true, checks, checked_at: "11:06:08Z".into() }.summary()
        };
        assert_eq!(
            summary(&[good.clone(), good.clone()]),
            ("No faults".into(), "All 2 checks passed, 11:06:08Z".into())
        );
        assert_eq!(
            summary(&[good.clone(), unknown.clone(), fault]),
            ("1 fault".into(), "Drive X".into())
        );
        let silent = ("Not known".into(), "1 of 2 checks has no answer, 11:06:08Z".into());
        assert_eq!(summary(&[good.clone(), unknown.clone()]), silent);
        let alone = ("Not known".into(), "The only check has no answer, 11:06:08Z".into());
        assert_eq!(summary(&[unknown]), alone);
        assert_eq!(summary(&[good]).1, "The only check passed, 11:06:08Z");
    }

    #[test]
    fn without_an_answer_nothing_is_known_and_the_last_report_is_told_as_such() {
        let checks = [check("Power", CheckState::Good), check("Drive X", CheckState::Fault)];
        let faults = |checks| Faults { is_known: false, checks, checked_at: "11:06:08Z".into() };
        let silent = faults(&checks);
        assert_eq!(silent.summary(), ("Not known".into(), "Last report 11:06:08Z: 1 fault".into()));
        assert_eq!(silent.worst(), CheckState::Unknown);
        let good = faults(&checks[..1]).summary();
        assert_eq!(good.1, "Last report 11:06:08Z: no faults");
    }
}
