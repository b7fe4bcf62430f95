//! The session of one antenna: keeps its link, polls its controller, carries out the intent
//! and stops what has to be stopped. It lives on the driver's thread and needs neither window
//! nor frames.

mod activity;
mod auto_track;
mod clocks;
mod command;
mod effect;
mod guard;
mod hands;
mod inside;
mod io_loop;
mod jog;
mod judging;
mod likeness;
mod liveness;
mod lock_out;
mod marking;
mod monitor;
mod off_target;
mod offsets;
mod on_board;
mod on_board_track;
mod pointing;
mod program_track;
mod shutdown;
mod silence;
mod standstill;
mod step;
mod stop;
mod supervise;
#[cfg(test)]
pub(super) mod testing;
mod tracking;
mod unit_offsets;
mod unproved;
mod wanted;
mod write_settings;

use std::{
    path::PathBuf,
    sync::{Arc, atomic::Ordering},
    time::Duration,
};

use tokio::sync::{Mutex as AsyncMutex, Notify, mpsc, watch};

use super::{
    AntennaHandle, COMMANDS, Clock, Dial, EVENTS, Numbered, Orbits, Orders, PositionLog, Stopper,
    Wake, before_sleep::Awake, debts::Debts, gate::Gate,
};
use crate::{
    clock::{Instant, Moment},
    contract::driver::{
        AxisLessons, Event, LeftMoving, LinkState, Preview, Snapshot, Unit, WireLog,
    },
    device::{AxisMotion, Controller, Pointing, Variant},
    plan::{Bounds, on_board::Ability},
    station::{Antenna, LockOut, Monitor},
};
use activity::Activity;
use clocks::Clocks;
use effect::Effects;
use guard::Guard;
pub(super) use io_loop::{CONNECT, MIN_WAIT, WRITE, in_words};
use jog::JogKey;
pub use jog::LEASE as JOG_LEASE;
use judging::Judging;
use likeness::{Likeness, Recheck};
use lock_out::Locking;
use marking::Marking;
use monitor::{Overrun, Watch};
use program_track::ResumeRule;
use silence::Silence;
use standstill::Rest;
use step::Stepping;
use stop::Stop;
use supervise::{CHECKS, Check, Doubt};
use tracking::{TrackConfig, Tracking};
use unit_offsets::UnitOffsets;
use wanted::Wanted;

/// The session's ends of the channels to the station. A session that breaks down leaves them
/// to the next one.
#[derive(Clone)]
pub struct Wires {
    /// Locked by the running session.
    commands: Arc<AsyncMutex<mpsc::Receiver<Numbered>>>,
    stopper: Stopper,
    before_sleep: Option<Arc<AsyncMutex<mpsc::Receiver<Awake>>>>,
    snapshots: watch::Sender<Arc<Snapshot>>,
    events: mpsc::Sender<Event>,
    wake: Wake,
    wire_log: WireLog,
    positions: PositionLog,
    orbit: Orbits,
    bounds: watch::Receiver<Bounds>,
}

impl Wires {
    /// Creates both ends of one antenna's channels.
    pub(super) fn new(
        antenna: &Antenna,
        bounds: Bounds,
        now: Instant,
        wake: Wake,
        orders: &Orders,
    ) -> (Self, AntennaHandle) {
        let (send_command, commands) = mpsc::channel(COMMANDS);
        let (events, read_events) = mpsc::channel(EVENTS);
        let (_, link) = first_link(antenna, now);
        let first = Arc::new(Snapshot::before_anything(link));
        let (snapshots, read_snapshots) = watch::channel(first);
        let stopper = Stopper {
            stop: Arc::new(Notify::new()),
            void: Arc::default(),
            orders: orders.clone(),
            snapshots: read_snapshots,
        };
        let (wire_log, orbit) = (WireLog::default(), Orbits::default());
        let positions = PositionLog::default();
        let (keep_within, bounds) = watch::channel(bounds);
        let wires = Self {
            commands: Arc::new(AsyncMutex::new(commands)),
            stopper: stopper.clone(),
            before_sleep: None,
            snapshots,
            events,
            wake,
            wire_log: wire_log.clone(),
            positions: positions.clone(),
            orbit: Arc::clone(&orbit),
            bounds,
        };
        let handle = AntennaHandle {
            commands: send_command,
            stopper,
            orders: orders.clone(),
            events: read_events,
            wire: wire_log,
            positions,
            orbit,
            bounds: keep_within,
        };
        (wires, handle)
    }

