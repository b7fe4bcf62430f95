//! Replay of the record in the window, while the live station goes on.
//!
//! Invariant: a replay cannot reach a unit. A replay has its own model and views, and no handle on
//! a station. All commands of its views end here, except [`RoomEdge`], which holds no command to a
//! unit but STOP.

mod ending;
mod room;
#[cfg(test)]
mod tests;

use std::{path::PathBuf, sync::Arc};

use jiff::Timestamp;

use self::{
    ending::why_over,
    room::{Answer, FilmTarget, Found, Room, RoomRequest, Scene},
};
use super::{App, catalog_table::CatalogWork, effects::EffectsJobs};
use crate::{
    astro::time::add_seconds,
    clock::{Instant, Moment},
    contract::{
        Command, Snapshot,
        passes::{PredictedPass, Scope},
        recorded::RecordLook,
    },
    job::{Job, Wake},
    model::{
        Appearance, Model, UiCommand, View,
        replay::{
            JumpNews, ReplayCommand, ReplayEnd, ReplayProblem, Replayed, Stretch, StretchPass,
        },
    },
    record::Neighbour,
    station::AntennaId,
    ui,
};

/// Min step between two shown moments while a replay plays, seconds.
const STEP_S: f64 = 0.05;

impl App {
    /// Starts a replay of a stretch of the record at `time`.
    pub(super) fn begin_replay(&mut self, stretch: Stretch, time: Timestamp) {
        let Some(record) = &self.model.record else { return };
        let views = ui::Views::new(self.views.stored());
        let (path, wake) = (record.path.clone(), Arc::clone(&self.wake));
        self.model.replay_end = None;
        self.replay = Some(Replay::begin(path, stretch, time, &self.model, views, wake));
    }

    /// Shows the live station again, with the reason for leaving the replay.
    pub(super) fn leave_replay(&mut self, reason: Option<ReplayEnd>) {
        let Some(replay) = self.replay.take() else { return };
        replay.end();
        self.model.replay_end = reason;
    }

    pub(super) fn go_on_with_replay(&mut self) {
        let Some(replay) = &mut self.replay else { return };
        replay.think(self.model.steady);
        let reason = why_over(replay.begun_at, &self.model);
        if reason.is_some() {
            self.leave_replay(reason);
        }
    }

    /// Carries out a command of the replay's views in the replay, or the action that leads out of
    /// it.
    pub(super) fn carry_out_in_replay(&mut self, command: UiCommand, ctx: &egui::Context) {
        let Some(replay) = &mut self.replay else { return };
        match replay.carry_out(command) {
            None => {}
            Some(RoomEdge::Stop) => self.stop_all(),
            Some(RoomEdge::StopAntenna(antenna)) => self.stop_one(antenna),
            Some(RoomEdge::Leave) => self.leave_replay(None),
            Some(RoomEdge::Show(view)) => self.show_view(view),
            Some(RoomEdge::Appear(appearance)) => {
                replay.appear(appearance);
                self.change_appearance(appearance, ctx);
            }
        }
    }
}

/// Action that leads out of a replay.
pub(super) enum RoomEdge {
    /// STOP of all antennas of the live station.
    Stop,
    /// STOP of one antenna of the live station.
    StopAntenna(AntennaId),
    Leave,
    Show(View),
    Appear(Appearance),
}

/// Replay of a stretch of the record.
pub(super) struct Replay {
    model: Model,
    views: ui::Views,
    /// UTC of the live station when the replay began.
    begun_at: Timestamp,
    /// Reader of the film, while no job uses it.
    room: Option<Box<Room>>,
    /// Running job, which returns the reader unless the job breaks off.
    job: Option<Job<(Box<Room>, Answer)>>,
    /// The moment to show next.
    requested: Option<FilmTarget>,
    /// Pass whose antenna the replay selects once it knows the station of that time.
    unselected: Option<StretchPass>,
    /// Stretch whose passes the replay marks.
    marked: Option<Stretch>,
    /// Time at which the shown moment last moved on, by the clock of the window.
    moved_at: Instant,
    /// Part of the record that the replay shows.
    look: Option<RecordLook>,
    catalog_work: CatalogWork,
    effects_jobs: EffectsJobs,
    wake: Wake,
}

impl Replay {
    /// Starts a replay of the record at `path`, in the window that shows `live`.
    pub(super) fn begin(
        path: PathBuf,
        stretch: Stretch,
        time: Timestamp,
        live: &Model,
        views: ui::Views,
        wake: Wake,
    ) -> Self {
        let now = Moment { utc: time, steady: live.steady };
        let mut model = Model::before_anything(now);
        (model.view, model.appearance, model.list) = (live.view, live.appearance, live.list);
        // The film holds the elements of the favourites, so the list shows only their passes.
        model.list.scope = Scope::Favourites;
        model.selected_antenna = live.selected_antenna;
        let unselected = stretch.pass;
        model.replay = Some(Replayed::begin(stretch, time));
        Self {
            model,
            views,
            begun_at: live.now,
            room: Some(Box::new(Room::new(path))),
            job: None,
            requested: Some(FilmTarget::At(time)),
            unselected,
            marked: None,
            moved_at: live.steady,
            look: None,
            catalog_work: CatalogWork::default(),
            effects_jobs: EffectsJobs::default(),
            wake,
        }
    }

