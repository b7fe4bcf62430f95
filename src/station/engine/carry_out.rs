//! Commands of clients, carried out by the engine.

use std::sync::Arc;

use jiff::Timestamp;

use super::{
    Engine, StationClaim,
    automatic::Duty,
    control::Rules as _,
    handle::Stopped,
    on_board,
    sources::{self, Task},
};
use crate::{
    astro::time::seconds_between,
    contract::{
        self, CatalogState, Command, CommandOrigin, Event,
        alarms::AlarmKind,
        driver,
        passes::{PassListKey, PredictedPass},
        sources::SourceWork,
        uploads,
    },
    controller::SPECS,
    engine::{alarms::KeepAlarms, sources::due_by_themselves},
    orbit::SourcePlace,
    plan::ProgramTrack,
    secret::Secret,
    station::{self, AntennaId, Station},
};

/// Min time between two rounds of requests without the operator, after any outcome, seconds.
const REFRESH_PAUSE_S: f64 = 600.0;

impl Engine {
    #[expect(clippy::too_many_lines, reason = "one arm a command")]
    pub(super) fn carry_out(&mut self, command: Command) {
        if let Command::Client(antenna, command) = command {
            return self.take_client_command(antenna, command);
        }
        if command.row().only_here && !self.is_from_this_machine() {
            return tracing::error!(?command, "only the station's own machine may ask for this");
        }
        if self.is_elsewhere(&command) || self.is_void(&command) || self.is_too_late(&command) {
            return;
        }
        self.note_track(&command);
        self.leave_to_operator(&command);
        match command {
            Command::Antenna(id, driver::Command::WriteSettings(change)) => {
                self.with_antenna(id, |engine, index| engine.write_settings(index, change));
            }
            Command::Antenna(id, driver::Command::LockOut(lock_out)) => {
                self.with_antenna(id, |engine, index| engine.set_lock_out(index, Some(lock_out)));
            }
            Command::Antenna(id, driver::Command::Unlock) => {
                self.with_antenna(id, |engine, index| engine.set_lock_out(index, None));
            }
            Command::Antenna(id, mut command) => {
                if let driver::Command::ProgramTrack(follow)
                | driver::Command::ProgramTrackIntoSun(follow) = &mut command
                {
                    self.begin_with_offsets(id, follow);
                }
                self.with_antenna(id, |engine, index| engine.send(index, command));
            }
            Command::Track { antenna, pass, is_agreed } => {
                self.with_antenna(antenna, |engine, index| engine.track(index, pass, is_agreed));
            }
            Command::ProgramTrackPass { antenna, pass } => {
                self.with_antenna(antenna, |engine, index| engine.follow_pass(index, pass));
            }
            Command::SetAutomatic { antenna, is_on } => {
                self.with_antenna(antenna, |engine, index| engine.set_automatic(index, is_on));
            }
            Command::GoOn(antenna) => self.with_antenna(antenna, Self::go_on),
            Command::ChoosePass { satellite, tca, take } => {
                let now = self.now;
                self.change_station(|station| station.choose_pass(satellite, tca, take, now));
            }
            Command::PriceSwap(pass) => self.price_swap(pass),
            Command::SetPassLimits { numbers, limits } => self.change_station(|station| {
                for number in numbers {
                    station.favourites.set_limits(number, limits.clone());
                }
            }),
            Command::SetScheduling(scheduling) => {
                self.change_station(|station| station.scheduling = scheduling);
            }
            Command::SaveSettings(id) => self.with_antenna(id, Self::save_copy),
            Command::CompareSettings(id) => self.with_antenna(id, Self::open_copies),
            Command::ReadCopy { antenna, path } => self.with_antenna(antenna, |engine, index| {
                if let Some(antenna) = engine.antennas.get(index) {
                    engine.copy_work.read(path, &antenna.shown);
                }
            }),
            Command::CloseCopy => self.copies.open = None,
            Command::SetElevationFloor(floor_deg) => {
                Arc::make_mut(&mut self.station).elevation_floor_deg = floor_deg;
            }
            Command::CancelSearch(scope) => self.searches.of_mut(scope).cancel(),
            Command::ResumeSearch(scope) => self.searches.of_mut(scope).resume(),
            Command::SetFavourites { numbers, is_favourite } => self.change_station(|station| {
                for number in numbers {
                    station.favourites.mark(number, is_favourite);
                }
            }),
            Command::SetPriority { numbers, priority } => self.change_station(|station| {
                for number in numbers {
                    station.favourites.set_priority(number, priority);
                }
            }),
            Command::SetSourceOrder { satellite, sources } => self.change_station(|station| {
                station.favourites.set_sources(satellite, sources);
            }),
            Command::SetFrequencies { satellite, frequencies } => self.change_station(|station| {
                station.frequencies.retain(|frequency| frequency.satellite != satellite);
                station.frequencies.extend(frequencies);
            }),
            Command::KeepOffsets { subject: offsets_subject, offsets } => {
                self.change_station(|station| station.keep_offsets(offsets_subject, offsets));
                self.tell_first_offsets();
            }
            Command::CopyElements { name, origin } => {
                let copy = Some((name, origin));
                self.begin_elements(Task { copy, ..Task::default() });
            }
            Command::SetRefresh { name, hours } => {
                let mut list = self.sources.list.clone();
                for source in list.iter_mut().filter(|source| source.name == name) {
                    source.refresh = hours;
                }
                self.begin_elements(Task { list: Some(list), ..Task::default() });
            }
            Command::ListOlderSets(number) => self.list_older_sets(number),
            Command::LookAtRecord(look) => self.look_at_record(look),
            Command::FitPointing(antenna, excluded) => self.fit_pointing(antenna, excluded),
            Command::ChangePeaks(antenna, change) => self.change_peaks(antenna, change),
            Command::UseSet(choice) => {
                self.begin_elements(Task { set: Some(choice), ..Task::default() });
            }
            Command::AddSource(source) => {
                let ask = vec![source.name.clone()];
                let mut list = self.sources.list.clone();
                list.push(source);
                self.begin_elements(Task { list: Some(list), ask, ..Task::default() });
            }
            Command::RemoveSource(name) => {
                let mut list = self.sources.list.clone();
                list.retain(|source| source.name != name);
                self.begin_elements(Task { list: Some(list), ..Task::default() });
            }
            Command::RefreshSources { names, forced } => {
                self.begin_elements(Task { ask: names, forced, ..Task::default() });
            }
            Command::SetSourcePassword { name, secret, keep } => {
                self.set_source_password(name, &secret, keep);
            }
            Command::OpenedAlarms => self.alarms.unopened = false,
            Command::AcknowledgeAlarm(id) => self.alarms.acknowledge(id, self.now),
            Command::AcknowledgeAlarms { newest } => {
                self.alarms.acknowledge_all(newest, self.now);
            }
            Command::ShelveAlarm { id, time } => self.alarms.shelve(id, time, self.now),
            Command::UnshelveAlarm(id) => self.alarms.unshelve(id),
            Command::SaveStation(mut station) => {
                if !self.is_from_this_machine() {
                    station.keep_local_settings(&self.station);
                }
                self.save_station(*station);
            }
            Command::TryHook(hook) => self.try_hook(&hook),
            Command::TestSource(ask) => self.source_test_runner.ask(ask, &mut self.source_tests),
            Command::TestLink(antenna) => self.test_link(*antenna),
            Command::Upload(ask) => self.ask_about_upload(ask),
            Command::CloseAfter(close_choice) => self.close_after(close_choice),
            Command::StayOpen => self.closing = None,
            Command::ReleaseControl(antenna) => {
                self.with_antenna(antenna, |engine, index| engine.give_control(index, None));
            }
            Command::HandOver { antenna, client, always } => {
                self.with_antenna(antenna, |engine, index| engine.hand_over(index, client, always));
            }
            // Handled above: `TakeControl` by its row, `Client` as a program's command.
            Command::TakeControl(_) | Command::Client(..) => {}
            Command::Look(attention) => self.attention = attention,
        }
    }

