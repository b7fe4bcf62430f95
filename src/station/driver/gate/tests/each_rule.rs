//! Proof that every rule is necessary: for each rule, a case that it alone refuses, and that passes
//! without it.

use std::collections::BTreeSet;

use super::{
    makes::{genius, rc2000c},
    *,
};
use crate::device::{
    Phase, Program,
    settings::{Hindrance, Value, Values},
};

/// Request to the gate.
#[derive(Debug, Clone, Copy)]
enum Request {
    Motion(Motion),
    /// Action that moves nothing.
    Act,
    MovingAct,
    /// Same action with the operator's permission.
    AgreedAct,
    /// Setting that decides where the antenna points.
    Setting,
    /// Same setting during a requested motion.
    SettingInMotion,
}

/// Returns a Satrak that stands and would not start on its own.
fn idle_satrak() -> Case {
    changed(Case::new(Intent::Standby), |case| {
        let phase = Phase::OutOfWindow;
        case.state.program = Some(Program { enabled: false, phase, auto: Some(false) });
    })
}

/// Case that proves a rule necessary.
struct Needed {
    rule: &'static str,
    case: Case,
    request: Request,
    is_its_refusal: fn(&Refusal) -> bool,
}

fn submit(gate: &mut Gate, case: &Case, request: Request) -> Result<(), Refusal> {
    let (intent, stopping, now) = (case.intent, case.stopping, case.now());
    let act = |action| Act { action, values: Values::new() };
    let change = || Change {
        ticket: 1,
        group: "gps",
        values: Values::from([("is_automatic", Value::Flag(true))]),
        expected: None,
        is_unlocked: false,
    };
    match request {
        Request::Motion(motion) => gate.start(motion, intent, stopping, now),
        Request::Act => gate.act(act("read_list"), false, intent, stopping, now).map(drop),
        Request::MovingAct => gate.act(act("to_counts"), false, intent, stopping, now).map(drop),
        Request::AgreedAct => gate.act(act("to_counts"), true, intent, stopping, now).map(drop),
        Request::Setting => gate.write_settings(change(), false, stopping, now),
        Request::SettingInMotion => gate.write_settings(change(), true, stopping, now),
    }
}

fn lock_out(case: Case) -> Case {
    let lock_out = LockOut {
        operator: "Ada".to_owned(),
        reason: "gear".to_owned(),
        start: Timestamp::UNIX_EPOCH,
    };
    Case { lock_out: Some(lock_out), ..case }
}

/// Adds a mast between 100 and 120 degrees, up to 40 degrees.
pub(super) fn add_mast(case: Case) -> Case {
    let corners_deg = [(100.0, -5.0), (120.0, -5.0), (120.0, 40.0), (100.0, 40.0)];
    let mast = KeepOut {
        name: "mast".to_owned(),
        reason: String::new(),
        entered: crate::station::Entered::Hard,
        antenna: None,
        margin_deg: 1.0,
        zone: KeepOut::zone_of(&corners_deg).unwrap(),
    };
    Case { keep_outs: vec![mast], ..case }
}

/// Makes a keep-out of the station unreadable.
pub(super) fn make_unread(case: Case) -> Case {
    let unread = Unread { place: "keep_out[0]".to_owned(), antenna: None };
    Case { unread: vec![unread], ..case }
}

fn changed(mut case: Case, change: fn(&mut Case)) -> Case {
    change(&mut case);
    case
}

/// Returns the end of the azimuth axis of an RC2000C, degrees.
fn last_azimuth_deg() -> f64 {
    let [(_, to_deg), _] = rc2000c(Intent::Manual).antenna.mount.travel_deg();
    to_deg
}

fn needed(
    rule: &'static str,
    case: Case,
    request: Request,
    is_its_refusal: fn(&Refusal) -> bool,
) -> Needed {
    Needed { rule, case, request, is_its_refusal }
}

