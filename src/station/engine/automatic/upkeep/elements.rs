//! Uploads of newer elements to a unit between passes.

use std::{collections::BTreeMap, mem, time::Duration};

use jiff::Timestamp;

use super::{RETRY, is_free};
use crate::{
    astro::time::{DAY_S, seconds_between},
    clock::Instant,
    contract::{
        CatalogState,
        alarms::AlarmKind,
        antenna::AntennaModel,
        automatic::DayEvent,
        transfer::{FileName, FileObject, TleFile},
        uploads::{Ask, Cargo, Order, Stage},
    },
    device::ElementFiles,
    engine::{
        Engine,
        alarms::KeepAlarms,
        automatic::Operate,
        uploads::{UploadTarget, old_algorithms},
    },
    orbit::{Catalog, Elements},
    station::{self, AntennaId},
};

/// Min time before departure for starting an upload, seconds.
const MIN_TIME_FOR_UPLOAD_S: f64 = 300.0;
/// Time before departure at which Azel cancels an upload, seconds.
const ENDS_BEFORE_S: f64 = 60.0;
/// Time between two checks of the elements' age.
const CHECK_PERIOD: Duration = Duration::from_mins(1);
/// Number of checks with a due but blocked upload that raises an alarm.
const MAX_BLOCKED: u32 = 60;
/// Max duration of an upload. A locked keyring may wait for somebody without end.
const UPLOAD_TIMEOUT: Duration = Duration::from_mins(30);

/// Upload that a rule has begun.
pub(in crate::engine) struct RuleUpload {
    pub(in crate::engine) antenna: AntennaId,
    start: Instant,
}

impl Engine {
    /// Uploads newer elements if the ones on the unit are too old.
    pub(super) fn keep_elements(&mut self, index: usize) {
        let steady = self.steady;
        let Some(antenna) = self.antennas.get(index) else { return };
        let shown = &antenna.shown;
        let id = shown.id();
        if !shown.config.upkeep.uploads_elements || !shown.operation.is_on() {
            return self.clear_upload_alarm(id);
        }
        let is_due = self.rule_upload.is_none()
            && self.demo.is_none()
            && antenna.at_work.upkeep.next_check.is_none_or(|instant| steady >= instant)
            && self.is_between_passes(shown, MIN_TIME_FOR_UPLOAD_S);
        if !is_due {
            return;
        }
        // Wait until the unit's settings and the elements are read.
        let Some(needed) = self.needed_upload(shown) else { return };
        self.check_elements_after(id, CHECK_PERIOD);
        match needed {
            Ok(None) => self.clear_upload_alarm(id),
            Err(reason) => self.note_upload_failure(id, reason),
            Ok(Some(order)) => {
                if !self.is_blocked(index) && self.prepare_for_settings(index) {
                    self.rule_upload = Some(RuleUpload { antenna: id, start: steady });
                    self.check_elements_after(id, RETRY);
                    self.ask_about_upload(Ask::Begin(Box::new(order)));
                    self.end_rule_upload();
                }
            }
        }
    }

    /// Returns `true` if an upload by hand is under way, or has failed and is still shown.
    fn is_blocked(&mut self, index: usize) -> bool {
        let Some(antenna) = self.antennas.get_mut(index) else { return true };
        let work = &mut antenna.at_work.upkeep;
        if matches!(self.uploads.stage, Stage::Idle | Stage::Proved(_)) {
            work.blocked = 0;
            return false;
        }
        work.blocked += 1;
        if work.blocked >= MAX_BLOCKED {
            work.blocked = 0;
            let id = antenna.shown.id();
            let reason = format!("an upload to {} is still open", self.uploads.antenna);
            self.note_upload_failure(id, reason);
        }
        true
    }

