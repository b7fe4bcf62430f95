//! Selection of an uploaded file on a unit, and judgement of the unit's answer.

use std::sync::Arc;

use jiff::Timestamp;

use crate::{
    clock::Instant,
    contract::{
        antenna::AntennaModel,
        driver,
        transfer::{FileObject, Uploaded},
        uploads::Busy,
    },
    device::{
        ElementFiles,
        panel::{Check, CheckState},
        settings::{Change, HeldGroup, Hindrance, Written},
    },
    engine::automatic::Operate,
};

/// First ticket of selections; tickets of forms are lower.
pub(super) const TICKETS: u64 = 1 << 63;

/// Returns the reason why the operator must agree to a change of the unit of `antenna`.
fn busy(antenna: &AntennaModel) -> Option<Busy> {
    let program = antenna.snapshot.state.program?;
    if program.enabled {
        return Some(Busy::Tracks);
    }
    (program.auto == Some(true)).then_some(Busy::MayTrack)
}

/// Current state of an antenna's unit.
#[derive(Debug, Clone, Default)]
pub(in crate::engine) struct UnitNow {
    /// Time of this state.
    pub(super) time: Timestamp,
    /// Reason why the operator must agree before the unit uses a file.
    pub(super) busy: Option<Busy>,
    /// Holder and reason of a lock-out.
    pub(super) locked_out: Option<String>,
    /// Reason why the driver would refuse the use of a file now.
    pub(super) hindrance: Option<Hindrance>,
    /// `true` if automatic operation is on and requests nothing of the antenna.
    pub(super) is_idle: bool,
    /// Catalog number of the unit's current satellite.
    pub(super) current: Option<u32>,
    /// Answer to the last finished selection.
    pub(super) answer: Option<Answer>,
}

/// Answer to a finished selection.
#[derive(Debug, Clone)]
pub(super) struct Answer {
    written: Arc<Written>,
    /// Last values that the unit reported.
    group: Option<HeldGroup>,
    checks: Arc<[Check]>,
    /// Time at which the checks were read.
    checked_at: Option<Timestamp>,
}

impl UnitNow {
    /// Returns the state known to the session of `antenna`.
    pub(in crate::engine) fn new(
        antenna: Option<&AntennaModel>,
        time: Timestamp,
        steady: Instant,
    ) -> Self {
        let Some(antenna) = antenna else { return Self { time, ..Self::default() } };
        let state = &antenna.snapshot.state;
        let takes = antenna.spec().element_files;
        let group = takes.and_then(|takes| state.groups.get(takes.group));
        let answer = group.and_then(|group| {
            Some(Answer {
                written: group.written.clone()?,
                group: group.last_read.clone(),
                checks: Arc::clone(&state.checks),
                checked_at: state.checked_at,
            })
        });
        let current = state.on_board.satellite.as_ref().map(|satellite| satellite.catalog_number);
        let locked_out = antenna.snapshot.lock_out.as_ref();
        let locked_out =
            locked_out.map(|lock_out| format!("{}: {}", lock_out.operator, lock_out.reason));
        let hindrance = antenna.snapshot.hindrance(antenna.variant().capabilities, steady);
        let is_idle = antenna.operation.is_idle();
        Self { time, busy: busy(antenna), locked_out, hindrance, is_idle, current, answer }
    }

    /// Returns `true` if a rule may change the unit's element file.
    pub(super) fn is_free(&self) -> bool {
        self.is_idle && self.hindrance.is_none() && self.locked_out.is_none()
    }
}

/// Satellite in a file that a unit is to use.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::engine) struct Selection {
    /// Unique number of the selection, from [`TICKETS`] up.
    pub(super) ticket: u64,
    pub(super) takes: &'static ElementFiles,
    /// Time of the selection.
    pub(super) start: Timestamp,
    pub(super) file: String,
    pub(super) satellite: FileObject,
}

impl Selection {
    /// Returns the command for the session. It ends the current track.
    pub(in crate::engine) fn command(&self) -> driver::Command {
        let values = (self.takes.choose)(&self.file, &self.satellite.name);
        driver::Command::WriteSettings(Change {
            ticket: self.ticket,
            group: self.takes.group,
            values,
            expected: None,
            is_unlocked: false,
        })
    }

    /// Returns the end and outcome of the selection; `None` while it is pending. The outcome is
    /// good only if the unit has named the same object, and its checks were read afterwards.
    pub(super) fn end(&self, answer: &Answer) -> Option<(Timestamp, Result<(), String>)> {
        let written = &answer.written;
        if written.change.ticket != self.ticket {
            return None;
        }
        let result = written.result.clone().map_err(|error| error.to_string());
        Some((written.time, result.and_then(|()| self.judge(answer).map_err(str::to_owned))))
    }

