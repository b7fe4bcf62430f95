//! The stretch of a replay as a bar, with its passes and the moment that is shown.

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

/// Least width of the bar.
const LEAST: f32 = 40.0;
/// Half the height of the bar, and of the box around a pass.
const HALF_BAR: f32 = 4.0;
const HALF_BOX: f32 = 7.0;
/// Least width of what was lost.
const LEAST_LOST: f32 = 2.0;
/// Least gap between two words below the bar.
const WORD_GAP: f32 = 6.0;

/// The bar, of which there is one: the keys of a replay work with the focus there as well.
pub(super) fn id() -> Id {
    Id::unique("replay moment")
}

/// Shows the bar in `rect`. A click or a drag there goes to a moment.
pub(super) fn scrubber(ui: &Ui, rect: Rect, replay: &Replayed, commands: &mut Vec<UiCommand>) {
    if rect.width() < LEAST {
        return;
    }
    let t = theme::tokens(ui);
    let line = Line::new(rect, &replay.stretch);
    let is_high = rect.height() >= HEIGHT;
    ui.painter().rect(line.bar, 0.0, t.bg0, (1.0, t.edge), StrokeKind::Inside);
    let x = line.axis.x_within(replay.at);
    ui.painter().rect_filled(line.bar.with_max_x(x), 0.0, t.warn);
    for (place, times) in replay.passes.iter().enumerate() {
        pass(ui, &line, place, times, replay.at);
    }
    if is_high {
        below(ui, rect, &line, &replay.passes);
        let times = Rect::from_x_y_ranges(rect.x_range(), rect.top() + 2.0..=rect.top() + 18.0);
        let (font, colour) = (text::caption(), t.t2);
        let [from, until] = [replay.stretch.from, replay.stretch.until].map(format::clock);
        paint::text_in(ui, times, Align2::LEFT_CENTER, &from, font.clone(), colour);
        if rect.width() > 140.0 {
            paint::text_in(ui, times, Align2::RIGHT_CENTER, &until, font, colour);
        }
    }
    let response = moment(ui, &line, replay, commands);
    let handle = Rect::from_center_size(pos2(x, line.bar.center().y), vec2(6.0, 22.0));
    ui.painter().rect_filled(handle, 1.0, t.ant);
    paint::focus_ring(ui, &response, 2);
    if !replay.passes.is_empty() {
        let told: Vec<String> = replay.passes.iter().map(|of| in_words(of, replay.at)).collect();
        response.on_hover_text(told.join("\n"));
    }
}

/// The bar, and the time along it.
struct Line {
    bar: Rect,
    axis: TimeAxis,
}

impl Line {
    fn new(rect: Rect, stretch: &Stretch) -> Self {
        let y = rect.center().y;
        let whole_s = seconds_between(stretch.from, stretch.until);
        Self {
            bar: Rect::from_x_y_ranges(rect.x_range(), y - HALF_BAR..=y + HALF_BAR),
            axis: TimeAxis::lasting(stretch.from, whole_s, rect.x_range()),
        }
    }
}

/// A box from AOS to LOS, a tick at TCA, and in red where the beam was lost.
fn pass(ui: &Ui, line: &Line, place: usize, times: &PassTimes, now: Timestamp) {
    let t = theme::tokens(ui);
    let y = line.bar.center().y;
    let (from, until) = (line.axis.x_within(times.aos), line.axis.x_within(times.los));
    let within = Rect::from_x_y_ranges(from..=until, y - HALF_BOX..=y + HALF_BOX);
    for (from, until) in &times.lost {
        let (from, until) = (line.axis.x_within(*from), line.axis.x_within(*until));
        let lost = within.with_min_x(from).with_max_x(until.max(from + LEAST_LOST));
        ui.painter().rect_filled(lost, 0.0, t.bad);
    }
    ui.painter().rect_stroke(within, 0.0, (1.0, t.sat), StrokeKind::Inside);
    if let Some(tca) = times.tca {
        ui.painter().vline(line.axis.x_within(tca), within.y_range(), (1.0, t.sat));
    }
    paint::name_text(ui, ("pass", place), within, &in_words(times, now));
}

fn in_words(pass: &PassTimes, now: Timestamp) -> String {
    let at = |word: &str, time| format!("{word} {}", format::moment(time, now));
    let lost_s: f64 = pass.lost.iter().map(|(from, until)| seconds_between(*from, *until)).sum();
    let lost = if pass.lost.is_empty() {
        "nothing lost".to_owned()
    } else {
        format!("{} lost", format::duration(lost_s))
    };
    let times = [Some(at("AOS", pass.aos)), pass.tca.map(|tca| at("TCA", tca))];
    let times: Vec<String> = times.into_iter().flatten().chain([at("LOS", pass.los)]).collect();
    format!("{}: {}, {lost}", pass.name, times.join(", "))
}

/// Below the bar: the events of a single pass, or the names of several, as far as there is room.
fn below(ui: &Ui, rect: Rect, line: &Line, passes: &[PassTimes]) {
    let t = theme::tokens(ui);
    let words: Vec<(&str, Timestamp)> = match passes {
        [only] => {
            [Some(("AOS", only.aos)), Some(("LOS", only.los)), only.tca.map(|at| ("TCA", at))]
                .into_iter()
                .flatten()
                .collect()
        }
        several => several.iter().map(|of| (&*of.name, of.tca.unwrap_or(of.aos))).collect(),
    };
    let mut taken: Vec<Rect> = Vec::new();
    for (word, at) in words {
        let width = paint::text_width(ui, word, text::caption());
        let most = (rect.right() - width / 2.0).max(rect.left() + width / 2.0);
        let middle = line.axis.x_within(at).clamp(rect.left() + width / 2.0, most);
        let place = Rect::from_center_size(pos2(middle, rect.bottom() - 9.0), vec2(width, 16.0));
        if taken.iter().any(|of| of.intersects(place.expand2(vec2(WORD_GAP, 0.0)))) {
            continue;
        }
        paint::text(ui, place.center(), Align2::CENTER_CENTER, word, text::caption(), t.t2);
        taken.push(place);
    }
}

/// Takes the moment that the operator goes to.
fn moment(ui: &Ui, line: &Line, replay: &Replayed, commands: &mut Vec<UiCommand>) -> Response {
    let place = line.bar.expand2(vec2(0.0, 8.0));
    let response = ui.interact(place, id(), Sense::click_and_drag());
    let words = format!("Moment of the replay, {}", format::moment(replay.at, replay.at));
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, &words));
    let wanted = response.interact_pointer_pos().map(|at| line.axis.time(at.x));
    if response.has_focus() {
        // The arrows move the moment, not the focus.
        let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id(), filter));
    }
    commands.extend(wanted.map(|at| UiCommand::Replay(ReplayCommand::To(at))));
    response
}
