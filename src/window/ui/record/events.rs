//! Events of a pass, in lanes below its curves.

use egui::{Align2, Color32, Rect, Role, Sense, Ui, WidgetInfo, pos2};
use jiff::Timestamp;

use super::{PADDING, RecordState, curves};
use crate::{
    astro::time::seconds_between,
    contract::{
        CommandOrigin,
        alarms::{Alarm, AlarmChange},
        hooks::HookRun,
        record::{OpenedPass, Row},
    },
    model::Model,
    plan::pass_report::LossCause,
    ui::{
        format, text, theme,
        time_axis::TimeAxis,
        widgets::paint,
        words::{alarm, hooks::run as hook_words, record as words},
    },
};

const LANE: f32 = 20.0;
/// Gap between a mark and its words, points.
const GAP: f32 = 6.0;
/// Room for words to the right of the lane, points.
const MIN_DISTANCE: f32 = 80.0;
/// Min room for words, points; shorter words would be meaningless.
const MIN_ROOM: f32 = 24.0;
/// Min duration of a shown loss, seconds. The view would show a shorter loss as 0:00.
const MIN_S: f64 = 1.0;
const LANES: [&str; 4] = ["Pass", "Sent", "Link", "Alarm"];

/// Draws the lanes into `rect`; times have the same x as in `plots` above.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    plots: Rect,
    axis: &TimeAxis,
    model: &Model,
    opened: &OpenedPass,
    state: &mut RecordState,
) {
    let t = theme::tokens(ui);
    let lane = |index: usize| {
        let top = rect.top() + index as f32 * LANE;
        Rect::from_x_y_ranges(plots.x_range(), top..=top + LANE)
    };
    for (index, name) in LANES.into_iter().enumerate() {
        let place = lane(index);
        let label = place.with_min_x(rect.left() + PADDING).with_max_x(plots.left() - 4.0);
        paint::text_in(ui, label, Align2::LEFT_CENTER, name, text::caption(), t.t2);
        ui.painter().hline(rect.x_range(), place.bottom(), (1.0, t.line));
    }
    let below = lane(LANES.len());
    for minute in curves::minutes(axis) {
        let position = pos2(axis.x(minute), below.center().y);
        let words = format::minute_of_day(minute);
        paint::text(ui, position, Align2::CENTER_CENTER, words, text::caption(), t.t3);
    }
    link(ui, lane(2), axis, opened);
    for (index, of_lane) in events(model, axis, opened).into_iter().enumerate() {
        controls(ui, (index, lane(index)), axis, &of_lane, model.now, state);
        marks(ui, lane(index), axis, &of_lane);
    }
}

