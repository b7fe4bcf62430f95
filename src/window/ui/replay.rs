//! The strip above a replay: its content and its controls.

mod end;
mod scrubber;

use egui::{Align2, Color32, Rect, Response, Role, Shape, Stroke, StrokeKind, Ui, pos2, vec2};
use jiff::Timestamp;

pub use self::end::show as show_end;
use self::scrubber::scrubber;

use super::{
    format, text, theme,
    tokens::Tokens,
    widgets::{
        button::{Button, HEIGHT as BUTTON, RADIUS, SMALL_HEIGHT},
        paint,
        segmented::{self, Segment},
    },
    words,
};
use crate::{
    astro::time::seconds_between,
    model::{
        Model, UiCommand,
        replay::{JumpNews, ReplayCommand, ReplayProblem, Replayed, SPEEDS},
    },
};

pub const HEIGHT: f32 = 56.0;
/// Steps of the arrow keys, seconds; the long step with Shift.
pub const STEP_S: f64 = 1.0;
pub const LONG_STEP_S: f64 = 10.0;
/// Answer to a command that a replay refuses.
pub const REFUSED: &str = "Not done: this is a replay. Leave it first.";
/// Text about STOP, which keeps working in a replay.
const STOP_WORKS: &str = "STOP stops the live antennas.";
const STOP_IN_SHORT: &str = "STOP is live";
/// Min width of the bar next to words, points.
const MIN_BAR: f32 = 80.0;

/// Min width of a strip with all controls, points.
const WIDE: f32 = 1360.0;
/// Min width of a strip with the buttons for passes, points.
const PASS_KEYS_FROM: f32 = 720.0;
const HATCHED: f32 = 72.0;
const GAP: f32 = 8.0;
const TAG: f32 = 76.0;
const TIME: f32 = 104.0;
const SMALL_TIME: f32 = 72.0;
const DESCRIPTION_WIDTH: f32 = 184.0;
const KEY: f32 = 36.0;
const SMALL_KEY: f32 = 26.0;
const SPEEDS_WIDTH: f32 = 225.0;
const SPEED: f32 = 52.0;
/// Thickness of the frame around a replay, points.
const FRAME: f32 = 3.0;

/// Reason why controls are locked that would change something or save a file.
pub const LOCKED: &str = "Replay. Leave it first.";

/// Returns [`LOCKED`] in a replay, otherwise `None`.
pub fn lock(model: &Model) -> Option<&'static str> {
    model.replay.as_ref().map(|_| LOCKED)
}

/// Returns the reason why the controls of an antenna are locked.
pub fn locked(antenna: &str) -> String {
    format!("Replay. Leave it to command {antenna}.")
}

/// Returns `true` if the keys of a replay work. A focused control may need some of these keys.
pub fn takes_keys(ui: &Ui) -> bool {
    ui.memory(egui::Memory::focused).is_none_or(|focused| focused == scrubber::id())
}

