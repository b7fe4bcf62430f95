//! Entries that the station writes to its record: commands that it received, and changes since the
//! last turn. The sessions' logs supply the wire lines and positions.

mod differences;
mod explain;
mod live;
mod plans;
mod reports;
mod state;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use jiff::Timestamp;
use serde_json::{Value, json};
use tokio::sync::mpsc;

use self::{
    differences::differences,
    reports::{Finished, Followed},
    state::State,
};
use super::{
    Antenna, Engine,
    claim::{digest, whole_path},
    handle::Stopped,
};
use crate::{
    astro::time::seconds_between,
    clock::{Clock, Instant, Moment},
    contract::{
        self, Command, CommandOrigin, Snapshot,
        alarms::{Alarm, AlarmKind},
        automatic::DayLine,
        driver::{Event, Response, Safety, TimeSync},
        hooks::HookRun,
        record::{PeakChange, Status},
        schedule::Planned,
    },
    driver::{self, AntennaHandle},
    engine::alarms::KeepAlarms,
    job::Job,
    plan::pass_report::LossCause,
    record::{Entry, Kind, PassNote, RecordedSession, Recorder},
    station::{self, AntennaId, Station},
};

/// Min step of UTC against the steady clock that counts as setting the clock, seconds.
const CLOCK_SET_S: f64 = 0.05;
/// Name of the demo station's record.
const DEMO: &str = "demo.sqlite";

/// Record of a station, and the state that it already contains.
#[derive(Default)]
pub(super) struct Recording {
    /// Folder of all records; `None` if Azel keeps no records.
    folder: Option<PathBuf>,
    /// Channel for reports of passes, besides the record.
    taker: Option<mpsc::Sender<PassNote>>,
    recorder: Option<(PathBuf, Recorder)>,
    status: Option<Arc<Status>>,
    station: Value,
    states: BTreeMap<AntennaId, State>,
    /// Last write to each group of settings.
    written: BTreeMap<(AntennaId, &'static str), Timestamp>,
    alarms: Vec<Alarm>,
    /// Last recorded schedule.
    schedule: Arc<Planned>,
    /// Clocks at the last turn, with the computer's total sleep time.
    clock: Option<(Moment, Duration, TimeSync)>,
    /// Antenna that a held key turns, and the time of the last renewal.
    jog: Option<(AntennaId, Instant)>,
    /// Satellite that each antenna was commanded to track, and the start of that command.
    commanded: BTreeMap<AntennaId, (u32, Timestamp)>,
    /// Tracked passes, and passes whose report is in progress.
    followed: Vec<Followed>,
    /// Passes reported before their LOS because the antenna had already finished them.
    announced: Vec<(AntennaId, u32, Timestamp)>,
    /// Tracks without a known pass, with the time of the last search.
    lookups: Vec<((AntennaId, u32), Timestamp)>,
    reports: Vec<Option<Job<Finished>>>,
    /// Second in which tracks were last checked.
    looked_at: i64,
}

/// Returns the path of a station file's record in the folder of all records.
pub fn record_path(folder: &Path, station: &Path) -> PathBuf {
    let path = whole_path(station);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    folder.join(format!("{}.sqlite", digest(&stem, path.to_string_lossy().as_bytes())))
}

/// Returns the path of the demo station's record in the folder of all records.
pub fn demo_record_path(folder: &Path) -> PathBuf {
    folder.join(DEMO)
}

/// Returns the folder of this user's records; `None` on a machine without a home folder.
pub fn records_folder() -> Option<PathBuf> {
    let dirs = directories::ProjectDirs::from("", "", "azel")?;
    Some(dirs.data_dir().join("records"))
}

impl Recording {
    pub(super) fn new(folder: Option<PathBuf>, taker: Option<mpsc::Sender<PassNote>>) -> Self {
        Self { folder, taker, ..Self::default() }
    }

    /// Returns `true` if a record or a channel takes reports of passes.
    fn wants_reports(&self) -> bool {
        self.recorder.is_some() || self.taker.is_some()
    }

