//! Details of the selected object.

use egui::{Align2, Frame, Margin, Rect, Role, Ui, pos2, vec2};

use super::{ElementsState, PADDING, copy, facts, frequencies, holds, sets, table, words::Form};
use crate::{
    contract::{self, CatalogState, passes::PredictedPass},
    model::{Model, UiCommand, View, object_detail::ObjectDetail},
    orbit::{Catalog, Elements},
    station::Priority,
    ui::{
        confirm::Question,
        format,
        icons::{self, Icon},
        pass_limits, replay, text, theme,
        upcoming::Upcoming,
        upload::Choice,
        widgets::{
            button::{Button, HEIGHT as BUTTON, SMALL_HEIGHT},
            inspector::{self, Head, Parts},
            paint,
        },
    },
};

pub(super) const WIDTH: f32 = 344.0;
/// Side length of the star button, points.
const STAR: f32 = 22.0;
const FOOT: f32 = 88.0;
const GAP: f32 = 8.0;

/// Draws the details of the selected object into `rect`.
#[allow(clippy::too_many_arguments)]
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    lock: Option<&'static str>,
    state: &mut ElementsState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    inspector::show_ground(ui, rect);
    let selected = match &model.catalog {
        CatalogState::Ready(catalog) => {
            state.selection.row().and_then(|row| Some((catalog.get(row)?, &**catalog)))
        }
        CatalogState::Loading | CatalogState::Failed => None,
    };
    let Some((elements, catalog)) = selected else {
        let words = "Click a satellite in the table to see its elements.";
        return inspector::show_nothing(ui, rect, "No satellite selected", words);
    };
    let Parts { head, body, foot } = Parts::new(rect, FOOT);
    show_head(ui, head, model, elements, lock, commands);
    inspector::show_body(ui, body, "elements", |ui| {
        let object = Object { model, elements, catalog, lock };
        object.parts(ui, body.width(), state, question, commands);
    });
    show_foot(ui, foot, model, elements, lock, state, commands);
}

/// Object in the inspector.
struct Object<'a> {
    model: &'a Model,
    elements: &'a Elements,
    catalog: &'a Catalog,
    lock: Option<&'static str>,
}

impl Object<'_> {
    fn parts(
        &self,
        ui: &mut Ui,
        width: f32,
        state: &mut ElementsState,
        question: &mut Option<Question>,
        commands: &mut Vec<UiCommand>,
    ) {
        let Self { model, elements, catalog, lock } = *self;
        let number = elements.catalog_number();
        let place = |ui: &mut Ui, height: f32| inspector::place(ui, width, height);
        let part = place(ui, facts::HEIGHT);
        facts::show(ui, part, model, elements, catalog, lock, commands);
        let part = place(ui, holds::height(model));
        holds::show(ui, part, model, elements);
        let detail = sets::detail(model, number);
        let part = place(ui, sets::height(detail, catalog.set_aside(number).is_some()));
        sets::show(ui, part, model, elements, catalog, detail, question);
        let part = self.next_passes(ui, width, detail, commands);
        let t = theme::tokens(ui);
        ui.painter().hline(part.x_range(), part.bottom() - 0.5, (1.0, t.line));
        Frame::new().inner_margin(Margin::symmetric(PADDING as i8, 8)).show(ui, |ui| {
            ui.set_width(width - 2.0 * PADDING);
            frequencies::show(ui, model, number, lock, state, commands);
            ui.add_space(8.0);
            let room = width - 2.0 * PADDING;
            pass_limits::show(ui, room, model, number, lock, commands);
        });
    }

    /// Shows the next passes. A click on the pass of a favourite opens it on the sky plot.
    fn next_passes(
        &self,
        ui: &mut Ui,
        width: f32,
        detail: Option<&ObjectDetail>,
        commands: &mut Vec<UiCommand>,
    ) -> Rect {
        let Self { model, .. } = *self;
        let passes: Vec<&PredictedPass> = detail.iter().flat_map(|detail| &detail.passes).collect();
        let floor = format::degrees(model.station.elevation_floor_deg, 0);
        let upcoming = Upcoming {
            title: "Next passes",
            remark: &format!("floor {floor}"),
            passes: &passes,
            empty: match detail {
                None => "The passes are being computed.",
                Some(_) => "No pass in the next 7 d.",
            },
        };
        let part = inspector::place(ui, width, upcoming.height());
        let clicked = upcoming.show(ui, part, model).map(PredictedPass::key);
        if let Some(key) = clicked.filter(|key| model.pass_lists.find(*key).is_some()) {
            commands.push(UiCommand::SelectPass(key));
            commands.push(UiCommand::Show(View::Operate));
        }
        part
    }
}