/// Shows the strip.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    live: &Model,
    replay: &Replayed,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.warnbg);
    let is_high = rect.height() >= HEIGHT;
    let is_wide = is_high && rect.width() >= WIDE;
    let mut left = rect.left() + GAP;
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.warn));
    if is_wide {
        hatch(ui, rect.with_max_x(rect.left() + HATCHED), t);
        left = rect.left() + HATCHED + GAP;
    }
    let height = height_of_buttons(rect);
    let mut place = |width: f32| {
        let area =
            Rect::from_min_size(pos2(left, rect.center().y - height / 2.0), vec2(width, height));
        left += width + GAP;
        area
    };
    let centre = Align2::CENTER_CENTER;
    let tag = place(TAG);
    ui.painter().rect_filled(tag, RADIUS, t.warn);
    paint::text_in(ui, tag, centre, "REPLAY", text::body_medium(), t.bg0);
    let clock = place(if is_high { TIME } else { SMALL_TIME });
    let font = if is_high { text::clock() } else { text::value() };
    let font = if is_high { egui::FontId { size: 20.0, ..font } } else { font };
    paint::text_in(ui, clock, centre, &format::clock(replay.time), font, t.t1);
    let description = description(replay, live.now);
    paint::name_text(ui, "replay", tag.union(clock), &format!("Replay, {description}"))
        .on_hover_text(STOP_WORKS);
    if is_wide {
        let room = place(DESCRIPTION_WIDTH);
        let line = |y: f32| {
            Rect::from_x_y_ranges(
                room.x_range(),
                room.center().y + y - 9.0..=room.center().y + y + 9.0,
            )
        };
        let left = Align2::LEFT_CENTER;
        let name = format!("{}, {}", format::date(replay.time), replay.stretch.name);
        paint::text_in(ui, line(-9.0), left, &name, text::small(), t.t1);
        let spoken = news(replay).unwrap_or_else(|| STOP_WORKS.to_owned());
        paint::text_in(ui, line(9.0), left, &spoken, text::small(), t.warn);
        let whole = whole_news(replay).unwrap_or(spoken);
        paint::name_text(ui, "about the replay", line(9.0), &whole).on_hover_text(&whole);
    }
    let key = if is_high { KEY } else { SMALL_KEY };
    let has_pass_keys = rect.width() >= PASS_KEYS_FROM;
    transport(ui, &mut || place(key), has_pass_keys, replay, commands);
    speeds(ui, &mut place, is_wide, replay, commands);
    let leave = Button::normal(if is_high { "Leave replay (Q)" } else { "Leave (Q)" });
    let area = at_the_end(ui, rect, leave);
    let rest = rect.with_min_x(left + GAP).with_max_x(area.left() - 2.0 * GAP);
    if let Some(spoken) = news(replay).filter(|_| !is_wide) {
        paint::text_in(ui, rest, Align2::LEFT_CENTER, &spoken, text::small(), t.warn);
        let whole = whole_news(replay).unwrap_or(spoken);
        paint::name_text(ui, "about the replay", rest, &whole).on_hover_text(&whole);
    } else {
        let bar = if is_wide { rest } else { after_stop_works(ui, rest) };
        scrubber(ui, bar, replay, commands);
    }
    if leave.show(ui, "leave replay", area).clicked() {
        commands.push(UiCommand::LeaveReplay);
    }
}

/// Returns the place of a button at the right end of the strip.
fn at_the_end(ui: &Ui, strip: Rect, button: Button<'_>) -> Rect {
    let height = height_of_buttons(strip);
    let size = vec2(button.width(ui), height);
    let min = pos2(strip.right() - 2.0 * GAP - size.x, strip.center().y - height / 2.0);
    Rect::from_min_size(min, size)
}

fn height_of_buttons(strip: Rect) -> f32 {
    if strip.height() >= HEIGHT { BUTTON } else { SMALL_HEIGHT }
}

/// Shows the text about STOP in a narrow strip. Returns the room after the text.
fn after_stop_works(ui: &Ui, rect: Rect) -> Rect {
    let font = text::small();
    let has_room = paint::text_width(ui, STOP_WORKS, font.clone()) + GAP + MIN_BAR <= rect.width();
    let words = if has_room { STOP_WORKS } else { STOP_IN_SHORT };
    let left = Align2::LEFT_CENTER;
    let drawn = paint::text_in(ui, rect, left, words, font, theme::tokens(ui).warn);
    paint::name_text(ui, "about the replay", drawn, STOP_WORKS).on_hover_text(STOP_WORKS);
    rect.with_min_x(drawn.right() + GAP)
}

/// Draws the frame around a replay; the strip is its upper side.
pub fn frame(ui: &Ui, rect: Rect) {
    let stroke = Stroke::new(FRAME, theme::tokens(ui).warn);
    let inner = rect.shrink(FRAME / 2.0);
    for x in [inner.left(), inner.right()] {
        ui.painter().vline(x, rect.y_range(), stroke);
    }
    ui.painter().hline(rect.x_range(), inner.bottom(), stroke);
}

fn description(replay: &Replayed, now: Timestamp) -> String {
    let speed = in_words(replay.speed);
    let goes = if replay.plays { format!("plays at {speed}") } else { "stands".to_owned() };
    let spoken = news(replay).unwrap_or_else(|| STOP_WORKS.to_owned());
    format!("{} of {}, {goes}. {spoken}", format::moment(replay.time, now), replay.stretch.name)
}

