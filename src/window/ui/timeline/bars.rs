//! The passes as bars on the floor of a lane, and the names above them.

use std::ops::RangeInclusive;

use egui::{Align2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use jiff::Timestamp;

use super::{
    Bar, State, TimelineModel, head,
    labels::{self, Placed, Wish},
    scale::bar_height,
};
use crate::{
    model::{UiCommand, plan},
    ui::{
        format,
        pass_bar::{self, BarForm},
        text, theme,
        time_axis::TimeAxis,
        widgets::{context_menu, paint},
    },
};

/// Frame of the selected bar: width of its line, and gap to the bar, points.
const FRAME: f32 = 1.5;
const FRAME_GAP: f32 = 1.5;
/// Min height of a bar, points, so that it stays visible in a low lane.
const LOWEST: f32 = 8.0;
const TRIANGLE: egui::Vec2 = vec2(9.0, 7.0);
/// Gap at the left and the right of a name, points.
const GAP: f32 = 1.0;
/// Gap between the bars and the lower edge of the lane, for the frame, points.
const FLOOR: f32 = 4.0;
/// Room above the highest bar for a name, the sign for lost seconds and the frame.
const ABOVE: f32 = 25.0;

/// Returns the bar heights that fit `lane`; in a low lane the high bars shrink below `span`.
pub(super) fn fitting(span: &RangeInclusive<f32>, lane: Rect) -> RangeInclusive<f32> {
    let highest = (lane.height() - FLOOR - ABOVE).clamp(LOWEST, *span.end());
    span.start().min(highest)..=highest
}

/// Number of bars from which one bar represents all bars that begin within a few points.
const MANY: usize = 400;
const APART: f32 = 2.0;

/// The antenna of a lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct LaneOf<'a> {
    pub antenna: &'a str,
    pub is_one_of_several: bool,
}

/// A bar and its place.
pub(super) struct Standing<'a> {
    bar: &'a Bar<'a>,
    rect: Rect,
}

/// Places the accepted bars of the window in `lane`, in order of AOS. Their heights grow with the
/// maximum elevation from 0° to 90°. Keeps only distinguishable bars if there are very many.
pub(super) fn stand<'a>(
    bars: &'a [Bar<'a>],
    is_shown: impl Fn(&Bar<'_>) -> bool,
    selected: Option<(u32, Timestamp)>,
    scale: &TimeAxis,
    lane: Rect,
    heights: &RangeInclusive<f32>,
) -> Vec<Standing<'a>> {
    let floor = lane.bottom() - FLOOR;
    let mut standing: Vec<_> = bars
        .iter()
        .filter(|bar| is_shown(bar))
        .filter_map(|bar| {
            let x = scale.range(bar.aos, bar.los)?;
            let top = floor - bar_height(bar.max_elevation_deg.unwrap_or_default(), heights);
            Some(Standing { bar, rect: Rect::from_x_y_ranges(x, top..=floor) })
        })
        .collect();
    standing.sort_by_key(|one| (one.bar.aos, one.bar.key));
    if standing.len() > MANY { thinned(standing, selected) } else { standing }
}

