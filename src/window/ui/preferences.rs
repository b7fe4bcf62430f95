//! Settings of the station: site, satellites and antennas, in forms with a page each.

mod antenna;
pub(super) mod antenna_fields;
mod appearance;
mod checks;
mod columns;
pub(super) mod connection_fields;
pub(super) mod draft;
pub(super) mod fields;
mod file_block;
mod findings;
pub(super) mod form;
mod head;
mod horizon;
mod list;
mod notices;
mod page;
mod picker;
mod preview;
mod rules;
mod satellites;
mod save_bar;
mod search;
mod section;
mod site;
pub(super) mod station_fields;

use egui::{Rect, Ui};
use jiff::Timestamp;

use super::{theme, widgets::hold_button::HoldState, words};
use crate::{
    astro::MaskForm,
    model::{MaskNews, Model, UiCommand},
    station::{AntennaId, Station},
};
use columns::Part;
use draft::Draft;
use form::FocusTarget;
use horizon::HorizonState;
use page::Page;
use rules::RulesState;
use satellites::SatellitesState;
use search::Search;

const PADDING: f32 = 16.0;
/// Height of the bar above a page: default, and in a small window, points.
const HEAD: [f32; 2] = [56.0, 44.0];
/// Size below which a view counts as small, points.
const SMALL_BELOW: [f32; 2] = [1120.0, 640.0];

/// Edited settings, and the result of the last save.
#[derive(Default)]
pub struct PreferencesState {
    draft: Option<(Station, Draft)>,
    outcome: Option<Result<Timestamp, String>>,
    page: Page,
    search: Search,
    form: FormState,
    horizon: HorizonState,
    confirming: HoldState,
}

/// State of the forms of all pages.
#[derive(Default)]
struct FormState {
    focus_target: FocusTarget,
    /// `true` if the fold of the preview is open.
    preview_is_open: bool,
    satellites: SatellitesState,
    rules: RulesState,
    /// A peak of the Sun or the Moon that the operator enters.
    peak: antenna::peaks::TypedPeak,
}

/// The parts of the view.
struct Places {
    list: Rect,
    page: Rect,
    /// Height of the bar above the page, points.
    head: f32,
    save_bar: Rect,
}

impl Places {
    fn new(rect: Rect) -> Self {
        let [min_width, min_height] = SMALL_BELOW;
        let is_narrow = rect.width() < min_width;
        let is_small = is_narrow || rect.height() < min_height;
        let list = if is_narrow { list::SMALL_WIDTH } else { list::WIDTH };
        let (list, rest) = rect.split_left_right_at_x(rect.left() + list);
        let top = rest.bottom() - save_bar::height(is_small);
        let (page, save_bar) = rest.split_top_bottom_at_y(top);
        let [default, small] = HEAD;
        Self { list, page, head: if is_small { small } else { default }, save_bar }
    }
}

impl PreferencesState {
    /// Returns `true` if an edit is not saved.
    pub fn is_edited(&self) -> bool {
        self.draft.as_ref().is_some_and(|(station, draft)| *draft != Draft::new(station))
    }

    /// Discards the draft, because the station has changed elsewhere. Callers ask the operator
    /// first if there are edits.
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
            MaskNews::Failed(reason) => Err(format!("{}.", words::capitalised(&reason))),
        });
    }

    /// Takes the time of a save, or its error.
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

    /// Shows the page of this antenna.
    pub fn show_antenna(&mut self, antenna: AntennaId) {
        self.page = Page::Antenna(antenna);
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
        let draft = Draft::new(&station);
        (station, draft)
    });
    let before = Draft::new(&station);
    if !Page::all(&draft).contains(&state.page) {
        state.page = Page::default();
    }
    let places = Places::new(rect);
    list::show(ui, &places, model, (&mut draft, &before), state, commands);
    show_page(ui, &places, model, &station, (&mut draft, &before), state, commands);
    let drafts = (&draft, &before);
    let is_reverted = save_bar::show(ui, places.save_bar, model, &station, drafts, state, commands);
    if is_reverted {
        state.outcome = None;
        state.horizon.forget();
    } else {
        state.draft = Some((station, draft));
    }
}

fn show_page(
    ui: &mut Ui,
    places: &Places,
    model: &Model,
    station: &Station,
    (draft, before): (&mut Draft, &Draft),
    state: &mut PreferencesState,
    commands: &mut Vec<UiCommand>,
) {
    if state.page == Page::Horizon {
        let antennas = draft.antenna_names();
        let (skies, horizon) = (&mut draft.skies, &mut state.horizon);
        horizon::show(ui, places.page, model, (station, &antennas), skies, horizon, commands);
        return;
    }
    let (bar, rect) = places.page.split_top_bottom_at_y(places.page.top() + places.head);
    head::show(ui, bar, model, draft, state, commands);
    let (page, form) = (state.page, &mut state.form);
    match page {
        Page::Site => site::show(ui, rect, model, (draft, before), form, commands),
        Page::Satellites => satellites::show(ui, rect, model, (draft, before), form),
        Page::Rules => rules::show(ui, rect, model, (draft, before), form),
        Page::Antenna(id) => {
            antenna::show(ui, rect, model, id, (draft, before), form, commands);
        }
        Page::Notices => cards(ui, rect, "notices", &notices::CARDS, |ui, card| {
            notices::card_of(ui, card, model, draft, &mut form.focus_target, commands);
        }),
        Page::Appearance => cards(ui, rect, "appearance", &appearance::CARDS, |ui, card| {
            appearance::card_of(ui, card, model, commands);
        }),
        Page::Horizon => {}
    }
}

/// Shows a page that consists only of cards.
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
