//! Tests of the rules: each rule refuses and allows.

mod any;
mod detours;
mod each_rule;
mod makes;
mod pointing;

use std::{
    sync::{Arc, LazyLock, Mutex},
    time::Duration,
};

use jiff::Timestamp;

use super::*;
use crate::{
    astro::{AzEl, Site, time::add_seconds},
    device::{
        Axis, AxisMotion, ControllerEvent, Drive, Extent, Measured, TrackTarget,
        panel::Lead,
        settings::{Change, Values},
    },
    orbit::{PassSearch, Propagator, passes},
    plan::{OnBoardPass, on_board::Ability},
    station::{KeepOut, Station, SunAvoidance, Unread},
};

/// Fake controller that records the started motions.
struct Metal {
    state: AntennaState,
    started: Arc<Mutex<Vec<Motion>>>,
    objection: Option<&'static str>,
    leads_to: Lead,
}

impl Metal {
    fn new(case: &Case, started: Arc<Mutex<Vec<Motion>>>) -> Self {
        Self {
            state: case.state.clone(),
            started,
            objection: case.objection,
            leads_to: case.leads_to,
        }
    }
}

impl Device for Metal {
    fn link_up(&mut self, _: Moment) {}
    fn receive(&mut self, _: &[u8], _: Moment) {}

    fn poll(&mut self, _: Moment) -> Option<Vec<u8>> {
        None
    }
    fn due(&self, now: Moment) -> Instant {
        now.steady
    }
    fn halt(&mut self, _: Extent, _: Moment) -> Vec<u8> {
        Vec::new()
    }
    fn watch_closely(&mut self, _: bool) {}
    fn motion_under_way(&self) -> bool {
        false
    }
    fn next_event(&mut self) -> Option<ControllerEvent> {
        None
    }

    fn state(&self) -> &AntennaState {
        &self.state
    }

    fn poll_period(&self) -> Duration {
        Duration::ZERO
    }
}

impl Controller for Metal {
    fn objection(&self, _: &MotionRequest, _: Moment) -> Option<&'static str> {
        self.objection
    }

    fn lead_of(&self, _: &Act) -> Lead {
        self.leads_to
    }

    fn start(&mut self, motion: Motion) {
        self.started.lock().unwrap().push(motion);
    }
}

/// Pass that stays within the limits of the test antenna.
static PROGRAM: LazyLock<Arc<Judge>> = LazyLock::new(|| {
    let catalog = crate::orbit::bundled().unwrap();
    let elements = catalog.get(25_544).unwrap().clone();
    let (site, start) = (Site::default(), "2026-08-12T00:00:00Z".parse().unwrap());
    let aos_elevation = Angle::from_degrees(10.0);
    let search =
        PassSearch { aos_elevation, ..PassSearch::new(site, start, add_seconds(start, 86_400.0)) };
    let propagator = Propagator::new(&elements).unwrap();
    let pass = passes(&propagator, &search, &|| false)[0];
    let target = TrackTarget {
        catalog_number: 25_544,
        name: "ISS".to_owned(),
        element_file: None,
        start: pass.aos.time,
        end: pass.los.time,
    };
    let pass = OnBoardPass { target, elements, site, is_agreed: false };
    Arc::new(Judge::new(pass, Ability::from_antenna(&Antenna::satrak("Dish", ""))).unwrap())
});

/// Situation in which a test asks the gate.
struct Case {
    state: AntennaState,
    intent: Intent,
    stopping: bool,
    age: Duration,
    antenna: Antenna,
    keep_outs: Vec<KeepOut>,
    unread: Vec<Unread>,
    /// `true` if the unit's program starts on [`PROGRAM`].
    pass_is_known: bool,
    /// Pass that the unit would track on its own.
    next_pass: NextPass,
    lock_out: Option<LockOut>,
    /// Objection of the controller to any motion.
    objection: Option<&'static str>,
    /// Lead of every action.
    leads_to: Lead,
}