    /// Returns `true` if the current request does not come through a network port.
    fn is_from_this_machine(&self) -> bool {
        self.current_request.is_none_or(|request| request.origin.is_on_this_machine())
    }

    /// Returns `true` if a later STOP voids the command: a STOP of its antenna, or any STOP for a
    /// command that concerns all antennas.
    fn is_void(&self, command: &Command) -> bool {
        let Some(current_request) = self.current_request.filter(|_| command.row().void_after_stop)
        else {
            return false;
        };
        let one = command.antenna();
        let mut concerned =
            self.antennas.iter().filter(|antenna| one.is_none_or(|one| antenna.shown.id() == one));
        concerned.any(|antenna| antenna.handle.stopper().is_void(current_request.number))
    }

    /// Returns `true` if another Azel drives the antenna, and shows the refusal on the antenna.
    fn is_elsewhere(&mut self, command: &Command) -> bool {
        let named =
            |name: &str| self.antennas.iter().position(|antenna| antenna.shown.config.name == name);
        let place = match command {
            Command::Upload(uploads::Ask::Begin(order)) => named(&order.antenna),
            command => command.antenna().and_then(|id| self.place(id)),
        };
        let Some(place) = place else { return false };
        let Some(antenna) = self.antennas.get_mut(place) else { return false };
        let Some(holder) = &antenna.shown.held_by else { return false };
        let refusal = driver::Refusal::Elsewhere(holder.to_string());
        antenna.shown.news = Some((driver::Event::NotSent(refusal), self.now));
        true
    }