    /// Sends the report of a pass to the channel and to the record.
    fn tell_pass(&self, note: PassNote) {
        if let Some(taker) = &self.taker
            && taker.try_send(note.clone()).is_err()
        {
            tracing::error!("a report of a pass is not taken");
        }
        if let Some((_, recorder)) = &self.recorder {
            recorder.note_pass(note);
        }
    }

    pub(super) fn status(&self) -> Option<Arc<Status>> {
        self.status.clone()
    }

    /// Records a new session of an antenna.
    pub(super) fn follow(&self, config: &station::Antenna, handle: &AntennaHandle, moment: Moment) {
        let Some((_, recorder)) = &self.recorder else { return };
        recorder.follow(RecordedSession {
            moment,
            antenna: config.id,
            name: config.name.clone(),
            make: config.connection.spec().key,
            wire: handle.wire().clone(),
            positions: handle.positions().clone(),
        });
    }

    pub(super) fn day_line(&self, line: &DayLine, moment: Moment) {
        self.note(moment, Some(line.antenna), Kind::Day, line);
    }

    /// Records the call of a hook, once it has ended or is not made.
    pub(super) fn hook(&self, run: &HookRun, moment: Moment) {
        self.note(moment, run.antenna, Kind::Hook, run);
    }

    pub(super) fn event(&mut self, antenna: AntennaId, event: &Event, moment: Moment) {
        self.note(moment, Some(antenna), kind_of(event), event);
        if let Some(loss_cause) = ended_by(event) {
            for pass in self.followed.iter_mut().filter(|pass| pass.antenna == antenna) {
                pass.breaks.note_stop(moment.utc, loss_cause);
            }
        }
    }

    /// Adds a published snapshot to the film.
    pub(super) fn film(&self, snapshot: &Arc<Snapshot>) {
        if let Some((_, recorder)) = &self.recorder {
            recorder.film(snapshot.clone());
        }
    }

    fn note(
        &self,
        moment: Moment,
        antenna: Option<AntennaId>,
        kind: Kind,
        data: &impl serde::Serialize,
    ) {
        if let Some((_, recorder)) = &self.recorder {
            recorder.note(Entry::new(moment, antenna, kind, data));
        }
    }

    /// Starts recording into the file at `path`, with no recorded state yet.
    fn begin(&mut self, path: PathBuf, clock: &Clock, keeping: station::Retention) {
        match Recorder::start(path.clone(), clock.clone(), keeping) {
            Ok(recorder) => {
                let (folder, taker) = (self.folder.take(), self.taker.take());
                let recorder = Some((path, recorder));
                *self = Self { folder, taker, recorder, ..Self::default() };
            }
            Err(error) => tracing::error!(%error, "no thread for the record"),
        }
    }
}

impl Engine {
    /// Returns the path of the current station's record, even if another Azel writes it.
    pub(super) fn record_file(&self) -> Option<PathBuf> {
        let folder = self.recording.folder.as_deref();
        folder.zip(self.settings_path.as_deref()).map(|(folder, path)| match self.demo {
            Some(_) => demo_record_path(folder),
            None => record_path(folder, path),
        })
    }

    /// Records into the file of a station that comes into use, and records changes of the station.
    pub(super) fn record_station(&mut self, station: &Station) {
        // Another Azel that drives the station records it.
        let path = self
            .record_file()
            .filter(|_| !matches!(self.station_claim, super::StationClaim::Theirs(_)));
        match (path, &self.recording.recorder) {
            (Some(path), Some((open_path, recorder))) if path == *open_path => {
                recorder.keep(station.record);
            }
            (path, before) => {
                if before.is_some() {
                    self.report_last_passes();
                }
                match path {
                    Some(path) => self.recording.begin(path, &self.clock, station.record),
                    None => self.recording.recorder = None,
                }
            }
        }
        self.record_has_grown();
        self.read_peaks();
        let moment = self.clock.now();
        let now = serde_json::to_value(station).unwrap_or_default();
        let before = std::mem::replace(&mut self.recording.station, now);
        let now = &self.recording.station;
        if before.is_null() {
            self.recording.note(moment, None, Kind::Station, &json!({ "station": now }));
        } else if before != *now {
            let changes = differences(&before, now);
            self.recording.note(moment, None, Kind::Station, &json!({ "changes": changes }));
        }
    }