    pub(super) fn model(&self) -> &Model {
        &self.model
    }

    pub(super) fn plays(&self) -> bool {
        self.model.replay.as_ref().is_some_and(|replay| replay.plays)
    }

    /// Takes the results of the thread and moves on. `now` is the time of the window's clock.
    pub(super) fn think(&mut self, now: Instant) {
        self.take_answer();
        self.move_on(now);
        self.ask();
        self.effects_jobs.work(&mut self.model, &self.wake);
        self.catalog_work.work(&mut self.model, &self.wake);
        self.model.refresh_sky();
    }

    /// Ends the replay. A thread closes the file, because closing needs the disk.
    fn end(self) {
        if let Some(room) = self.room {
            drop(Job::start("azel-replay", self.wake, move |_| drop(room)));
        }
    }

    pub(super) fn show(&mut self, ui: &mut egui::Ui, live: &Model, commands: &mut Vec<UiCommand>) {
        self.views.show_replay(ui, live, &self.model, commands);
    }

    /// Carries out a command of the replay's views, or returns the action that leads out of the
    /// replay. Ignores all other commands.
    pub(super) fn carry_out(&mut self, command: UiCommand) -> Option<RoomEdge> {
        let model = &mut self.model;
        match command {
            UiCommand::Stop => return Some(RoomEdge::Stop),
            UiCommand::StopAntenna(antenna) => return Some(RoomEdge::StopAntenna(antenna)),
            UiCommand::LeaveReplay => return Some(RoomEdge::Leave),
            UiCommand::Replay(command) => self.change(command),
            // The set-up belongs to the live station.
            UiCommand::Show(View::Setup) => {}
            UiCommand::Show(view) => {
                model.view = view;
                return Some(RoomEdge::Show(view));
            }
            UiCommand::SetTheme(theme) => {
                let appearance = Appearance { theme, light_by_day: false, ..model.appearance };
                return Some(RoomEdge::Appear(appearance));
            }
            UiCommand::SetAppearance(appearance) => return Some(RoomEdge::Appear(appearance)),
            UiCommand::SelectPass(pass) => model.choose_pass(pass),
            UiCommand::SelectSatellite(number) => {
                if let Some(pass) = model.pass_of(number).map(PredictedPass::key) {
                    model.choose_pass(pass);
                }
            }
            UiCommand::SelectAntenna(index) => model.select_antenna(index),
            UiCommand::SetSpan(span_h) => model.list.set_span_h(span_h),
            UiCommand::ShowEffects(question) => model.obstacle_effects.ask(*question, model.steady),
            UiCommand::ShowTracked(question) => model.mount_effects.ask(*question, model.steady),
            UiCommand::ShowMoved(question) => model.site_effects.ask(*question, model.steady),
            UiCommand::ShowCatalog(question) => model.catalog_table.question = question,
            UiCommand::InspectObject(number) => model.catalog_table.inspected = Some(number),
            UiCommand::Station(Command::LookAtRecord(look)) => {
                if look.is_none() {
                    model.shown_mut().recorded = None;
                }
                self.look = look;
            }
            _ => {}
        }
        (self.wake)();
        None
    }

    pub(super) fn appear(&mut self, appearance: Appearance) {
        self.model.appearance = appearance;
    }

    fn change(&mut self, command: ReplayCommand) {
        let Some(replay) = &mut self.model.replay else { return };
        replay.news = None;
        if matches!(replay.problem, Some(ReplayProblem::NotRead(_))) {
            return;
        }
        match command {
            ReplayCommand::Pass { is_next } => {
                let pass = replay.stretch.pass.map(|pass| Neighbour::Pass(pass.id));
                let reference = pass.unwrap_or(Neighbour::Moment(replay.time));
                self.requested = Some(FilmTarget::Pass { reference, is_next });
            }
            ReplayCommand::PlayOrPause => {
                let is_forward = replay.speed > 0;
                if let Some(ReplayProblem::NoFilm { start: begin, end }) = replay.problem {
                    // Continue on the other side of the gap in the film.
                    self.requested = Some(FilmTarget::At(if is_forward { end } else { begin }));
                } else if !replay.plays && replay.is_at_end() {
                    let stretch = &replay.stretch;
                    let start = if replay.speed < 0 { stretch.end } else { stretch.start };
                    self.requested = Some(FilmTarget::At(start));
                }
                replay.plays = !replay.plays;
            }
            ReplayCommand::Speed(speed) => replay.speed = speed,
            ReplayCommand::Event { is_next } => {
                replay.plays = false;
                self.requested = Some(FilmTarget::Event { start: replay.time, is_next });
            }
            ReplayCommand::To(time) => {
                let time = time.clamp(replay.stretch.start, replay.stretch.end);
                self.requested = Some(FilmTarget::At(time));
            }
        }
    }