    /// Returns `true` if the closing station refuses the command, and shows the refusal on the
    /// antenna.
    fn is_too_late(&mut self, command: &Command) -> bool {
        if self.closing.is_none() || command.row().while_closing {
            return false;
        }
        let place = command.antenna().and_then(|id| self.place(id));
        if let Some(antenna) = place.and_then(|place| self.antennas.get_mut(place)) {
            let refusal = driver::Event::NotSent(driver::Refusal::Closing);
            antenna.shown.news = Some((refusal, self.now));
        }
        true
    }

    /// Runs `work` with the index of an antenna, if the station still has it.
    fn with_antenna(&mut self, id: AntennaId, work: impl FnOnce(&mut Self, usize)) {
        if let Some(index) = self.place(id) {
            work(self, index);
        }
    }

    /// Stops one antenna past every queue, even if its unit must first be connected.
    pub(super) fn stop_one(&mut self, index: usize) {
        if let Some(antenna) = self.antennas.get(index) {
            let (id, stopper) = (antenna.shown.id(), antenna.handle.stopper());
            let stopped = Stopped {
                instant: self.steady,
                origin: CommandOrigin::Station,
                antennas: vec![id],
                elsewhere: Vec::new(),
                tracked: stopper.tracks().then_some(id).into_iter().collect(),
                is_for_all: false,
                newest_session: antenna.session,
            };
            stopper.stop();
            self.note_stop(&stopped);
        }
    }

