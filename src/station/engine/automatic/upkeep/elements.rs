//! Uploads newer elements to a unit between passes.

use std::{collections::BTreeMap, mem};

use jiff::Timestamp;

use super::{AGAIN_S, DayEvent};
use crate::{
    astro::time::{DAY_S, add_seconds, seconds_between},
    device::ElementFiles,
    engine::{
        CatalogState, Engine,
        alarms::AlarmKind,
        antenna::AntennaModel,
        uploads::{Ask, Cargo, Order, Stage},
    },
    orbit::{Catalog, Elements},
    station::{AntennaId, UploadWay},
    transfer::{FileName, FileObject, Peer, TleFile},
};

/// Time that must be left before the antenna sets out, for an upload, seconds.
const UPLOAD_TAKES_S: f64 = 300.0;
/// Time between two looks at the age of the elements, seconds.
const LOOK_S: f64 = 60.0;

impl Engine {
    /// Uploads newer elements if those on the unit are too old. Ends an upload once there is no time
    /// for it, or once automatic operation ends.
    pub(super) fn keep_elements(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let shown = &antenna.shown;
        let id = shown.id();
        if !shown.config.upkeep.uploads_elements {
            self.forget_failure(id);
            return;
        }
        let is_ours = self.upload_runner.order().is_some_and(|order| order.is_unattended)
            && self.uploads.antenna == shown.config.name;
        if is_ours && self.uploads.stage.can_cancel() && !self.is_between_passes(shown, 0.0) {
            return self.ask_about_upload(Ask::Cancel);
        }
        let is_due = antenna.at_work.upkeep.next_look.is_none_or(|at| self.now >= at)
            && self.demo.is_none()
            && !self.uploads.stage.is_open()
            && self.is_between_passes(shown, UPLOAD_TAKES_S);
        if !is_due {
            return;
        }
        let order = self.order_for(shown);
        let wait_s = if order.is_some() { AGAIN_S } else { LOOK_S };
        if order.is_some() && !self.is_at_rest(index) {
            return;
        }
        let now = self.now;
        if let Some(antenna) = self.antennas.get_mut(index) {
            antenna.at_work.upkeep.next_look = Some(add_seconds(now, wait_s));
        }
        match order {
            None => {}
            Some(Ok(order)) => {
                self.ask_about_upload(Ask::Begin(Box::new(order)));
                self.end_unattended();
            }
            Some(Err(why)) => self.note_failure(id, why),
        }
    }

    /// The upload that an antenna's unit needs now, or why there can be none; `None` if it needs none.
    fn order_for(&self, antenna: &AntennaModel) -> Option<Result<Order, String>> {
        let takes = antenna.spec().element_files?;
        let CatalogState::Ready(catalog) = &self.catalog else { return None };
        let group = antenna.snapshot.state.held.get(takes.source_group);
        let held = group.and_then(|group| group.held.as_ref())?;
        if (takes.are_fetched_by_unit)(&held.values) {
            return None;
        }
        let favourites = self.station.favourites.numbers();
        let chosen = chosen(catalog, &favourites, takes);
        let on_unit = self.last_run.unit_elements(antenna.id());
        let limit_s = antenna.config.upkeep.element_limit_d * DAY_S;
        if !are_old(&chosen, &on_unit, limit_s, self.now) {
            return None;
        }
        let Some(way) = &antenna.config.upkeep.way else {
            return Some(
                Err("nobody has uploaded any by hand yet, so the way is not known".into()),
            );
        };
        Some(order(antenna, way, takes, &chosen))
    }

    pub(in crate::engine) fn note_unit_elements(&mut self, id: AntennaId, objects: &[FileObject]) {
        let satellites = objects.iter().map(|object| (object.catalog_number, object.epoch));
        self.last_run.note_unit_elements(id, satellites.collect());
        self.keep_last_run();
    }

    /// Notes how an upload by the rule has ended.
    pub(in crate::engine) fn end_unattended(&mut self) {
        if !self.upload_runner.order().is_some_and(|order| order.is_unattended) {
            return;
        }
        let name = &self.uploads.antenna;
        let antenna = self.antennas.iter().find(|one| one.shown.config.name == *name);
        let Some(id) = antenna.map(|antenna| antenna.shown.id()) else { return };
        match &self.uploads.stage {
            Stage::Proved(proved) => {
                let file = proved.uploaded.file.as_str().to_owned();
                let satellites = proved.uploaded.objects.len();
                self.note_day(id, DayEvent::ElementsUploaded { file, satellites });
                self.forget_failure(id);
            }
            Stage::Failed(failure) => {
                let why = failure.text.clone();
                self.note_failure(id, why);
            }
            Stage::Idle
            | Stage::AsksAboutTracking(_)
            | Stage::Working { .. }
            | Stage::AsksAboutHostKey(_)
            | Stage::AsksForSecret(_)
            | Stage::Selecting(_) => return,
        }
        mem::take(&mut self.uploads.stage);
    }

