//! Session of one antenna: keeps its link, polls its controller, executes the intent and stops
//! motions. A session runs on the driver thread and needs no window.

mod activity;
mod auto_track;
mod bounds_watch;
mod clocks;
mod command;
mod commanded;
mod contact;
mod dead_man_watch;
mod effect;
mod effect_watch;
mod guard;
mod halt;
mod hands;
mod io_loop;
mod jog;
mod jog_key;
mod judged_commands;
mod judging;
mod likeness;
mod lock_out;
mod locking;
mod marking;
mod monitor;
mod observed;
mod off_target;
mod offsets;
mod on_board;
mod on_board_track;
mod overrun;
mod owed;
mod owed_stop;
mod place;
mod pointing;
mod program_track;
mod recheck;
mod release;
mod setup;
mod shutdown;
mod silence;
mod sleep;
mod standstill;
mod step;
mod stop;
mod supervise;
#[cfg(test)]
pub(super) mod testing;
mod tracking;
mod unanswered;
mod unit_debts;
mod unit_offsets;
mod unproved;
mod way_out;
mod wires;
mod write_settings;

use std::{path::PathBuf, sync::Arc, time::Duration};

use super::{AntennaHandle, Clock, Dial, Orders, Wake, debts::Debts, gate::Gate};
use crate::{
    clock::Moment,
    contract::{
        control::Answer,
        driver::{Event, Preview, Snapshot, Unit},
    },
    device::{AxisMotion, Controller},
    plan::Bounds,
    station::Antenna,
};
use commanded::Commanded;
use contact::{Contact, PollPace};
use guard::Guard;
pub(super) use io_loop::{CONNECT, MIN_WAIT, WRITE, error_text};
pub use jog::LEASE as JOG_LEASE;
use jog_key::Jog;
use judging::Judging;
use observed::Observed;
use owed::Owed;
use setup::Setup;
use standstill::Figures;
use stop::Stop;
use supervise::{CHECKS, Check};
use tracking::Tracking;
use unit_offsets::Shifting;
pub use wires::Wires;

pub struct Session {
    setup: Setup,
    gate: Gate,
    clock: Clock,
    wires: Wires,
    contact: Contact,
    owed: Owed,
    commanded: Commanded,
    observed: Observed,
    judging: Judging,
    /// List of the checks that [`Session::supervise`] runs.
    checks: &'static [Check],
    stop: Stop,
    /// Offsets added to the unit's own track.
    unit_offsets: Shifting,
    /// Answer to the last command with a waiting sender.
    answer: Option<Answer>,
}

impl Session {
    /// Creates a session of `antenna` that records owed STOPs in `debts`, and its handle. The
    /// session does nothing before [`Self::run`].
    pub fn new(
        controller: Box<dyn Controller>,
        antenna: &Antenna,
        dial: Dial,
        clock: Clock,
        wake: Wake,
        debts: Debts,
    ) -> (Self, AntennaHandle) {
        let bounds = Bounds::of_antenna(antenna);
        let now = clock.now().steady;
        let (wires, handle) = Wires::new(antenna, bounds, now, wake, &Orders::default());
        (Self::with_wires(controller, antenna, dial, clock, wires, debts), handle)
    }

    /// Creates a session of `antenna` on these channels, which records owed STOPs in `debts`.
    pub(super) fn with_wires(
        controller: Box<dyn Controller>,
        antenna: &Antenna,
        dial: Dial,
        clock: Clock,
        mut wires: Wires,
        debts: Debts,
    ) -> Self {
        let (bounds, learned) = (wires.first_bounds(), wires.learned());
        let mut gate = Gate::new(controller, antenna, bounds, &learned);
        let contact = Contact::new(antenna, dial, clock.now().steady);
        let owed = Owed::begin(debts, Unit::new(antenna), wires.stop_handle());
        gate.note_earlier_motion(owed.debts().unproved_since());
        Self {
            setup: Setup::new(antenna),
            clock,
            wires,
            contact,
            owed,
            commanded: Commanded::new(),
            observed: Observed::default(),
            gate,
            judging: Judging::default(),
            checks: CHECKS,
            stop: Stop::new(Guard::new(None)),
            unit_offsets: Shifting::default(),
            answer: None,
        }
    }

    /// Sets `program` as the dead-man of manual motions.
    #[must_use]
    pub fn with_dead_man(self, program: PathBuf) -> Self {
        Self { stop: Stop::new(Guard::new(Some(program))), ..self }
    }