    /// Returns the upload that an antenna's unit needs now, or the reason why none is possible.
    /// `None` means that this is not known yet.
    fn needed_upload(&self, antenna: &AntennaModel) -> Option<Result<Option<Order>, String>> {
        let takes = antenna.spec().element_files?;
        let CatalogState::Ready(catalog) = &self.catalog else { return None };
        let group = antenna.snapshot.state.groups.get(takes.source_group);
        let reading = group.and_then(|group| group.last_read.as_ref())?;
        if (takes.are_fetched_by_unit)(&reading.values) {
            return Some(Ok(None));
        }
        let address = &antenna.config.connection.address;
        let last = self.last_run.unit_elements(antenna.id(), address);
        let on_unit: BTreeMap<u32, Timestamp> =
            last.map(|last| last.epochs.iter().copied().collect()).unwrap_or_default();
        // The upload replaces the whole file, so keep satellites that an operator added.
        let mut numbers = self.station.favourites.numbers();
        let others: Vec<u32> =
            on_unit.keys().copied().filter(|number| !numbers.contains(number)).collect();
        numbers.extend(others);
        let chosen = chosen(catalog, &numbers, takes);
        let limit_s = antenna.config.upkeep.element_limit_d * DAY_S;
        let is_due = is_upload_due(&chosen, &on_unit, limit_s, self.now);
        Some(is_due.and_then(|is_due| match last {
            _ if !is_due => Ok(None),
            Some(last) => order(antenna, &last.target, takes, &chosen).map(Some),
            None => Err("the host and the folder are not known. Upload once by hand".to_owned()),
        }))
    }

    /// Records a verified upload to the unit of an antenna.
    pub(in crate::engine) fn note_upload(
        &mut self,
        config: &station::Antenna,
        target: UploadTarget,
        objects: &[FileObject],
    ) {
        let unit = (config.id, config.connection.address.as_str());
        self.last_run.note_upload(unit, target, objects, self.uploads.is_roll_back);
        self.keep_last_run();
        self.clear_upload_alarm(config.id);
        // Do not replace an upload by hand at once.
        self.check_elements_after(config.id, RETRY);
    }

    /// Cancels the upload of a rule if its antenna is needed, the rule is off or the station
    /// closes.
    pub(in crate::engine) fn limit_rule_upload(&mut self) {
        let Some(upload) = &self.rule_upload else { return };
        let (id, start) = (upload.antenna, upload.start);
        let entries = &self.schedule.schedule.entries;
        let is_wanted = |shown: &AntennaModel| {
            shown.config.name == self.uploads.antenna
                && shown.config.upkeep.uploads_elements
                && shown.operation.is_idle()
                && shown.snapshot.lock_out.is_none()
                && is_free(entries, id, self.now, ENDS_BEFORE_S)
        };
        let antenna = self.antennas.iter().find(|antenna| antenna.shown.id() == id);
        let continues =
            self.closing.is_none() && antenna.is_some_and(|antenna| is_wanted(&antenna.shown));
        if !continues && self.uploads.stage.can_cancel() {
            self.ask_about_upload(Ask::Cancel);
        }
        if self.steady.saturating_duration_since(start) > UPLOAD_TIMEOUT {
            let text = "it did not end within half an hour. Is the keyring locked?".to_owned();
            self.upload_runner.give_up(text, &mut self.uploads);
        }
        self.end_rule_upload();
    }

    /// Records the end of a rule's upload.
    pub(in crate::engine) fn end_rule_upload(&mut self) {
        if self.uploads.stage.is_open() {
            return;
        }
        let Some(upload) = self.rule_upload.take() else { return };
        let id = upload.antenna;
        match &self.uploads.stage {
            Stage::Proved(proved) => {
                let file = proved.uploaded.file.as_str().to_owned();
                let satellites = proved.uploaded.objects.len();
                let old_algorithms = old_algorithms(&self.uploads).to_vec();
                let day_event = DayEvent::ElementsUploaded { file, satellites, old_algorithms };
                self.note_day(id, day_event);
            }
            Stage::Failed(failure) => {
                let (reason, is_cancel) = (failure.text.clone(), failure.is_cancel);
                // Clear the stage: the window would offer actions meant for uploads by hand.
                mem::take(&mut self.uploads.stage);
                if is_cancel {
                    self.note_day(id, DayEvent::ElementsNotUploaded { reason });
                    self.check_elements_after(id, CHECK_PERIOD);
                } else {
                    self.note_upload_failure(id, reason);
                }
            }
            Stage::Idle
            | Stage::AsksAboutTracking(_)
            | Stage::Working { .. }
            | Stage::AsksAboutHostKey(_)
            | Stage::AsksForSecret(_)
            | Stage::Selecting(_) => {}
        }
    }