    /// Records a command of a client. A held jog key counts as one command.
    pub(super) fn note_command(&mut self, command: &Command, origin: CommandOrigin) {
        match command {
            command if command.only_looks() => return,
            Command::Antenna(id, contract::driver::Command::Jog { .. }) => {
                let previous = self.recording.jog.replace((*id, self.steady));
                let lease = driver::JOG_LEASE;
                let is_held = previous.is_some_and(|(antenna, instant)| {
                    antenna == *id && self.steady.saturating_duration_since(instant) <= lease
                });
                if is_held {
                    return;
                }
            }
            _ => self.recording.jog = None,
        }
        let moment = self.clock.now();
        let data = json!({ "by": origin, "command": command });
        self.recording.note(moment, command.antenna(), Kind::Command, &data);
    }

    /// Records a command to a session. Client commands are already recorded, except that tracks are
    /// recorded again with the target instead of only the pass.
    pub(super) fn note_sent(&self, index: usize, command: &contract::driver::Command) {
        use crate::contract::driver::Command::{ProgramTrack, ProgramTrackIntoSun, Track};
        let origin = self
            .current_request
            .map_or(CommandOrigin::Station, |current_request| current_request.origin);
        let is_track = matches!(command, Track(_) | ProgramTrack(_) | ProgramTrackIntoSun(_));
        if origin != CommandOrigin::Station && !is_track {
            return;
        }
        let Some(id) = self.antennas.get(index).map(|antenna| antenna.shown.id()) else { return };
        let data = json!({ "by": origin, "command": { "Antenna": [id, command] } });
        self.recording.note(self.clock.now(), Some(id), Kind::Command, &data);
    }

    /// Records a change of the peaks; returns `false` if there is no record.
    pub(super) fn note_peak(&self, antenna: AntennaId, change: PeakChange) -> bool {
        self.recording.note(self.clock.now(), Some(antenna), Kind::Peak, &change);
        self.recording.recorder.is_some()
    }

    pub(super) fn note_pressed_stop(&mut self, stopped: &Stopped) {
        let now = self.now;
        for pass in &mut self.recording.followed {
            if stopped.antennas.contains(&pass.antenna) {
                pass.breaks.note_stop(now, LossCause::Stopped);
            }
        }
        let moment = Moment { steady: stopped.instant, utc: self.now };
        let data = json!({
            "by": stopped.origin,
            "antennas": stopped.antennas,
            "elsewhere": stopped.elsewhere,
            "is_for_all": stopped.is_for_all,
        });
        self.recording.note(moment, None, Kind::Stop, &data);
    }

    /// Records the changes of this turn, and checks the record's state.
    pub(super) fn record_turn(&mut self) {
        self.report_passes();
        let Some((_, recorder)) = &self.recording.recorder else {
            self.recording.status = None;
            return;
        };
        let status = recorder.status();
        match &status.failing {
            Some(failing) => {
                self.alarms.raise(None, AlarmKind::NoRecord(failing.reason.clone()), self.now);
            }
            None => {
                self.alarms.clear(None, self.now, |kind| matches!(kind, AlarmKind::NoRecord(_)));
            }
        }
        let previous = self.recording.status.as_ref().and_then(|status| status.removed);
        if status.removed.is_some() && status.removed != previous {
            self.alarms.raise(None, AlarmKind::RecordRemoved, self.now);
        }
        if self.recording.status.as_deref() != Some(&status) {
            self.recording.status = Some(Arc::new(status));
        }
        let moment = self.clock.now();
        self.note_clock(moment);
        self.note_alarms(moment);
        self.note_schedule(moment);
        for antenna in &self.antennas {
            note_antenna(&mut self.recording, antenna, moment);
        }
        self.recording
            .states
            .retain(|id, _| self.antennas.iter().any(|other| other.shown.id() == *id));
    }

