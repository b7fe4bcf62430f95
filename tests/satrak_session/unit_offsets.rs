//! Offsets that Azel adds to a track that the unit computes.

use azel::{
    astro::{Angle, AzEl, Offset, TrackOffsets},
    contract::driver::{Command, Event, Intent, LeftOffsets, OffsetChange, Refusal},
    device::settings::{Value, WriteError},
    plan::{
        Bounds,
        on_board::{OffLimits, Trespass},
    },
    sim::satrak::Fault,
    station::Station,
};

use super::{
    on_board::{by_another, by_another_at_once, window},
    rig::{Rig, antenna, iss, track},
    scene::{self, orbit, twin},
    settings::{change, write_settings},
};

fn azimuth(degrees: f64) -> Offset {
    Offset::Azimuth(Angle::from_degrees(degrees))
}

fn elevation(degrees: f64) -> Offset {
    Offset::Elevation(Angle::from_degrees(degrees))
}

fn with(steps: &[Offset]) -> TrackOffsets {
    steps.iter().copied().try_fold(TrackOffsets::NONE, TrackOffsets::plus).unwrap()
}

/// Starts a unit in mid-pass that held an azimuth offset of -0.1 degrees before.
async fn in_a_pass() -> Rig {
    let mut rig = Rig::usual().await;
    let held = change("general", [("azimuth_offset_deg", Value::Decimal(-0.1))]);
    assert_eq!(write_settings(&mut rig, held).await, Ok(()));
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    rig.seconds(200.0).await;
    rig.events();
    rig
}

fn offset(rig: &Rig, change: OffsetChange) {
    rig.send(Command::Offset(change));
}

fn added(rig: &Rig) -> TrackOffsets {
    rig.shown().unit_offsets.as_ref().map(|unit| unit.offsets).unwrap_or_default()
}

async fn until_added(rig: &mut Rig, wanted: TrackOffsets) {
    rig.until("it is in force", 10, |shown| {
        let unit = shown.unit_offsets.clone();
        let is_settled = unit.as_ref().is_none_or(|unit| !unit.is_changing);
        is_settled && unit.map(|unit| unit.offsets).unwrap_or_default() == wanted
    })
    .await;
}

fn held(rig: &Rig) -> (f64, f64) {
    let offsets = rig.shown().state.on_board.offsets.unwrap();
    (offsets.azimuth_deg, offsets.elevation_deg)
}

#[tokio::test(start_paused = true)]
async fn steps_are_written_read_back_and_then_shown() {
    let mut rig = in_a_pass().await;
    assert_eq!(rig.shown().unit_offsets, None);
    let before = rig.orders().len();
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    rig.until("on its way", 1, |shown| {
        shown.unit_offsets.as_ref().is_some_and(|it| it.is_changing)
    })
    .await;
    assert_eq!(added(&rig), TrackOffsets::NONE, "nothing is shown before it is read back");
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    offset(&rig, OffsetChange::Step(elevation(0.1)));
    until_added(&mut rig, with(&[azimuth(0.2), elevation(0.1)])).await;
    assert_eq!(
        rig.orders()[before..],
        ["SETTINGS=,?,?,0.1,?,?,?,?,?,?,?,?", "SETTINGS=,?,?,?,0.1,?,?,?,?,?,?,?"]
    );
    rig.seconds(60.0).await;
    let view = rig.shown().on_board.clone().unwrap();
    assert_eq!(view.missing, None, "it is expected beside its satellite");
    assert!((view.found.worst.angle.degrees() - 0.1).abs() < 0.02, "of the unit alone: {view:?}");
    offset(&rig, OffsetChange::Undo);
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    offset(&rig, OffsetChange::Undo);
    until_added(&mut rig, TrackOffsets::NONE).await;
    offset(&rig, OffsetChange::Undo);
    let told = rig.until_event(2, |event| matches!(event, Event::OffsetRefused(_))).await;
    assert_eq!(told, Event::OffsetRefused(Refusal::Nothing));
    assert_eq!(held(&rig), (-0.1, 0.0));
    assert_eq!(rig.shown().intent, Intent::Track);
}

