//! A lane for each antenna: its entries with slews and waits, and its switch.

use egui::{
    Align2, Rect, Role, ScrollArea, Sense, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo, pos2,
    vec2,
};

use super::{PADDING, PlanState, legend, switches};
use crate::{
    astro::time::{add_seconds, seconds_between},
    contract::{
        self,
        antenna::AntennaModel,
        automatic::{DayEvent, Operation},
        driver::LinkState,
    },
    model::{Model, UiCommand, plan::PlannedSatellite},
    plan::schedule::Entry,
    ui::{
        bar, format, icons,
        pass_bar::{self, BarForm},
        text::{self, Weight},
        theme,
        time_axis::TimeAxis,
        timeline::labels::{self, Placed, Wish},
        widgets::{button::Button, list, paint},
        words,
    },
};

const BAR: f32 = 32.0;
const AXIS: f32 = 20.0;
const LANE: f32 = 50.0;
/// Width of the names and switches, points.
const LABEL: f32 = 252.0;
/// Time before now in the lanes, seconds, so that a current pass keeps its bar.
const PAST_S: f64 = 1200.0;
const ENTRY: f32 = 22.0;
/// Height of a name above a bar, and the min gap at each of its sides, points.
const NAME: f32 = 13.0;
const NAME_GAP: f32 = 3.0;

pub(super) fn height(lanes: usize) -> f32 {
    BAR + AXIS + lanes as f32 * LANE
}