    /// The handle of an antenna that no session drives: it takes nothing.
    pub(super) fn closed(antenna: &Antenna, now: Instant) -> AntennaHandle {
        let bounds = Bounds::of_antenna(antenna);
        let (wires, handle) = Self::new(antenna, bounds, now, Arc::new(|| {}), &Orders::default());
        let off = Snapshot::before_anything(LinkState::Off);
        wires.snapshots.send_replace(Arc::new(off));
        handle
    }

    /// With a channel that tells before this computer sleeps.
    pub(super) fn hearing(mut self, before_sleep: mpsc::Receiver<Awake>) -> Self {
        self.before_sleep = Some(Arc::new(AsyncMutex::new(before_sleep)));
        self
    }

    /// Fills in the first snapshot, before the session runs: what was learned of the axes before,
    /// and the lock-out of the unit.
    pub(super) fn begin_with(&self, learned: [AxisLessons; 2], lock_out: Option<LockOut>) {
        self.snapshots.send_modify(|first| {
            let first = Arc::make_mut(first);
            first.learned = learned;
            first.locking = lock_out.is_some();
            first.lock_out = lock_out;
        });
    }

    /// The lock-out that was shown last.
    pub(super) fn shown_lock_out(&self) -> Option<LockOut> {
        self.snapshots.borrow().lock_out.clone()
    }

    /// Sends a STOP ahead of the next command.
    pub(super) fn stop(&self) {
        self.stopper.stop();
    }

    /// The newest request that a STOP has voided.
    pub(super) fn newest_void(&self) -> u64 {
        self.stopper.void.load(Ordering::SeqCst)
    }

    /// Waits for a STOP that has voided a newer request than `void`.
    pub(super) async fn stopped_after(&self, void: u64) {
        while self.newest_void() <= void {
            self.stopper.stop.notified().await;
        }
    }

    /// Sends an event to the station.
    pub(super) fn tell(&self, event: Event) {
        if let Err(error) = self.events.try_send(event) {
            tracing::warn!(%error, "nobody reads the events; one was dropped");
        }
        (self.wake)();
    }

    fn stop_handle(&self) -> Arc<Notify> {
        Arc::clone(&self.stopper.stop)
    }
}

/// Returns the link that a new session wants, and the link state to show first.
fn first_link(antenna: &Antenna, since: Instant) -> (Wanted, LinkState) {
    let waits = antenna.connection.variant().capabilities.waits_for_word;
    if waits && !antenna.connects_at_start {
        return (Wanted::No, LinkState::Off);
    }
    (Wanted::Yes, LinkState::Connecting { since })
}

/// The antenna's settings.
struct Setup {
    park: Pointing,
    track_config: TrackConfig,
    /// Limits for judging a pass that the unit tracks on its own.
    ability: Ability,
    /// When program track resumes without a question.
    rule: ResumeRule,
    /// The sway that the operator allows, degrees.
    sway_deg: f64,
    /// Response to somebody else driving the antenna into a keep-out or near the Sun.
    monitor: Monitor,
}

/// State of the link, and what is remembered while there is none.
struct Contact {
    wanted: Wanted,
    link: LinkState,
    silence: Silence,
    /// The clocks at the last comparison.
    clocks: Option<Clocks>,
    /// How long the computer has slept since the link was last up.
    slept: Duration,
    /// Looks of the unit when it was last read over the previous link.
    left_as: Likeness,
    /// The unit must still prove to be as before; a program track keeps this itself.
    recheck: Option<Recheck>,
    /// When a link that had been up was lost.
    away_since: Option<Instant>,
    /// The operator has been told of the lost link.
    loss_is_told: bool,
    /// The unit has not been read on this link yet.
    unread: bool,
    /// The unit's own program was on at the last reading.
    program_was_on: bool,
}

