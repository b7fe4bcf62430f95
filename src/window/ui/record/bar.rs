//! The controls above the record.

use egui::{Align2, Rect, RichText, Role, TextEdit, Ui, WidgetInfo, pos2, vec2};

use super::{PADDING, RecordState, days::DaysDialog, lock};
use crate::{
    astro::time::add_seconds,
    contract::{antenna::AntennaModel, record::ListedKind},
    model::{Model, UiCommand, replay::Stretch},
    plan::pass_report::PassVerdict,
    ui::{
        format,
        icons::{self, Icon},
        text, theme,
        widgets::{
            button::{Button, HEIGHT as BUTTON},
            drop_down::DropDown,
            input, paint,
            segmented::{self, Segment},
        },
        words::record as words,
    },
};

pub(super) const HEIGHT: f32 = 56.0;
const GAP: f32 = 8.0;
const TITLE: f32 = 228.0;
const SMALL_TITLE: f32 = 76.0;
const SEARCH: f32 = 208.0;
/// Bar width below which the recording state is only a mark and the title has no second line,
/// points.
const WIDE: f32 = 1150.0;
const ANTENNA: f32 = 84.0;
/// Time before the present at which a replay of the last hour starts to play, seconds.
const LAST_S: f64 = 60.0;
const KINDS: [ListedKind; 4] = [
    ListedKind::Tracked(PassVerdict::Good),
    ListedKind::Tracked(PassVerdict::Fair),
    ListedKind::Tracked(PassVerdict::Poor),
    ListedKind::NotTracked,
];

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    has_drawer: bool,
    state: &mut RecordState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let is_wide = rect.width() >= WIDE;
    let mut left = inner.left();
    let mut place = |width: f32| {
        let min = pos2(left, rect.center().y - BUTTON / 2.0);
        left += width + GAP;
        Rect::from_min_size(min, vec2(width, BUTTON))
    };
    if has_drawer {
        let button = Button::normal("Passes");
        let area = place(button.width(ui));
        if button.show(ui, "record passes", area).clicked() {
            state.list_is_open = !state.list_is_open;
        }
    }
    let area = place(if is_wide { TITLE } else { SMALL_TITLE });
    title(ui, area, model, is_wide, state);
    antennas(ui, &mut place, model, is_wide, state);
    let area = place(if is_wide { SEARCH } else { SEARCH - 48.0 });
    search(ui, area, state);
    verdicts(ui, &mut place, state);
    let room = inner.with_min_x(left + GAP);
    let room = export_days(ui, room, model, state);
    let rest = last_hour(ui, room, model, commands);
    recording(ui, rest, model);
}

fn title(ui: &Ui, rect: Rect, model: &Model, is_wide: bool, state: &RecordState) {
    let t = theme::tokens(ui);
    let left = Align2::LEFT_CENTER;
    let words = summary(model, state);
    if is_wide {
        let line = |y: f32| {
            Rect::from_x_y_ranges(
                rect.x_range(),
                rect.center().y + y - 12.0..=rect.center().y + y + 12.0,
            )
        };
        paint::text_in(ui, line(-9.0), left, "Record", text::title(), t.t1);
        paint::named_text_in(ui, "record summary", line(12.0), left, &words, text::small(), t.t2);
    } else {
        paint::text_in(ui, rect, left, "Record", text::title(), t.t1);
        paint::name_text(ui, "record summary", rect, &words).on_hover_text(&words);
    }
}

/// Returns the number of passes, and the start and size of the record.
fn summary(model: &Model, state: &RecordState) -> String {
    let Some(page) = RecordState::page(model) else { return String::new() };
    let size = model.record.as_ref().map(|record| format::bytes(record.bytes));
    let mut words = match (page.all, page.start) {
        (0, _) | (_, None) => "No pass yet".to_owned(),
        (1, Some(start)) => format!("1 pass, {}", format::day(start)),
        (all, Some(start)) => format!("{all} passes since {}", format::day(start)),
    };
    if state.filters() {
        words = format!("{} of {words}", page.matching);
    }
    match size {
        Some(size) => format!("{words}, {size}"),
        None => words,
    }
}

fn antennas(
    ui: &Ui,
    place: &mut impl FnMut(f32) -> Rect,
    model: &Model,
    is_wide: bool,
    state: &mut RecordState,
) {
    let chosen = state.query.antenna;
    if is_wide && model.antennas.len() <= 3 {
        let mark = |is_chosen| if is_chosen { Segment::Chosen } else { Segment::Free };
        let mut segments = vec![("All", mark(chosen.is_none()))];
        segments.extend(
            model
                .antennas
                .iter()
                .map(|antenna| (antenna.config.name.as_str(), mark(chosen == Some(antenna.id())))),
        );
        let rect = place(44.0 + ANTENNA * model.antennas.len() as f32);
        if let Some(index) = segmented::show(ui, "record antenna", rect, "Antenna", &segments) {
            let antenna = index.checked_sub(1).and_then(|index| model.antennas.get(index));
            state.query.antenna = antenna.map(AntennaModel::id);
        }
        return;
    }
    let model_antenna = chosen.and_then(|id| model.antenna_of(id));
    let word = model_antenna.map_or("All antennas", |antenna| &antenna.config.name).to_owned();
    let name = format!("Antenna, {word}");
    let list = DropDown { button: Button::normal(&word), salt: "record antenna", name: &name };
    let rect = place(list.width(ui));
    list.show(ui, rect, |ui| {
        ui.selectable_value(&mut state.query.antenna, None, "All antennas");
        for antenna in &model.antennas {
            let name = antenna.config.name.as_str();
            ui.selectable_value(&mut state.query.antenna, Some(antenna.id()), name);
        }
    });
}

