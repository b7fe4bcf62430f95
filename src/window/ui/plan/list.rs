//! The passes of the chosen antenna in the order of execution: passes that are over, taken or left
//! out.

use egui::{Align2, Color32, Rect, Role, Ui, WidgetInfo, pos2, vec2};

use super::{PADDING, PlanState, state::Shown};
use crate::{
    contract::{antenna::AntennaModel, passes::PassListKey},
    model::{
        Model, UiCommand,
        plan::{ListedPass, Standing},
    },
    plan::schedule::{LeftOutReason, sets_out},
    station::Take,
    ui::{
        format,
        icons::{self, Icon},
        replay,
        text::{self, Weight},
        theme,
        tokens::Tokens,
        widgets::{
            button::Button,
            list::List,
            paint,
            segmented::{self, Segment},
        },
        words,
    },
};

const BAR: f32 = 32.0;
const HEAD: f32 = 22.0;
const ROW: f32 = 25.0;
const SEGMENTS: f32 = 236.0;
/// Spare time below which a row shows a caution, seconds.
const SHORT_S: f64 = 60.0;
/// Min width for all columns, points; the smallest window has less.
const ALL_FROM: f32 = 1000.0;
/// Width below which a row next to the drawer shows only facts that no other place shows, points.
const LEAN_BELOW: f32 = 760.0;
/// Width from which the slew column grows by at most [`MORE_SLEW`], points.
const WIDE_FROM: f32 = 1024.0;
const MORE_SLEW: f32 = 120.0;
/// Width of satellite names, points: names in large constellations have 15 characters.
const NAME: f32 = 138.0;
/// Width of satellite names in a lean row, points.
const LEAN_NAME: f32 = 100.0;
/// Min width of the notes column with *Swap* in which any reason fits, points.
const WIDE_NOTES: f32 = 460.0;

/// Returns the min height, points: ten rows below the heads, or three in a low window.
pub(super) fn min_height(is_low: bool) -> f32 {
    let rows = if is_low { 3.0 } else { 10.0 };
    BAR + HEAD + rows * ROW
}

/// Columns of a row: the left end of each text, and the right end of times and numbers.
#[derive(Clone, Copy)]
struct Columns {
    state: f32,
    aos: f32,
    los: Option<f32>,
    name: f32,
    max: Option<f32>,
    /// Left end of the slew and right end of the spare time, points, if both fit.
    slew: Option<(f32, f32)>,
    text: f32,
    /// `true` if a reason fits in the notes column; otherwise the reason begins in the slew column.
    has_wide_notes: bool,
    /// `true` if the rows have *Swap*. The drawer offers it for the selected pass.
    swaps: bool,
}

impl Columns {
    fn new(width: f32) -> Self {
        if width < ALL_FROM {
            let is_lean = width < LEAN_BELOW;
            let of_room = |x: f32| (!is_lean).then_some(x);
            let (aos, los) = (240.0, of_room(354.0));
            let name = los.unwrap_or(aos) + 16.0;
            let max = of_room(name + NAME + 30.0);
            let text = max.unwrap_or(name + LEAN_NAME - 8.0) + 16.0;
            let (slew, has_wide_notes) = (None, true);
            let swaps = !is_lean;
            return Self { state: 16.0, aos, los, name, max, slew, text, has_wide_notes, swaps };
        }
        // Satellite names are complete where space permits.
        let more = (width - WIDE_FROM).clamp(0.0, MORE_SLEW);
        let name = 418.0;
        let max = name + NAME + 30.0;
        let (slew, spare) = (max + 16.0, max + 216.0 + more);
        let text = spare + 16.0;
        Self {
            state: 16.0,
            aos: 288.0,
            los: Some(402.0),
            name,
            max: Some(max),
            slew: Some((slew, spare)),
            text,
            has_wide_notes: width - text >= WIDE_NOTES,
            swaps: true,
        }
    }

    fn name_end(self) -> f32 {
        self.max.map_or(self.text - 8.0, |max| max - 30.0)
    }
}

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (bar, rest) = rect.split_top_bottom_at_y(rect.top() + BAR);
    let (head, body) = rest.split_top_bottom_at_y(rest.top() + HEAD);
    ui.painter().rect_filled(bar, 0.0, t.bg2);
    ui.painter().rect_filled(head, 0.0, t.bg1);
    let Some(antenna) = model.antenna() else { return };
    let all = model.listed_passes(antenna);
    let is_taken =
        |pass: &ListedPass<'_>| pass.entry.is_some() || matches!(pass.standing, Standing::Flown(_));
    let used = all.iter().filter(|pass| is_taken(pass)).count();
    let counts = [all.len(), used, all.len() - used];
    let columns = Columns::new(rect.width());
    show_bar(ui, bar, antenna, counts, columns, state);
    heads(ui, head, columns);
    let rows: Vec<&ListedPass<'_>> = all
        .iter()
        .filter(|pass| match state.shown {
            Shown::All => true,
            Shown::Taken => is_taken(pass),
            Shown::LeftOut => !is_taken(pass),
        })
        .collect();
    ui.painter().rect_filled(body, 0.0, theme::tokens(ui).field);
    let list = List::new(ui, body, "plan list", &title(antenna), ROW);
    if rows.is_empty() {
        return list.show_empty(ui, "no rows", "No such pass in this period.");
    }
    let mut scroll = state.scroll;
    list.show_rows(ui, rows.len(), &mut scroll, |ui, row, index| {
        if let Some(listed) = rows.get(index) {
            show_row(ui, &list, row, model, antenna, listed, columns, state, commands);
        }
    });
    state.scroll = scroll;
}