/// Debts to the unit, also from other sessions and earlier runs.
struct Owed {
    unit: Unit,
    debts: Debts,
    /// When the unit was last told on this link to switch auto-track off.
    auto_track_told: Option<Instant>,
    /// The operator knows that the unit does not switch it off.
    auto_stays_told: bool,
    /// Tells the sessions of one unit apart.
    number: u64,
    /// Since when a record is kept that the unit was moved and has not been proved to stand.
    kept_unproved: Option<Instant>,
    marking: Marking,
    /// An earlier run may have left the unit moving, since then; the operator is being asked.
    left_moving: Option<LeftMoving>,
}

/// State at the last look, for comparison with the next one.
#[derive(Default)]
struct LastSeen {
    watch: Watch,
    place: inside::Place,
    overrun: Overrun,
    rest: Rest,
    effects: Effects,
    /// When the last position that was judged came in.
    looked: Option<Instant>,
}

pub struct Session {
    name: String,
    variant: &'static Variant,
    setup: Setup,
    gate: Gate,
    dial: Dial,
    clock: Clock,
    wires: Wires,
    contact: Contact,
    owed: Owed,
    seen: LastSeen,
    activity: Activity,
    /// Watch over a track that nobody asked for from here.
    unasked: Option<on_board::Watch>,
    judging: Judging,
    /// Checks that [`Session::supervise`] carries out.
    checks: &'static [Check],
    key: JogKey,
    guard: Guard,
    /// Delays the computer's sleep while a motion is out that only STOP ends.
    awake: Option<Awake>,
    /// An action of the make was requested from here, and standstill has not been proved
    /// since.
    acts: bool,
    /// A step that may not be over yet.
    stepping: Option<Stepping>,
    /// The direction that the operator looks at.
    previewed: Option<Pointing>,
    stop: Stop,
    /// Progress of a lock-out.
    locking: Option<Locking>,
    /// A motion whose answer was lost.
    doubt: Option<Doubt>,
    /// Offsets added to the track that the unit computes.
    unit_offsets: UnitOffsets,
    /// Bytes of a halt, to be written before anything else.
    stop_bytes: Vec<u8>,
}

