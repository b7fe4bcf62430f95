//! The groups: names, satellites, priorities and limits.

use egui::{Align2, Rect, Sense, Ui, pos2, vec2};

use super::{
    GroupContext,
    draft::{GROUP, GroupDraft, SatellitesDraft},
    favourites::limits_form,
};
use crate::ui::{
    icons::{self, Icon},
    pass_limits,
    preferences::{FormState, form, picker},
    text, theme,
    widgets::{
        button::{Button, SMALL_HEIGHT},
        paint,
    },
    words,
};

pub(super) const TITLE: &str = "Groups";
const ROW: f32 = 32.0;

pub(super) fn show(
    ui: &mut Ui,
    context: &GroupContext<'_>,
    draft: &mut SatellitesDraft,
    state: &mut FormState,
) {
    form::card(ui, TITLE, |ui| {
        form::remark(
            ui,
            "A group gives priority and limits to those of its satellites that have none.",
        );
        for index in 0..draft.groups().len() {
            ui.push_id(index, |ui| {
                row(ui, context, index, draft, state);
                if state.satellites.group == Some(index) {
                    edit(ui, context, index, draft, state);
                }
            });
        }
        if ui.button("Add a group").clicked() {
            state.satellites.group = Some(draft.add_group());
        }
    });
}

fn row(
    ui: &mut Ui,
    context: &GroupContext<'_>,
    index: usize,
    draft: &mut SatellitesDraft,
    state: &mut FormState,
) {
    let t = theme::tokens(ui);
    let problem = draft.standings(index).into_iter().find_map(|standing| standing.problem);
    let Some(group) = draft.group_mut(index) else { return };
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
    let title = group.title();
    // Both labels have the same width, so that the button stays under the pointer.
    let width = Button::quiet("Undo: keep it").width(ui);
    let word = if group.is_removed { "Undo: keep it" } else { "Remove" };
    let place = Rect::from_center_size(
        pos2(row.right() - width / 2.0, row.center().y),
        vec2(width, SMALL_HEIGHT),
    );
    let response = Button::quiet(word).show(ui, "remove", place);
    response.widget_info(|| {
        let name = format!("{word}: group {title}");
        egui::WidgetInfo::labeled(egui::Role::Button, true, name)
    });
    if response.clicked() {
        group.is_removed = !group.is_removed;
        state.satellites.group.take_if(|open| *open == index);
    }
    let problem = problem.filter(|_| !group.is_removed);
    let summary = match &problem {
        _ if group.is_removed => "removed when you save".to_owned(),
        Some(problem) => format!("cannot be saved, its name {}", problem.reason),
        None => in_short(group, context),
    };
    let head = row.with_max_x(place.left() - 8.0).shrink2(vec2(0.0, 3.0));
    let name = format!("Group {title}: {summary}");
    let can_open = !group.is_removed;
    let response = paint::control(ui, "group", head, egui::Role::Button, can_open, &name);
    let is_open = state.satellites.group == Some(index);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_expanded(is_open));
    if response.hovered() && can_open {
        ui.painter().rect_filled(head, 4.0, t.bg3);
    }
    let rect = paint::square(pos2(head.left() + 10.0, head.center().y), 12.0);
    let (icon, colour) = match (problem.is_some(), is_open) {
        (true, _) => (Icon::Warning, t.bad),
        (false, true) => (Icon::ChevronDown, t.t2),
        (false, false) => (Icon::ChevronRight, t.t2),
    };
    icons::paint(ui.painter(), rect, icon, colour);
    let room = head.with_min_x(head.left() + 24.0);
    let ink = if group.is_removed { t.t3 } else { t.t1 };
    let named = paint::text_in(ui, room, Align2::LEFT_CENTER, &title, text::body_medium(), ink);
    let room = room.with_min_x(named.right() + 12.0).with_max_x(head.right() - 4.0);
    let ink = if problem.is_some() { t.bad } else { t.t2 };
    paint::text_in(ui, room, Align2::LEFT_CENTER, &summary, text::small(), ink);
    paint::focus_ring(ui, &response, 4);
    let has_room = paint::fits(ui, &summary, text::small(), room);
    let response = if has_room { response } else { response.on_hover_text(&summary) };
    if response.clicked() {
        state.satellites.group = (!is_open).then_some(index);
    }
}

/// Returns the group in a few words, such as "2 satellites, priority 1, by night".
fn in_short(group: &GroupDraft, context: &GroupContext<'_>) -> String {
    let satellites = match group.satellites.len() {
        0 => "no satellites".to_owned(),
        1 => "1 satellite".to_owned(),
        many => format!("{many} satellites"),
    };
    let priority = group.priority().map(|priority| format!("priority {}", priority.number()));
    let limits = pass_limits::in_short(&group.limits, &context.antennas);
    let limits = Some(limits).filter(|limits| !limits.is_empty());
    let parts = [Some(satellites), priority, limits];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn edit(
    ui: &mut Ui,
    context: &GroupContext<'_>,
    index: usize,
    draft: &mut SatellitesDraft,
    state: &mut FormState,
) {
    let standings = draft.standings(index);
    let Some(group) = draft.group_mut(index).filter(|group| !group.is_removed) else { return };
    ui.add_space(4.0);
    form::rows(ui, "group", (&mut group.named, &standings), GROUP, &mut state.focus_target);
    form::custom_row(ui, ("group", "Satellites"), None, group.has_other_satellites(), |ui| {
        ui.vertical(|ui| {
            members(ui, context, &group.title(), &mut group.satellites);
            let (favourites, taken_numbers) = (&context.favourites, &group.satellites);
            let search = &mut state.satellites.search;
            let added = picker::show(ui, context.model, favourites, taken_numbers, search);
            group.satellites.extend(added);
        });
    });
    let all = group.limits.clone();
    limits_form(ui, context).show(ui, &mut group.limits, &all);
    ui.add_space(8.0);
}

/// Shows the satellites of a group; a click on a satellite removes it.
fn members(ui: &mut Ui, context: &GroupContext<'_>, group: &str, satellites: &mut Vec<u32>) {
    let mut removed = None;
    ui.horizontal_wrapped(|ui| {
        for number in &*satellites {
            let name = words::satellite(context.model, *number);
            let response = ui.button(format!("{name} ×"));
            response.widget_info(|| {
                let spoken = format!("Remove {name} from {group}");
                egui::WidgetInfo::labeled(egui::Role::Button, true, spoken)
            });
            let is_favourite = context.favourites.contains(number);
            let more =
                if is_favourite { "" } else { ". Not a favourite: its passes are not planned" };
            if response.on_hover_text(format!("{number}, click to remove{more}")).clicked() {
                removed = Some(*number);
            }
        }
    });
    satellites.retain(|number| Some(*number) != removed);
}
