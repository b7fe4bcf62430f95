//! The parts of the view around a step: the list of steps and the buttons below.

use egui::{Align2, Rect, Role, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::{NARROW_BELOW, PADDING, SetupState, Step, draft::SetupDraft, so_far, steps::Passed};
use crate::{
    contract::link_tests::LinkTest,
    model::{Model, UiCommand},
    ui::{
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::{
            button::{Button, HEIGHT},
            list::paint_ground,
            paint,
        },
        words,
    },
};

const STEPS: f32 = 304.0;
const SO_FAR: f32 = 344.0;
const STRIP: f32 = 48.0;
const FOOT: f32 = 72.0;
const LOW_FOOT: f32 = 52.0;
/// View height below which the foot is low, points.
const LOW_BELOW: f32 = 640.0;
const STEP: f32 = 80.0;
const RING: f32 = 13.0;

/// Places of the parts of the view.
pub(super) struct Panels {
    /// Place of the steps: a column, or a strip in a narrow view.
    steps: Rect,
    is_strip: bool,
    /// Places of the step and its buttons.
    pub(super) middle: (Rect, Rect),
    pub(super) right: Option<Rect>,
}

pub(super) fn split(rect: Rect) -> Panels {
    let foot = if rect.height() < LOW_BELOW { LOW_FOOT } else { FOOT };
    let over_foot = |middle: Rect| middle.split_top_bottom_at_y(middle.bottom() - foot);
    if rect.width() < NARROW_BELOW {
        let (steps, rest) = rect.split_top_bottom_at_y(rect.top() + STRIP);
        return Panels { steps, is_strip: true, middle: over_foot(rest), right: None };
    }
    let (steps, rest) = rect.split_left_right_at_x(rect.left() + STEPS);
    let (middle, right) = rest.split_left_right_at_x(rest.right() - SO_FAR);
    Panels { steps, is_strip: false, middle: over_foot(middle), right: Some(right) }
}

/// Shows the list of steps. Returns the clicked step.
pub(super) fn show_steps(
    ui: &Ui,
    panels: &Panels,
    model: &Model,
    draft: &SetupDraft,
    state: &SetupState,
) -> Option<Step> {
    let t = theme::tokens(ui);
    let rect = panels.steps;
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    if panels.is_strip {
        strip(ui, rect, model, draft, state)
    } else {
        column(ui, rect, model, draft, state)
    }
}

/// Shows the steps in a column, each with its result.
fn column(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    draft: &SetupDraft,
    state: &SetupState,
) -> Option<Step> {
    let t = theme::tokens(ui);
    let (mut clicked, unadded) = (None, state.unadded(model));
    ui.painter().vline(rect.right() - 0.5, rect.y_range(), (1.0, t.line));
    let inner = rect.shrink2(vec2(16.0, 16.0));
    let title = "Set up your station";
    paint::text(ui, inner.min, Align2::LEFT_TOP, title, text::title(), t.t1);
    let description = "Every step can be skipped and changed later in Preferences.";
    let position = inner.min + vec2(0.0, 28.0);
    let description =
        paint::paragraph(ui, position, inner.width(), description, text::small(), t.t2);
    let top = description.bottom() + 16.0;
    for (index, step) in Step::NUMBERED.into_iter().enumerate() {
        let min = pos2(rect.left(), top + STEP * index as f32);
        let row = Rect::from_min_size(min, vec2(rect.width(), STEP));
        let detail = detail(step, model, draft, state);
        let passed = state.passed(step, draft, model);
        if entry(ui, row, step, (&detail, passed), unadded.as_deref(), state) {
            clicked = Some(step);
        }
        let (ring, words) =
            (pos2(row.left() + 32.0, row.center().y), row.with_min_x(row.left() + 60.0));
        show_ring(ui, ring, step, passed, state);
        let (name, below) = words.shrink2(vec2(0.0, 18.0)).split_top_bottom_at_fraction(0.5);
        let strong = text::sized(14.0, Weight::SemiBold);
        paint::text_in(ui, name, Align2::LEFT_CENTER, step.name(), strong, t.t1);
        let below = below.with_max_x(rect.right() - 12.0);
        paint::text_in(ui, below, Align2::LEFT_CENTER, &detail, text::small(), t.t2);
    }
    let foot = rect.with_min_y(rect.bottom() - 40.0).shrink2(vec2(16.0, 0.0));
    let words = "Esc stops the antennas here as well.";
    paint::text_in(ui, foot, Align2::LEFT_CENTER, words, text::small(), t.t2);
    clicked
}

/// Shows the steps as numbers in one line, and the number of ready parts.
fn strip(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    draft: &SetupDraft,
    state: &SetupState,
) -> Option<Step> {
    let t = theme::tokens(ui);
    let (mut clicked, unadded) = (None, state.unadded(model));
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let parts = so_far::parts(model, draft, state.progress);
    let ready = format!("Ready {}", so_far::ready(&parts));
    let room = rect.shrink2(vec2(16.0, 0.0));
    let place = paint::text_in(ui, room, Align2::RIGHT_CENTER, &ready, text::body_medium(), t.t2);
    let sentences: Vec<String> =
        parts.iter().map(|part| format!("{}: {}", part.name, part.state)).collect();
    paint::name_text(ui, "ready", place, &ready).on_hover_text(sentences.join("\n"));
    let width = ((place.left() - 16.0 - rect.left()) / Step::NUMBERED.len() as f32).min(190.0);
    for (index, step) in Step::NUMBERED.into_iter().enumerate() {
        let min = pos2(rect.left() + width * index as f32, rect.top());
        let cell = Rect::from_min_size(min, vec2(width, rect.height()));
        let detail = detail(step, model, draft, state);
        let passed = state.passed(step, draft, model);
        if entry(ui, cell, step, (&detail, passed), unadded.as_deref(), state) {
            clicked = Some(step);
        }
        show_ring(ui, pos2(cell.left() + 28.0, cell.center().y), step, passed, state);
        let words = cell.with_min_x(cell.left() + 50.0);
        paint::text_in(ui, words, Align2::LEFT_CENTER, step.name(), text::body_medium(), t.t1);
    }
    clicked
}

/// Draws the background of a step. Returns `true` when the operator clicks it. An `unadded` source
/// locks the other steps and Next.
fn entry(
    ui: &Ui,
    row: Rect,
    step: Step,
    (detail, passed): (&str, Passed),
    unadded: Option<&str>,
    state: &SetupState,
) -> bool {
    let is_shown = state.step == step;
    let reason = unadded.filter(|_| !is_shown);
    let is_enabled = reason.is_none();
    let passed = match passed {
        Passed::NotYet => "",
        Passed::Done => ", done",
        Passed::Skipped => ", skipped",
    };
    let name = format!("Step {}: {}{passed}, {detail}", step.number(), step.name());
    let mut response = paint::control(ui, ("step", step), row, Role::Tab, is_enabled, &name);
    response.widget_info(|| WidgetInfo::selected(Role::Tab, is_enabled, is_shown, &name));
    if let Some(reason) = reason {
        response = response.on_hover_text(reason);
    }
    let is_hovered = is_enabled && response.hovered();
    paint_ground(ui, row, is_shown, is_hovered);
    paint::focus_ring(ui, &response, 0);
    response.clicked()
}

fn show_ring(ui: &Ui, position: egui::Pos2, step: Step, passed: Passed, state: &SetupState) {
    let t = theme::tokens(ui);
    let is_shown = state.step == step;
    let painter = ui.painter();
    let (icon, colour) = match passed {
        _ if is_shown => {
            painter.circle_filled(position, RING, t.sat);
            (None, t.onsat)
        }
        Passed::NotYet => {
            painter.circle_stroke(position, RING, Stroke::new(1.5, t.edge));
            (None, t.t2)
        }
        Passed::Done => {
            painter.circle(position, RING, t.okbg, Stroke::new(1.5, t.ok));
            (Some(Icon::Check), t.ok)
        }
        Passed::Skipped => {
            painter.circle_stroke(position, RING, Stroke::new(1.5, t.t3));
            (Some(Icon::Dash), t.t3)
        }
    };
    if let Some(icon) = icon {
        icons::paint(painter, paint::square(position, 14.0), icon, colour);
    } else {
        let number = step.number().to_string();
        paint::text(ui, position, Align2::CENTER_CENTER, number, text::body_medium(), colour);
    }
}

/// Returns the current result of a step.
fn detail(step: Step, model: &Model, draft: &SetupDraft, state: &SetupState) -> String {
    match step {
        Step::Site => match draft.site() {
            Some((name, _)) => {
                format!("{name}, {}", so_far::site(draft, state.progress).1)
            }
            None => "Where the antennas are".to_owned(),
        },
        Step::Antennas => {
            let count = draft.form.antennas.len();
            let tests = (0..count).filter_map(|index| draft.form.test(index, model));
            let reached: Vec<&LinkTest> =
                tests.filter(|test| words::link_test_reached(test)).collect();
            let faulty = reached.iter().filter(|test| words::link_test_faults(test) > 0).count();
            match (count, faulty) {
                (0, _) => "None yet".to_owned(),
                (_, 0) => format!("{} of {count} reached", reached.len()),
                (_, faulty) => {
                    format!("{} of {count} reached, {faulty} with a fault", reached.len())
                }
            }
        }
        Step::Satellites => crate::ui::words::capitalised(&so_far::satellites(draft).1),
        Step::Elements => crate::ui::words::capitalised(&so_far::elements(model, draft).1),
        Step::End => String::new(),
    }
}

/// Shows the buttons Back, Skip and Next, with the reason why Next is locked.
pub(super) fn show_foot(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    draft: &mut SetupDraft,
    state: &mut SetupState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let (step, hindrance) = (state.step, state.hindrance(draft, model));
    let words = match step.next() {
        Some(next) => format!("Next: {} (Enter)", next.name()),
        None => "Finish (Enter)".to_owned(),
    };
    let place = |left: f32, width: f32| {
        Rect::from_min_size(pos2(left, rect.center().y - HEIGHT / 2.0), vec2(width, HEIGHT))
    };
    let back = Button::normal("Back").locked(step.before().is_none());
    let next = Button::primary(&words).locked(hindrance.is_some());
    let skip = Button::quiet("Skip this step");
    let back_place = place(rect.left() + PADDING, back.width(ui) + 24.0);
    let width = next.width(ui) + 16.0;
    let next_place = place(rect.right() - PADDING - width, width);
    let mut left = next_place.left();
    let goes_back = back.show(ui, "back", back_place).clicked();
    let mut skips = false;
    if step.next().is_some() {
        let width = skip.width(ui);
        left -= width + 8.0;
        skips = skip.show(ui, "skip", place(left, width)).clicked();
    }
    let goes_on = next.show(ui, "next", next_place).clicked();
    let room = rect.with_min_x(back_place.right() + 16.0).with_max_x(left - 12.0);
    let (words, colour) = match hindrance {
        Some(words) => (words, t.warn),
        None if step == Step::End => (String::new(), t.t2),
        None => (format!("Step {} of {}", step.number(), Step::NUMBERED.len()), t.t2),
    };
    if !words.is_empty() {
        paint::paragraph_in(ui, room, &words, text::body(), colour);
        paint::name_text(ui, "progress", room, &words);
    }
    if goes_back {
        state.go_back();
    } else if skips {
        state.skip(draft);
    } else if goes_on {
        state.go_on(draft, model, commands);
    }
}
