//! Entries that the station hands to its record: the commands that it received, and its changes
//! since the last turn. Lines and positions go there from the sessions' own logs.

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

/// A step of UTC against the steady clock from which the clock counts as set, seconds.
const CLOCK_SET_S: f64 = 0.05;
/// Name of the demo station's record.
const DEMO: &str = "demo.sqlite";

/// The record of a station, and what of the station it holds already.
#[derive(Default)]
pub(super) struct Recording {
    /// Folder of all records; `None` to keep none.
    folder: Option<PathBuf>,
    /// Channel for reports of passes, besides the record.
    taker: Option<mpsc::Sender<PassNote>>,
    recorder: Option<(PathBuf, Recorder)>,
    status: Option<Arc<Status>>,
    station: Value,
    states: BTreeMap<AntennaId, State>,
    /// The last write to each group of settings.
    written: BTreeMap<(AntennaId, &'static str), Timestamp>,
    alarms: Vec<Alarm>,
    /// The schedule that was recorded last.
    schedule: Arc<Planned>,
    /// The clocks of the last turn, and how long the computer had slept by then.
    clock: Option<(Moment, Duration, TimeSync)>,
    /// The antenna that a held key turns, and when that was last heard of.
    jog: Option<(AntennaId, Instant)>,
    /// The satellite that each antenna has the command to track, and since when.
    commanded: BTreeMap<AntennaId, (u32, Timestamp)>,
    /// Passes that are tracked, and the reports that are worked on.
    followed: Vec<Followed>,
    /// Passes that are reported before their LOS, because they were over for their antenna.
    announced: Vec<(AntennaId, u32, Timestamp)>,
    /// Tracks of no pass, with the time of the last search for one.
    lookups: Vec<((AntennaId, u32), Timestamp)>,
    reports: Vec<Option<Job<Finished>>>,
    /// The second in which tracks were last looked at.
    looked_at: i64,
}

/// The record of the station file at `station`, in the folder of all records.
pub fn record_path(folder: &Path, station: &Path) -> PathBuf {
    let path = whole_path(station);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    folder.join(format!("{}.sqlite", digest(&stem, path.to_string_lossy().as_bytes())))
}

/// The record of the demo station, in the folder of all records.
pub fn demo_record_path(folder: &Path) -> PathBuf {
    folder.join(DEMO)
}

/// Folder of this user's records; `None` on a machine without a home.
pub fn records_folder() -> Option<PathBuf> {
    let dirs = directories::ProjectDirs::from("", "", "azel")?;
    Some(dirs.data_dir().join("records"))
}

impl Recording {
    pub(super) fn new(folder: Option<PathBuf>, taker: Option<mpsc::Sender<PassNote>>) -> Self {
        Self { folder, taker, ..Self::default() }
    }

    /// Returns `true` if somebody wants reports of passes.
    fn wants_reports(&self) -> bool {
        self.recorder.is_some() || self.taker.is_some()
    }

    /// Passes on the report of a pass.
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

    /// Records the session that begins for an antenna.
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

    pub(super) fn event(&mut self, antenna: AntennaId, event: &Event, moment: Moment) {
        self.note(moment, Some(antenna), kind_of(event), event);
        if let Some(loss_cause) = ended_by(event) {
            for pass in self.followed.iter_mut().filter(|pass| pass.antenna == antenna) {
                pass.breaks.note_stop(moment.utc, loss_cause);
            }
        }
    }

    /// Films what is published.
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

    /// Records into the file at `path`, from its beginning.
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
    /// The record of the station in use, whoever writes it.
    pub(super) fn record_file(&self) -> Option<PathBuf> {
        let folder = self.recording.folder.as_deref();
        folder.zip(self.settings_path.as_deref()).map(|(folder, path)| match self.demo {
            Some(_) => demo_record_path(folder),
            None => record_path(folder, path),
        })
    }

    /// Records into the file of the station that comes into use, and what is new in it.
    pub(super) fn record_station(&mut self, station: &Station) {
        // Another Azel that drives the station records it itself.
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

    /// Records a command of a client. A held jog key counts once.
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

    /// Records a command that goes to a session. A client's command was recorded when it came,
    /// unless the client named only a pass.
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

    /// Returns `false` where nothing is recorded.
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

    /// Records what this turn has changed, and watches over the record.
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
        // How long something stands grows with every turn.
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

/// Why a pass ends with this event: what the driver found and stopped the antenna for.
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