/// An event at a moment, with its words.
struct Moment {
    time: Timestamp,
    words: String,
    colour: Colour,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Colour {
    Satellite,
    Sent,
    Caution,
    Fault,
    Quiet,
}

impl Colour {
    fn in_theme(self, ui: &Ui) -> Color32 {
        let t = theme::tokens(ui);
        match self {
            Self::Satellite => t.sat,
            Self::Sent => t.cmd,
            Self::Caution => t.warn,
            Self::Fault => t.bad,
            Self::Quiet => t.t2,
        }
    }
}

fn events(model: &Model, axis: &TimeAxis, opened: &OpenedPass) -> [Vec<Moment>; 4] {
    let report = &opened.pass.report;
    let highest = opened
        .path
        .iter()
        .max_by(|a, b| a.direction.elevation_deg().total_cmp(&b.direction.elevation_deg()));
    let of_pass = |time: Timestamp, word: &str| Moment {
        time,
        words: format!("{word} {}", format::moment(time, model.now)),
        colour: Colour::Satellite,
    };
    let mut pass = vec![of_pass(report.start, "AOS")];
    pass.extend(highest.map(|sample| of_pass(sample.time, "TCA")));
    pass.push(of_pass(report.end, "LOS"));
    let mut lanes = [pass, Vec::new(), Vec::new(), Vec::new()];
    let mut announced: Vec<(i64, Alarm)> = Vec::new();
    let mut hooks = Vec::new();
    for row in &opened.entries {
        let (lane, words, colour) = match &*row.kind {
            "command" => (1, command(row), Colour::Sent),
            "stop" => (1, stop(row), Colour::Fault),
            "refusal" => (1, "Refused".to_owned(), Colour::Caution),
            "link" => (2, variant(&row.data).unwrap_or_default(), Colour::Caution),
            "alarm" => match serde_json::from_value::<Alarm>(row.data.clone()) {
                Ok(raised) => {
                    let words = alarm(&raised.kind, &opened.pass.antenna_name, model.now);
                    let place = announced
                        .iter()
                        .position(|(run, earlier)| *run == row.run && earlier.id == raised.id);
                    let before = place.map(|place| announced.swap_remove(place).1);
                    let change = AlarmChange::new(&raised, before.as_ref(), row.time);
                    announced.push((row.run, raised));
                    let Some(change) = change else { continue };
                    match words::alarm_change(change) {
                        Some(change) => (3, format!("{change}: {words}"), Colour::Quiet),
                        None => (3, words, Colour::Caution),
                    }
                }
                Err(_) => continue,
            },
            "hook" => match serde_json::from_value::<HookRun>(row.data.clone()) {
                Ok(run) => {
                    let colour = if run.is_failure() { Colour::Caution } else { Colour::Sent };
                    hooks.push(Moment { time: run.started, words: hook_words(&run), colour });
                    continue;
                }
                Err(_) => continue,
            },
            "gap" => (2, not_recorded(row), Colour::Caution),
            _ => continue,
        };
        // The record contains a gap at its end.
        let time = row.gap_since().map_or(row.time, |start| start.max(axis.start()));
        if let Some(lane) = lanes.get_mut(lane) {
            lane.push(Moment { time, words, colour });
        }
    }
    if let Some(lane) = lanes.get_mut(1) {
        lane.extend(hooks);
    }
    let is_told = |cause: LossCause, seconds: f64| has_positions(cause) && seconds >= MIN_S;
    let longest = report.report.losses.iter();
    let longest = longest.filter(|lost| is_told(lost.cause, lost.seconds()));
    if let Some(alarms) = lanes.last_mut() {
        alarms.extend(longest.map(|lost| Moment {
            time: lost.start,
            words: format!(
                "Beyond half the beamwidth for {}: {}",
                format::duration(lost.seconds()),
                words::loss(lost.cause).to_lowercase()
            ),
            colour: Colour::Fault,
        }));
    }
    for lane in &mut lanes {
        lane.sort_by_key(|moment| moment.time);
    }
    lanes
}

/// Describes a STOP with its origin or its outcome.
fn stop(row: &Row) -> String {
    match origin_of_row(row) {
        Some(origin) => format!("STOP (from {})", given_by(origin)),
        None => variant(&row.data).unwrap_or_else(|| "STOP".to_owned()),
    }
}

fn not_recorded(row: &Row) -> String {
    match row.gap_since() {
        Some(start) => {
            let lasted_s = seconds_between(start, row.time);
            format!("Not recorded for {}", format::duration(lasted_s))
        }
        None => "Not recorded".to_owned(),
    }
}

fn origin_of_row(row: &Row) -> Option<CommandOrigin> {
    row.data.get("by").cloned().and_then(|origin| serde_json::from_value(origin).ok())
}

/// Describes a command and its origin.
fn command(row: &Row) -> String {
    let command = row.data.get("command");
    let of_antenna =
        command.and_then(|command| command.get("Antenna")).and_then(|parts| parts.get(1));
    let subject = of_antenna.or(command).and_then(variant).unwrap_or_default();
    match origin_of_row(row).map(given_by) {
        Some(name) => format!("{subject} (from {name})"),
        None => subject,
    }
}

fn given_by(origin: CommandOrigin) -> String {
    match origin {
        CommandOrigin::Window => "the window".to_owned(),
        CommandOrigin::Serve => "azel serve".to_owned(),
        CommandOrigin::Program => "another program".to_owned(),
        CommandOrigin::Signal => "a signal".to_owned(),
        CommandOrigin::Station => "the station".to_owned(),
        CommandOrigin::Port(address) => format!("the program at {address}"),
    }
}

/// Splits the name of a variant into words.
fn variant(value: &serde_json::Value) -> Option<String> {
    let name = value.as_str().or_else(|| {
        value.as_object().and_then(|fields| fields.keys().next()).map(String::as_str)
    })?;
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
            words.extend(letter.to_lowercase());
        } else {
            words.push(letter);
        }
    }
    Some(words)
}