/// Returns the time axis of the lanes.
pub(super) fn axis(model: &Model, place: Rect, state: &PlanState) -> TimeAxis {
    let start = add_seconds(model.now, state.lanes_after_s - PAST_S);
    TimeAxis::lasting(start, state.lanes_h() * 3600.0, place.x_range())
}

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    satellites: &[PlannedSatellite<'_>],
    is_low: bool,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (bar, rest) = rect.split_top_bottom_at_y(rect.top() + BAR);
    let (names, body) = rest.split_top_bottom_at_y(rest.top() + AXIS);
    ui.painter().rect_filled(bar, 0.0, t.bg2);
    ui.painter().rect_filled(names, 0.0, t.bg1);
    let place = |row: Rect| row.with_min_x(rect.left() + LABEL);
    let axis = axis(model, place(rect), state);
    title(ui, bar, model, satellites, axis);
    hours(ui, place(names), axis);
    if model.antennas.is_empty() {
        let words = "No antenna yet. Add one in Preferences or run the set-up.";
        let position = body.left_top() + vec2(PADDING, 12.0);
        let drawn = paint::paragraph(ui, position, body.width() - 32.0, words, text::body(), t.t2);
        paint::name_text(ui, "no lanes", drawn, words);
        return;
    }
    ui.scope_builder(UiBuilder::new().id_salt("plan lanes").max_rect(body), |ui| {
        ui.set_clip_rect(body.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        ScrollArea::vertical().id_salt("lanes").auto_shrink(false).show(ui, |ui| {
            // The chosen antenna stays first.
            let chosen = model.selected_antenna;
            let mut order: Vec<usize> = (0..model.antennas.len()).collect();
            order.sort_by_key(|index| *index != chosen);
            let shown = if is_low { 1 } else { order.len() };
            for index in order.into_iter().take(shown) {
                let Some(antenna) = model.antennas.get(index) else { continue };
                let (_, row) = ui.allocate_space(vec2(body.width(), LANE));
                label(
                    ui,
                    row.with_max_x(rect.left() + LABEL),
                    model,
                    index,
                    antenna,
                    state,
                    commands,
                );
                lane(ui, row, place(row), model, antenna, axis, commands);
            }
        });
    });
    if axis.contains(model.now) {
        let y = egui::Rangef::new(names.bottom() - 6.0, body.bottom());
        ui.painter().vline(axis.x(model.now), y, (1.75, t.t1));
    }
}

fn title(ui: &Ui, bar: Rect, model: &Model, satellites: &[PlannedSatellite<'_>], axis: TimeAxis) {
    let t = theme::tokens(ui);
    let inner = bar.shrink2(vec2(PADDING, 0.0));
    let left = Align2::LEFT_CENTER;
    let words = format!("Antennas, {}", format::minutes(axis.start(), axis.end(), model.now));
    let font = text::sized(13.0, Weight::SemiBold);
    let drawn = paint::text_in(ui, inner, left, &words, font, t.t1);
    let all: usize = satellites.iter().map(|satellite| satellite.passes.len()).sum();
    let passes = satellites.iter().flat_map(|satellite| &satellite.passes);
    let used = passes.filter(|planned| !planned.entries.is_empty()).count();
    let proof = if model.schedule.made_at.is_none() {
        ""
    } else if model.schedule.schedule.is_proved() {
        ": no better plan exists"
    } else {
        ": not proved to be the best"
    };
    let count = format!("{used} of {all} passes are taken{proof}");
    let room = inner.with_min_x(drawn.right() + 24.0);
    let drawn = paint::text_in(ui, room, left, &count, text::small(), t.t2);
    legend::show(ui, inner.with_min_x(drawn.right() + 24.0));
    paint::name_text(ui, "sequences", bar, &format!("{words}. {count}"))
        .on_hover_text(worth(model));
}

/// Returns the worth of the schedule, class by class.
fn worth(model: &Model) -> String {
    let choose_by = model.station.scheduling.choose_by;
    let classes = model.schedule.schedule.worth.iter();
    let lines = classes.map(|class| words::schedule::class_worth(class, choose_by));
    lines.collect::<Vec<_>>().join("\n")
}

fn hours(ui: &Ui, names: Rect, axis: TimeAxis) {
    let t = theme::tokens(ui);
    ui.painter().hline(names.x_range(), names.bottom() - 0.5, (1.0, t.line));
    for time in marks(axis) {
        let position = pos2(axis.x(time), names.center().y);
        if position.x + 18.0 < names.right() && position.x - 18.0 > names.left() {
            let word = format::on_axis(time);
            paint::text(ui, position, Align2::CENTER_CENTER, word, text::caption(), t.t3);
        }
    }
}

/// Returns the half or full hours of the lanes.
fn marks(axis: TimeAxis) -> impl Iterator<Item = jiff::Timestamp> {
    axis.multiples(if axis.seconds() > 7.0 * 3600.0 { 3600 } else { 1800 })
}

fn label(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    index: usize,
    antenna: &AntennaModel,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let is_chosen = index == model.selected_antenna;
    let name = &antenna.config.name;
    let switch = switches::place(rect);
    let choose = rect.with_max_x(switch.left() - 8.0);
    let id = ui.make_persistent_id(("plan lane", antenna.id().0));
    let response = ui.interact(choose, id, Sense::click());
    let standing = words::automatic::in_short(model, antenna);
    let whole = words::automatic::in_full(model, antenna);
    let spoken = format!("{name}. {standing} {}", whole.as_deref().unwrap_or_default());
    let spoken = spoken.trim_end();
    response.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, is_chosen, spoken));
    list::paint_ground(ui, rect, is_chosen, false);
    list::paint_divider(ui, rect);
    let inner = rect.shrink2(vec2(PADDING, 6.0));
    let (first, second) = inner.split_top_bottom_at_fraction(0.5);
    let (glyph, colour) = bar::glyph(model, antenna).look(t);
    let area = paint::square(pos2(first.left() + 6.0, first.center().y), 12.0);
    icons::paint(ui.painter(), area, glyph, colour);
    let room = first.with_min_x(area.right() + 6.0).with_max_x(switch.left() - 70.0);
    let font = text::sized(13.0, Weight::SemiBold);
    paint::text_in(ui, room, Align2::LEFT_CENTER, name, font.clone(), t.t1);
    let is_name_whole = paint::fits(ui, name, font, room);
    let colour = match antenna.operation {
        Operation::Suspended { .. } => t.warn,
        _ => t.t2,
    };
    let resume = words::automatic::go_on(model, antenna);
    let key = Button::primary(words::automatic::RESUME).locked(model.replay.is_some());
    let used = if resume.is_some() { key.width(ui) + 8.0 } else { 0.0 };
    let room = second.with_max_x(second.right() - used);
    paint::text_in(ui, room, Align2::LEFT_CENTER, &standing, text::small(), colour);
    let word = first.with_max_x(switch.left() - 6.0);
    paint::text_in(ui, word, Align2::RIGHT_CENTER, "automatic", text::small(), t.t3);
    if response.clicked() {
        commands.push(UiCommand::SelectAntenna(index));
    }
    paint::focus_ring(ui, &response, 2);
    let is_whole = is_name_whole && paint::fits(ui, &standing, text::small(), room);
    if whole.is_some() || !is_whole {
        response.on_hover_text(spoken);
    }
    if let Some(words) = resume {
        let place = second.with_min_x(room.right() + 8.0);
        let shown = key.show(ui, ("go on", antenna.id().0), place);
        let is_enabled = model.replay.is_none();
        shown.widget_info(|| WidgetInfo::labeled(Role::Button, is_enabled, &words));
        if shown.clicked() {
            commands.push(UiCommand::Station(contract::Command::GoOn(antenna.id())));
        }
        shown.on_hover_text(words);
    }
    switches::show(ui, switch, model, antenna, state, commands);
}