    pub(super) fn send(&mut self, index: usize, command: driver::Command) {
        self.note_sent(index, &command);
        let number = self.number();
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let antenna_id = Some(antenna.shown.id());
        // Any other command answers the question to the operator.
        if !command.row().in_replay {
            antenna.shown.asks_unseen = None;
        }
        match command {
            driver::Command::AllowUnguarded => antenna.shown.asks_unguarded = false,
            // The operator confirms standstill, whatever the unit reports.
            driver::Command::SeenStanding => {
                let alarms = &mut self.alarms;
                alarms.clear(antenna_id, self.now, |kind| *kind == AlarmKind::StopNotConfirmed);
            }
            _ => {}
        }
        let sent = if antenna.shown.control.awaits(number) {
            antenna.handle.send_answered(command, number)
        } else {
            antenna.handle.send_as(command, number)
        };
        let Err(command) = sent else { return };
        tracing::error!(?command, "the session is too busy to take a command");
        // A lost command of this kind would leave the antenna moving, so stop it instead.
        if matches!(command, driver::Command::Standby | driver::Command::EndJog) {
            self.stop_one(index);
        }
        self.alarms.raise(antenna_id, AlarmKind::NotTaken, self.now);
    }

    /// Returns the number of the current request. Without a request, returns a new number.
    pub(super) fn number(&self) -> u64 {
        self.current_request
            .map_or_else(|| self.driver.orders().next(), |current_request| current_request.number)
    }

    /// Starts tracking a pass of the schedule.
    pub(super) fn take_pass(&mut self, index: usize, duty: &Duty) {
        let Some(predicted) = self.pass(duty.pass) else { return };
        let (site, now) = (self.station.site, self.now);
        let Some(antenna) = self.antennas.get(index) else { return };
        let config = &antenna.shown.config;
        let cut = |(start, end): (Timestamp, Timestamp)| {
            let start = if duty.begins_late { start.max(duty.start) } else { start };
            let end = if duty.ends_early { end.min(duty.end) } else { end };
            (start, end)
        };
        if antenna.shown.variant().capabilities.has_program {
            return match on_board::pass_for(predicted, config, site, now) {
                Ok(mut pass) => {
                    (pass.target.start, pass.target.end) =
                        contract::passes::whole_seconds(cut((pass.target.start, pass.target.end)));
                    self.send(index, driver::Command::Track(Box::new(pass)));
                }
                Err(refusal) => self.take_event(index, driver::Event::NotSent(refusal)),
            };
        }
        let mut track = predicted.follow(config, self.station.elevation_floor()).one_pass(now);
        track.passes.iter_mut().for_each(|span| *span = cut(*span));
        self.begin_with_offsets(config.id, &mut track);
        self.send(index, driver::Command::ProgramTrack(Box::new(track)));
    }

    fn track(&mut self, index: usize, pass: PassListKey, is_agreed: bool) {
        let Some(antenna) = self.antennas.get(index) else { return };
        if antenna.shown.variant().capabilities.has_program {
            return self.track_on_board(index, pass, is_agreed);
        }
        self.follow_pass(index, pass);
    }

    fn follow_pass(&mut self, index: usize, pass: PassListKey) {
        // If the pass has ended since the request, Azel does not take another one.
        let Some(predicted) = self.pass(pass) else { return };
        let Some(antenna) = self.antennas.get(index) else { return };
        let config = &antenna.shown.config;
        let mut follow = predicted.follow(config, self.station.elevation_floor());
        self.begin_with_offsets(config.id, &mut follow);
        self.send(index, driver::Command::ProgramTrack(Box::new(follow)));
    }

    /// Sets the initial offsets of a track: the stored ones of its satellite and antenna.
    pub(super) fn begin_with_offsets(&self, antenna: AntennaId, follow: &mut ProgramTrack) {
        follow.offsets = self.station.first_offsets(antenna, follow.target.catalog_number());
    }

    /// Sends the sessions the initial offsets for the next passes of their tracks.
    fn tell_first_offsets(&mut self) {
        for index in 0..self.antennas.len() {
            let Some(antenna) = self.antennas.get(index) else { continue };
            let Some(track) = &antenna.shown.snapshot.program_track else { continue };
            let id = antenna.shown.id();
            let offsets = self.station.first_offsets(id, track.catalog_number);
            self.send(index, driver::Command::FirstOffsets(offsets));
        }
    }