fn in_words(speed: i32) -> String {
    format!("{speed}×")
}

/// Returns the outcome of the last jump, or the reason why the replay cannot show the time.
fn news(replay: &Replayed) -> Option<String> {
    let side = |is_next: bool| if is_next { "later" } else { "earlier" };
    let age = |start, end| format::age(seconds_between(start, end));
    Some(match (&replay.news, &replay.problem) {
        (None, None) => return None,
        (_, Some(ReplayProblem::NotRead(_))) => "Reading failed: leave it (Q).".to_owned(),
        (Some(JumpNews::NoEvent { is_next }), _) => {
            format!("No {} event is recorded.", side(*is_next))
        }
        (Some(JumpNews::NoPass { is_next }), _) => {
            format!("No {} pass is recorded.", side(*is_next))
        }
        (Some(JumpNews::Failed(reason)), _) => format!("Not found. {}", words::sentence(reason)),
        (_, Some(ReplayProblem::NoFilm { start: begin, end: last })) => {
            format!("No film here, for {}.", age(*begin, *last))
        }
        (_, Some(ReplayProblem::NothingYet)) => "Nothing was recorded at this moment.".to_owned(),
        (_, Some(ReplayProblem::Failed(reason))) => {
            format!("Not shown. {}", words::sentence(reason))
        }
        (Some(JumpNews::Skipped { start: begin, end: last }), None) => {
            format!("Skipped {}: no film.", age(*begin, *last))
        }
    })
}

/// Returns the complete news for the tool-tip.
fn whole_news(replay: &Replayed) -> Option<String> {
    let (start, end) = match (&replay.news, &replay.problem) {
        (
            None | Some(JumpNews::Skipped { .. }),
            Some(ReplayProblem::NoFilm { start: begin, end: last }),
        )
        | (Some(JumpNews::Skipped { start: begin, end: last }), None) => (*begin, *last),
        (_, Some(ReplayProblem::NotRead(reason))) => {
            let reason = words::sentence(reason);
            return Some(format!(
                "Nothing more of the record is read. {reason} Leave the replay (Q) and begin it again."
            ));
        }
        _ => return news(replay),
    };
    let stretch = format::stretch(start, end, replay.time);
    Some(format!(
        "There is no film of {stretch}: Azel did not run, or what it showed is not kept any more."
    ))
}

fn hatch(ui: &Ui, rect: Rect, t: &Tokens) {
    let painter = ui.painter().with_clip_rect(rect);
    let mut x = rect.left() - rect.height();
    while x < rect.right() {
        let line = [pos2(x, rect.bottom()), pos2(x + rect.height(), rect.top())];
        painter.line_segment(line, (3.0, t.warn));
        x += 12.0;
    }
}

/// Shows the buttons: previous pass, previous event, backward, forward, next event and next pass.
fn transport(
    ui: &Ui,
    place: &mut dyn FnMut() -> Rect,
    has_pass_keys: bool,
    replay: &Replayed,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    if has_pass_keys {
        jump(ui, place(), "Previous pass", ReplayCommand::Pass { is_next: false }, commands);
    }
    let before = ReplayCommand::Event { is_next: false };
    jump(ui, place(), "Previous event (comma)", before, commands);
    for (sign, salt) in [(-1, "play backward"), (1, "play forward")] {
        let rect = place();
        let goes = replay.plays && replay.speed.signum() == sign;
        let name = match (goes, sign) {
            (true, _) => "Pause (Space)",
            (false, 1) => "Play",
            (false, _) => "Play backward",
        };
        if key(ui, salt, rect, name, goes).clicked() {
            if replay.speed.signum() != sign {
                commands.push(UiCommand::Replay(ReplayCommand::Speed(-replay.speed)));
            }
            if goes || !replay.plays {
                commands.push(UiCommand::Replay(ReplayCommand::PlayOrPause));
            }
        }
        if goes {
            for x in [-3.5, 3.5] {
                let bar = Rect::from_center_size(rect.center() + vec2(x, 0.0), vec2(3.5, 12.0));
                ui.painter().rect_filled(bar, 0.0, t.onsat);
            }
        } else {
            triangle(ui, rect, sign as f32, false, t.t1);
        }
    }
    let after = ReplayCommand::Event { is_next: true };
    jump(ui, place(), "Next event (full stop)", after, commands);
    if has_pass_keys {
        jump(ui, place(), "Next pass", ReplayCommand::Pass { is_next: true }, commands);
    }
}