#[tokio::test(start_paused = true)]
async fn quick_steps_end_where_the_last_one_leads() {
    let mut rig = in_a_pass().await;
    for _ in 0..5 {
        offset(&rig, OffsetChange::Step(azimuth(0.1)));
    }
    until_added(&mut rig, with(&[azimuth(0.5)])).await;
    offset(&rig, OffsetChange::Zero);
    until_added(&mut rig, TrackOffsets::NONE).await;
    assert_eq!(held(&rig), (-0.1, 0.0));
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn at_the_end_of_the_track_they_are_taken_back() {
    for how in ["LOS", "Standby", "STOP", "by another"] {
        let mut rig = in_a_pass().await;
        offset(&rig, OffsetChange::Step(elevation(0.2)));
        until_added(&mut rig, with(&[elevation(0.2)])).await;
        match how {
            "LOS" => {}
            "Standby" => rig.send(Command::Standby),
            "STOP" => rig.stop(),
            _ => by_another(&rig, "TRACK=,0").await,
        }
        rig.until("taken back", 1500, |shown| shown.unit_offsets.is_none()).await;
        assert_eq!(held(&rig), (-0.1, 0.0), "{how}");
        let orders = rig.orders();
        assert_eq!(orders.last().unwrap(), "SETTINGS=,?,?,?,0.0,?,?,?,?,?,?,?", "{how}");
        rig.seconds(40.0).await;
        assert_eq!(rig.orders().len(), orders.len(), "{how}: once");
        assert!(!rig.control.state().is_moving, "{how}");
    }
}

#[tokio::test(start_paused = true)]
async fn stop_overtakes_an_offset_that_is_on_its_way() {
    for pause_ms in (0..300).step_by(20) {
        let mut rig = in_a_pass().await;
        offset(&rig, OffsetChange::Step(azimuth(1.0)));
        rig.seconds(f64::from(pause_ms) / 1000.0).await;
        let before = rig.orders().len();
        rig.stop();
        rig.until_event(4, |event| *event == Event::Stopped).await;
        assert_eq!(rig.orders()[before], "STOP=", "after {pause_ms} ms");
        rig.until("settled", 60, |shown| shown.unit_offsets.is_none()).await;
        assert_eq!(held(&rig), (-0.1, 0.0), "after {pause_ms} ms");
        let events = rig.events();
        assert!(events.iter().all(|event| *event == Event::Stopped), "{events:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_step_that_leads_too_low_is_refused_and_nothing_is_sent() {
    let mut rig = in_a_pass().await;
    let before = rig.orders().len();
    offset(&rig, OffsetChange::Step(elevation(-9.0)));
    let told = rig.until_event(2, |event| matches!(event, Event::OffsetRefused(_))).await;
    assert!(matches!(told, Event::OffsetRefused(Refusal::Path(_))), "{told:?}");
    offset(&rig, OffsetChange::Step(Offset::Along(Angle::from_degrees(0.1))));
    let told = rig.until_event(2, |event| matches!(event, Event::OffsetRefused(_))).await;
    assert_eq!(told, Event::OffsetRefused(Refusal::NotOffered), "not constant along the pass");
    rig.seconds(5.0).await;
    assert_eq!(rig.orders().len(), before);
    assert_eq!(rig.shown().unit_offsets, None);
}

/// Returns bounds with a keep-out around the highest point of the pass. `above_deg` has the heights
/// of its lower and upper edge above that point.
fn keep_out(above_deg: [f64; 2]) -> Bounds {
    let AzEl { azimuth, elevation } = scene::pass().tca.direction;
    let [from_deg, to_deg] = [azimuth.degrees() - 10.0, azimuth.degrees() + 10.0];
    let [low_deg, high_deg] = above_deg.map(|above_deg| elevation.degrees() + above_deg);
    let corners_deg =
        [(from_deg, low_deg), (to_deg, low_deg), (to_deg, high_deg), (from_deg, high_deg)];
    let keep_outs = vec![crate::common::mast(&corners_deg)];
    Bounds::new(&Station { keep_outs, ..Station::default() }, &antenna())
}

async fn until_forbidden(rig: &mut Rig) {
    let told = rig.until_event(2, |event| matches!(event, Event::OffsetRefused(_))).await;
    let Event::OffsetRefused(Refusal::Path(Trespass { limit, .. })) = &told else {
        panic!("{told:?}")
    };
    assert!(matches!(limit, OffLimits::Forbidden(_)), "{told:?}");
}

#[tokio::test(start_paused = true)]
async fn a_step_that_would_lead_into_a_keep_out_later_in_the_pass_is_refused() {
    let mut rig = in_a_pass().await;
    rig.handle().keep_within(keep_out([4.0, 15.0]));
    offset(&rig, OffsetChange::Step(elevation(1.0)));
    until_added(&mut rig, with(&[elevation(1.0)])).await;
    offset(&rig, OffsetChange::Step(elevation(5.0)));
    until_forbidden(&mut rig).await;
    assert_eq!(added(&rig), with(&[elevation(1.0)]), "what was on stays on");
}

#[tokio::test(start_paused = true)]
async fn a_step_is_judged_by_the_direction_on_the_sky_too() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(elevation(6.0)));
    until_added(&mut rig, with(&[elevation(6.0)])).await;
    assert_eq!(rig.events(), [], "it reads back as written");
    // The axes keep clear of the keep-out. The beam does not if the offset corrects an error of the
    // axes.
    rig.handle().keep_within(keep_out([-2.0, 2.0]));
    offset(&rig, OffsetChange::Step(azimuth(0.1)));
    until_forbidden(&mut rig).await;
}

#[tokio::test(start_paused = true)]
async fn back_to_what_was_there_before_is_judged_too_while_the_unit_tracks() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(elevation(6.0)));
    until_added(&mut rig, with(&[elevation(6.0)])).await;
    rig.handle().keep_within(keep_out([-2.0, 2.0]));
    let orders = rig.orders().len();
    for back in [OffsetChange::Zero, OffsetChange::Undo] {
        offset(&rig, back);
        until_forbidden(&mut rig).await;
    }
    assert_eq!(added(&rig), with(&[elevation(6.0)]), "what was on stays on");
    assert_eq!(rig.orders().len(), orders);
    rig.stop();
    rig.until("taken back", 20, |shown| shown.unit_offsets.is_none()).await;
    assert_eq!(held(&rig), (-0.1, 0.0), "it moves nothing any more");
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_taken_back_is_told_and_tried_again_until_it_is() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    rig.control.set_fault(Fault::RefuseSettings, true);
    rig.send(Command::Standby);
    rig.until("told", 20, |shown| {
        let left = shown.unit_offsets.as_ref().and_then(|unit| unit.left.clone());
        matches!(left, Some(LeftOffsets::Failed(_)))
    })
    .await;
    let tries = rig.sent("SETTINGS=").len();
    rig.seconds(65.0).await;
    // Azel tries after 10 and 20 s; the next try comes after 40 s more.
    assert_eq!(rig.sent("SETTINGS=").len(), tries + 2);
    assert_eq!(added(&rig), with(&[azimuth(0.2)]));
    rig.seconds(1190.0).await;
    // Azel tries after 70, 150, 310, 630 and 1,230 s, because no wait is longer than 600 s.
    assert_eq!(rig.sent("SETTINGS=").len(), tries + 7);
    rig.control.set_fault(Fault::RefuseSettings, false);
    rig.until("taken back", 620, |shown| shown.unit_offsets.is_none()).await;
    assert_eq!(held(&rig), (-0.1, 0.0));
}