/// Keeps one of all bars that begin at the same place: the selected bar, else a taken bar, else the
/// highest.
fn thinned(standing: Vec<Standing<'_>>, selected: Option<(u32, Timestamp)>) -> Vec<Standing<'_>> {
    let column = |one: &Standing<'_>| (one.rect.left() / APART).floor() as i32;
    let rank =
        |one: &Standing<'_>| (selected == Some(one.bar.key), one.bar.is_taken(), one.rect.height());
    let mut apart: Vec<Standing<'_>> = Vec::new();
    for one in standing {
        match apart.last_mut().filter(|last| column(last) == column(&one)) {
            Some(last) if rank(last) < rank(&one) => *last = one,
            Some(_) => {}
            None => apart.push(one),
        }
    }
    apart
}

/// Paints the bars of an antenna, later bars above earlier ones.
pub(super) fn show(
    ui: &Ui,
    standing: &[Standing<'_>],
    lane: LaneOf<'_>,
    model: &TimelineModel<'_>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let selected = model.selected;
    let mut focused = None;
    for Standing { bar, rect } in standing {
        let remarks = || remarks(bar, lane.antenna, model);
        let response = node(ui, bar, *rect, lane, (model.now, selected == Some(bar.key)), &remarks);
        pass_bar::paint(ui, *rect, form(bar));
        if response.hovered() {
            let stroke = Stroke::new(1.0, t.t1);
            ui.painter().rect_stroke(*rect, 0, stroke, StrokeKind::Outside);
        }
        if response.clicked() {
            commands.push(UiCommand::SelectPass(bar.key));
        }
        if response.has_focus() {
            focused = Some(response.clone());
        }
        context_menu::show(ui, &response, |ui| {
            (model.menu)(ui, response.id, bar.key, commands);
        });
        if response.hovered() {
            response.on_hover_text(tool_tip(bar, model.now, &remarks()));
        }
    }
    for one in standing {
        if let Some(sign) = one.triangle() {
            head::triangle(ui, sign, t.warn);
        }
        if selected == Some(one.bar.key) {
            let frame = one.rect.expand(FRAME_GAP);
            ui.painter().rect_stroke(frame, 2, Stroke::new(FRAME, t.ant), StrokeKind::Outside);
        }
    }
    if let Some(response) = focused {
        paint::focus_ring(ui, &response, 2);
    }
}

/// Returns the form of a bar, the same as in the lanes of the plan.
fn form(bar: &Bar<'_>) -> BarForm {
    match bar.state {
        State::Plan(plan::Standing::Flown(flown)) if flown.cause.is_none() => BarForm::Done,
        State::Plan(plan::Standing::Flown(_)) => BarForm::Missed,
        State::Plan(plan::Standing::Sent(_)) => BarForm::Sent,
        State::Plan(plan::Standing::Proved(_)) => BarForm::Proved,
        State::Plan(plan::Standing::Running) => BarForm::Running,
        State::Mount { .. } | State::Plan(_) if bar.is_taken() => BarForm::Planned,
        State::Mount { .. } | State::Plan(_) => BarForm::LeftOut,
    }
}

/// Paints the names that fit above the bars: first the selected one, then the names of taken
/// passes.
pub(super) fn show_names(
    ui: &Ui,
    standing: &[Standing<'_>],
    selected: Option<(u32, Timestamp)>,
    room: Rect,
) {
    let t = theme::tokens(ui);
    let mut order: Vec<&Standing<'_>> = standing.iter().collect();
    order.sort_by_key(|one| (selected != Some(one.bar.key), !one.bar.is_taken()));
    let shorts: Vec<String> =
        order.iter().map(|one| labels::short_name(one.bar.name.text())).collect();
    let mut obstacles: Vec<Rect> = standing.iter().map(|one| one.rect).collect();
    obstacles.extend(standing.iter().filter_map(Standing::triangle));
    let wishes: Vec<Wish> = order
        .iter()
        .zip(&shorts)
        .map(|(one, short)| Wish {
            short: one.name_rect(ui, short, room),
            full: one.name_rect(ui, one.bar.name.text(), room),
        })
        .collect();
    let placed = labels::place(&wishes, &obstacles, room);
    for ((one, short), placed) in order.iter().zip(&shorts).zip(placed) {
        let (name, rect) = match placed {
            Placed::Out => continue,
            Placed::Short(rect) => (short.as_str(), rect),
            Placed::Full(rect) => (one.bar.name.text(), rect),
        };
        // The fill covers the now-line and the grid behind the letters.
        ui.painter().rect_filled(rect, 0, t.bg0);
        let colour = if one.bar.is_taken() { t.t1 } else { t.other };
        paint::text(ui, rect.center(), Align2::CENTER_CENTER, name, text::caption(), colour);
    }
}

impl Standing<'_> {
    /// Returns the rectangle of the sign for lost seconds.
    fn triangle(&self) -> Option<Rect> {
        let shown = self.bar.loses && self.bar.is_taken();
        let low = pos2(self.rect.center().x, self.rect.top() - FRAME - FRAME_GAP);
        shown.then(|| Align2::CENTER_BOTTOM.anchor_size(low, TRIANGLE))
    }

    /// Returns the rectangle of `name` above the bar, moved inwards at the ends of `room`.
    fn name_rect(&self, ui: &Ui, name: &str, room: Rect) -> Rect {
        let galley =
            ui.painter().layout_no_wrap(name.to_owned(), text::caption(), theme::tokens(ui).t1);
        let size = vec2(galley.size().x + 2.0 * GAP, galley.size().y);
        let top = self.triangle().map_or(self.rect.top() - FRAME - FRAME_GAP, |sign| sign.top());
        let half = size.x / 2.0;
        let leftmost = room.left() + half;
        let x = self.rect.center().x.clamp(leftmost, (room.right() - half).max(leftmost));
        Align2::CENTER_BOTTOM.anchor_size(pos2(x, top), size)
    }
}

fn node(
    ui: &Ui,
    bar: &Bar<'_>,
    rect: Rect,
    lane: LaneOf<'_>,
    (now, selected): (Timestamp, bool),
    remarks: &dyn Fn() -> String,
) -> Response {
    let id = ui.make_persistent_id(("pass bar", lane.antenna, bar.key));
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| {
        let mut name = accessible_name(bar, now, &remarks());
        if lane.is_one_of_several {
            name = format!("{}: {name}", lane.antenna);
        }
        WidgetInfo::selected(Role::ListBoxOption, true, selected, name)
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_selected(selected));
    response
}

/// Describes the status of a pass, each remark after a comma.
fn remarks(bar: &Bar<'_>, antenna: &str, model: &TimelineModel<'_>) -> String {
    let stands = match bar.state {
        State::Mount { can_track: true } => None,
        State::Mount { can_track: false } => Some("out of reach".to_owned()),
        State::Plan(standing) => Some((model.says)(standing, antenna)),
    };
    let lost = (bar.loses && bar.is_taken()).then(|| "part lost".to_owned());
    let mut remarks = String::new();
    for remark in stands.into_iter().chain(lost) {
        remarks += ", ";
        remarks += &remark;
    }
    remarks
}

fn accessible_name(bar: &Bar<'_>, now: Timestamp, remarks: &str) -> String {
    let times = format::minutes(bar.aos, bar.los, now);
    format!("{}, {times}{}{remarks}", bar.name.text(), max_elevation(bar, ", "))
}

fn tool_tip(bar: &Bar<'_>, now: Timestamp, remarks: &str) -> String {
    let times = format::stretch(bar.aos, bar.los, now);
    format!("{}\n{times}{}{remarks}", bar.name.text(), max_elevation(bar, "\n"))
}

/// Returns the maximum elevation after `separator`; empty if it is no longer known.
fn max_elevation(bar: &Bar<'_>, separator: &str) -> String {
    let elevation = bar.max_elevation_deg.map(|deg| format::degrees(deg, 0));
    elevation.map_or_else(String::new, |deg| format!("{separator}max {deg}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{astro::time::add_seconds, ui::timeline::BarName};

    #[test]
    fn bars_leave_room_for_names_in_a_low_lane() {
        let lane = |height| Rect::from_min_size(egui::Pos2::ZERO, vec2(100.0, height));
        assert_eq!(fitting(&(14.0..=44.0), lane(80.0)), 14.0..=44.0);
        assert_eq!(fitting(&(14.0..=44.0), lane(59.0)), 14.0..=30.0);
        assert_eq!(fitting(&(14.0..=44.0), lane(10.0)), 8.0..=8.0);
    }

    #[test]
    fn of_very_many_bars_the_selected_taken_and_highest_stand_for_those_beside_them() {
        let now: Timestamp = "2026-08-12T11:15:30Z".parse().unwrap();
        let bar = |number: u32| Bar {
            key: (number, now),
            name: BarName::Known("NOAA 20"),
            aos: add_seconds(now, f64::from(number) * 20.0),
            los: add_seconds(now, f64::from(number) * 20.0 + 600.0),
            max_elevation_deg: Some(f64::from(number % 7) * 10.0),
            loses: false,
            state: State::Mount { can_track: number % 7 < 3 },
        };
        let lane = Rect::from_min_size(egui::Pos2::ZERO, vec2(1000.0, 80.0));
        let scale = super::super::scale::axis(now, 24.0, lane.x_range());
        let shown = |count, selected| {
            let bars: Vec<Bar<'_>> = (0..count).map(bar).collect();
            let standing = stand(&bars, |_| true, selected, &scale, lane, &(14.0..=44.0));
            standing.iter().map(|one| one.bar.key.0).collect::<Vec<_>>()
        };
        assert_eq!(shown(MANY as u32, None).len(), MANY);
        let few = shown(4000, None);
        assert!((400..=500).contains(&few.len()), "{}", few.len());
        assert!(few.iter().filter(|number| *number % 7 == 2).count() > few.len() / 2);
        let unseen = (0..4000).find(|number| !few.contains(number)).unwrap();
        assert!(shown(4000, Some((unseen, now))).contains(&unseen));
    }
}