impl Case {
    fn new(intent: Intent) -> Self {
        let axis = Axis {
            angle_deg: Some(90.0),
            motion: AxisMotion::Still,
            drive: Drive::Off,
            plus_limit: false,
            minus_limit: false,
        };
        let now = Instant::now();
        let measured = Measured {
            time: Timestamp::UNIX_EPOCH,
            requested: now,
            received: now,
            pointing: AzEl::from_degrees(80.0, 45.0).into(),
            axes: [axis; 2],
        };
        Self {
            state: AntennaState {
                measured: Some(measured),
                motion_lock: Some(false),
                link_since: Some(now),
                ..AntennaState::default()
            },
            intent,
            stopping: false,
            age: Duration::from_millis(100),
            antenna: Antenna::satrak("Dish", ""),
            keep_outs: Vec::new(),
            unread: Vec::new(),
            pass_is_known: true,
            next_pass: NextPass::Nothing,
            lock_out: None,
            objection: None,
            leads_to: Lead::Nowhere,
        }
    }

    fn axes(&mut self) -> &mut [Axis; 2] {
        &mut self.state.measured.as_mut().unwrap().axes
    }

    /// Returns the gate's answer; checks that only an allowed motion starts.
    fn ask(&self, motion: Motion) -> Result<(), Refusal> {
        let started = Arc::default();
        let mut gate = self.gate(&started);
        let answer = gate.start(motion, self.intent, self.stopping, self.now());
        assert_eq!(started.lock().unwrap().len(), usize::from(answer.is_ok()));
        answer
    }

    /// Returns the gate's answer to an action for which the operator takes responsibility.
    fn act(&self, action: &'static str) -> Result<(), Refusal> {
        let act = Act { action, values: Values::new() };
        let mut gate = self.gate(&Arc::default());
        gate.act(act, true, self.intent, self.stopping, self.now()).map(drop)
    }

    fn gate(&self, started: &Arc<Mutex<Vec<Motion>>>) -> Gate {
        let metal = Metal::new(self, Arc::clone(started));
        let station = Station {
            keep_outs: self.keep_outs.clone(),
            unread: self.unread.clone(),
            ..Station::default()
        };
        let bounds = Bounds::new(&station, &self.antenna);
        let mut gate = Gate::new(Box::new(metal), &self.antenna, bounds, &Default::default());
        gate.next_pass = self.next_pass.clone();
        gate.program = self.pass_is_known.then(|| Arc::clone(&PROGRAM));
        gate.set_lock_out(self.lock_out.clone());
        judge(&mut gate);
        gate
    }

    fn now(&self) -> Moment {
        let received = self.state.measured.map_or_else(Instant::now, |read| read.received);
        Moment { steady: received + self.age, utc: Timestamp::UNIX_EPOCH }
    }
}

/// Judges the path of the pass, like the worker.
fn judge(gate: &mut Gate) {
    let unit = gate.state().on_board.clone();
    let Some(program) = gate.program.clone() else { return };
    let open = gate.open_questions(&program, &[unit]);
    let judged = open.into_iter().map(|question| {
        let verdict = question.judge();
        (question, verdict)
    });
    gate.take_judgements(judged.collect());
}

#[test]
fn a_path_has_to_be_judged_by_what_the_unit_reports_now_and_within_the_present_bounds() {
    let case = Case::new(Intent::Track);
    let mut gate = case.gate(&Arc::default());
    let start =
        |gate: &mut Gate| gate.start(Motion::StartProgram, Intent::Track, false, case.now());
    let bounds = Bounds::new(
        &Station {
            sun_avoidance: Some(SunAvoidance { radius_deg: 5.0, ahead_min: 0.0 }),
            ..Station::default()
        },
        &case.antenna,
    );
    gate.keep_within(bounds);
    assert_eq!(start(&mut gate), Err(Refusal::BeingJudged));
    judge(&mut gate);
    assert_ne!(start(&mut gate), Err(Refusal::BeingJudged));
}

fn jog(x_deg_s: f64, y_deg_s: f64) -> Motion {
    Motion::Jog { x_deg_s, y_deg_s }
}

