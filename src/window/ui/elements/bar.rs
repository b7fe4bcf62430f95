//! The controls above the sources.

use egui::{
    Align2, Popup, PopupCloseBehavior, Rect, Response, RichText, Role, TextEdit, Ui, WidgetInfo,
    pos2, vec2,
};

use super::{ElementsState, PADDING, add, words};
use crate::{
    contract::{self, CatalogState, sources::SourceWork},
    model::{Model, UiCommand},
    ui::{
        format,
        icons::Icon,
        replay, text, theme,
        widgets::{
            button::{self, Button, HEIGHT as BUTTON},
            close_key, paint,
        },
        words::sentence,
    },
};

pub(super) const HEIGHT: f32 = 56.0;
pub(super) const LOW_HEIGHT: f32 = 44.0;
const GAP: f32 = 8.0;
const SEARCH: f32 = 280.0;
const MIN_SEARCH: f32 = 160.0;
/// Room for the title without and with the sentence below it, points.
const TITLE: [f32; 2] = [92.0, 300.0];
/// Width of the form for a new source, points.
const FORM: f32 = 560.0;

/// Draws the controls. With `has_drawer`, a button opens the inspector.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    has_drawer: bool,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let due = due(model);
    let word = match due.len() {
        0 => "Read again".to_owned(),
        count => format!("Refresh {count} due"),
    };
    let lock = words::sources_lock(model);
    let has_sources = !model.sources.list.is_empty();
    let refresh = if due.is_empty() { Button::normal(&word) } else { Button::primary(&word) };
    let refresh = refresh.icon(Icon::Refresh).locked(!has_sources).locked_by(lock);
    let add = Button::normal("Add a source").icon(Icon::Plus).locked_by(replay::lock(model));
    let word = if state.inspector_is_open { "Close details" } else { "Details" };
    let details = has_drawer.then(|| Button::normal(word));
    let mut right = inner.right_center();
    let of_details = details.map(|button| {
        let [place] = button::row(right, [button.width(ui)]);
        right.x = place.left() - GAP;
        place
    });
    let [of_add, of_refresh] = button::row(right, [add.width(ui), refresh.width(ui)]);
    let left = of_add.left();
    let has_sentence = rect.height() >= HEIGHT;
    let title_room = TITLE.map(|width| inner.left() + width);
    let min = if has_sentence { title_room[1] } else { title_room[0] };
    let start = (left - GAP - SEARCH).max(min).min(left - GAP - MIN_SEARCH);
    title(ui, inner.with_max_x(start - GAP), model, has_sentence);
    let place = Rect::from_min_max(
        pos2(start, rect.center().y - BUTTON / 2.0),
        pos2(left - GAP, rect.center().y + BUTTON / 2.0),
    );
    search(ui, place, state);
    add_source(&add.show(ui, "add a source", of_add), model, state, commands);
    let is_free = !refresh.is_locked();
    let refresh = refresh.show(ui, "refresh", of_refresh);
    let refresh = match next_due(model) {
        Some(next) if due.is_empty() && is_free => refresh.on_hover_text(format!(
            "Reads all files and folders. No server is due before {}.",
            format::moment(next, model.now)
        )),
        _ => refresh,
    };
    if refresh.clicked() {
        commands.push(refresh_due(model));
    }
    if let Some((details, place)) = details.zip(of_details)
        && details.show(ui, "element details", place).clicked()
    {
        state.inspector_is_open = !state.inspector_is_open;
    }
}

fn title(ui: &Ui, rect: Rect, model: &Model, has_sentence: bool) {
    let t = theme::tokens(ui);
    if !has_sentence {
        paint::text_in(ui, rect, Align2::LEFT_CENTER, "Elements", text::title(), t.t1);
    }
    let line = |y: f32| {
        Rect::from_x_y_ranges(rect.x_range(), rect.top() + y - 12.0..=rect.top() + y + 12.0)
    };
    let problems: Vec<String> =
        model.sources.problems.iter().map(|problem| sentence(problem)).collect();
    let (words, colour) =
        if problems.is_empty() { (summary(model), t.t2) } else { (problems.join(" "), t.bad) };
    if has_sentence {
        paint::text_in(ui, line(19.0), Align2::LEFT_CENTER, "Elements", text::title(), t.t1);
        paint::text_in(ui, line(40.0), Align2::LEFT_CENTER, &words, text::small(), colour);
    }
    let place = if has_sentence { line(40.0) } else { rect };
    let named = paint::name_text(ui, "elements summary", place, &words);
    if !has_sentence || !paint::fits(ui, &words, text::small(), place) {
        named.on_hover_text(&words);
    }
}

/// Describes all elements in a sentence, or the work in progress on them.
fn summary(model: &Model) -> String {
    let sources = &model.sources;
    match sources.work {
        SourceWork::Asking => {
            return "The servers are being asked. Meanwhile the present elements stay in use."
                .to_owned();
        }
        SourceWork::Reading => return "The sources are being read.".to_owned(),
        SourceWork::Nothing => {}
    }
    match &model.catalog {
        CatalogState::Loading => "The elements are being read.".to_owned(),
        CatalogState::Failed => "There are no elements.".to_owned(),
        CatalogState::Ready(catalog) => {
            let start_text = format::counted(catalog.groups().count(), "source");
            let all = words::objects(catalog.len());
            let mut favourites = model.station.favourites.iter();
            let rule = if favourites.any(|favourite| !favourite.sources.is_empty()) {
                "The newest or a preferred set is used."
            } else {
                "The newest set of each object is used."
            };
            format!("{all} from {start_text}. {rule}")
        }
    }
}

fn search(ui: &mut Ui, place: Rect, state: &mut ElementsState) {
    let t = theme::tokens(ui);
    let hint = RichText::new("Name, number, designator").color(t.t3);
    let typed = &mut state.question.search;
    let edit = TextEdit::singleline(typed)
        .id_salt("search the catalogue")
        .hint_text(hint)
        .align(Align2::LEFT_CENTER)
        .min_size(place.size())
        .desired_width(place.width());
    let edit = ui.place(place, edit);
    edit.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Search the catalogue"));
    if std::mem::take(&mut state.wants_search) {
        edit.request_focus();
    }
}

/// Shows the form for a new source below the button that opens it.
fn add_source(
    button: &Response,
    model: &Model,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    Popup::from_toggle_button_response(button)
        .accessible_name("Add a source")
        .width(FORM)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.set_width(FORM);
            if state.add.forget_the_added(&model.sources) {
                ui.close();
            }
            add::show(ui, &model.sources, &mut state.add, commands);
            close_key::show(ui);
        });
}

/// Returns the names of the servers that Azel may ask now.
fn due(model: &Model) -> Vec<String> {
    let sources = model.sources.list.iter().enumerate();
    sources
        .filter(|(index, source)| {
            words::is_due(source, model.sources.reports.get(*index), model.now)
        })
        .map(|(_, source)| source.name.clone())
        .collect()
}

fn next_due(model: &Model) -> Option<jiff::Timestamp> {
    model.sources.reports.iter().filter_map(|report| report.pause_end(model.now)).min()
}

/// Returns the command that asks all servers that Azel may ask now, and reads all other sources.
pub fn refresh_due(model: &Model) -> UiCommand {
    let command = contract::Command::RefreshSources { names: due(model), forced: false };
    UiCommand::Station(command)
}