fn search(ui: &mut Ui, place: Rect, state: &mut RecordState) {
    let t = theme::tokens(ui);
    let edit = TextEdit::singleline(&mut state.query.text)
        .id_salt("search the record")
        .hint_text(RichText::new("Name or 2026-11-30").color(t.t3))
        .align(Align2::LEFT_CENTER)
        .min_size(place.size())
        .desired_width(place.width());
    let edit = ui.place(place, edit).accessible_name("Satellite or date");
    input::select_when_tabbed(ui, &edit, &state.query.text);
    paint::focus_ring(ui, &edit, 4);
}

fn verdicts(ui: &Ui, place: &mut impl FnMut(f32) -> Rect, state: &mut RecordState) {
    let word = state.query.kind.map_or("All verdicts", words::listed_kind);
    let name = format!("Verdict, {word}");
    let list = DropDown { button: Button::normal(word), salt: "record verdict", name: &name };
    let rect = place(list.width(ui));
    list.show(ui, rect, |ui| {
        ui.selectable_value(&mut state.query.kind, None, "All verdicts");
        for kind in KINDS {
            ui.selectable_value(&mut state.query.kind, Some(kind), words::listed_kind(kind));
        }
    });
}

/// Shows the button that opens the dialog for exporting several days. Returns the room at its left.
fn export_days(ui: &Ui, room: Rect, model: &Model, state: &mut RecordState) -> Rect {
    let is_of_reports = state.query.kind != Some(ListedKind::NotTracked);
    let has_none = (!is_of_reports).then_some("A pass that was not tracked has no report.");
    let button = Button::normal("Export days").locked_by(lock(model).or(has_none));
    let size = vec2(button.width(ui), BUTTON);
    let min = pos2(room.right() - size.x, room.center().y - BUTTON / 2.0);
    let response = button.show(ui, "export days", Rect::from_min_size(min, size));
    if response.clicked() {
        state.days = Some(DaysDialog::new(model));
    }
    if !button.is_locked() {
        response.on_hover_text("The passes of several days in one file");
    }
    room.with_max_x(min.x - GAP)
}

/// Shows the button that replays the last hour. Returns the room at its left.
fn last_hour(ui: &Ui, room: Rect, model: &Model, commands: &mut Vec<UiCommand>) -> Rect {
    let button = Button::normal("Replay the last hour").locked_by(lock(model));
    let size = vec2(button.width(ui), BUTTON);
    let min = pos2(room.right() - size.x, room.center().y - BUTTON / 2.0);
    let response = button.show(ui, "replay the last hour", Rect::from_min_size(min, size));
    if response.clicked() {
        let start = add_seconds(model.now, -3600.0);
        let name = "the last hour".to_owned();
        let stretch = Stretch { name, pass: None, start, end: model.now };
        let time = add_seconds(model.now, -LAST_S);
        commands.push(UiCommand::BeginReplay(stretch, time));
    }
    if !button.is_locked() {
        response.on_hover_text("The replay begins a minute before the end.");
    }
    room.with_max_x(min.x - 2.0 * GAP)
}

/// Shows the state of the recording at the right.
fn recording(ui: &Ui, room: Rect, model: &Model) {
    let t = theme::tokens(ui);
    let failing = model.record.as_ref().and_then(|record| record.failing.as_ref());
    let (icon, colour, words) = if let Some(failing) = failing {
        let start_text = format::moment(failing.last_write, model.now);
        (Icon::Warning, t.bad, format!("Nothing recorded since {start_text}: {}", failing.reason))
    } else if model.record.is_some() {
        let count = model.antennas.len();
        let antennas = if count == 1 { "antenna" } else { "antennas" };
        (Icon::Disc, t.ok, format!("Recording {count} {antennas}"))
    } else {
        (Icon::OpenRing, t.t3, "Not recording".to_owned())
    };
    if room.width() < 24.0 {
        return;
    }
    let width = paint::text_width(ui, &words, text::small()) + 20.0;
    // A narrow bar shows only the mark, except after a failure.
    let has_words = width <= room.width() || failing.is_some();
    let width = if has_words { width } else { 12.0 };
    let place = room.with_min_x((room.right() - width).max(room.left()));
    let position = pos2(place.left() + 6.0, place.center().y);
    icons::paint(ui.painter(), paint::square(position, 12.0), icon, colour);
    let rest = place.with_min_x(place.left() + 18.0);
    if has_words {
        paint::text_in(ui, rest, Align2::LEFT_CENTER, &words, text::small(), t.t2);
    }
    let response = paint::name_text(ui, "recording", place, &words);
    response.widget_info(|| WidgetInfo::labeled(Role::Status, true, &words));
    if !has_words || !paint::fits(ui, &words, text::small(), rest) {
        response.on_hover_text(&words);
    }
}