fn step(x_deg: f64, y_deg: f64) -> Motion {
    Motion::Step { x_deg, y_deg }
}

fn position(azimuth_deg: impl Into<Option<f64>>, elevation_deg: impl Into<Option<f64>>) -> Motion {
    Motion::Position {
        azimuth: azimuth_deg.into().map(Angle::from_degrees),
        elevation: elevation_deg.into().map(Angle::from_degrees),
    }
}

#[test]
fn nothing_and_what_is_no_number_is_refused() {
    let manual = Case::new(Intent::Manual);
    for motion in [jog(0.0, 0.0), jog(f64::NAN, 1.0), jog(f64::INFINITY, 0.0), step(0.0, 0.0)] {
        assert_eq!(manual.ask(motion), Err(Refusal::Nothing), "{motion:?}");
    }
    let to_position = Case::new(Intent::Position);
    for motion in [position(None, None), position(f64::NAN, 40.0), position(None, f64::INFINITY)] {
        assert_eq!(to_position.ask(motion), Err(Refusal::Nothing), "{motion:?}");
    }
    assert_eq!(manual.ask(jog(0.0, -1.0)), Ok(()));
    assert_eq!(to_position.ask(position(None, 40.0)), Ok(()));
}

#[test]
fn without_a_position_nothing_starts() {
    for (intent, motion) in [
        (Intent::Manual, jog(1.0, 0.0)),
        (Intent::Position, position(10.0, 40.0)),
        (Intent::Track, Motion::StartProgram),
        (Intent::Standby, Motion::EnableAuto),
    ] {
        let mut case = Case::new(intent);
        assert_eq!(case.ask(motion), Ok(()), "{motion:?}");
        case.state.measured = None;
        assert_eq!(case.ask(motion), Err(Refusal::PositionUnknown), "{motion:?}");
    }
}

#[test]
fn a_jog_needs_a_fresher_position_than_the_rest() {
    for (intent, motion, allowed_ms) in [
        (Intent::Manual, jog(1.0, 0.0), 1000),
        (Intent::Manual, step(1.0, 0.0), 1000),
        (Intent::Park, position(10.0, 40.0), 5000),
        (Intent::Track, Motion::StartProgram, 5000),
        (Intent::Standby, Motion::EnableAuto, 5000),
    ] {
        let allowed = Duration::from_millis(allowed_ms);
        let mut case = Case::new(intent);
        case.age = Duration::from_millis(allowed_ms - 1);
        assert_eq!(case.ask(motion), Ok(()), "{motion:?}");
        case.age = allowed;
        assert_eq!(case.ask(motion), Err(Refusal::PositionOld(allowed)), "{motion:?}");
    }
}

#[test]
fn nothing_starts_while_a_stop_is_under_way() {
    let mut case = Case::new(Intent::Manual);
    case.stopping = true;
    assert_eq!(case.ask(jog(1.0, 0.0)), Err(Refusal::Stopping));
    assert_eq!(case.ask(Motion::EnableAuto), Err(Refusal::Stopping));
}

#[test]
fn each_motion_belongs_to_its_intents() {
    use crate::contract::driver::Intent::{Manual, Park, Position, Standby, Track};
    let all = [Standby, Manual, Position, Track, Park];
    for (motion, allowed) in [
        (jog(1.0, 0.0), &[Manual][..]),
        (step(1.0, 0.0), &[Manual]),
        (position(10.0, 40.0), &[Position, Park, Track]),
        (Motion::StartProgram, &[Track]),
        (Motion::EnableAuto, &all),
    ] {
        for intent in all {
            let expected =
                if allowed.contains(&intent) { Ok(()) } else { Err(Refusal::Intent(intent)) };
            assert_eq!(Case::new(intent).ask(motion), expected, "{motion:?}");
        }
    }
    for intent in all {
        let allowed = matches!(intent, Manual | Position);
        let expected = if allowed { Ok(()) } else { Err(Refusal::Intent(intent)) };
        assert_eq!(makes::rc2000c(intent).act("to_counts"), expected, "{intent:?}");
    }
}

