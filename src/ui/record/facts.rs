//! What the antenna was led by, and how its clock stood.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};

use super::PADDING;
use crate::{
    driver::TimeSync,
    model::{Model, UiCommand, View},
    plan::pass_report::Cause,
    record::OpenedPass,
    ui::{
        format, text, theme,
        tokens::Tokens,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
        words::record as words,
    },
};

pub(super) const HEIGHT: f32 = 316.0;
const BAR: f32 = 32.0;
const LINE: f32 = 19.0;
/// From here on the clock of a unit is worth a caution, seconds.
const CLOCK_OFF_S: f64 = 0.1;

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    opened: &OpenedPass,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
    let bar = rect.with_max_y(rect.top() + BAR);
    ui.painter().rect_filled(bar, 0.0, t.bg2);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let title = bar.with_min_x(inner.left());
    paint::text_in(ui, title, Align2::LEFT_CENTER, "Flown with", text::small_strong(), t.t1);
    if let Some(place) = model.place(opened.pass.antenna) {
        let button = Button::normal("Unit settings");
        let size = vec2(button.width(ui), SMALL_HEIGHT);
        let at = pos2(inner.right() - size.x, bar.center().y - size.y / 2.0);
        if button.show(ui, "recorded unit", Rect::from_min_size(at, size)).clicked() {
            commands.push(UiCommand::SelectAntenna(place));
            commands.push(UiCommand::Show(View::Antennas));
        }
    }
    let mut y = bar.bottom() + 8.0;
    for (index, (name, value, colour)) in facts(model, opened, t).into_iter().enumerate() {
        let line = Rect::from_min_size(pos2(inner.left(), y), vec2(inner.width(), LINE));
        let left = paint::text_in(ui, line, Align2::LEFT_CENTER, name, text::small(), t.t2);
        let room = line.with_min_x(left.right() + 8.0);
        paint::text_in(ui, room, Align2::RIGHT_CENTER, &value, text::small(), colour);
        let words = format!("{name}: {value}");
        paint::name_text(ui, ("flown with", index), line, &words).on_hover_text(&words);
        y += LINE;
    }
    if !is_clock_late(opened) {
        return;
    }
    let words = "Set the unit's clock first: a time offset would hide the wrong clock, and be \
                 wrong itself once the clock is set.";
    let width = inner.width() - 24.0;
    let galley = ui.painter().layout(words.to_owned(), text::small(), t.warn, width);
    let note = Rect::from_min_size(
        pos2(inner.left(), y + 6.0),
        vec2(inner.width(), galley.size().y + 16.0),
    );
    ui.painter().rect_filled(note, 4.0, t.warnbg);
    ui.painter().galley(note.min + vec2(12.0, 8.0), galley, t.warn);
    paint::name_text(ui, "clock note", note, words);
}

/// The error is explained by the time, and the clock of the unit was off by then.
fn is_clock_late(opened: &OpenedPass) -> bool {
    let report = &opened.pass.report;
    let is_time = |explanation: &crate::plan::pass_report::Explanation| {
        matches!(explanation.cause, Cause::Late { .. })
    };
    report.explanations.first().is_some_and(is_time)
        && report.about.unit_clock_ahead_s.is_some_and(|ahead_s| ahead_s.abs() >= CLOCK_OFF_S)
}

fn facts(model: &Model, opened: &OpenedPass, t: &Tokens) -> Vec<(&'static str, String, Color32)> {
    let report = &opened.pass.report;
    let about = &report.about;
    let epoch = format::copied(report.elements.epoch());
    let age = format::age(report.age_days * 86_400.0);
    let mut facts = vec![
        ("Elements of", epoch, t.t1),
        ("Their age in the pass", age, t.t1),
        ("Tracked by", words::tracked_by(about.tracked_by).to_owned(), t.t1),
        ("Tracked since", format::moment(about.begun, model.now), t.t1),
    ];
    if let Some(sent) = about.sent {
        facts.push(("Positions sent", sent.to_string(), t.t1));
    }
    if let Some(ahead_s) = about.unit_clock_ahead_s {
        let colour = if ahead_s.abs() >= CLOCK_OFF_S { t.warn } else { t.t1 };
        let way = if ahead_s < 0.0 { "late" } else { "early" };
        let words = format!("{} s {way}", format::number(ahead_s.abs(), 2));
        facts.push(("Unit clock", words, colour));
    }
    let (sync, colour) = match about.sync {
        TimeSync::Synchronised => ("synchronised", t.t1),
        TimeSync::NotSynchronised => ("not synchronised", t.warn),
        TimeSync::NotKnown => ("not known", t.t2),
    };
    facts.push(("Clock of this computer", sync.to_owned(), colour));
    let known = format!(
        "{} of {}",
        format::duration(report.report.known_s),
        format::duration(report.report.counted_s)
    );
    facts.push(("With positions", known, t.t1));
    if let Some(rms) = report.report.rms {
        let two = |a: f64, b: f64| format!("{}, {}", format::degrees(a, 3), format::degrees(b, 3));
        facts.push(("Rms in azimuth, elevation", two(rms.azimuth_deg, rms.elevation_deg), t.t1));
        facts.push(("Rms along, across", two(rms.along_deg, rms.across_deg), t.t1));
    }
    facts
}
