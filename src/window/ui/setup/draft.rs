//! The station as entered so far. It builds on the draft of Preferences; the steps show a part of
//! it.

use super::{Step, antennas};
use crate::{
    astro::Site,
    contract::{driver::LinkFinding, link_tests::LinkTestStage},
    device::Place,
    model::{Model, UiCommand},
    station::{AntennaId, Favourites, Station},
    ui::preferences::{
        draft::Draft,
        fields::Standing,
        station_fields::{LATITUDE, LONGITUDE},
    },
};

/// Number of fields of the site, which come first in the form.
pub(super) const SITE_FIELDS: usize = 5;
/// Number of fields that have no default: name, latitude, longitude and altitude.
const UNKNOWN_FIELDS: usize = 4;

pub(super) struct SetupDraft {
    pub(super) form: Draft,
    /// The entered locator.
    pub(super) locator: String,
    pub(super) favourites: Favourites,
    proposed: Favourites,
    /// The antenna whose address the operator has to enter.
    pub(super) wants_address: Option<AntennaId>,
    /// The antenna whose address field has the keyboard focus.
    pub(super) typed_address: Option<AntennaId>,
}

impl SetupDraft {
    /// Creates an empty form; `station` provides the proposed values.
    pub(super) fn new(station: Station) -> Self {
        let mut form = Draft::new(&station);
        for field in form.ground.fields.iter_mut().take(UNKNOWN_FIELDS) {
            field.empty();
        }
        let favourites = station.favourites;
        Self {
            form,
            locator: String::new(),
            proposed: favourites.clone(),
            favourites,
            wants_address: None,
            typed_address: None,
        }
    }

    pub(super) fn is_edited(&self) -> bool {
        let fields = &self.form.ground.fields;
        let is_edited = fields.iter().take(UNKNOWN_FIELDS).any(|field| field.entry.is_edited());
        is_edited || !self.form.antennas.is_empty() || self.favourites != self.proposed
    }

    /// Fills in the site of the demonstration.
    pub(super) fn skip_site(&mut self) {
        self.form.ground.reset(SITE_FIELDS);
        self.locator.clear();
    }

    pub(super) fn put_place(&mut self, latitude_deg: f64, longitude_deg: f64, decimals: usize) {
        for (label, degrees) in [(LATITUDE, latitude_deg), (LONGITUDE, longitude_deg)] {
            self.form.ground.type_in(label, format!("{degrees:.decimals$}"));
        }
    }

    /// Returns the state of each field of the site. An empty field is not invalid yet.
    pub(super) fn site_standings(&self) -> Vec<Standing> {
        let mut standings = self.form.ground_standings();
        standings.truncate(SITE_FIELDS);
        for (standing, field) in standings.iter_mut().zip(&self.form.ground.fields) {
            if field.entry.text.trim().is_empty() {
                standing.problem = None;
            }
        }
        standings
    }

    /// Returns name and site if all their fields are valid.
    pub(super) fn site(&self) -> Option<(String, Site)> {
        let (ground, standings) = self.form.ground.read();
        if standings.iter().take(SITE_FIELDS).any(|standing| standing.problem.is_some()) {
            return None;
        }
        let station = ground.station()?;
        Some((station.name, station.site))
    }

    /// Returns the location, even while other fields are invalid.
    pub(super) fn place(&self) -> Option<Site> {
        self.form.place()
    }

    /// Returns the entered name, or the name of the make if the field is empty.
    pub(super) fn antenna_name(&self, index: usize) -> String {
        let Some(antenna) = self.form.antennas.get(index) else { return String::new() };
        let typed = antenna.read().0;
        if typed.name.is_empty() {
            typed.connection.spec().short_name.to_owned()
        } else {
            typed.name
        }
    }