    /// Returns a listed pass that is not over.
    pub(super) fn pass(&self, key: PassListKey) -> Option<&PredictedPass> {
        self.pass_lists.find(key).filter(|predicted| predicted.pass.los.time > self.now)
    }

    /// Asks the servers that are due and need no client. Asks no server while other work on
    /// elements is under way.
    pub(super) fn refresh_by_itself(&mut self) {
        if self.elements_job.is_some() || self.sources.is_locked {
            return;
        }
        let is_soon = |time: Timestamp| seconds_between(time, self.now).abs() < REFRESH_PAUSE_S;
        if self.refreshed_at.is_some_and(is_soon) {
            return;
        }
        let due = due_by_themselves(&self.sources, self.now);
        if !due.is_empty() {
            self.refreshed_at = Some(self.now);
            self.begin_elements(Task { ask: due, ..Task::default() });
        }
    }

    /// Reads the elements again if the station's source priorities changed. Elements that came with
    /// the settings are in no source, and stay.
    pub(super) fn follow_source_orders(&mut self) {
        let is_known = Arc::ptr_eq(&self.ordered_for, &self.station);
        if self.has_given_elements || self.elements_job.is_some() || is_known {
            return;
        }
        let [previous, current] =
            [&self.ordered_for, &self.station].map(|station| station.favourites.source_orders());
        if previous == current {
            self.ordered_for = Arc::clone(&self.station);
        } else {
            self.begin_elements(Task::default());
        }
    }

    /// Stores a typed password, and asks the server of its source as soon as possible.
    fn set_source_password(&mut self, name: String, secret: &Secret, is_kept: bool) {
        let sources = &mut self.sources.list.iter();
        let user = sources.find_map(|source| match &source.place {
            SourcePlace::SpaceTrack(user) if source.name == name => Some(user.clone()),
            _ => None,
        });
        // A recorded secret is empty, and must not replace a password.
        let user = user.filter(|_| !secret.reveal().is_empty());
        let Some((user, passwords)) = user.zip(self.passwords.as_ref()) else { return };
        passwords.take(&user, secret, is_kept);
        self.typed_passwords.retain(|waiting| *waiting != name);
        self.typed_passwords.push(name);
        self.ask_with_typed_passwords();
    }

    /// Asks the servers whose passwords the operator has typed, unless other work is under way.
    pub(super) fn ask_with_typed_passwords(&mut self) {
        if self.typed_passwords.is_empty() || self.elements_job.is_some() || self.sources.is_locked
        {
            return;
        }
        let ask = std::mem::take(&mut self.typed_passwords);
        self.begin_elements(Task { ask, forced: true, awaits_log_in: true, ..Task::default() });
    }

    /// Starts reading the elements, unless a job is under way: two jobs would write the same files.
    pub(super) fn begin_elements(&mut self, task: Task) {
        if self.elements_job.is_some() || self.sources.is_locked {
            return;
        }
        self.start_elements(task);
    }

    /// Reads the elements again if the current time changes which sets are best, such as after a
    /// clock step.
    pub(super) fn judge_epochs_again(&mut self) {
        if let CatalogState::Ready(catalog) = &self.catalog
            && catalog.is_outdated(self.now)
        {
            self.begin_elements(Task::default());
        }
    }

    /// Starts a job that reads the elements. The caller checks that no other job runs.
    pub(super) fn start_elements(&mut self, task: Task) {
        let task = Task {
            orders: self.station.favourites.source_orders(),
            favourites: self.station.favourites.numbers(),
            passwords: self.passwords.clone(),
            ..task
        };
        self.ordered_for = Arc::clone(&self.station);
        let work = if task.ask.is_empty() { SourceWork::Reading } else { SourceWork::Asking };
        let in_use = match &self.catalog {
            CatalogState::Ready(catalog) => Some(Arc::clone(catalog)),
            CatalogState::Loading | CatalogState::Failed => None,
        };
        let job = sources::start(&self.places, task, in_use, self.now, Arc::clone(&self.wake));
        self.elements_job = Some(job);
        self.sources.work = work;
    }