#[test]
fn a_fault_that_locks_motion_forbids_everything() {
    for (intent, motion) in [
        (Intent::Manual, jog(1.0, 0.0)),
        (Intent::Position, position(10.0, 40.0)),
        (Intent::Track, Motion::StartProgram),
        (Intent::Standby, Motion::EnableAuto),
    ] {
        let mut case = Case::new(intent);
        case.state.motion_lock = Some(true);
        assert_eq!(case.ask(motion), Err(Refusal::Fault), "{motion:?}");
    }
}

#[test]
fn a_limit_switch_blocks_its_direction_only() {
    for (axis, name) in [(0, "X"), (1, "Y")] {
        for plus in [true, false] {
            let mut case = Case::new(Intent::Manual);
            case.axes()[axis].plus_limit = plus;
            case.axes()[axis].minus_limit = !plus;
            let along = |sign: f64| if axis == 0 { [sign, 0.0] } else { [0.0, sign] };
            let inward = along(if plus { 1.0 } else { -1.0 });
            let outward = inward.map(|rate| -rate);
            let refused = Err(Refusal::Limit { axis: name, plus });
            assert_eq!(case.ask(jog(inward[0], inward[1])), refused);
            assert_eq!(case.ask(step(inward[0], inward[1])), refused);
            assert_eq!(case.ask(jog(outward[0], outward[1])), Ok(()));
            assert_eq!(case.ask(step(outward[0], outward[1])), Ok(()));
            assert_eq!(case.ask(jog(inward[1], inward[0])), Ok(()), "the other axis is free");
        }
    }
}

#[test]
fn rates_and_steps_stay_within_the_limits_of_the_antenna() {
    let case = Case::new(Intent::Manual);
    assert_eq!(case.ask(jog(3.0, -3.0)), Ok(()));
    let too_fast = Err(Refusal::TooFast { asked_deg_s: 3.01, allowed_deg_s: 3.0 });
    assert_eq!(case.ask(jog(0.1, -3.01)), too_fast);
    assert_eq!(case.ask(step(-5.0, 5.0)), Ok(()));
    let too_large = Err(Refusal::StepTooLarge { asked_deg: 5.5, allowed_deg: 5.0 });
    assert_eq!(case.ask(step(5.5, 0.0)), too_large);
}

#[test]
fn positions_stay_above_the_lowest_elevation_and_out_of_the_keyholes() {
    let mut case = Case::new(Intent::Position);
    assert_eq!(case.ask(position(45.0, 5.0)), Ok(()));
    assert_eq!(case.ask(position(45.0, 90.0)), Ok(()));
    for asked_deg in [4.9, -10.0, 90.1] {
        let refused = Err(Refusal::Elevation { asked_deg, lowest_deg: 5.0 });
        assert_eq!(case.ask(position(45.0, asked_deg)), refused);
        assert_eq!(case.ask(position(None, asked_deg)), refused);
    }
    case.antenna.limits.minimum_elevation_deg = 0.0;
    for (azimuth_deg, blocked) in [(0.0, "Y"), (180.0, "Y"), (90.0, "X"), (270.0, "X")] {
        let Err(Refusal::Travel { axis, from_deg, to_deg, .. }) =
            case.ask(position(azimuth_deg, 4.0))
        else {
            panic!("{azimuth_deg}")
        };
        assert_eq!((axis, from_deg, to_deg), (blocked, 5.0, 175.0));
        assert_eq!(case.ask(position(azimuth_deg, 6.0)), Ok(()));
    }
}

#[test]
fn an_angle_that_stays_is_taken_from_the_measured_position() {
    let mut case = Case::new(Intent::Position);
    case.antenna.limits.minimum_elevation_deg = 0.0;
    case.state.measured.as_mut().unwrap().pointing = AzEl::from_degrees(45.0, 3.0).into();
    assert_eq!(case.ask(position(30.0, None)), Ok(()));
    assert!(matches!(case.ask(position(0.0, None)), Err(Refusal::Travel { axis: "Y", .. })));
}

