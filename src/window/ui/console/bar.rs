//! The controls above the log, and the status line below it.

use egui::{
    Align, Align2, Layout, Pos2, Rect, RichText, Role, Sense, TextEdit, Ui, UiBuilder, WidgetInfo,
    vec2,
};

use super::{ConsoleState, PADDING};
use crate::{
    device::Direction,
    model::{Model, UiCommand},
    ui::{
        format, replay, text, theme,
        widgets::{
            button::{self, Button, HEIGHT as BUTTON},
            check_box::CheckBox,
            drop_down::DropDown,
            paint,
        },
    },
};

/// Height of the bar above the log, points.
pub(super) const HEIGHT: f32 = 56.0;
/// Height of the line below the log, points.
pub(super) const STRIP: f32 = 28.0;
const GAP: f32 = 8.0;
const TITLE: f32 = 88.0;
const ANTENNA: f32 = 128.0;
const DIRECTION: f32 = 104.0;
const POLLS: f32 = 104.0;
/// Menu entry that shows the lines of all antennas.
const ALL: &str = "All antennas";

/// Draws the controls. With `has_drawer`, a button opens the inspector.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    has_drawer: bool,
    state: &mut ConsoleState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    paint::text_in(ui, inner, Align2::LEFT_CENTER, "Console", text::title(), t.t1);
    let buttons = Buttons::new(model, state, has_drawer);
    let places = buttons.places(ui, inner.right_center());
    let room = inner.with_min_x(inner.left() + TITLE).with_max_x(places.pause.left() - GAP);
    let layout = Layout::left_to_right(Align::Center);
    ui.scope_builder(UiBuilder::new().id_salt("console bar").max_rect(room).layout(layout), |ui| {
        antenna(ui, model, state);
        direction(ui, state);
        let polls = vec2(POLLS, BUTTON);
        let is_hidden = &mut state.filter.hides_polls;
        ui.add_sized(polls, CheckBox::new(is_hidden, "Hide polls"));
        let hint = RichText::new("Filter by text").color(t.t3);
        let needle = &mut state.filter.needle;
        let edit = TextEdit::singleline(needle).hint_text(hint).id_salt("filter");
        let edit = ui.add(edit.desired_width(ui.available_width() - GAP));
        edit.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Filter the log"));
        if std::mem::take(&mut state.filter_wants_focus) {
            edit.request_focus();
        }
    });
    show_buttons(ui, buttons, places, state, commands);
}

fn antenna(ui: &mut Ui, model: &Model, state: &mut ConsoleState) {
    let chosen = &mut state.filter.antenna;
    let shown = chosen.clone().unwrap_or_else(|| ALL.to_owned());
    let name = format!("Log of {shown}");
    let antennas =
        DropDown { button: Button::normal(&shown), salt: "console antenna", name: &name };
    let (place, _) = ui.allocate_exact_size(vec2(ANTENNA, BUTTON), Sense::hover());
    antennas.show(ui, place, |ui| {
        ui.selectable_value(chosen, None, ALL);
        for antenna in &model.antennas {
            let name = &antenna.config.name;
            ui.selectable_value(chosen, Some(name.clone()), name);
        }
    });
}

fn direction(ui: &mut Ui, state: &mut ConsoleState) {
    const WAYS: [(Option<Direction>, &str); 3] = [
        (None, "Both ways"),
        (Some(Direction::Sent), "Sent"),
        (Some(Direction::Received), "Received"),
    ];
    let chosen = &mut state.filter.direction;
    let shown = WAYS.iter().find(|(way, _)| way == chosen).map_or("", |(_, word)| word);
    let name = format!("Lines of the log: {shown}");
    let ways = DropDown { button: Button::normal(shown), salt: "console direction", name: &name };
    let (place, _) = ui.allocate_exact_size(vec2(DIRECTION, BUTTON), Sense::hover());
    ways.show(ui, place, |ui| {
        for (way, word) in WAYS {
            ui.selectable_value(chosen, way, word);
        }
    });
}

