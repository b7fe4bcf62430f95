//! The bar of a replay, with its passes and the current time.

use egui::{
    Align2, EventFilter, Id, Rect, Response, Role, Sense, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};
use jiff::Timestamp;

use super::HEIGHT;
use crate::{
    astro::time::seconds_between,
    contract::record::PassTimes,
    model::{
        UiCommand,
        replay::{ReplayCommand, Replayed, Stretch},
    },
    ui::{format, text, theme, time_axis::TimeAxis, widgets::paint},
};

/// Min width of the bar, points.
const MIN_WIDTH: f32 = 40.0;
/// Half the height of the bar, and of the box around a pass, points.
const HALF_BAR: f32 = 4.0;
const HALF_BOX: f32 = 7.0;
/// Min width of a lost part, points.
const MIN_LOST: f32 = 2.0;
/// Min gap between two words below the bar, points.
const WORD_GAP: f32 = 6.0;

/// Returns the id of the only bar. The keys of a replay also work while the bar has the focus.
pub(super) fn id() -> Id {
    Id::unique("replay moment")
}

/// Shows the bar in `rect`. A click or a drag on the bar jumps to a time.
pub(super) fn scrubber(ui: &Ui, rect: Rect, replay: &Replayed, commands: &mut Vec<UiCommand>) {
    if rect.width() < MIN_WIDTH {
        return;
    }
    let t = theme::tokens(ui);
    let line = Line::new(rect, &replay.stretch);
    let is_high = rect.height() >= HEIGHT;
    ui.painter().rect(line.bar, 0.0, t.bg0, (1.0, t.edge), StrokeKind::Inside);
    let x = line.axis.x_within(replay.time);
    ui.painter().rect_filled(line.bar.with_max_x(x), 0.0, t.warn);
    for (place, times) in replay.passes.iter().enumerate() {
        pass(ui, &line, place, times, replay.time);
    }
    if is_high {
        below(ui, rect, &line, &replay.passes);
        let times = Rect::from_x_y_ranges(rect.x_range(), rect.top() + 2.0..=rect.top() + 18.0);
        let (font, colour) = (text::caption(), t.t2);
        let [start_text, end_text] = [replay.stretch.start, replay.stretch.end].map(format::clock);
        paint::text_in(ui, times, Align2::LEFT_CENTER, &start_text, font.clone(), colour);
        if rect.width() > 140.0 {
            paint::text_in(ui, times, Align2::RIGHT_CENTER, &end_text, font, colour);
        }
    }
    let response = moment(ui, &line, replay, commands);
    let handle = Rect::from_center_size(pos2(x, line.bar.center().y), vec2(6.0, 22.0));
    ui.painter().rect_filled(handle, 1.0, t.ant);
    paint::focus_ring(ui, &response, 2);
    if !replay.passes.is_empty() {
        let sentences: Vec<String> =
            replay.passes.iter().map(|pass_times| in_words(pass_times, replay.time)).collect();
        response.on_hover_text(sentences.join("\n"));
    }
}

/// The bar and its time axis.
struct Line {
    bar: Rect,
    axis: TimeAxis,
}

impl Line {
    fn new(rect: Rect, stretch: &Stretch) -> Self {
        let y = rect.center().y;
        let whole_s = seconds_between(stretch.start, stretch.end);
        Self {
            bar: Rect::from_x_y_ranges(rect.x_range(), y - HALF_BAR..=y + HALF_BAR),
            axis: TimeAxis::lasting(stretch.start, whole_s, rect.x_range()),
        }
    }
}

/// Draws a pass: a box from AOS to LOS, a tick at TCA, and red parts where the beam lost the
/// satellite.
fn pass(ui: &Ui, line: &Line, place: usize, times: &PassTimes, now: Timestamp) {
    let t = theme::tokens(ui);
    let y = line.bar.center().y;
    let (start, end) = (line.axis.x_within(times.aos), line.axis.x_within(times.los));
    let box_rect = Rect::from_x_y_ranges(start..=end, y - HALF_BOX..=y + HALF_BOX);
    for (start, end) in &times.lost {
        let (start, end) = (line.axis.x_within(*start), line.axis.x_within(*end));
        let lost = box_rect.with_min_x(start).with_max_x(end.max(start + MIN_LOST));
        ui.painter().rect_filled(lost, 0.0, t.bad);
    }
    ui.painter().rect_stroke(box_rect, 0.0, (1.0, t.sat), StrokeKind::Inside);
    if let Some(tca) = times.tca {
        ui.painter().vline(line.axis.x_within(tca), box_rect.y_range(), (1.0, t.sat));
    }
    paint::name_text(ui, ("pass", place), box_rect, &in_words(times, now));
}

fn in_words(pass: &PassTimes, now: Timestamp) -> String {
    let label = |word: &str, time| format!("{word} {}", format::moment(time, now));
    let lost_s: f64 = pass.lost.iter().map(|(start, end)| seconds_between(*start, *end)).sum();
    let lost = if pass.lost.is_empty() {
        "nothing lost".to_owned()
    } else {
        format!("{} lost", format::duration(lost_s))
    };
    let times = [Some(label("AOS", pass.aos)), pass.tca.map(|tca| label("TCA", tca))];
    let times: Vec<String> = times.into_iter().flatten().chain([label("LOS", pass.los)]).collect();
    format!("{}: {}, {lost}", pass.name, times.join(", "))
}

/// Draws the events of a single pass or the names of several passes below the bar, as far as they
/// fit.
fn below(ui: &Ui, rect: Rect, line: &Line, passes: &[PassTimes]) {
    let t = theme::tokens(ui);
    let words: Vec<(&str, Timestamp)> = match passes {
        [only] => {
            [Some(("AOS", only.aos)), Some(("LOS", only.los)), only.tca.map(|time| ("TCA", time))]
                .into_iter()
                .flatten()
                .collect()
        }
        several => {
            several.iter().map(|times| (&*times.name, times.tca.unwrap_or(times.aos))).collect()
        }
    };
    let mut rects: Vec<Rect> = Vec::new();
    for (word, time) in words {
        let width = paint::text_width(ui, word, text::caption());
        let max = (rect.right() - width / 2.0).max(rect.left() + width / 2.0);
        let middle = line.axis.x_within(time).clamp(rect.left() + width / 2.0, max);
        let place = Rect::from_center_size(pos2(middle, rect.bottom() - 9.0), vec2(width, 16.0));
        if rects.iter().any(|other| other.intersects(place.expand2(vec2(WORD_GAP, 0.0)))) {
            continue;
        }
        paint::text(ui, place.center(), Align2::CENTER_CENTER, word, text::caption(), t.t2);
        rects.push(place);
    }
}

/// Handles the time that the operator jumps to.
fn moment(ui: &Ui, line: &Line, replay: &Replayed, commands: &mut Vec<UiCommand>) -> Response {
    let place = line.bar.expand2(vec2(0.0, 8.0));
    let response = ui.interact(place, id(), Sense::click_and_drag());
    let words = format!("Moment of the replay, {}", format::moment(replay.time, replay.time));
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, &words));
    let requested = response.interact_pointer_pos().map(|position| line.axis.time(position.x));
    if response.has_focus() {
        // The arrow keys move the time, not the focus.
        let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id(), filter));
    }
    commands.extend(requested.map(|time| UiCommand::Replay(ReplayCommand::To(time))));
    response
}