#[test]
fn a_position_from_before_the_link_came_up_counts_for_nothing() {
    let mut case = Case::new(Intent::Manual);
    case.state.link_since =
        case.state.measured.map(|read| read.requested + Duration::from_millis(1));
    assert_eq!(case.ask(jog(1.0, 0.0)), Err(Refusal::PositionUnknown));
}

#[test]
fn faults_that_were_not_read_yet_may_forbid_motion() {
    let mut case = Case::new(Intent::Manual);
    case.state.motion_lock = None;
    assert_eq!(case.ask(jog(1.0, 0.0)), Err(Refusal::FaultsUnknown));
}

#[test]
fn by_hand_the_axes_stay_within_their_travel() {
    let mut case = Case::new(Intent::Manual);
    if let Some(measured) = &mut case.state.measured {
        measured.axes[0].angle_deg = Some(174.5);
    }
    assert!(matches!(case.ask(step(1.0, 0.0)), Err(Refusal::Travel { axis: "X", .. })));
    assert!(matches!(case.ask(jog(2.0, 0.0)), Err(Refusal::Travel { axis: "X", .. })));
    assert_eq!(case.ask(step(-1.0, 0.0)), Ok(()));
    if let Some(measured) = &mut case.state.measured {
        measured.axes[0].angle_deg = Some(179.0);
    }
    assert_eq!(case.ask(jog(-2.0, 0.0)), Ok(()), "the way back is free");
}

#[test]
fn an_azimuth_beyond_the_sky_is_meant_as_the_axis_counts() {
    let case = Case::new(Intent::Position);
    let mut mount = Antenna::rc2000c("Dish", "").mount;
    if let Mount::AzEl { azimuth_to_deg, .. } = &mut mount {
        *azimuth_to_deg = 450.0;
    }
    let metal = Metal::new(&case, Arc::default());
    let gate = Gate::new(
        Box::new(metal),
        &case.antenna,
        Bounds::of_antenna(&Antenna { mount, ..case.antenna.clone() }),
        &Default::default(),
    );
    // The axis stands at 90 degrees.
    for (asked_deg, meant_deg) in [(10.0, 10.0), (370.0, 370.0), (360.0, 360.0), (-10.0, 350.0)] {
        assert_eq!(gate.nearest(position(asked_deg, 45.0)), Ok(position(meant_deg, 45.0)));
    }
}

#[test]
fn while_a_safety_setting_is_unread_only_slow_motion_by_hand_is_permitted() {
    let place = "keep_out[0]".into();
    let unread = Refusal::SettingsUnread { place };
    for (intent, motion) in [
        (Intent::Position, position(10.0, 40.0)),
        (Intent::Track, Motion::StartProgram),
        (Intent::Standby, Motion::EnableAuto),
        (Intent::Manual, jog(0.5, 0.0)),
        (Intent::Manual, step(0.0, 1.0)),
    ] {
        let case = each_rule::make_unread(Case::new(intent));
        assert_eq!(case.ask(motion), Err(unread.clone()), "{motion:?}");
        let mut gate = case.gate(&Arc::default());
        gate.permit_exit(Some(case.now().steady + Duration::from_mins(1)));
        let by_hand = intent == Intent::Manual;
        let expected = if by_hand { Ok(()) } else { Err(unread.clone()) };
        assert_eq!(gate.check(motion, intent, case.now()), expected, "{motion:?}");
    }
    let case = each_rule::make_unread(Case::new(Intent::Manual));
    let mut gate = case.gate(&Arc::default());
    gate.permit_exit(Some(case.now().steady + Duration::from_mins(1)));
    let fast = gate.check(jog(3.0, 0.0), Intent::Manual, case.now());
    assert!(matches!(fast, Err(Refusal::TooFast { .. })), "{fast:?}");
    let mut case = case;
    case.unread[0].antenna = Some(crate::station::AntennaId(case.antenna.id.0 + 1));
    assert_eq!(case.ask(jog(3.0, 0.0)), Ok(()), "it concerns another antenna");
}