/// Shows star, name, number and designator at the left, the countdown at the right.
fn show_head(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    elements: &Elements,
    lock: Option<&'static str>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let number = elements.catalog_number();
    let is_favourite = model.station.favourites.contains(number);
    let name = if is_favourite { "Remove from favourites" } else { "Add to favourites" };
    let place = paint::square(pos2(rect.left() + PADDING + 9.0, rect.top() + 19.0), STAR);
    let response = paint::control(ui, "inspector star", place, Role::Button, lock.is_none(), name);
    let (icon, colour) = if is_favourite { (Icon::Star, t.sat) } else { (Icon::OpenStar, t.t3) };
    icons::paint(ui.painter(), place.shrink(2.0), icon, colour);
    paint::focus_ring(ui, &response, 4);
    if response.on_hover_text(lock.unwrap_or(name)).clicked() {
        table::favour(vec![number], !is_favourite, commands);
    }
    let next = model.catalog_table.next.as_ref().and_then(|next| next.get(number, model.now));
    let (event, countdown) = match next {
        None => ("", String::new()),
        Some(next) if next.is_always_up => ("", "always up".to_owned()),
        Some(next) => {
            let (event, time) =
                if next.aos <= model.now { ("LOS", next.los) } else { ("AOS", next.aos) };
            (event, format::countdown(model.now, time))
        }
    };
    let designator = elements.international_designator().unwrap_or("no designator");
    let detail = format!("{number}, {designator}");
    let head = Head {
        name: &elements.label(),
        detail: &detail,
        event,
        countdown: &countdown,
        indent: STAR + 2.0,
    };
    inspector::show_head(ui, rect, "elements", head);
}

#[allow(clippy::too_many_arguments)]
fn show_foot(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    elements: &Elements,
    lock: Option<&'static str>,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let number = elements.catalog_number();
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let first = |left: f32, right: f32| {
        let top = rect.top() + 8.0;
        Rect::from_min_max(pos2(left, top), pos2(right, top + BUTTON))
    };
    let half = (inner.width() - GAP) / 2.0;
    if let Some(antenna) = model.antenna() {
        let word = format!("Upload to {}", antenna.config.name);
        let takes = antenna.spec().element_files.is_some();
        let upload = Button::primary(&word).icon(Icon::Upload);
        let upload = upload.locked(!takes).locked_by(replay::lock(model));
        let place = first(inner.left(), inner.left() + half);
        if upload.show(ui, "upload selected", place).clicked() {
            state.upload(Choice::Also(number));
        }
    }
    if model.pass_of(number).is_some() {
        let plot = Button::normal("Open on sky plot").icon(Icon::CrossHair);
        let place = first(inner.right() - half, inner.right());
        if plot.show(ui, "open on sky plot", place).clicked() {
            commands.push(UiCommand::SelectSatellite(number));
            commands.push(UiCommand::Show(crate::model::View::Operate));
        }
    }
    let second = |left: f32, width: f32| {
        let top = rect.top() + 16.0 + BUTTON;
        Rect::from_min_size(pos2(left, top), vec2(width, BUTTON))
    };
    for (place, word, form) in [(0.0, "TLE", Form::Tle), (80.0, "OMM", Form::Omm)] {
        let button = Button::normal(word).icon(Icon::Copy);
        let response = button.show(ui, ("copy", word), second(inner.left() + place, 72.0));
        let tip = format!("Copies the elements as {word}");
        if response.on_hover_text(tip).clicked() {
            copy(ui, model, &[number], form);
        }
    }
    if let Some(priority) = model.station.priority(number) {
        show_priority(ui, second(inner.right() - 150.0, 150.0), number, priority, lock, commands);
    }
}

/// Shows the priority between two buttons that change it.
fn show_priority(
    ui: &Ui,
    rect: Rect,
    number: u32,
    priority: Priority,
    lock: Option<&'static str>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    paint::text_in(ui, rect, Align2::LEFT_CENTER, "Priority", text::small(), t.t2);
    let area = |x: f32| {
        let min = pos2(rect.right() - x, rect.center().y - SMALL_HEIGHT / 2.0);
        Rect::from_min_size(min, vec2(SMALL_HEIGHT, SMALL_HEIGHT))
    };
    let place = Priority::ALL.iter().position(|level| *level == priority).unwrap_or_default();
    for (x, word, name, step) in
        [(80.0, "−", "More important", -1), (24.0, "+", "Less important", 1)]
    {
        let other = place.checked_add_signed(step).and_then(|place| Priority::ALL.get(place));
        let is_free = other.is_some() && lock.is_none();
        let response = Button::normal(word).locked(!is_free).show(ui, name, area(x));
        response.widget_info(|| egui::WidgetInfo::labeled(Role::Button, is_free, name));
        let response = response.on_hover_text(lock.unwrap_or(name));
        if let (true, Some(priority)) = (response.clicked(), other) {
            let numbers = vec![number];
            let command = contract::Command::SetPriority { numbers, priority: *priority };
            commands.push(UiCommand::Station(command));
        }
    }
    let middle = area(52.0);
    let word = priority.number().to_string();
    paint::text_in(ui, middle, Align2::CENTER_CENTER, &word, text::value(), t.t1);
    paint::name_text(ui, "priority", middle, &format!("Priority {word}"));
}