    fn note_failure(&mut self, id: AntennaId, why: String) {
        self.alarms.raise(Some(id), AlarmKind::ElementsNotUploaded { why: why.clone() }, self.now);
        self.note_day(id, DayEvent::ElementsNotUploaded { why });
    }

    fn forget_failure(&mut self, id: AntennaId) {
        let is_that = |kind: &AlarmKind| matches!(kind, AlarmKind::ElementsNotUploaded { .. });
        self.alarms.clear(Some(id), self.now, is_that);
    }
}

/// The elements of those favourites that a unit takes in one file.
fn chosen<'a>(
    catalog: &'a Catalog,
    favourites: &[u32],
    takes: &ElementFiles,
) -> Vec<(FileObject, &'a Elements)> {
    let mut chosen: Vec<(FileObject, &Elements)> = Vec::new();
    for elements in favourites.iter().filter_map(|number| catalog.get(*number)) {
        let Ok(alone) = TleFile::of([elements], takes) else { continue };
        let Some(object) = alone.objects().first().cloned() else { continue };
        // The unit looks for a satellite by its name.
        if chosen.iter().all(|(known, _)| known.name != object.name) {
            chosen.push((object, elements));
        }
    }
    chosen
}

/// Returns `true` if newer elements are at hand for one that is missing on the unit or too old there.
fn are_old(
    chosen: &[(FileObject, &Elements)],
    on_unit: &BTreeMap<u32, Timestamp>,
    limit_s: f64,
    now: Timestamp,
) -> bool {
    chosen.iter().any(|(object, _)| {
        on_unit
            .get(&object.catalog_number)
            .is_none_or(|epoch| object.epoch > *epoch && seconds_between(*epoch, now) > limit_s)
    })
}

fn order(
    antenna: &AntennaModel,
    way: &UploadWay,
    takes: &'static ElementFiles,
    chosen: &[(FileObject, &Elements)],
) -> Result<Order, String> {
    let file = TleFile::of(chosen.iter().map(|(_, elements)| *elements), takes);
    Ok(Order {
        antenna: antenna.config.name.clone(),
        takes,
        unit: Peer { host: way.host.clone(), port: way.port },
        folder: way.folder.clone(),
        file: FileName::new(&way.file, takes).map_err(|error| error.to_string())?,
        user: way.user.clone(),
        key_file: way.key_file.clone(),
        cargo: Cargo::New(file.map_err(|error| error.to_string())?),
        satellite: None,
        is_unattended: true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{controller::satrak::ELEMENT_FILES, orbit::bundled};

    const FAVOURITES: [u32; 2] = [25_544, 43_013];

    #[test]
    fn elements_are_old_past_the_limit_while_newer_ones_are_at_hand() {
        let catalog = bundled().unwrap();
        let chosen = chosen(&catalog, &FAVOURITES, &ELEMENT_FILES);
        assert_eq!(chosen.len(), FAVOURITES.len());
        let at_hand = |number: u32| {
            chosen.iter().find(|(object, _)| object.catalog_number == number).unwrap().0.epoch
        };
        let [iss, noaa] = FAVOURITES;
        let later = |days: f64| add_seconds(at_hand(iss).max(at_hand(noaa)), days * DAY_S);
        let are_old = |iss_before_d: f64, days: f64| {
            let iss_epoch = add_seconds(at_hand(iss), -iss_before_d * DAY_S);
            let on_unit = BTreeMap::from([(iss, iss_epoch), (noaa, at_hand(noaa))]);
            are_old(&chosen, &on_unit, 2.0 * DAY_S, later(days))
        };
        assert!(!are_old(1.0, 0.5), "within the limit");
        assert!(are_old(1.0, 1.5), "past the limit");
        assert!(!are_old(0.0, 30.0), "nothing newer is at hand");
        let missing = BTreeMap::from([(iss, at_hand(iss))]);
        assert!(super::are_old(&chosen, &missing, 2.0 * DAY_S, later(0.1)), "one is missing");
    }

    #[test]
    fn a_satellite_that_the_unit_cannot_take_does_not_keep_the_others_from_it() {
        let catalog = bundled().unwrap();
        let twice = [FAVOURITES[0], 1_000_000, FAVOURITES[0], FAVOURITES[1]];
        let chosen = chosen(&catalog, &twice, &ELEMENT_FILES);
        let numbers: Vec<u32> = chosen.iter().map(|(object, _)| object.catalog_number).collect();
        assert_eq!(numbers, FAVOURITES);
        assert!(TleFile::of(chosen.iter().map(|(_, elements)| *elements), &ELEMENT_FILES).is_ok());
    }
}