fn show_bar(
    ui: &Ui,
    bar: Rect,
    antenna: &AntennaModel,
    [all, used, left_out]: [usize; 3],
    columns: Columns,
    state: &mut PlanState,
) {
    let t = theme::tokens(ui);
    let inner = bar.shrink2(vec2(PADDING, 0.0));
    let words = title(antenna);
    let font = text::sized(13.0, Weight::SemiBold);
    let room = inner.with_max_x(inner.right() - SEGMENTS - 16.0);
    let drawn = paint::text_in(ui, room, Align2::LEFT_CENTER, &words, font, t.t1);
    let choices = [
        (Shown::All, format!("All {all}")),
        (Shown::Taken, format!("Taken {used}")),
        (Shown::LeftOut, format!("Left out {left_out}")),
    ];
    let segments: Vec<(&str, Segment)> = choices
        .iter()
        .map(|(shown_entry, word)| {
            (
                word.as_str(),
                if *shown_entry == state.shown { Segment::Chosen } else { Segment::Free },
            )
        })
        .collect();
    let min = pos2(drawn.right() + 24.0, bar.center().y - 12.0);
    let place = Rect::from_min_size(min, vec2(SEGMENTS, 24.0));
    let clicked = segmented::show(ui, "plan shown", place, "Passes in the list", &segments);
    if let Some((shown, _)) = clicked.and_then(|index| choices.get(index)) {
        state.shown = *shown;
    }
    if columns.slew.is_none() {
        return;
    }
    let room = inner.with_min_x(place.right() + 16.0);
    let set_up = format::duration(antenna.config.set_up_s());
    let note = format!("Spare: time left before AOS after slew and {set_up} of set-up.");
    paint::text_in(ui, room, Align2::LEFT_CENTER, &note, text::small(), t.t2);
}

/// Returns the title. Azel executes nothing while automatic operation is off.
fn title(antenna: &AntennaModel) -> String {
    let name = &antenna.config.name;
    if antenna.operation.is_on() {
        format!("{name}, as it will be executed")
    } else {
        format!("{name}, as planned")
    }
}

fn heads(ui: &Ui, head: Rect, columns: Columns) {
    let t = theme::tokens(ui);
    ui.painter().hline(head.x_range(), head.bottom() - 0.5, (1.0, t.line));
    let (left, right) = (Align2::LEFT_CENTER, Align2::RIGHT_CENTER);
    let cell = |x: f32, anchor: Align2, words: &str| {
        let x = head.left() + x;
        let place = if anchor == left { head.with_min_x(x) } else { head.with_max_x(x) };
        paint::text_in(ui, place, anchor, words, text::caption(), t.t3);
    };
    cell(columns.state, left, "State");
    cell(columns.aos, right, "AOS");
    if let Some(los) = columns.los {
        cell(los, right, "LOS");
    }
    cell(columns.name, left, "Satellite");
    if let Some(max) = columns.max {
        cell(max, right, "Max el");
    }
    if let Some((slew, spare)) = columns.slew {
        cell(slew, left, "Slew in");
        cell(spare, right, "Spare");
    }
    cell(columns.text, left, "Notes");
}

