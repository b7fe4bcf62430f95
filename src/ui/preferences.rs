//! Settings of the station: site, satellites and antennas, in forms with a page each.

mod antenna;
mod antenna_fields;
mod appearance;
mod checks;
mod columns;
pub(super) mod connection_fields;
pub(super) mod draft;
pub(super) mod fields;
mod findings;
pub(super) mod form;
mod head;
mod horizon;
mod keys;
mod list;
mod notices;
mod page;
mod preview;
mod save_bar;
mod search;
mod site;
pub(super) mod station_fields;

use egui::{Rect, Ui};
use jiff::Timestamp;

use super::{theme, widgets::hold_button::HoldState, words};
use crate::{
    astro::MaskForm,
    model::{MaskNews, Model, UiCommand},
    station::Station,
};
use columns::Part;
use draft::Draft;
use form::Sought;
use horizon::HorizonState;
use page::Page;
use search::Search;

const PADDING: f32 = 16.0;
/// Height of the bar above a page, and in a small window.
const HEAD: [f32; 2] = [56.0, 44.0];
/// Size of the view below which it is small.
const SMALL_BELOW: [f32; 2] = [1120.0, 640.0];

/// Edited settings, and the result of the last saving.
#[derive(Default)]
pub struct PreferencesState {
    draft: Option<(Station, Draft)>,
    outcome: Option<Result<Timestamp, String>>,
    page: Page,
    search: Search,
    sought: Sought,
    /// The preview is unfolded, where it is a fold.
    preview_is_open: bool,
    horizon: HorizonState,
    confirming: HoldState,
}

impl PreferencesState {
    /// Whether something typed is not saved.
    pub fn is_edited(&self) -> bool {
        self.draft.as_ref().is_some_and(|(station, draft)| *draft != Draft::of(station))
    }

    /// Drops the draft, because the station has changed elsewhere. Callers ask the operator
    /// first if something is typed.
    pub fn forget(&mut self) {
        self.draft = None;
        self.horizon.forget();
    }

    /// Takes the result of reading or writing a horizon mask.
    pub fn mask_news(&mut self, news: MaskNews) {
        self.horizon.exchanged(match news {
            MaskNews::Read(mask, form) => {
                let points = mask.points_deg().len();
                if let Some((_, draft)) = &mut self.draft {
                    draft.skies.mask = mask.to_string();
                }
                let form = match form {
                    MaskForm::Points => "plain numbers",
                    MaskForm::Table => "a table",
                    MaskForm::Keys => "keys and values",
                };
                Ok(format!("{points} points read from {form}. Save to use them."))
            }
            MaskNews::Written(path) => Ok(format!("Written to {}.", path.display())),
            MaskNews::Failed(why) => Err(format!("{}.", words::capitalised(&why))),
        });
    }

    /// Takes the time of saving the settings, or the failure.
    pub fn saved(&mut self, result: Result<Timestamp, String>) {
        if result.is_ok() {
            self.draft = None;
            self.horizon.forget();
        }
        self.outcome = Some(result);
    }

    /// Puts the focus into the search for a setting.
    pub fn focus_search(&mut self) {
        self.search.wants_focus = true;
    }

    /// Shows the next page.
    pub fn next_page(&mut self) {
        if let Some((_, draft)) = &self.draft {
            self.page = self.page.next(draft);
        }
    }
}

/// Draws the view.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    state: &mut PreferencesState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let (station, mut draft) = state.draft.take().unwrap_or_else(|| {
        let station = model.station_to_edit();
        let draft = Draft::of(&station);
        (station, draft)
    });
    let before = Draft::of(&station);
    if !Page::all(&draft).contains(&state.page) {
        state.page = Page::default();
    }
    let is_small = rect.width() < SMALL_BELOW[0] || rect.height() < SMALL_BELOW[1];
    let [usual, small] = HEAD;
    let head = if is_small { small } else { usual };
    let list = if rect.width() < SMALL_BELOW[0] { list::SMALL_WIDTH } else { list::WIDTH };
    let (list, rest) = rect.split_left_right_at_x(rect.left() + list);
    let (page, bar) = rest.split_top_bottom_at_y(rest.bottom() - save_bar::height(is_small));
    list::show(ui, list, head, model, (&mut draft, &before), state);
    show_page(ui, page, head, model, &station, (&mut draft, &before), state, commands);
    let is_reverted = save_bar::show(ui, bar, model, &station, (&draft, &before), state, commands);
    if is_reverted {
        state.outcome = None;
        state.horizon.forget();
    } else {
        state.draft = Some((station, draft));
    }
}

fn show_page(
    ui: &mut Ui,
    rect: Rect,
    head: f32,
    model: &Model,
    station: &Station,
    (draft, before): (&mut Draft, &Draft),
    state: &mut PreferencesState,
    commands: &mut Vec<UiCommand>,
) {
    if state.page == Page::Horizon {
        let antennas = draft.antenna_names();
        let (skies, horizon) = (&mut draft.skies, &mut state.horizon);
        horizon::show(ui, rect, model, (station, &antennas), skies, horizon, commands);
        return;
    }
    let (bar, rect) = rect.split_top_bottom_at_y(rect.top() + head);
    head::show(ui, bar, model, draft, state, commands);
    let page = state.page;
    let PreferencesState { sought, preview_is_open, .. } = state;
    match page {
        Page::Site | Page::Satellites => {
            site::show(ui, rect, page, model, draft, sought, preview_is_open);
        }
        Page::Antenna(id) => {
            let drafts = (draft, before);
            antenna::show(ui, rect, model, id, drafts, sought, preview_is_open, commands);
        }
        Page::Notices => cards(ui, rect, "notices", &notices::CARDS, |ui, card| {
            notices::card_of(ui, card, model, draft, sought, commands);
        }),
        Page::Appearance => cards(ui, rect, "appearance", &appearance::CARDS, |ui, card| {
            appearance::card_of(ui, card, model, commands);
        }),
        Page::Keys => cards(ui, rect, "keys", &keys::rows(), keys::card_of),
        Page::Horizon => {}
    }
}

/// Shows a page of cards alone.
fn cards(
    ui: &mut Ui,
    rect: Rect,
    salt: &str,
    rows: &[usize],
    mut card_of: impl FnMut(&mut Ui, usize),
) {
    columns::show(ui, rect, salt, rows, false, |ui, part| {
        if let Part::Card(card) = part {
            card_of(ui, card);
        }
    });
}