/// Shows a button that jumps to an event or to a pass.
fn jump(ui: &Ui, rect: Rect, name: &str, command: ReplayCommand, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let clicked = key(ui, name, rect, name, false).clicked();
    let (triangles, is_next): (&[f32], bool) = match command {
        ReplayCommand::Pass { is_next } => (&[-5.0, 4.0], is_next),
        ReplayCommand::Event { is_next } => (&[0.0], is_next),
        _ => return,
    };
    let sign = if is_next { 1.0 } else { -1.0 };
    for (place, offset) in triangles.iter().enumerate() {
        let rect = rect.translate(vec2(offset * sign, 0.0));
        triangle(ui, rect, sign, place + 1 == triangles.len(), t.t1);
    }
    if clicked {
        commands.push(UiCommand::Replay(command));
    }
}

fn key(ui: &Ui, salt: &str, rect: Rect, name: &str, is_on: bool) -> Response {
    let t = theme::tokens(ui);
    let response = paint::control(ui, salt, rect, Role::Button, true, name);
    let fill = match (is_on, response.is_pointer_button_down_on()) {
        (true, _) => t.sat,
        (false, true) => t.bgsel,
        (false, false) => t.bg3,
    };
    let border = if response.hovered() { t.t2 } else { t.edge };
    ui.painter().rect(rect, RADIUS, fill, Stroke::new(1.0, border), StrokeKind::Inside);
    paint::focus_ring(ui, &response, RADIUS);
    response.on_hover_text(name)
}

/// Draws a triangle that points to the left if `sign` is negative; `to_stop` adds a bar at its tip.
fn triangle(ui: &Ui, rect: Rect, sign: f32, to_stop: bool, colour: Color32) {
    let (position, size) = (rect.center(), 5.0);
    let tip = position + vec2(sign * size, 0.0);
    let base = position.x - sign * size;
    let corners = vec![tip, pos2(base, position.y - size), pos2(base, position.y + size)];
    ui.painter().add(Shape::convex_polygon(corners, colour, Stroke::NONE));
    if to_stop {
        let bar = Rect::from_center_size(tip + vec2(sign, 0.0), vec2(2.0, 2.0 * size));
        ui.painter().rect_filled(bar, 0.0, colour);
    }
}

/// Shows the speeds. A narrow strip shows only the current speed; a click selects the next one.
fn speeds(
    ui: &Ui,
    place: &mut dyn FnMut(f32) -> Rect,
    is_wide: bool,
    replay: &Replayed,
    commands: &mut Vec<UiCommand>,
) {
    let (speed, sign) = (replay.speed.abs(), replay.speed.signum());
    let index = SPEEDS.iter().position(|speed_step| *speed_step == speed).unwrap_or_default();
    let chosen = if is_wide {
        let rect = place(SPEEDS_WIDTH);
        let words = SPEEDS.map(in_words);
        let segments = std::array::from_fn::<_, { SPEEDS.len() }, _>(|total| {
            let state = if total == index { Segment::Chosen } else { Segment::Free };
            (words.get(total).map_or("", String::as_str), state)
        });
        segmented::show(ui, "replay speed", rect, "Speed of the replay", &segments)
    } else {
        let rect = place(SPEED);
        let word = in_words(speed);
        let clicked = Button::normal(&word).show(ui, "replay speed", rect).clicked();
        clicked.then_some((index + 1) % SPEEDS.len())
    };
    if let Some(speed) = chosen.and_then(|total| SPEEDS.get(total)) {
        commands.push(UiCommand::Replay(ReplayCommand::Speed(sign * speed)));
    }
}
