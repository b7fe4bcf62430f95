//! The table of the favourites with their priorities and limits.

use egui::{Align2, Rect, Sense, Stroke, StrokeKind, Ui, vec2};

use super::{GroupContext, SatellitesState, draft::SatellitesDraft};
use crate::{
    station::Priority,
    ui::{
        pass_limits::{self, LimitsForm},
        preferences::form,
        text, theme,
        widgets::{
            button::{Button, RADIUS, SMALL_HEIGHT},
            form::{GAP, LABEL},
            paint, segmented,
        },
        words,
    },
};

pub(super) const TITLE: &str = "Priorities of the favourites";
const ROW: f32 = 32.0;
const HEAD: f32 = 20.0;
const PRIORITY: f32 = 176.0;
/// Width of the inherited settings of a favourite without its own priority, points.
const DEFAULTS_WIDTH: f32 = 76.0;
/// Width of the limits: default, and in a wide row, points.
const LIMITS: [f32; 2] = [112.0, 240.0];
const WIDE: f32 = 640.0;

pub(super) fn show(
    ui: &mut Ui,
    context: &GroupContext<'_>,
    (draft, before): (&mut SatellitesDraft, &SatellitesDraft),
    state: &mut SatellitesState,
) {
    form::card(ui, TITLE, |ui| {
        form::remark(
            ui,
            "1 is taken first. A favourite without its own priority has its group's, else 3.",
        );
        if !context.favourites.is_empty() {
            head(ui);
        }
        for number in &context.favourites {
            ui.push_id(number, |ui| row(ui, context, *number, (draft, before), state));
        }
        if context.favourites.is_empty() {
            form::remark(
                ui,
                "There are no favourites. Mark some in Elements, or name them by number here.",
            );
        }
    });
}

/// Returns the columns in `row`: name, own priority, inherited settings, limits.
fn columns(row: Rect) -> [Rect; 4] {
    let from_right = |right: f32, width: f32| {
        let centre = egui::pos2(row.right() - right - width / 2.0, row.center().y);
        Rect::from_center_size(centre, vec2(width, SMALL_HEIGHT))
    };
    let [default_limits, wide_limits] = LIMITS;
    let limits = if row.width() < WIDE { default_limits } else { wide_limits };
    let priority = from_right(limits + DEFAULTS_WIDTH + 2.0 * GAP, PRIORITY);
    let name = row.with_max_x(priority.left() - GAP);
    [name, priority, from_right(limits + GAP, DEFAULTS_WIDTH), from_right(0.0, limits)]
}

/// Draws the column headings.
fn head(ui: &mut Ui) {
    let t = theme::tokens(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEAD), Sense::hover());
    for (place, word) in
        columns(rect).into_iter().zip(["Satellite", "Own priority", "Inherited", "Limits"])
    {
        paint::text_in(ui, place, Align2::LEFT_CENTER, word, text::caption(), t.t3);
        paint::name_text(ui, ("head", word), place, word);
    }
}

fn row(
    ui: &mut Ui,
    context: &GroupContext<'_>,
    number: u32,
    (draft, before): (&mut SatellitesDraft, &SatellitesDraft),
    state: &mut SatellitesState,
) {
    let t = theme::tokens(ui);
    let name = words::satellite(context.model, number);
    let (mut own, of_groups) = (draft.own(number), draft.of_groups(number));
    let width = ui.available_width();
    let (row, _) = ui.allocate_exact_size(vec2(width, ROW), Sense::hover());
    ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
    let [name_at, priority_at, defaults_rect, limits_at] = columns(row);
    paint::text_in(ui, name_at, Align2::LEFT_CENTER, &name, text::body_medium(), t.t1);
    paint::name_text(ui, "name", name_at, &name).on_hover_text(format!("{name}, {number}"));

    choose_priority(ui, priority_at, &name, &mut own.priority);
    let was = before.own(number);
    for (place, is_edited) in
        [(priority_at, was.priority != own.priority), (limits_at, was.limits != own.limits)]
    {
        if is_edited {
            let stroke = Stroke::new(2.0, t.sat);
            ui.painter().rect_stroke(place, RADIUS, stroke, StrokeKind::Outside);
        }
    }
    if was != own {
        paint::name_text(ui, "edited", name_at, &format!("{name}: edited"));
    }
    if own.priority.is_none() {
        let default = of_groups.priority.as_ref().map_or_else(
            || format!("{}, default", Priority::default().number()),
            |(priority, group)| format!("{}, {group}", priority.number()),
        );
        paint::text_in(ui, defaults_rect, Align2::LEFT_CENTER, &default, text::small(), t.t2);
        paint::name_text(ui, "usual", defaults_rect, &format!("Priority of {name}: {default}"));
    }
    let all = own.limits.or(&of_groups.limits);
    let in_short = pass_limits::in_short(&all, &context.antennas);
    let words = if in_short.is_empty() { "No limits" } else { &in_short };
    let is_open = state.favourite == Some(number);
    let button = Button::normal(words).chevron();
    let has_room = button.width(ui) <= limits_at.width();
    let response = button.show(ui, "limits", limits_at);
    response.widget_info(|| {
        let name = format!("Limits of {name}: {words}");
        egui::WidgetInfo::labeled(egui::Role::Button, true, name)
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_expanded(is_open));
    let response = if has_room { response } else { response.on_hover_text(words) };
    if response.clicked() {
        state.favourite = (!is_open).then_some(number);
    }
    if is_open {
        limits_form(ui, context).show(ui, &mut own.limits, &all);
        ui.add_space(GAP);
    }
    if own != draft.own(number) {
        draft.put(own);
    }
}

pub(super) fn limits_form<'a>(ui: &Ui, context: &'a GroupContext<'_>) -> LimitsForm<'a> {
    LimitsForm {
        width: ui.available_width(),
        label_width: LABEL + GAP,
        antennas: &context.antennas,
        lock: None,
    }
}

fn choose_priority(ui: &Ui, place: Rect, name: &str, priority: &mut Option<Priority>) {
    let choices: Vec<(Option<Priority>, String)> = std::iter::once((None, "Default".to_owned()))
        .chain(Priority::ALL.map(|level| (Some(level), level.number().to_string())))
        .collect();
    let choices: Vec<(&str, Option<Priority>)> =
        choices.iter().map(|(priority, word)| (word.as_str(), *priority)).collect();
    let name = format!("Priority of {name}");
    segmented::choose(ui, "priority", place, &name, &choices, priority);
}