/// Returns icon, words and colour of a state.
fn state(
    model: &Model,
    antenna: &AntennaModel,
    listed: &ListedPass<'_>,
    t: &Tokens,
) -> (Icon, String, Color32) {
    match listed.standing {
        Standing::Flown(flown) if flown.cause.is_none() => {
            let percent = 100.0 * flown.in_beam_s / flown.of_s.max(1.0);
            let words = format!("Done, {} % in beam", format::number(percent, 0));
            (Icon::Check, words, t.ok)
        }
        Standing::Flown(flown) => {
            let [lost, name] = [flown.lost_s(), flown.of_s].map(format::duration);
            (Icon::Cross, format!("Missed {lost} of {name}"), t.bad)
        }
        Standing::Running => {
            let deviation = antenna.error().map(|error| error.off_beam.degrees());
            let words = deviation.map_or_else(
                || "Running".to_owned(),
                |deviation| format!("Running, {} off", format::degrees(deviation, 2)),
            );
            (Icon::Disc, words, t.ok)
        }
        Standing::Proved(time) => {
            let subject = if antenna.variant().capabilities.has_program {
                "On the unit"
            } else {
                "On its way"
            };
            (Icon::Lock, format!("{subject}, {}", format::moment(time, model.now)), t.ok)
        }
        Standing::Sent(time) => {
            let words = format!("Sent {}, not verified", format::moment(time, model.now));
            (Icon::ChevronRight, words, t.cmd)
        }
        Standing::Planned(entry) if antenna.operation.is_on() => {
            let time = sets_out(entry, antenna.config.automatic.between_passes);
            (Icon::Clock, words::schedule::sets_out(antenna, time, model.now), t.t1)
        }
        Standing::Planned(_) => (Icon::Clock, "Planned".to_owned(), t.t1),
        Standing::LeftOut(LeftOutReason::UnderWay) => (Icon::Dash, "Not tracked".to_owned(), t.t2),
        Standing::TakenBy(_) | Standing::LeftOut(_) => (Icon::Dash, "Left out".to_owned(), t.t2),
        Standing::NotKnown => (Icon::Dash, "Not planned yet".to_owned(), t.t3),
    }
}

/// Returns the loss or cut of a pass, or the reason why the schedule takes it or leaves it out.
fn reason(model: &Model, antenna: &AntennaModel, listed: &ListedPass<'_>) -> (String, bool) {
    let always = listed.planned.as_ref().and_then(|planned| planned.choice);
    match listed.standing {
        Standing::Flown(flown) => match flown.cause {
            None => (String::new(), false),
            Some(cause) => (words::automatic::miss_cause(cause), true),
        },
        Standing::LeftOut(obstacle @ LeftOutReason::UnderWay) => {
            let cause = words::automatic::not_tracking(&antenna.operation);
            let cause = cause.map_or_else(String::new, |cause| format!(" {cause}"));
            (format!("{}.{cause}", words::schedule::why_left_out(model, obstacle)), false)
        }
        Standing::LeftOut(obstacle) => {
            (format!("{}.", words::schedule::why_left_out(model, obstacle)), false)
        }
        Standing::TakenBy(other) => {
            (format!("{} takes it.", words::schedule::antenna_name(model, other)), false)
        }
        Standing::NotKnown => (String::new(), false),
        Standing::Running | Standing::Proved(_) | Standing::Sent(_) | Standing::Planned(_) => {
            let Some(entry) = listed.entry else { return (String::new(), false) };
            if let Some(lost) = entry.lost {
                return (format!("{}.", words::schedule::lost(lost)), true);
            }
            let cut = entry.late_s + entry.early_s;
            if cut > 0.0 {
                return (format!("Shortened by {}.", format::duration(cut)), true);
            }
            match always.filter(|choice| choice.take == Take::Always) {
                Some(choice) => {
                    let time_text = format::moment(choice.chosen_at, model.now);
                    (format!("Always, set {time_text}."), false)
                }
                None => (String::new(), false),
            }
        }
    }
}

fn cannot_swap(model: &Model, pass: PassListKey) -> bool {
    model.swap_of(pass).is_some_and(|swap| swap.changes.is_none())
}

