//! Possible reports of a Satrak, for the stories.

use std::sync::Arc;

use azel::{
    astro::{AzEl, time::add_seconds},
    clock::Instant,
    contract::driver::{Intent, LinkState, Snapshot},
    controller::satrak::checks,
    device::{Axis, AxisMotion, Drive, HeldSatellite, Measured, Phase, Program, TrackTarget},
    model::Model,
    protocol::satrak::{Frame, Reply},
};
use jiff::Timestamp;

use crate::window_stories::rig::{NOAA_20, ago, model, now, quiet};

/// Returns a position that has just come in.
pub(crate) fn measured(azimuth_deg: f64, elevation_deg: f64, motion: AxisMotion) -> Measured {
    let axis = Axis {
        angle_deg: Some(90.0),
        motion,
        drive: Drive::On,
        plus_limit: false,
        minus_limit: false,
    };
    let steady = Instant::now();
    Measured {
        time: now(),
        requested: steady,
        received: steady,
        pointing: AzEl::from_degrees(azimuth_deg, elevation_deg).into(),
        axes: [axis; 2],
    }
}

/// Returns the state of an antenna that stands, without any intent to move.
pub(crate) fn holding() -> Snapshot {
    let mut snapshot = quiet();
    snapshot.state.measured = Some(measured(343.1, 5.0, AxisMotion::Still));
    snapshot.state.program =
        Some(Program { enabled: false, phase: Phase::OutOfWindow, auto: Some(false) });
    snapshot
}

/// Returns the state of an antenna that moves without a command from Azel.
pub(crate) fn moving() -> Snapshot {
    let mut snapshot = holding();
    snapshot.state.measured = Some(measured(120.0, 30.0, AxisMotion::Plus));
    snapshot
}

/// Returns the state of an antenna that the operator moves by hand.
pub(crate) fn manual() -> Snapshot {
    Snapshot { intent: Intent::Manual, ..holding() }
}

/// Returns the target of a track of NOAA 20.
pub(crate) fn target() -> TrackTarget {
    TrackTarget {
        catalog_number: NOAA_20,
        name: "NOAA 20 (JPSS-1)".to_owned(),
        element_file: None,
        start: now(),
        end: los(),
    }
}

/// Returns the LOS of NOAA 20, to the second.
pub(crate) fn los() -> Timestamp {
    "2026-08-12T11:21:27Z".parse().unwrap()
}

/// Returns the state of an on-board track of NOAA 20 that points `off_deg` too high.
pub(crate) fn tracking(off_deg: f64) -> Snapshot {
    let wanted = model(quiet()).sky.selected.unwrap().look.direction;
    let (azimuth_deg, elevation_deg) = (wanted.azimuth_deg(), wanted.elevation_deg());
    let mut snapshot = Snapshot { intent: Intent::Track, target: Some(target()), ..quiet() };
    snapshot.state.measured =
        Some(measured(azimuth_deg, elevation_deg + off_deg, AxisMotion::Plus));
    snapshot.state.program =
        Some(Program { enabled: true, phase: Phase::Tracking, auto: Some(false) });
    hold_noaa_20(&mut snapshot);
    snapshot
}

/// Returns the state of a unit whose program is on, in this phase.
pub(crate) fn program(phase: Phase, motion: AxisMotion) -> Snapshot {
    let mut snapshot = Snapshot { intent: Intent::Track, target: Some(target()), ..quiet() };
    snapshot.state.measured = Some(measured(205.0, 5.0, motion));
    snapshot.state.program = Some(Program { enabled: true, phase, auto: Some(false) });
    hold_noaa_20(&mut snapshot);
    snapshot.state.on_board.window = Some((add_seconds(now(), 192.0), los()));
    snapshot
}

fn hold_noaa_20(snapshot: &mut Snapshot) {
    snapshot.state.on_board.satellite = Some(HeldSatellite {
        catalog_number: NOAA_20,
        name: "NOAA 20 (JPSS-1)".to_owned(),
        maximum_elevation_deg: Some(70.8),
    });
    snapshot.state.on_board.window = Some((now(), los()));
}

/// Returns the sentence about the first antenna.
pub(crate) fn sentence(model: &Model) -> String {
    azel::ui::state_sentence::state_sentence(model, &model.antennas[0]).text()
}

/// Makes the last reply `reply_s` old and the position `position_s`, over an open link.
pub(crate) fn is_late(model: &mut Model, reply_s: u64, position_s: u64) {
    let [reply, asked, up] = [reply_s, position_s, 600].map(|seconds| ago(model, seconds));
    let antenna = model.shown_mut().antennas.first_mut().expect("an antenna");
    let snapshot = Arc::make_mut(&mut antenna.snapshot);
    snapshot.link = LinkState::Stale { as_of: asked.min(reply) };
    snapshot.state.link_since = Some(up);
    snapshot.state.traffic.last_reply = Some(reply);
    if let Some(measured) = &mut snapshot.state.measured {
        (measured.requested, measured.received) = (asked, reply);
    }
}

/// Adds the unit's checks at `at`, with the numbered ones (1 to 12) set.
pub(crate) fn report(snapshot: &mut Snapshot, set: &[usize], at: Timestamp) {
    let flags: Vec<&str> =
        (1..=12).map(|number| if set.contains(&number) { "1" } else { "0" }).collect();
    let frame = Frame::from_payload(&format!("ERRSTATUS?,{}", flags.join(",")));
    let reply = Reply::parse(&frame).unwrap().reply;
    let Reply::Faults(faults) = reply else { panic!("{reply:?}") };
    snapshot.state.checks = checks(Some(&faults)).into();
    snapshot.state.checked_at = Some(at);
}