    /// Changes the station's data on satellites. The change is not saved for the demo station, for
    /// an unread station file, or while another Azel holds the station.
    pub(super) fn change_station(&mut self, change: impl FnOnce(&mut Station)) {
        let mut station = Station::clone(&self.station);
        change(&mut station);
        if self.demo.is_none()
            && !self.settings_unread
            && !matches!(self.station_claim, StationClaim::Theirs(_))
            && let Some(path) = &self.settings_path
        {
            match station::save(&station, path, SPECS) {
                Ok(saved) => station.unread = saved.unread,
                Err(error) => {
                    let text = error.to_string();
                    tracing::error!("{text}");
                    self.alarms.raise(None, AlarmKind::Settings(text), self.now);
                    return;
                }
            }
            self.station_saved_at = Some(self.now);
        }
        self.record_station(&station);
        self.station = Arc::new(station);
        self.keep_fingerprint();
        self.tell(Event::Changed);
    }

    /// Saves a station, and uses it after the save succeeds.
    fn save_station(&mut self, mut station: station::Station) {
        let now = self.now;
        let was_theirs = matches!(self.station_claim, StationClaim::Theirs(_));
        if was_theirs && self.demo.is_none() && self.take_over_station() {
            let text = "the station was open in another Azel until now: look at it again";
            return self.tell(Event::Saved(Err(text.to_owned())));
        }
        self.claim_station();
        let busy = self.antennas.iter().find(|antenna| antenna.shown.is_busy());
        // A track would continue from the old site. The simulators of the demo end when the site
        // changes.
        let moves_site = self.demo.is_none() && self.station.site != station.site;
        let saved = match &self.settings_path {
            _ if moves_site && let Some(antenna) = busy => {
                let name = &antenna.shown.config.name;
                Err(format!("{name} moves or tracks: stop it before the site is changed"))
            }
            _ if let StationClaim::Theirs(holder) = &self.station_claim => {
                Err(format!("it is open in {holder}: save it there, or close it there first"))
            }
            // The operator has not seen the file's content, so a save would replace it unseen.
            Some(path) if self.settings_unread && path.exists() => Err(format!(
                "the station file could not be read, and saving would replace it. Mend it or move it \
                 away, then start Azel again: {}",
                path.display()
            )),
            // The file now belongs to a station that the operator has not seen.
            Some(path) if self.demo.is_some() && path.exists() => Err(format!(
                "a station has been set up elsewhere meanwhile: open it in the station menu: {}",
                path.display()
            )),
            Some(path) => {
                let saved = station::save(&station, path, SPECS);
                saved.map_err(|error| error.to_string())
            }
            None => Err("this user has no folder for settings".to_owned()),
        };
        match saved {
            Ok(saved) => {
                station.unread = saved.unread;
                self.alarms.clear(None, self.now, |kind| {
                    matches!(
                        kind,
                        AlarmKind::Settings(_)
                            | AlarmKind::Setting(_)
                            | AlarmKind::SafetySetting { .. }
                    )
                });
                self.raise_notes(saved.notes, &station);
                let demo = self.demo.take();
                if demo.is_some() {
                    self.load_lock_outs();
                }
                self.settings_unread = false;
                self.station_saved_at = Some(now);
                self.use_station(station);
                drop(demo);
                self.tell(Event::Saved(Ok(now)));
            }
            Err(text) => {
                if self.demo.is_some() {
                    // The demo continues without a claim.
                    self.station_claim = StationClaim::None;
                    let is_told = |kind: &AlarmKind| matches!(kind, AlarmKind::StationElsewhere(_));
                    self.alarms.clear(None, self.now, is_told);
                }
                tracing::error!("{text}");
                self.tell(Event::Saved(Err(text.clone())));
                self.alarms.raise(None, AlarmKind::Settings(text), now);
            }
        }
    }
}