    /// Tests the link to the address that has the focus, unless it was tested. Returns `true` while
    /// the step waits for that test or for a valid address.
    pub(super) fn test_typed(&self, model: &Model, commands: &mut Vec<UiCommand>) -> bool {
        let mut antennas = self.form.antennas.iter();
        let typed = antennas
            .position(|typed_antenna| Some(typed_antenna.before().id) == self.typed_address);
        let Some(index) = typed else { return false };
        let antenna = self.form.antenna(index);
        // A test may take the panel from a person at the unit, so only the button starts it.
        if antenna
            .as_ref()
            .is_some_and(|other| other.connection.variant().capabilities.waits_for_word)
        {
            return false;
        }
        match self.form.test(index, model).map(|test| &test.stage) {
            Some(
                LinkTestStage::InUse | LinkTestStage::Elsewhere(_) | LinkTestStage::Done { .. },
            ) => false,
            Some(LinkTestStage::Working) => true,
            None => {
                commands.extend(antenna.as_ref().map(antennas::test_of));
                true
            }
        }
    }

    /// Returns `true` while the link of an antenna has not been tested.
    pub(super) fn has_untested(&self, model: &Model) -> bool {
        let is_tested = |index: usize| {
            let test = self.form.test(index, model);
            test.is_some_and(|test| test.stage != LinkTestStage::Working)
        };
        !(0..self.form.antennas.len()).all(is_tested)
    }

    /// Returns the antennas whose units reported a position, with the position.
    pub(super) fn places(&self, model: &Model) -> Vec<(String, Place)> {
        let pair = |index: usize| {
            let LinkTestStage::Done { finding: LinkFinding::Reached { state, .. }, .. } =
                &self.form.test(index, model)?.stage
            else {
                return None;
            };
            Some((self.antenna_name(index), state.on_board.place?))
        };
        (0..self.form.antennas.len()).filter_map(pair).collect()
    }

    /// Returns the distance between the entered site and the position of the first unit that
    /// reported one, km.
    pub(super) fn off_the_told_km(&self, model: &Model) -> Option<(String, f64)> {
        let (name, place) = self.places(model).into_iter().next()?;
        let site = self.place()?;
        Some((name, place.km_from(site)))
    }

    /// Returns the station if all of it is valid.
    pub(super) fn station(&self) -> Option<Station> {
        let station = self.form.read()?;
        Some(Station { favourites: self.favourites.clone(), ..station })
    }

    /// Returns the reason why the operator cannot continue from `step`.
    pub(super) fn hindrance(&self, step: Step, model: &Model) -> Option<String> {
        match step {
            Step::Site => self.site_hindrance(),
            Step::Antennas => self.antenna_hindrance(model),
            Step::Satellites | Step::Elements => None,
            Step::End => self.site_hindrance().or_else(|| self.antenna_hindrance(model)),
        }
    }

    fn site_hindrance(&self) -> Option<String> {
        let fields = self.form.ground.fields.iter().take(SITE_FIELDS);
        let missing = fields.filter(|field| field.entry.text.trim().is_empty());
        let missing: Vec<&str> = missing.map(|field| &*field.description.label).collect();
        if !missing.is_empty() {
            return Some(super::words::missing(&missing));
        }
        self.site().is_none().then(|| "Site: a field cannot be used.".to_owned())
    }

    fn antenna_hindrance(&self, model: &Model) -> Option<String> {
        (0..self.form.antennas.len()).find_map(|index| {
            let name = self.antenna_name(index);
            let Some(antenna) = self.form.antenna(index) else {
                return Some(format!("{name}: a field cannot be used."));
            };
            let of_demo = |model_antenna: &&crate::contract::antenna::AntennaModel| {
                model_antenna.config.connection.spec() == antenna.connection.spec()
                    && model_antenna.config.connection.address == antenna.connection.address
            };
            let is_of_demo =
                model.demo && model.antennas.iter().any(|model_antenna| of_demo(&model_antenna));
            is_of_demo.then(|| {
                format!("{name}: this address belongs to the demo station and ends with it.")
            })
        })
    }
}