#[tokio::test(start_paused = true)]
async fn the_operator_takes_back_at_once_what_is_tried_again_later() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    rig.control.set_fault(Fault::RefuseSettings, true);
    rig.send(Command::Standby);
    rig.seconds(200.0).await;
    rig.control.set_fault(Fault::RefuseSettings, false);
    offset(&rig, OffsetChange::Zero);
    rig.until("taken back", 5, |shown| shown.unit_offsets.is_none()).await;
    assert_eq!(held(&rig), (-0.1, 0.0));
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_taken_back_in_mid_pass_is_taken_back_at_its_end() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    rig.control.set_fault(Fault::RefuseSettings, true);
    offset(&rig, OffsetChange::Zero);
    rig.until_event(10, |event| matches!(event, Event::OffsetNotTaken(_))).await;
    rig.control.set_fault(Fault::RefuseSettings, false);
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    assert_eq!(rig.shown().unit_offsets.as_ref().unwrap().left, None, "they are meant to be on");
    rig.send(Command::Standby);
    rig.until("taken back", 20, |shown| shown.unit_offsets.is_none()).await;
    assert_eq!(held(&rig), (-0.1, 0.0));
}

#[tokio::test(start_paused = true)]
async fn a_lost_link_leaves_them_in_force_and_they_are_taken_back_after_it() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    rig.set_off(true);
    rig.seconds(30.0).await;
    rig.set_off(false);
    rig.until("read again", 60, |shown| shown.state.on_board.offsets.is_some()).await;
    assert_eq!(added(&rig), with(&[azimuth(0.2)]));
    rig.set_off(true);
    rig.seconds(900.0).await;
    rig.set_off(false);
    rig.until("taken back", 90, |shown| {
        shown.unit_offsets.is_none() && shown.state.on_board.offsets.is_some()
    })
    .await;
    assert_eq!(held(&rig), (-0.1, 0.0));
}