    fn check_elements_after(&mut self, id: AntennaId, wait: Duration) {
        let instant = self.steady + wait;
        if let Some(antenna) = self.antennas.iter_mut().find(|antenna| antenna.shown.id() == id) {
            antenna.at_work.upkeep.next_check = Some(instant);
        }
    }

    fn note_upload_failure(&mut self, id: AntennaId, reason: String) {
        self.check_elements_after(id, RETRY);
        self.alarms.raise(
            Some(id),
            AlarmKind::ElementsNotUploaded { reason: reason.clone() },
            self.now,
        );
        self.note_day(id, DayEvent::ElementsNotUploaded { reason });
    }

    fn clear_upload_alarm(&mut self, id: AntennaId) {
        let is_that = |kind: &AlarmKind| matches!(kind, AlarmKind::ElementsNotUploaded { .. });
        self.alarms.clear(Some(id), self.now, is_that);
    }
}

/// Returns the elements of the satellites that the unit accepts in one file.
fn chosen<'a>(
    catalog: &'a Catalog,
    numbers: &[u32],
    takes: &ElementFiles,
) -> Vec<(FileObject, &'a Elements)> {
    let mut chosen: Vec<(FileObject, &Elements)> = Vec::new();
    for elements in numbers.iter().filter_map(|number| catalog.get(*number)) {
        let Ok(alone) = TleFile::new([elements], takes) else { continue };
        let Some(object) = alone.objects().first().cloned() else { continue };
        // The unit looks up a satellite by its name.
        if chosen.iter().all(|(chosen_object, _)| chosen_object.name != object.name) {
            chosen.push((object, elements));
        }
    }
    chosen
}

/// Returns `true` if newer elements exist for a satellite that is missing or too old on the unit.
/// Fails if the upload, which replaces the whole file, would make a satellite older.
fn is_upload_due(
    chosen: &[(FileObject, &Elements)],
    on_unit: &BTreeMap<u32, Timestamp>,
    limit_s: f64,
    now: Timestamp,
) -> Result<bool, String> {
    let is_old = |epoch: Timestamp| seconds_between(epoch, now) > limit_s;
    let epoch_on_unit = |object: &FileObject| on_unit.get(&object.catalog_number).copied();
    let is_due = chosen.iter().any(|(object, _)| match epoch_on_unit(object) {
        Some(epoch) => object.epoch > epoch && is_old(epoch),
        None => !is_old(object.epoch),
    });
    let mut older = chosen
        .iter()
        .filter(|(object, _)| epoch_on_unit(object).is_some_and(|epoch| object.epoch < epoch));
    match older.next() {
        Some((object, _)) if is_due => {
            Err(format!("the elements of {} on the unit are newer than those here", object.name))
        }
        Some(_) | None => Ok(is_due),
    }
}