    fn judge(&self, answer: &Answer) -> Result<(), &'static str> {
        let number = answer
            .group
            .as_ref()
            .filter(|group| group.read_at >= self.start)
            .and_then(|group| self.takes.found(&group.values));
        if number != Some(self.satellite.catalog_number.into()) {
            return Err("the unit names another object than the one that was chosen");
        }
        if answer.checked_at.is_none_or(|read_at| read_at < self.start) {
            return Err("the unit did not tell its checks after it was told to use the file");
        }
        let is_bad = |check: &Check| {
            self.takes.checks.contains(&check.name) && check.state == CheckState::Fault
        };
        if answer.checks.iter().any(is_bad) {
            return Err("the unit does not find the satellite in the file");
        }
        Ok(())
    }
}

/// Returns the satellite of `uploaded` to use: the `chosen` one, else the unit's current one, else
/// the first.
pub(super) fn pick(
    uploaded: &Uploaded,
    chosen: Option<u32>,
    current: Option<u32>,
) -> Option<&FileObject> {
    let objects = &uploaded.objects;
    let find = |number: u32| objects.iter().find(|object| object.catalog_number == number);
    chosen.and_then(find).or_else(|| current.and_then(find)).or(objects.first())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        contract::driver::Command,
        controller::satrak::{
            ELEMENT_FILES,
            settings::{CATALOG_NUMBER, CONTINUE_TRACKING, PERIOD, SATELLITE_NAME},
        },
        device::settings::WriteError,
    };

    const NUMBER: u32 = 43_013;

    fn time(seconds: i64) -> Timestamp {
        Timestamp::from_second(1_786_000_000 + seconds).unwrap()
    }

    fn selection() -> Selection {
        let satellite =
            FileObject { name: "NOAA 20".to_owned(), catalog_number: NUMBER, epoch: time(-9000) };
        Selection {
            ticket: TICKETS + 1,
            takes: &ELEMENT_FILES,
            start: time(0),
            file: "active.txt".to_owned(),
            satellite,
        }
    }

    fn checks(file: CheckState) -> Arc<[Check]> {
        ELEMENT_FILES.checks.iter().map(|name| Check::new(name, file, "")).collect()
    }

    fn answer(result: Result<(), WriteError>) -> Answer {
        let Command::WriteSettings(change) = selection().command() else { panic!() };
        let values = [CATALOG_NUMBER.entry(NUMBER.into())].into();
        Answer {
            written: Arc::new(Written { change, time: time(3), result }),
            group: Some(HeldGroup { values, read_at: time(1) }),
            checks: checks(CheckState::Good),
            checked_at: Some(time(2)),
        }
    }

    fn problem(answer: &Answer) -> String {
        selection().end(answer).unwrap().1.unwrap_err()
    }

    #[test]
    fn the_unit_is_told_to_end_its_track_and_to_keep_its_period() {
        let Command::WriteSettings(change) = selection().command() else { panic!() };
        assert_eq!(CONTINUE_TRACKING.get(&change.values), Some(false));
        assert_eq!(SATELLITE_NAME.get(&change.values).as_deref(), Some("NOAA 20"));
        assert!(!change.values.contains_key(PERIOD.name));
    }

    #[test]
    fn only_the_unit_s_own_words_since_then_are_proof() {
        assert_eq!(selection().end(&answer(Ok(()))), Some((time(3), Ok(()))));
        let other = Selection { ticket: TICKETS + 2, ..selection() };
        assert_eq!(other.end(&answer(Ok(()))), None, "of another order");
        let failed = answer(Err(WriteError::LinkLost));
        assert!(problem(&failed).contains("link was lost"));
        let old = Answer { checked_at: Some(time(-1)), ..answer(Ok(())) };
        assert!(problem(&old).contains("did not tell its checks"));
        let missing = Answer { checks: checks(CheckState::Fault), ..answer(Ok(())) };
        assert!(problem(&missing).contains("does not find the satellite"));
        let mut wrong = answer(Ok(()));
        let group = wrong.group.as_mut().unwrap();
        group.values.extend([CATALOG_NUMBER.entry(0)]);
        assert!(problem(&wrong).contains("another object"));
        let stale = answer(Ok(()));
        let group = stale.group.clone().map(|group| HeldGroup { read_at: time(-1), ..group });
        assert!(problem(&Answer { group, ..stale }).contains("another object"));
    }
}