#[tokio::test(start_paused = true)]
async fn a_link_lost_while_they_are_taken_back_holds_nothing_up() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    rig.send(Command::Standby);
    rig.until("on its way", 20, |shown| {
        shown.unit_offsets.as_ref().is_some_and(|unit| unit.is_changing)
    })
    .await;
    rig.set_off(true);
    rig.until("lost", 20, |shown| !shown.link.is_open()).await;
    // The refusal of this change is the last outcome of the group.
    let other = change("general", [("azimuth_offset_deg", Value::Decimal(0.3))]);
    assert_eq!(write_settings(&mut rig, other).await, Err(WriteError::NoLink));
    rig.set_off(false);
    rig.until("taken back", 60, |shown| shown.link.is_open() && shown.unit_offsets.is_none()).await;
    rig.send(Command::Park);
    rig.until_event(200, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(held(&rig), (-0.1, 0.0));
}

#[tokio::test(start_paused = true)]
async fn what_somebody_else_sets_meanwhile_is_left_alone() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    by_another(&rig, "SETTINGS=,?,?,0.7,?,?,?,?,?,?,?,?").await;
    rig.until("read", 40, |shown| {
        let held = shown.state.on_board.offsets.unwrap();
        (held.azimuth_deg - 0.7).abs() < 1e-9
    })
    .await;
    assert_eq!(rig.events(), [Event::OffsetNotTaken(WriteError::ChangedMeanwhile)]);
    rig.send(Command::Standby);
    rig.seconds(60.0).await;
    assert_eq!(held(&rig), (0.7, 0.0));
    assert_eq!(rig.shown().unit_offsets, None);
}

/// Switches the unit to another satellite, without a rest that Azel could see.
async fn goes_on_to_the_twin(rig: &Rig) {
    let choice = format!("SATELLITE=,{},{},1,0", scene::FILE, twin().name);
    by_another_at_once(rig, &[&choice, &window(&twin()), "TRACK=,1"]).await;
    rig.know_orbit(Some(orbit(25_545)));
}

#[tokio::test(start_paused = true)]
async fn they_are_taken_back_when_the_unit_goes_straight_on_to_another_satellite() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    goes_on_to_the_twin(&rig).await;
    rig.until("taken back", 60, |shown| {
        let held = shown.state.on_board.offsets.unwrap();
        shown.unit_offsets.is_none() && (held.azimuth_deg + 0.1).abs() < 1e-9
    })
    .await;
    assert!(rig.control.state().is_tracking, "it goes on");
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_taken_back_on_the_next_pass_is_told_and_taken_back_at_its_end() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(elevation(6.0)));
    until_added(&mut rig, with(&[elevation(6.0)])).await;
    rig.handle().keep_within(keep_out([-2.0, 2.0]));
    goes_on_to_the_twin(&rig).await;
    rig.until("it is told", 60, |shown| {
        let left = shown.unit_offsets.as_ref().and_then(|unit| unit.left.clone());
        matches!(left, Some(LeftOffsets::Refused(_)))
    })
    .await;
    rig.send(Command::Standby);
    rig.until("taken back", 60, |shown| shown.unit_offsets.is_none()).await;
    assert_eq!(held(&rig), (-0.1, 0.0));
}

#[tokio::test(start_paused = true)]
async fn the_next_track_begins_without_them() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    rig.send(Command::Standby);
    rig.send(track(iss()));
    rig.until_event(20, |event| matches!(event, Event::Tracking(_))).await;
    let orders = rig.orders();
    let back = orders.iter().rposition(|order| order.starts_with("SETTINGS=")).unwrap();
    let start = orders.iter().rposition(|order| order == "TRACK=,1").unwrap();
    assert!(back < start, "{orders:?}");
    assert_eq!(rig.shown().unit_offsets, None);
    assert_eq!(held(&rig), (-0.1, 0.0));
}

#[tokio::test(start_paused = true)]
async fn at_the_end_of_the_program_they_are_taken_back_if_the_track_has_ended() {
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    rig.stop();
    rig.seconds(0.05).await;
    rig.drop_handle().await;
    assert_eq!(rig.orders().last().unwrap(), "SETTINGS=,?,?,-0.1,?,?,?,?,?,?,?,?");
    let mut rig = in_a_pass().await;
    offset(&rig, OffsetChange::Step(azimuth(0.2)));
    until_added(&mut rig, with(&[azimuth(0.2)])).await;
    rig.drop_handle().await;
    assert_eq!(rig.orders().last().unwrap(), "SETTINGS=,?,?,0.1,?,?,?,?,?,?,?,?", "it tracks on");
}