fn order(
    antenna: &AntennaModel,
    target: &UploadTarget,
    takes: &'static ElementFiles,
    chosen: &[(FileObject, &Elements)],
) -> Result<Order, String> {
    let content = TleFile::new(chosen.iter().map(|(_, elements)| *elements), takes);
    let file = antenna.config.connection.element_file().unwrap_or_else(|| target.file.clone());
    Ok(Order {
        antenna: antenna.config.name.clone(),
        takes,
        unit: target.unit.clone(),
        folder: target.folder.clone(),
        file: FileName::new(&file, takes).map_err(|error| error.to_string())?,
        user: target.user.clone(),
        key_file: target.key_file.clone(),
        cargo: Cargo::New(content.map_err(|error| error.to_string())?),
        satellite: None,
        is_unattended: true,
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        astro::time::add_seconds,
        contract::{transfer::Peer, uploads::Failure},
        controller::satrak::ELEMENT_FILES,
        engine::automatic::{LastRun, tests::station},
        orbit::bundled,
    };

    const FAVOURITES: [u32; 2] = [25_544, 43_013];

    #[test]
    fn newer_elements_are_due_for_what_is_missing_or_past_the_limit() {
        let catalog = bundled().unwrap();
        let chosen = chosen(&catalog, &FAVOURITES, &ELEMENT_FILES);
        assert_eq!(chosen.len(), FAVOURITES.len());
        let at_hand = |number: u32| {
            chosen.iter().find(|(object, _)| object.catalog_number == number).unwrap().0.epoch
        };
        let [iss, noaa] = FAVOURITES;
        let later = |days: f64| add_seconds(at_hand(iss).max(at_hand(noaa)), days * DAY_S);
        let limit_s = 2.0 * DAY_S;
        let is_due = |iss_before_d: f64, days: f64| {
            let iss_epoch = add_seconds(at_hand(iss), -iss_before_d * DAY_S);
            let on_unit = BTreeMap::from([(iss, iss_epoch), (noaa, at_hand(noaa))]);
            is_upload_due(&chosen, &on_unit, limit_s, later(days))
        };
        assert_eq!(is_due(1.0, 0.5), Ok(false), "within the limit");
        assert_eq!(is_due(1.0, 1.9), Ok(true), "past the limit");
        assert_eq!(is_due(0.0, 30.0), Ok(false), "nothing newer is at hand");
        assert_eq!(is_due(-0.5, 30.0), Ok(false), "those on the unit are newer");
        let missing = BTreeMap::from([(iss, at_hand(iss))]);
        let one_missing = |days| is_upload_due(&chosen, &missing, limit_s, later(days));
        assert_eq!(one_missing(0.1), Ok(true));
        assert_eq!(one_missing(30.0), Ok(false), "those at hand are old themselves");
        let noaa_newer = BTreeMap::from([(noaa, later(0.1))]);
        let mixed = is_upload_due(&chosen, &noaa_newer, limit_s, later(0.2));
        assert!(mixed.unwrap_err().contains("newer than those here"));
    }

    #[test]
    fn a_satellite_that_the_unit_cannot_take_does_not_keep_the_others_from_it() {
        let catalog = bundled().unwrap();
        let twice = [FAVOURITES[0], 1_000_000, FAVOURITES[0], FAVOURITES[1]];
        let chosen = chosen(&catalog, &twice, &ELEMENT_FILES);
        let numbers: Vec<u32> = chosen.iter().map(|(object, _)| object.catalog_number).collect();
        assert_eq!(numbers, FAVOURITES);
        assert!(TleFile::new(chosen.iter().map(|(_, elements)| *elements), &ELEMENT_FILES).is_ok());
    }

    fn target() -> UploadTarget {
        UploadTarget {
            unit: Peer { host: "dish".to_owned(), port: 22 },
            folder: "/tle".to_owned(),
            file: "a.txt".to_owned(),
            user: "op".to_owned(),
            key_file: None,
        }
    }

    fn object(catalog_number: u32, day: f64) -> FileObject {
        let epoch = add_seconds(Timestamp::UNIX_EPOCH, day * DAY_S);
        FileObject { name: catalog_number.to_string(), catalog_number, epoch }
    }

    #[test]
    fn what_a_unit_holds_outlasts_a_restart_and_belongs_to_its_address() {
        let folder = tempfile::tempdir().unwrap();
        let (mut engine, left) = station(folder.path());
        let config = engine.antennas[0].shown.config.clone();
        engine.note_upload(&config, target(), &[object(1, 10.0), object(2, 11.0)]);
        // The rule waits for elements newer than the ones that the operator took back.
        engine.uploads.is_roll_back = true;
        engine.note_upload(&config, target(), &[object(1, 9.0), object(3, 7.0)]);
        let read = LastRun::load(&left);
        let unit_elements = read.unit_elements(config.id, &config.connection.address).unwrap();
        let objects = [object(1, 10.0), object(2, 11.0), object(3, 7.0)];
        assert_eq!(
            unit_elements.epochs,
            objects.map(|object| (object.catalog_number, object.epoch))
        );
        assert_eq!(unit_elements.target, target());
        assert!(read.unit_elements(config.id, "another:4001").is_none());
        assert!(read.unit_elements(AntennaId(2), &config.connection.address).is_none());
    }

    /// Returns an engine whose rule has begun an upload.
    fn uploading(folder: &std::path::Path) -> Engine {
        let (mut engine, _) = station(folder);
        let shown = &mut engine.antennas[0].shown;
        Arc::make_mut(&mut shown.config).upkeep.uploads_elements = true;
        engine.uploads.antenna.clone_from(&shown.config.name);
        engine.uploads.stage = Stage::Working { progress: None, is_cancelled: false };
        engine.rule_upload = Some(RuleUpload { antenna: AntennaId(1), start: engine.steady });
        engine
    }

    fn is_cancelled(engine: &Engine) -> bool {
        matches!(engine.uploads.stage, Stage::Working { is_cancelled: true, .. })
    }

    fn alarms(engine: &Engine) -> usize {
        engine.alarms.list().iter().filter(|alarm| !alarm.is_over()).count()
    }

    #[test]
    fn an_upload_goes_on_while_its_antenna_is_idle_and_no_longer() {
        let ends: [fn(&mut Engine); 5] = [
            |_| {},
            |engine| engine.set_automatic(0, false),
            |engine| {
                Arc::make_mut(&mut engine.antennas[0].shown.config).upkeep.uploads_elements = false;
            },
            |engine| {
                Arc::make_mut(&mut engine.antennas[0].shown.config).name = "Another".to_owned();
            },
            |engine| engine.antennas.clear(),
        ];
        for (number, change) in ends.into_iter().enumerate() {
            let folder = tempfile::tempdir().unwrap();
            let mut engine = uploading(folder.path());
            change(&mut engine);
            engine.limit_rule_upload();
            assert_eq!(is_cancelled(&engine), number > 0, "{number}");
        }
    }

    #[test]
    fn an_upload_that_hangs_is_given_up_with_an_alarm() {
        let folder = tempfile::tempdir().unwrap();
        let mut engine = uploading(folder.path());
        engine.steady += UPLOAD_TIMEOUT;
        engine.limit_rule_upload();
        assert!(engine.uploads.stage.is_open() && alarms(&engine) == 0);
        engine.steady += Duration::from_secs(1);
        engine.limit_rule_upload();
        assert_eq!(engine.uploads.stage, Stage::Idle);
        assert!(engine.rule_upload.is_none() && alarms(&engine) == 1);
        // The next upload by hand clears the alarm.
        let config = engine.antennas[0].shown.config.clone();
        engine.note_upload(&config, target(), &[]);
        assert_eq!(alarms(&engine), 0);
    }

    #[test]
    fn a_cancelled_upload_raises_no_alarm_and_a_failed_one_does() {
        for is_cancel in [true, false] {
            let folder = tempfile::tempdir().unwrap();
            let mut engine = uploading(folder.path());
            let failure = Failure { text: "why".to_owned(), is_cancel, ..Failure::default() };
            engine.uploads.stage = Stage::Failed(failure);
            engine.end_rule_upload();
            let expected = DayEvent::ElementsNotUploaded { reason: "why".to_owned() };
            assert_eq!(engine.day.last().map(|line| &line.event), Some(&expected));
            assert_eq!((alarms(&engine) == 0, &engine.uploads.stage), (is_cancel, &Stage::Idle));
        }
    }

    #[test]
    fn the_failure_of_an_upload_by_hand_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let mut engine = uploading(folder.path());
        engine.rule_upload = None;
        engine.uploads.stage = Stage::Failed(Failure::default());
        engine.end_rule_upload();
        assert!(matches!(engine.uploads.stage, Stage::Failed(_)));
        for _ in 1..MAX_BLOCKED {
            assert!(engine.is_blocked(0) && alarms(&engine) == 0);
        }
        assert!(engine.is_blocked(0) && alarms(&engine) == 1);
        engine.uploads.stage = Stage::Idle;
        assert!(!engine.is_blocked(0));
    }
}