    fn note_clock(&mut self, moment: Moment) {
        let asleep = self.clock.asleep();
        let now = (moment, asleep, self.time_sync);
        let Some((before, slept, sync)) = self.recording.clock.replace(now) else {
            return self.recording.note(
                moment,
                None,
                Kind::Clock,
                &json!({ "sync": self.time_sync }),
            );
        };
        let passed = moment.steady.saturating_duration_since(before.steady);
        let expected_s = (passed + asleep.saturating_sub(slept)).as_secs_f64();
        let set_by_s = seconds_between(before.utc, moment.utc) - expected_s;
        if set_by_s.abs() > CLOCK_SET_S || sync != self.time_sync {
            let data = json!({ "sync": self.time_sync, "set_by_s": set_by_s });
            self.recording.note(moment, None, Kind::Clock, &data);
        }
    }

    fn note_alarms(&mut self, moment: Moment) {
        let list = self.alarms.list();
        // Leave out the duration: it grows with every turn.
        let story = |alarm: &Alarm| {
            (alarm.id, alarm.acknowledged, alarm.over_since, alarm.shelved_until, alarm.count)
        };
        let alarms = &self.recording.alarms;
        if list.iter().map(story).eq(alarms.iter().map(story)) {
            return;
        }
        for alarm in list {
            let before = alarms.iter().find(|before| before.id == alarm.id);
            if before.is_none_or(|before| story(before) != story(alarm)) {
                self.recording.note(moment, alarm.antenna, Kind::Alarm, alarm);
            }
        }
        self.recording.alarms = list.to_vec();
    }
}

fn note_antenna(recording: &mut Recording, antenna: &Antenna, moment: Moment) {
    let id = antenna.shown.id();
    let state = State::new(&antenna.shown);
    if recording.states.get(&id) != Some(&state) {
        recording.note(moment, Some(id), Kind::State, &state);
        recording.states.insert(id, state);
    }
    for (group, group_state) in &*antenna.shown.snapshot.state.groups {
        let Some(written) = &group_state.written else { continue };
        if recording.written.insert((id, group), written.time) != Some(written.time) {
            let data = json!({ "group": group, "written": written });
            recording.note(moment, Some(id), Kind::Setting, &data);
        }
    }
}

/// Returns the cause of a pass's end for an event: a fault for which the driver stopped the
/// antenna.
fn ended_by(event: &Event) -> Option<LossCause> {
    let Event::Safety(found) = event else { return None };
    match found {
        Safety::NoEffect { .. } => Some(LossCause::NoEffect),
        Safety::OffTarget { .. } => Some(LossCause::GivenUp),
        Safety::ForeignHands { .. } => Some(LossCause::ForeignHands),
        Safety::Forbidden { response: Response::Stopped, .. } => Some(LossCause::Forbidden),
        Safety::Forbidden { response: Response::Reported, .. }
        | Safety::DeadManFired
        | Safety::LeftMoving { .. }
        | Safety::NoMark
        | Safety::SessionBroke
        | Safety::StoppedByFlags { .. }
        | Safety::FlagsContradict { .. }
        | Safety::SilentInMotion
        | Safety::ClockStepped { .. }
        | Safety::EndedForSleep
        | Safety::Slept { .. }
        | Safety::AsksToResume { .. }
        | Safety::UnitDiffers { .. } => None,
    }
}

fn kind_of(event: &Event) -> Kind {
    match event {
        Event::LinkLost(_) | Event::Connected(_) | Event::Back { .. } => Kind::Link,
        Event::NotSent(_)
        | Event::OffsetRefused(_)
        | Event::Refused(..)
        | Event::Unanswered(_)
        | Event::CannotTrack(..)
        | Event::CannotProgramTrack(..)
        | Event::WouldMiss { .. }
        | Event::StopRefused(_)
        | Event::AutoStaysOn => Kind::Refusal,
        Event::Stopped | Event::StopNotConfirmed => Kind::Stop,
        _ => Kind::Event,
    }
}