fn has_positions(cause: LossCause) -> bool {
    !matches!(cause, LossCause::NotMeasured | LossCause::LinkLost)
}

/// Draws bars where positions arrived, and where they were missing.
fn link(ui: &Ui, lane: Rect, axis: &TimeAxis, opened: &OpenedPass) {
    let t = theme::tokens(ui);
    let report = &opened.pass.report;
    let bar = |start: Timestamp, end: Timestamp, colour| {
        let (left, right) = (axis.x(start), axis.x(end).max(axis.x(start) + 2.0));
        let place =
            Rect::from_x_y_ranges(left..=right, lane.center().y - 2.5..=lane.center().y + 2.5);
        ui.painter().rect_filled(place, 0.0, colour);
    };
    bar(report.start, report.end, t.ok);
    for lost in &report.report.losses {
        if !has_positions(lost.cause) {
            bar(lost.start, lost.end, t.bad);
        }
    }
}

fn mark(lane: Rect, axis: &TimeAxis, time: Timestamp) -> Rect {
    let x = axis.x(time).clamp(lane.left(), lane.right());
    Rect::from_center_size(pos2(x, lane.center().y), egui::vec2(3.0, 13.0))
}

/// Draws the moments of a lane as controls, in order of time.
fn controls(
    ui: &Ui,
    (number, lane): (usize, Rect),
    axis: &TimeAxis,
    moments: &[Moment],
    now: Timestamp,
    state: &mut RecordState,
) {
    for (index, moment) in moments.iter().enumerate() {
        let mark = mark(lane, axis, moment.time);
        let id = ui.make_persistent_id(("recorded event", number, index));
        let response = ui.interact(mark.expand(4.0), id, Sense::click());
        let spoken = format!("{}: {}", format::moment(moment.time, now), moment.words);
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &spoken));
        paint::focus_ring(ui, &response, 1);
        if response.clicked() {
            state.cursor = Some(moment.time);
        }
        response.on_hover_text(&spoken);
    }
}

/// Draws the moments of a lane. Omits words that would reach the next moment.
fn marks(ui: &Ui, lane: Rect, axis: &TimeAxis, moments: &[Moment]) {
    // The loop runs from the right: the words of a moment end before the words of the next begin.
    let mut free_to = lane.right() + MIN_DISTANCE;
    for (index, moment) in moments.iter().enumerate().rev() {
        let colour = moment.colour.in_theme(ui);
        let place = mark(lane, axis, moment.time);
        let x = place.center().x;
        ui.painter().rect_filled(place, 0.0, colour);
        let font = text::caption();
        let width = paint::text_width(ui, &moment.words, font.clone());
        let before = moments
            .get(..index)
            .and_then(<[Moment]>::last)
            .map_or(lane.left(), |before| mark(lane, axis, before.time).center().x);
        let room = if x + GAP + width > free_to && x - GAP - width > before + GAP {
            lane.with_min_x(x - GAP - width).with_max_x(x - GAP)
        } else {
            lane.with_min_x(x + GAP).with_max_x(free_to.max(x + GAP))
        };
        if room.width() >= MIN_ROOM {
            let letters = room.shrink2(egui::vec2(-2.0, 3.0));
            let letters =
                letters.with_max_x(letters.right().min(letters.left() + width + 2.0 + GAP));
            ui.painter().rect_filled(letters, 0.0, theme::tokens(ui).bg0);
            paint::text_in(ui, room, Align2::LEFT_CENTER, &moment.words, font, colour);
        }
        free_to = room.left().min(place.left()) - GAP;
    }
}