fn table() -> Vec<Needed> {
    let mut table = motions();
    table.extend(actions_and_settings());
    table
}

fn motions() -> Vec<Needed> {
    use crate::contract::driver::Intent::{Manual, Position, Standby, Track};
    let manual = || Case::new(Manual);
    let turn = Request::Motion(jog(1.0, 0.0));
    vec![
        needed("unit_is_not_locked_out", lock_out(manual()), turn, |refusal| {
            matches!(refusal, Refusal::LockedOut { .. })
        }),
        needed("something_is_asked_for", manual(), Request::Motion(jog(0.0, 0.0)), |refusal| {
            *refusal == Refusal::Nothing
        }),
        needed(
            "safety_settings_are_read",
            make_unread(manual()),
            Request::Motion(jog(0.5, 0.0)),
            |refusal| matches!(refusal, Refusal::SettingsUnread { .. }),
        ),
        needed("controller_offers_it", genius(Manual), Request::Motion(jog(1.0, 1.0)), |refusal| {
            *refusal == Refusal::OneAxis
        }),
        needed(
            "position_is_fresh",
            Case { age: Duration::from_secs(1), ..manual() },
            turn,
            |refusal| matches!(refusal, Refusal::PositionOld(_)),
        ),
        needed("no_stop_under_way", Case { stopping: true, ..manual() }, turn, |refusal| {
            *refusal == Refusal::Stopping
        }),
        needed("intent_allows_it", Case::new(Standby), turn, |refusal| {
            *refusal == Refusal::Intent(Standby)
        }),
        needed(
            "no_fault_forbids_it",
            changed(manual(), |case| case.state.motion_lock = Some(true)),
            turn,
            |refusal| *refusal == Refusal::Fault,
        ),
        needed(
            "no_limit_switch_in_that_direction",
            changed(manual(), |case| case.axes()[0].plus_limit = true),
            turn,
            |refusal| matches!(refusal, Refusal::Limit { plus: true, .. }),
        ),
        needed("within_rates_and_steps", manual(), Request::Motion(step(5.5, 0.0)), |refusal| {
            matches!(refusal, Refusal::StepTooLarge { .. })
        }),
        needed(
            "no_blind_jog",
            changed(genius(Manual), |case| case.axes()[0].angle_deg = None),
            turn,
            |refusal| matches!(refusal, Refusal::AngleUnknown { .. }),
        ),
        needed(
            "within_travel",
            changed(rc2000c(Manual), |case| {
                case.axes()[0].angle_deg = Some(last_azimuth_deg() - 0.001);
            }),
            turn,
            |refusal| matches!(refusal, Refusal::Travel { .. }),
        ),
        needed(
            "within_reach",
            rc2000c(Position),
            Request::Motion(position(last_azimuth_deg() + 1.0, 45.0)),
            |refusal| matches!(refusal, Refusal::Travel { .. }),
        ),
        needed(
            "way_is_clear",
            add_mast(genius(Position)),
            Request::Motion(position(160.0, 20.0)),
            |refusal| matches!(refusal, Refusal::Forbidden { .. }),
        ),
        needed(
            "program_is_clear",
            Case { pass_is_known: false, ..Case::new(Track) },
            Request::Motion(Motion::StartProgram),
            |refusal| *refusal == Refusal::PassUnknown,
        ),
        needed(
            "auto_track_is_clear",
            Case { next_pass: NextPass::Unknown { name: "TWIN".to_owned() }, ..Case::new(Standby) },
            Request::Motion(Motion::EnableAuto),
            |refusal| matches!(refusal, Refusal::OrbitUnknown { .. }),
        ),
        needed(
            "controller_agrees",
            Case { objection: Some("one rotator at a time"), ..manual() },
            turn,
            |refusal| matches!(refusal, Refusal::Controller(_)),
        ),
    ]
}