fn lane(
    ui: &Ui,
    row: Rect,
    place: Rect,
    model: &Model,
    antenna: &AntennaModel,
    axis: TimeAxis,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(place, 0.0, t.bg0);
    ui.painter().hline(row.x_range(), row.bottom() - 0.5, (1.0, t.line));
    for time in marks(axis) {
        let x = axis.x(time);
        ui.painter().vline(x, place.y_range(), (1.0, t.line));
    }
    let id = antenna.id();
    let middle = place.center().y + 4.0;
    let band =
        |x: egui::Rangef| Rect::from_x_y_ranges(x, middle - ENTRY / 2.0..=middle + ENTRY / 2.0);
    let own = model.day.iter().enumerate().filter(|(_, line)| line.antenna == id);
    for (place_in_day, line) in own {
        let DayEvent::Flown(flown) = &line.event else { continue };
        let end = add_seconds(flown.pass.1, flown.of_s);
        let Some(x) = axis.range(flown.pass.1, end) else { continue };
        let rect = band(x);
        let words = words::automatic::flown(flown, model.now);
        let form = if flown.cause.is_none() { BarForm::Done } else { BarForm::Missed };
        pass_bar::paint(ui, rect, form);
        paint::name_text(ui, ("flown", place_in_day), rect, &words).on_hover_text(words);
    }
    let entries: Vec<&Entry> =
        model.schedule.schedule.entries.iter().filter(|entry| entry.antenna == id).collect();
    let ahead = entries.iter().filter(|entry| entry.end > model.now);
    let mut before = model.now;
    let mut bars = Vec::new();
    for entry in ahead {
        way(ui, middle, before, entry, axis);
        bars.extend(bar(ui, band, model, antenna, entry, axis, commands));
        before = entry.end;
    }
    names(ui, place, &bars);
    if entries.is_empty() {
        let words = if antenna.snapshot.lock_out.is_some() {
            "Locked out: nothing is planned."
        } else if antenna.snapshot.link == LinkState::Off {
            "Not connected: nothing is planned."
        } else {
            "Nothing is planned."
        };
        let room = place.shrink2(vec2(PADDING, 0.0));
        // The words stand next to the line of now, not on it.
        let now = axis.x(model.now) + 8.0;
        let room = room.with_min_x(room.left().max(now.min(room.right())));
        paint::text_in(ui, room, Align2::LEFT_CENTER, words, text::small(), t.t3);
    }
}

/// Draws the wait after the previous entry, and the slew to the next one.
fn way(ui: &Ui, y: f32, before: jiff::Timestamp, entry: &Entry, axis: TimeAxis) {
    let t = theme::tokens(ui);
    let slew_s = entry.slew_s + entry.set_up_s;
    let arrives = add_seconds(before, slew_s);
    if let Some(x) = axis.range(arrives, entry.start)
        && seconds_between(arrives, entry.start) > 0.0
    {
        let line = [pos2(x.min, y), pos2(x.max, y)];
        ui.painter().extend(egui::Shape::dotted_line(&line, t.t3, 5.0, 0.75));
    }
    if slew_s > 0.0
        && let Some(x) = axis.range(before, arrives.min(entry.start))
    {
        let rect = Rect::from_x_y_ranges(x, y - ENTRY / 2.0..=y + ENTRY / 2.0);
        let stroke = Stroke::new(1.0, t.cmd);
        ui.painter().rect_stroke(rect, 0.0, stroke, StrokeKind::Inside);
        ui.painter().line_segment([rect.left_bottom(), rect.right_top()], stroke);
    }
}