    fn tell(&self, event: Event) {
        tracing::info!(antenna = self.setup.name(), ?event, "event");
        self.wires.tell(event);
    }

    fn publish(&mut self, now: Moment) {
        // After a breakdown, the unit's next session must know that the antenna may turn.
        self.owed.keep_unproved(self.gate.unproved_since());
        let (is_pressed, axes) = (self.stop.is_pressed(), self.setup.can().axes);
        let snapshot = Snapshot {
            link: self.contact.link().clone(),
            silent: self.contact.silence.is_reported(),
            intent: self.commanded.activity.intent(),
            pending: self.commanded.activity.is_pending(),
            being_judged: self.judging.is_under_way(),
            being_compared: self.recheck().is_some(),
            aim: self.commanded.activity.aim(),
            target: self.commanded.activity.on_board().map(|track| track.target.clone()),
            on_board: self.on_board_watch().map(on_board::OnBoardWatch::view),
            program_track: self.commanded.activity.last_program().map(Tracking::view),
            unit_offsets: self.unit_offsets_view(),
            rates_deg_s: Some(self.setup.track_config().rates_deg_s()),
            unproved: self.is_unproved(),
            lock_out: self.gate.lock_out().cloned(),
            locking: self.is_being_locked_out(),
            stop: self.stop.state(now.steady),
            stop_written: self.stop.written(),
            runs_out: self.stop.is_under_way(),
            unguarded: self.stop.guard.is_missing(),
            breach: self.observed.place.view(&axes, self.gate.permits_exit(now)),
            sun_lifted: self.commanded.activity.program().is_some() && self.gate.lifts_sun(),
            left_moving: self.owed.left_moving(),
            not_on_disk: is_pressed.then(|| self.owed.not_on_disk(now.steady)).flatten(),
            answer: self.answer.clone(),
            jog: self.commanded.key.started().map(Jog::rates_deg_s),
            stopping_way: self.observed.overrun.stopping_way(self.gate.overrun_s()),
            learned: self.gate.lessons(),
            step: self.commanded.steps_deg(),
            preview: self.preview(now),
            state: self.gate.state().clone(),
            poll_period: self.gate.device().poll_period(),
        };
        self.wires.publish(snapshot);
    }

    /// Returns the path to the direction that the operator previews.
    fn preview(&self, now: Moment) -> Option<Arc<Preview>> {
        let target = self.commanded.preview?;
        Some(Arc::new(Preview { target, way: self.gate.way_to(target, now) }))
    }

    /// Copies the link traffic to the wire log, and the position to its log.
    fn record(&mut self) {
        if let Some(measured) = self.gate.state().measured {
            self.wires.log_position(measured);
        }
        self.gate.remember_angles();
        let device = self.gate.device();
        self.wires.log_lines(std::iter::from_fn(|| device.next_wire_line()));
    }

    fn figures(&self) -> Figures {
        self.setup.figures(self.gate.measured_sway_deg())
    }

    fn alarm_figures(&self) -> Figures {
        self.setup.alarm_figures(self.gate.measured_sway_deg())
    }

    fn pace(&mut self) -> PollPace {
        let device = self.gate.device();
        PollPace { poll_period: device.poll_period(), patience: device.patience() }
    }

    fn now(&self) -> Moment {
        self.clock.now()
    }

    /// Returns the age of the last measured position.
    fn position_age(&self, now: Moment) -> Option<Duration> {
        let measured = self.gate.state().measured?;
        Some(now.steady.saturating_duration_since(measured.requested))
    }

    /// Returns `true` if the antenna turns; ignores other motions of the unit.
    fn is_turning(&self) -> bool {
        let count = self.setup.can().axis_count();
        let axes = self.gate.state().measured.into_iter().flat_map(|measured| measured.axes);
        axes.take(count).any(|axis| axis.motion != AxisMotion::Still)
    }

    /// Returns `true` if the antenna moves, or a motion has been sent or queued.
    fn may_move(&mut self) -> bool {
        self.is_turning()
            || self.gate.state().program.is_some_and(|program| program.enabled)
            || self.commanded.may_move()
            // The last motion may continue until Azel has read the unit on the new link.
            || (self.contact.is_unread() && self.gate.unproved_since().is_some())
            || self.gate.device().motion_under_way()
    }

    /// Returns `true` if the last reading showed a present or imminent motion of the unit.
    fn is_active(&self) -> bool {
        let state = self.gate.state();
        state.measured.is_some_and(|measured| measured.moving())
            || state.program.is_some_and(|program| program.enabled)
    }
}