/// One value for each button at the right end, from the left.
#[derive(Clone, Copy)]
struct AllSources<T> {
    pause: T,
    newest: T,
    copy: T,
    save: T,
    /// Value of the button that opens the drawer; `None` without a drawer.
    details: Option<T>,
}

type Buttons = AllSources<Button<'static>>;

impl Buttons {
    fn new(model: &Model, state: &ConsoleState, has_drawer: bool) -> Self {
        let nothing_chosen = state.chosen().next().is_none();
        let details = if state.inspector_is_open { "Close details" } else { "Details" };
        Self {
            pause: if state.is_paused {
                Button::primary("Resume")
            } else {
                Button::normal("Pause")
            },
            newest: Button::normal("Newest").locked(state.table.follows()),
            copy: Button::normal("Copy").locked(nothing_chosen),
            save: Button::normal("Save")
                .locked(state.log.shown().is_empty())
                .locked_by(replay::lock(model)),
            details: has_drawer.then(|| Button::normal(details)),
        }
    }

    fn places(&self, ui: &Ui, right: Pos2) -> AllSources<Rect> {
        let details = self.details.map(|button| {
            let [place] = button::row(right, [button.width(ui)]);
            place
        });
        let right = details.map_or(right, |place| place.left_center() - vec2(GAP, 0.0));
        let widths = [self.pause, self.newest, self.copy, self.save].map(|button| button.width(ui));
        let [pause, newest, copy, save] = button::row(right, widths);
        AllSources { pause, newest, copy, save, details }
    }
}

fn show_buttons(
    ui: &Ui,
    buttons: Buttons,
    places: AllSources<Rect>,
    state: &mut ConsoleState,
    commands: &mut Vec<UiCommand>,
) {
    if buttons.pause.show(ui, "pause", places.pause).clicked() {
        state.is_paused = !state.is_paused;
    }
    if buttons.newest.show(ui, "newest", places.newest).clicked() {
        state.table.follow();
    }
    if buttons.copy.show(ui, "copy lines", places.copy).clicked() {
        state.copy(ui);
    }
    if buttons.save.show(ui, "save log", places.save).clicked() {
        let lines = state.log.all_shown().cloned().collect();
        commands.push(UiCommand::SaveLog(lines));
    }
    if let Some((details, place)) = buttons.details.zip(places.details)
        && details.show(ui, "details", place).clicked()
    {
        state.inspector_is_open = !state.inspector_is_open;
    }
}

/// Shows the number of lines and the outcome of the last save.
pub(super) fn show_strip(ui: &Ui, rect: Rect, state: &ConsoleState) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let words = counts(state);
    let colour = if state.is_paused { t.warn } else { t.t2 };
    let width = paint::text_in(ui, inner, Align2::LEFT_CENTER, &words, text::small(), colour);
    paint::name_text(ui, "counts", width, &words);
    if let Some(saved) = &state.saved {
        let (words, colour) = match saved {
            Ok(path) => (format!("Saved to {}", path.display()), t.ok),
            Err(reason) => (format!("Not saved: {reason}"), t.bad),
        };
        let room = inner.with_min_x(width.right() + PADDING);
        paint::named_text_in(
            ui,
            "saved log",
            room,
            Align2::RIGHT_CENTER,
            &words,
            text::small(),
            colour,
        );
    }
}

fn counts(state: &ConsoleState) -> String {
    let number = |count: usize| format::number(count as f64, 0);
    let shown = state.log.shown().len();
    let plural = if shown == 1 { "line" } else { "lines" };
    let mut words = vec![format!("{} {plural}", number(shown))];
    let polls = state.log.hidden_polls();
    if polls > 0 {
        let plural = if polls == 1 { "poll" } else { "polls" };
        words.push(format!("{} {plural} hidden", number(polls)));
    }
    if state.is_paused {
        let waiting = usize::try_from(state.log.waiting()).unwrap_or(usize::MAX);
        words.push(format!("paused, {} recorded since", number(waiting)));
    }
    words.join(", ")
}