    fn take_answer(&mut self) {
        let Some(end) = Job::take(&mut self.job) else { return };
        let (room, Answer { found, recorded, passes }) = match end {
            Ok(end) => end,
            Err(broke_off) => return self.tell(ReplayProblem::NotRead(broke_off.to_string())),
        };
        self.room = Some(room);
        if recorded.is_some() {
            self.model.shown_mut().recorded = recorded.map(Arc::new);
        }
        if let Some(replay) = &mut self.model.replay
            && let Some((stretch, passes)) = passes
            && replay.stretch == stretch
        {
            replay.passes = passes;
        }
        match found {
            None => {}
            Some(Ok(found)) => self.take_moment(found),
            Some(Err(news)) => {
                if let Some(replay) = &mut self.model.replay {
                    replay.news = Some(news);
                }
            }
        }
    }

    fn take_moment(&mut self, Found { time, stretch, hole, skipped, scene }: Found) {
        if let Some(stretch) = &stretch {
            self.model.drop_choice();
            self.unselected = stretch.pass;
        }
        if let Some(replay) = &mut self.model.replay {
            replay.time = time;
            replay.stretch = stretch.unwrap_or_else(|| replay.stretch.clone().around_time(time));
            let skipped = skipped.map(|(start, end)| JumpNews::Skipped { start, end });
            replay.news = skipped.or(replay.news.take());
            replay.problem = None;
        }
        match scene {
            Ok(Some(scene)) => {
                self.take_scene(time, scene);
                if let Some((start, end)) = hole {
                    self.tell(ReplayProblem::NoFilm { start, end });
                }
            }
            Ok(None) => {
                // Clear the scene: state of another moment must not appear under this time.
                let moment = Moment { utc: time, steady: self.model.steady };
                self.take_scene(
                    time,
                    Scene { shown: Snapshot::before_anything(moment), wires: Vec::new() },
                );
                self.tell(match hole {
                    Some((start, end)) => ReplayProblem::NoFilm { start, end },
                    None => ReplayProblem::NothingYet,
                });
            }
            Err(error) => self.tell(ReplayProblem::Failed(error.to_string())),
        }
    }

    fn take_scene(&mut self, time: Timestamp, Scene { mut shown, wires }: Scene) {
        let model = &mut self.model;
        // The replay reads the record separately, and only the live station can close.
        (shown.recorded, shown.closing) = (model.recorded.clone(), None);
        // Show ages relative to `time`.
        let passed = time.duration_since(shown.moment.utc).try_into().unwrap_or_default();
        (model.now, model.steady) = (time, shown.moment.steady + passed);
        model.take(Arc::new(shown), |antenna| {
            wires
                .iter()
                .find(|(antenna_id, _)| *antenna_id == antenna)
                .map(|(_, wire)| wire.clone())
        });
        if !model.antennas.is_empty()
            && let Some(pass) = self.unselected.take()
        {
            model.selected_antenna = model.place(pass.antenna).unwrap_or(model.selected_antenna);
            if let Some(pass) = model.pass_of(pass.satellite).map(PredictedPass::key) {
                model.choose_pass(pass);
            }
        }
        model.follow_antenna();
    }

    fn tell(&mut self, problem: ReplayProblem) {
        if let Some(replay) = &mut self.model.replay {
            replay.problem = Some(problem);
            replay.plays = false;
        }
    }

    fn move_on(&mut self, now: Instant) {
        let passed_s = now.saturating_duration_since(self.moved_at).as_secs_f64();
        let Some(replay) = &mut self.model.replay else { return };
        if !replay.plays || self.requested.is_some() {
            self.moved_at = now;
            return;
        }
        if passed_s < STEP_S || self.room.is_none() {
            return;
        }
        self.moved_at = now;
        if replay.is_at_end() {
            replay.plays = false;
            return;
        }
        let time = add_seconds(replay.time, passed_s * f64::from(replay.speed));
        let time = time.clamp(replay.stretch.start, replay.stretch.end);
        self.requested = Some(FilmTarget::At(time));
    }

    /// Starts to read the requested parts, unless a read is running.
    fn ask(&mut self) {
        let is_read = |record_look: &RecordLook| {
            self.model.recorded.as_ref().is_some_and(|recorded| recorded.look == *record_look)
        };
        let look = self.look.as_ref().filter(|look| !is_read(look)).cloned();
        let stretch = self.model.replay.as_ref().map(|replay| &replay.stretch);
        let unmarked = stretch.filter(|stretch| self.marked.as_ref() != Some(stretch)).cloned();
        if self.requested.is_none() && look.is_none() && unmarked.is_none() {
            return;
        }
        let Some(mut room) = self.room.take() else { return };
        self.marked = unmarked.clone().or(self.marked.take());
        let request = RoomRequest { target: self.requested.take(), look, unmarked };
        let site = self.model.station.site;
        self.job = Some(Job::start("azel-replay", Arc::clone(&self.wake), move |_| {
            let answer = room.answer(request, site);
            (room, answer)
        }));
    }
}