#[allow(clippy::too_many_arguments)]
fn show_row(
    ui: &Ui,
    list: &List,
    row: Rect,
    model: &Model,
    antenna: &AntennaModel,
    listed: &ListedPass<'_>,
    columns: Columns,
    plan: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let is_selected = model.selected_pass().is_some_and(|selected| selected.key() == listed.key);
    let (icon, words, colour) = state(model, antenna, listed, t);
    let (explanation, is_caution) = reason(model, antenna, listed);
    let max = listed.max_elevation_deg.map(|deg| format::degrees(deg, 0)).unwrap_or_default();
    let [aos, los] = [listed.key.1, listed.los].map(|time| format::moment(time, model.now));
    let spoken = format!("{}, {aos} to {los}, {max}. {words}. {explanation}", listed.name);
    let is_missed = matches!(listed.standing, Standing::Flown(flown) if flown.cause.is_some());
    let tint = if is_missed { t.badbg } else { Color32::TRANSPARENT };
    let response = list.option(ui, row, listed.key, is_selected, tint, || spoken.clone());
    let x_at = |x: f32| row.left() + x;
    let small = text::small();
    let (left, right) = (Align2::LEFT_CENTER, Align2::RIGHT_CENTER);
    icons::paint(
        ui.painter(),
        paint::square(pos2(x_at(columns.state) + 6.0, row.center().y), 12.0),
        icon,
        colour,
    );
    let room = row.with_min_x(x_at(columns.state) + 20.0);
    let aos_width = paint::text_width(ui, &aos, small.clone());
    let room = room.with_max_x(x_at(columns.aos) - aos_width - 8.0);
    paint::text_in(ui, room, left, &words, small.clone(), colour);
    paint::text_in(ui, row.with_max_x(x_at(columns.aos)), right, &aos, small.clone(), t.t1);
    for (end, words, colour) in [(columns.los, &los, t.t2), (columns.max, &max, t.t1)] {
        if let Some(end) = end {
            paint::text_in(ui, row.with_max_x(x_at(end)), right, words, small.clone(), colour);
        }
    }
    let is_out = listed.entry.is_none() && !matches!(listed.standing, Standing::Flown(_));
    let room = row.with_min_x(x_at(columns.name)).with_max_x(x_at(columns.name_end()));
    let (font, name_colour) =
        if is_out { (text::small(), t.t2) } else { (text::sized(13.0, Weight::SemiBold), t.t1) };
    let is_name_cut = !paint::fits(ui, listed.name, font.clone(), room);
    paint::name_in(ui, room, left, listed.name, font, name_colour);
    let mut text_from = x_at(columns.text);
    match (columns.slew, listed.entry) {
        (Some((slew, spare)), Some(entry)) => {
            let start_text = entry.after.map(|after| {
                let name = words::schedule::pass_name(model, (after.satellite, after.aos));
                format!(" from {name}")
            });
            let words =
                format!("{}{}", format::duration(entry.slew_s), start_text.unwrap_or_default());
            let room = row.with_min_x(x_at(slew)).with_max_x(x_at(spare) - 48.0);
            paint::text_in(ui, room, left, &words, small.clone(), t.cmd);
            let waits = matches!(listed.standing, Standing::Planned(_));
            if let Some(spare_s) = entry.spare_at(model.now).filter(|_| waits) {
                let colour = if spare_s < SHORT_S { t.warn } else { t.t1 };
                let words = format::duration(spare_s);
                paint::text_in(
                    ui,
                    row.with_max_x(x_at(spare)),
                    right,
                    &words,
                    small.clone(),
                    colour,
                );
            }
        }
        (Some((slew, _)), None) if is_out && !columns.has_wide_notes => text_from = x_at(slew),
        _ => {}
    }
    let mut end = row.right() - PADDING;
    let can_swap = columns.swaps && matches!(listed.standing, Standing::LeftOut(_));
    if let (true, Some(planned)) = (can_swap, &listed.planned) {
        // Azel knows the reason once the inspector has shown the price.
        let cannot = cannot_swap(model, listed.key);
        let button = Button::normal("Swap").locked(cannot).locked_by(replay::lock(model));
        let width = button.width(ui);
        let place = Rect::from_min_size(pos2(end - width, row.top() + 2.0), vec2(width, ROW - 4.0));
        let response = button.show(ui, ("swap", listed.key), place);
        let named = format!("Swap for {}, {aos}", listed.name);
        response.widget_info(|| WidgetInfo::labeled(Role::Button, !button.is_locked(), &named));
        if response.clicked() {
            plan.choose_for(model, planned, Some(Take::Always), commands);
        }
        end = place.left() - 8.0;
    }
    let room = row.with_min_x(text_from).with_max_x(end);
    let colour = if is_missed {
        t.bad
    } else if is_caution {
        t.warn
    } else {
        t.t2
    };
    let is_why_cut = !paint::fits(ui, &explanation, small.clone(), room);
    paint::text_in(ui, room, left, &explanation, small, colour);
    if response.clicked() {
        commands.push(UiCommand::SelectPass(listed.key));
    }
    if response.double_clicked() {
        commands.push(UiCommand::Show(crate::model::View::Operate));
    }
    let name = is_name_cut.then_some(listed.name);
    let cut: Vec<&str> = name.into_iter().chain(is_why_cut.then_some(&*explanation)).collect();
    if !cut.is_empty() {
        response.on_hover_text(cut.join("\n"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;

    #[test]
    fn the_satellites_of_a_constellation_are_whole_beside_all_but_the_drawer() {
        let mut window = testing::window([400.0, 60.0], 0.0, |ui, width| {
            let font = text::sized(13.0, Weight::SemiBold);
            *width = paint::text_width(ui, "GLOBALSTAR M094", font);
        });
        window.run();
        let requested = *window.state();
        for width in [760.0, 968.0, 999.0, 1000.0, 1384.0, 2000.0] {
            let columns = Columns::new(width);
            let room = columns.name_end() - columns.name;
            assert!(requested > 0.0 && room >= requested, "{room} of {requested} in {width}");
        }
    }
}
