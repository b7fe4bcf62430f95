//! The Elements view: the sources of elements with their ages, the catalog as a table, and the
//! selected object in detail.

mod add;
mod bar;
mod bulk;
mod chips;
mod columns;
mod facts;
mod frequencies;
mod holds;
mod inspector;
mod intake;
mod refused;
mod set_menu;
mod sets;
mod source_order;
mod source_password;
mod sources;
mod table;
pub(super) mod words;

use egui::{Rect, Ui};

pub use self::bar::refresh_due;
use self::words::Form;
pub(super) use self::{
    add::{AddState, show as add_source},
    words::{objects, sentences as source_words},
};
use super::{
    confirm::Question,
    replay, theme,
    upload::Choice,
    widgets::{button::Button, list::Scroll, selection::BoxSelection},
};
use crate::{
    contract::CatalogState,
    model::{Model, UiCommand, catalog_table},
};

const PADDING: f32 = 16.0;
/// View width below which the inspector is a drawer, points.
const DRAWER_BELOW: f32 = 1028.0;
/// View height below which the bar is low, points.
const LOW_BELOW: f32 = 700.0;

/// Input, selection and open parts.
#[derive(Default)]
pub struct ElementsState {
    add: add::AddState,
    question: catalog_table::Question,
    selection: BoxSelection<u32>,
    wants_search: bool,
    scroll: Scroll,
    /// Flag: the list of sources is unfolded; `None` until the operator folds or unfolds it.
    sources_are_open: Option<bool>,
    refused_are_open: bool,
    source_password: source_password::SourcePassword,
    inspector_is_open: bool,
    upload_is_open: bool,
    frequencies: Option<frequencies::Edit>,
    /// Files that the operator held over the window in the last frame.
    hovered: Vec<std::path::PathBuf>,
    /// Indexes of the offers that the operator accepted.
    shown: Vec<usize>,
    /// Choice for the upload, until the upload takes it.
    uploads: Option<Choice>,
}

/// Place of the upload to the selected unit, in place of the inspector.
pub struct UploadPlace {
    pub rect: Rect,
    /// Satellites to choose for the upload, in the frame that opens the upload.
    pub choice: Option<Choice>,
}

impl ElementsState {
    /// Gives the search field the keyboard focus.
    pub fn focus_search(&mut self) {
        self.wants_search = true;
    }

    /// Opens the upload with this choice.
    fn upload(&mut self, choice: Choice) {
        self.upload_is_open = true;
        self.inspector_is_open = true;
        self.uploads = Some(choice);
    }
}

/// Draws the view. With `settings_are_edited`, the station's settings have unsaved edits and must
/// not change. Returns the place for the upload to the selected unit while the upload replaces the
/// inspector.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    settings_are_edited: bool,
    state: &mut ElementsState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) -> Option<UploadPlace> {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    if state.selection.row().is_none()
        && let Some(number) = first_object(model)
    {
        state.selection.select(number);
    }
    let lock = replay::lock(model).or(settings_are_edited.then_some(words::EDITED));
    let has_drawer = rect.width() < DRAWER_BELOW;
    let side = if has_drawer && !state.inspector_is_open { 0.0 } else { inspector::WIDTH };
    let (left, right) = rect.split_left_right_at_x(rect.right() - side);
    let main = if has_drawer { rect } else { left };
    let is_low = rect.height() < LOW_BELOW;
    let bar = if is_low { bar::LOW_HEIGHT } else { bar::HEIGHT };
    let (head, rest) = main.split_top_bottom_at_y(main.top() + bar);
    intake::take(ui, model, state, commands);
    bar::show(ui, head, model, has_drawer, state, commands);
    // A drawer above the table takes the pointer.
    let rest = if has_drawer { rest.with_max_x(right.left()) } else { rest };

    if let Some(intake) = &model.intake {
        intake::show(ui, rest, model, intake, state, commands);
    } else {
        state.shown.clear();
        show_main(ui, rest, rect.height(), model, lock, state, question, commands);
    }
    state.source_password.show(ui, model, commands);
    if state.question != model.catalog_table.question {
        commands.push(UiCommand::ShowCatalog(state.question.clone()));
    }
    if state.selection.row() != model.catalog_table.inspected {
        commands.extend(state.selection.row().map(UiCommand::InspectObject));
    }
    if side == 0.0 {
        return None;
    }
    let side = if has_drawer { right.with_min_y(head.bottom()) } else { right };
    if state.upload_is_open {
        return Some(show_upload(ui, side, state));
    }
    inspector::show(ui, side, model, lock, state, question, commands);
    None
}

/// Returns the satellite of the selected pass, else the first favourite with elements. The operator
/// can also upload a favourite without a pass, such as a geostationary one.
fn first_object(model: &Model) -> Option<u32> {
    let CatalogState::Ready(catalog) = &model.catalog else { return None };
    let of_pass = model.selected.map(|(number, _)| number);
    let is_held = |number: &u32| catalog.get(*number).is_some();
    of_pass.into_iter().chain(model.station.favourites.numbers()).find(is_held)
}

/// Draws the sources, groups and table with their controls, in a view of height `height`.
#[allow(clippy::too_many_arguments)]
fn show_main(
    ui: &mut Ui,
    rest: Rect,
    height: f32,
    model: &Model,
    lock: Option<&'static str>,
    state: &mut ElementsState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let sources = sources::height(model, state, height);
    let (top, rest) = rest.split_top_bottom_at_y(rest.top() + sources);
    sources::show(ui, top, height, model, state, question, commands);
    let (top, rest) = rest.split_top_bottom_at_y(rest.top() + chips::HEIGHT);
    chips::show(ui, top, model, state, commands);
    let (rest, bottom) = rest.split_top_bottom_at_y(rest.bottom() - refused::height(model, state));
    refused::show(ui, bottom, model, state);
    let is_marked = !state.selection.marked().is_empty();
    let bulk = if is_marked { bulk::HEIGHT } else { 0.0 };
    let (body, bottom) = rest.split_top_bottom_at_y(rest.bottom() - bulk);
    table::show(ui, body, model, lock, state, commands);
    if is_marked {
        bulk::show(ui, bottom, model, lock, state, commands);
    }
}

fn show_upload(ui: &Ui, rect: Rect, state: &mut ElementsState) -> UploadPlace {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
    let inner = rect.shrink(PADDING);
    let back = Button::normal("Back to the elements");
    let size = egui::vec2(back.width(ui), super::widgets::button::SMALL_HEIGHT);
    let place = Rect::from_min_size(inner.min, size);
    if back.show(ui, "back from upload", place).clicked() {
        state.upload_is_open = false;
    }
    let rect = inner.with_min_y(place.bottom() + 8.0);
    UploadPlace { rect, choice: state.uploads.take() }
}

/// Copies the elements of these objects to the clipboard.
fn copy(ui: &Ui, model: &Model, numbers: &[u32], form: Form) {
    let CatalogState::Ready(catalog) = &model.catalog else { return };
    let elements = numbers.iter().filter_map(|number| catalog.get(*number));
    ui.copy_text(words::copied(elements, form));
}