/// A bar in the lane, with the name of its satellite.
struct NamedBar {
    rect: Rect,
    name: String,
}

/// Draws the names above the bars; close bars get short names.
fn names(ui: &Ui, place: Rect, bars: &[NamedBar]) {
    let t = theme::tokens(ui);
    let shorts: Vec<String> = bars.iter().map(|bar| labels::short_name(&bar.name)).collect();
    let room = |bar: &NamedBar, name: &str| {
        let size = vec2(paint::text_width(ui, name, text::caption()) + 2.0 * NAME_GAP, NAME);
        let half = size.x / 2.0;
        let leftmost = place.left() + half;
        let x = bar.rect.center().x.clamp(leftmost, (place.right() - half).max(leftmost));
        Align2::CENTER_BOTTOM.anchor_size(pos2(x, bar.rect.top() - 2.0), size)
    };
    let wishes = bars.iter().zip(&shorts);
    let wishes =
        wishes.map(|(bar, short)| Wish { short: room(bar, short), full: room(bar, &bar.name) });
    let placed = labels::place(&wishes.collect::<Vec<_>>(), &[], place);
    for ((bar, short), placed) in bars.iter().zip(&shorts).zip(placed) {
        let (name, rect) = match placed {
            Placed::Out => continue,
            Placed::Short(rect) => (short, rect),
            Placed::Full(rect) => (&bar.name, rect),
        };
        paint::text(ui, rect.center(), Align2::CENTER_CENTER, name, text::caption(), t.t1);
    }
}

#[allow(clippy::too_many_arguments)]
fn bar(
    ui: &Ui,
    band: impl Fn(egui::Rangef) -> Rect,
    model: &Model,
    antenna: &AntennaModel,
    entry: &Entry,
    axis: TimeAxis,
    commands: &mut Vec<UiCommand>,
) -> Option<NamedBar> {
    let t = theme::tokens(ui);
    let rect = band(axis.range(entry.start, entry.end)?);
    let key = (entry.pass.satellite, entry.pass.aos);
    let name = words::schedule::pass_name(model, key);
    let found = model.pass_lists.find(key);
    let max = found.map_or(String::new(), |predicted| {
        format::degrees(predicted.pass.max_elevation().degrees(), 0)
    });
    let is_selected = model.selected_pass().is_some_and(|selected| {
        selected.number() == key.0 && seconds_between(selected.pass.aos.time, key.1).abs() < 60.0
    });
    let taking = antenna.operation.taking().filter(|taking| taking.pass.0 == key.0);
    let taking = taking.filter(|taking| taking.start < entry.end && entry.start < taking.end);
    let (form, state) = match taking {
        None => (BarForm::Planned, "planned"),
        Some(taking) if taking.proved_at.is_none() => (BarForm::Sent, "sent, not verified"),
        Some(taking) if taking.start <= model.now => (BarForm::Running, "running"),
        Some(_) => (BarForm::Proved, "verified"),
    };
    pass_bar::paint(ui, rect, form);
    if is_selected {
        let frame = rect.expand(2.5);
        ui.painter().rect_stroke(frame, 2.0, Stroke::new(1.5, t.ant), StrokeKind::Outside);
    }
    let id = ui.make_persistent_id(("lane bar", antenna.id().0, key));
    let response = ui.interact(rect, id, Sense::CLICK);
    let lost = entry.lost.map(|lost| format!(" {}.", words::schedule::lost(lost)));
    let spoken = format!(
        "{name} with {}, {}, {max}, {state}.{}",
        antenna.config.name,
        format::stretch(entry.start, entry.end, model.now),
        lost.unwrap_or_default()
    );
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_selected, &spoken));
    if paint::text_width(ui, &max, text::caption()) + 4.0 <= rect.width() {
        let centre = Align2::CENTER_CENTER;
        paint::text(ui, rect.center(), centre, &max, text::caption(), t.onsat);
    }
    if response.clicked() {
        commands.push(UiCommand::SelectPass(key));
    }
    response.on_hover_text(spoken);
    Some(NamedBar { rect, name })
}