fn actions_and_settings() -> Vec<Needed> {
    use crate::contract::driver::Intent::Manual;
    vec![
        needed("no_action_while_locked_out", lock_out(rc2000c(Manual)), Request::Act, |refusal| {
            matches!(refusal, Refusal::LockedOut { .. })
        }),
        needed(
            "the_end_of_the_action_can_be_known",
            Case { leads_to: Lead::Unknown("not calibrated"), ..rc2000c(Manual) },
            Request::MovingAct,
            |refusal| *refusal == Refusal::Controller("not calibrated"),
        ),
        needed(
            "the_operator_answers_for_an_unseen_end",
            Case { leads_to: Lead::Unseen("names only"), ..rc2000c(Manual) },
            Request::MovingAct,
            |refusal| matches!(refusal, Refusal::Unseen { .. }),
        ),
        needed(
            "an_unseen_way_is_watched",
            changed(
                Case { leads_to: Lead::Unseen("names only"), ..add_mast(rc2000c(Manual)) },
                |case| case.axes()[0].angle_deg = None,
            ),
            Request::AgreedAct,
            |refusal| matches!(refusal, Refusal::AngleUnknown { .. }),
        ),
        needed(
            "end_of_the_action_is_within_reach",
            Case {
                leads_to: Lead::To([Some(last_azimuth_deg() + 1.0), Some(45.0)]),
                ..rc2000c(Manual)
            },
            Request::MovingAct,
            |refusal| matches!(refusal, Refusal::Travel { .. }),
        ),
        needed(
            "way_of_the_action_is_clear",
            Case { leads_to: Lead::To([Some(160.0), Some(20.0)]), ..add_mast(rc2000c(Manual)) },
            Request::MovingAct,
            |refusal| matches!(refusal, Refusal::Forbidden { .. }),
        ),
        needed(
            "no_setting_while_locked_out",
            lock_out(idle_satrak()),
            Request::Setting,
            |refusal| matches!(refusal, Refusal::LockedOut { .. }),
        ),
        needed(
            "no_setting_while_stopping",
            Case { stopping: true, ..idle_satrak() },
            Request::Setting,
            |refusal| matches!(refusal, Refusal::Setting { hindrance: Hindrance::Stopping, .. }),
        ),
        needed(
            "no_setting_while_the_unit_may_move",
            changed(idle_satrak(), |case| case.axes()[1].motion = AxisMotion::Plus),
            Request::Setting,
            |refusal| matches!(refusal, Refusal::Setting { hindrance: Hindrance::Moves, .. }),
        ),
        needed(
            "no_setting_after_a_motion_was_asked_for",
            idle_satrak(),
            Request::SettingInMotion,
            |refusal| matches!(refusal, Refusal::Setting { hindrance: Hindrance::Moves, .. }),
        ),
    ]
}

#[test]
fn a_case_that_only_this_rule_refuses_passes_without_it() {
    for Needed { rule, case, request, is_its_refusal } in table() {
        let gate = || case.gate(&Arc::default());
        let Err(refused) = submit(&mut gate(), &case, request) else {
            panic!("{rule} lets it through")
        };
        assert!(is_its_refusal(&refused), "{rule}: {refused:?}");
        assert_eq!(submit(&mut gate().omit(rule), &case, request), Ok(()), "without {rule}");
        for other in RULES.iter().filter(|other| other.name != rule) {
            let answer = submit(&mut gate().omit(other.name), &case, request);
            assert_eq!(answer, Err(refused.clone()), "{rule}, without {}", other.name);
        }
    }
}

#[test]
fn every_rule_has_its_case_and_a_name_of_its_own() {
    let names: BTreeSet<&str> = RULES.iter().map(|rule| rule.name).collect();
    assert_eq!(names.len(), RULES.len(), "two rules share a name");
    let cases: BTreeSet<&str> = table().iter().map(|needed| needed.rule).collect();
    assert_eq!(cases, names);
}