impl Session {
    /// Creates a session of `antenna` that records owed STOPs in `debts`, and the handle to it.
    /// Nothing happens before [`Self::run`].
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
        (Self::over(controller, antenna, dial, clock, wires, debts), handle)
    }

    /// Creates a session of `antenna` on these channels, which records owed STOPs in `debts`.
    pub(super) fn over(
        controller: Box<dyn Controller>,
        antenna: &Antenna,
        dial: Dial,
        clock: Clock,
        mut wires: Wires,
        debts: Debts,
    ) -> Self {
        let bounds = wires.bounds.borrow_and_update().clone();
        // Also that of a session that broke down.
        let learned = wires.snapshots.borrow().learned;
        let mut gate = Gate::new(controller, antenna, bounds, &learned);
        let variant = antenna.connection.variant();
        let (wanted, link) = first_link(antenna, clock.now().steady);
        let unit = Unit::of(antenna);
        let number = debts.begin(&unit, wires.stop_handle());
        gate.was_moved(debts.unproved_since(&unit));
        let can = variant.capabilities;
        Self {
            name: antenna.name.clone(),
            variant,
            setup: Setup {
                park: antenna.park_direction().into(),
                track_config: TrackConfig::of(antenna, can),
                ability: Ability::of(antenna),
                rule: ResumeRule::of(antenna),
                sway_deg: antenna.sway_deg,
                monitor: antenna.monitor,
            },
            dial,
            clock,
            wires,
            contact: Contact {
                wanted,
                link,
                silence: Silence::default(),
                clocks: None,
                slept: Duration::ZERO,
                left_as: Likeness::default(),
                recheck: None,
                away_since: None,
                loss_is_told: false,
                unread: true,
                program_was_on: false,
            },
            owed: Owed {
                unit,
                debts,
                auto_track_told: None,
                auto_stays_told: false,
                number,
                kept_unproved: gate.unproved_since(),
                marking: Marking::None,
                left_moving: None,
            },
            seen: LastSeen::default(),
            gate,
            activity: Activity::Standby,
            unasked: None,
            judging: Judging::default(),
            checks: CHECKS,
            key: JogKey::Up,
            guard: Guard::new(None),
            awake: None,
            acts: false,
            stepping: None,
            previewed: None,
            stop: Stop::Ready,
            locking: None,
            doubt: None,
            unit_offsets: UnitOffsets::default(),
            stop_bytes: Vec::new(),
        }
    }

    /// With `program` as the dead-man of motions by hand.
    #[must_use]
    pub fn guarded_by(self, program: PathBuf) -> Self {
        Self { guard: Guard::new(Some(program)), ..self }
    }

    fn tell(&self, event: Event) {
        tracing::info!(antenna = self.name, ?event, "event");
        self.wires.tell(event);
    }

    /// Publishes a snapshot if anything in it has changed.
    fn publish(&mut self, now: Moment) {
        self.keep_unproved();
        let snapshot = Snapshot {
            link: self.contact.link.clone(),
            silent: self.is_silent(),
            intent: self.activity.intent(),
            pending: self.activity.is_pending(),
            being_judged: self.judging.is_under_way(),
            being_compared: self.recheck().is_some(),
            aim: self.activity.aim(),
            target: self.activity.on_board().map(|track| track.target.clone()),
            on_board: self.on_board_watch().map(on_board::Watch::view),
            program_track: self.activity.last_program().map(Tracking::view),
            unit_offsets: self.unit_offsets_view(),
            rates_deg_s: Some(self.setup.track_config.rates_deg_s()),
            unproved: self.is_unproved(),
            lock_out: self.gate.lock_out().cloned(),
            locking: self.is_being_locked_out(),
            stop: self.stop.shown(now.steady),
            runs_out: self.stop.is_under_way(),
            unguarded: self.guard.is_missing,
            inside: self.inside(now),
            sun_lifted: self.activity.program().is_some() && self.gate.lifts_sun(),
            left_moving: self.owed.left_moving,
            not_on_disk: self.not_on_disk(now),
            jog: self.key.started().map(|jog| jog.rates_deg_s),
            stopping_way: self.stopping_way(),
            learned: self.gate.lessons(),
            step: self.stepping.map(|stepping| stepping.steps_deg),
            preview: self.preview(now),
            state: self.gate.state().clone(),
            poll_period: self.gate.device().poll_period(),
        };
        let mut worth_a_look = false;
        self.wires.snapshots.send_if_modified(|held| {
            let changed = **held != snapshot;
            if changed {
                worth_a_look = !held.shows_the_same(&snapshot);
                *held = Arc::new(snapshot);
            }
            changed
        });
        if worth_a_look {
            (self.wires.wake)();
        }
    }

    /// The way to the direction that the operator looks at.
    fn preview(&self, now: Moment) -> Option<Arc<Preview>> {
        let to = self.previewed?;
        Some(Arc::new(Preview { to, way: self.gate.way_to(to, now) }))
    }

    /// Passes what went over the link on to the wire log, and the position on to its log.
    fn record(&mut self) {
        if let Some(measured) = self.gate.state().measured {
            self.wires.positions.push(measured);
        }
        self.gate.remember_angles();
        let mut is_awaited = false;
        while let Some(line) = self.gate.device().next_wire_line() {
            is_awaited |= self.wires.wire_log.push(line);
        }
        if is_awaited {
            (self.wires.wake)();
        }
    }

    fn now(&self) -> Moment {
        self.clock.now()
    }

    /// Age of the last measured position.
    fn position_age(&self, now: Moment) -> Option<Duration> {
        let measured = self.gate.state().measured?;
        Some(now.steady.saturating_duration_since(measured.asked))
    }

    /// Returns `true` if the antenna turns; what else the unit moves does not count.
    fn turns(&self) -> bool {
        let count = self.variant.capabilities.axis_count();
        let axes = self.gate.state().measured.into_iter().flat_map(|measured| measured.axes);
        axes.take(count).any(|axis| axis.motion != AxisMotion::Still)
    }

    /// Returns `true` if the antenna moves, or a motion has been sent or queued.
    fn may_move(&mut self) -> bool {
        self.turns()
            || self.gate.state().program.is_some_and(|program| program.enabled)
            || self.activity.may_move()
            || (self.contact.unread && self.gate.unproved_since().is_some())
            || self.key.held().is_some()
            || self.stepping.is_some()
            || self.gate.device().motion_under_way()
    }

    /// Returns `true` if the unit was last seen moving anything, or about to.
    fn active(&self) -> bool {
        let state = self.gate.state();
        state.measured.is_some_and(|measured| measured.moving())
            || state.program.is_some_and(|program| program.enabled)
    }
}
