//! Program track of an antenna.

use std::{sync::Arc, time::Duration};

use azel::{
    astro::{
        Angle, AzEl, TrackOffsets,
        time::{add_seconds, seconds_between},
    },
    clock::Instant,
    contract::{
        self,
        driver::{Command, Event, Found, Intent, LinkState, Snapshot, TrackView},
        passes::PredictedPass,
    },
    device::AxisMotion,
    engine::antenna::{Recent, refresh},
    model::{Model, UiCommand},
    plan::{ProgramTrack, Sample, Target, TrackPhase, TrackStats, program_track::OnPath},
    station::{Antenna, AntennaId, Mount},
    ui::bar::activity,
};
use egui::Role;
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{rig, states};

const WANTED: AzEl = AzEl::from_degrees(134.0, 20.0);

/// Returns a Genius that tracks NOAA 20 and points `off_deg` too high.
fn following(phase: TrackPhase, off_deg: f64, motion: AxisMotion) -> Model {
    let is_up = phase == TrackPhase::Tracking;
    let predicted = Sample { time: rig::now(), direction: WANTED };
    let view = TrackView {
        name: "NOAA 20 (JPSS-1)".to_owned(),
        catalog_number: Some(rig::NOAA_20),
        phase,
        stats: TrackStats::default(),
        awaits_operator: false,
        next_update: None,
        commanded: is_up.then_some(WANTED.into()),
        on_path: None,
        missing: None,
        predicted: is_up.then_some(predicted),
        offsets: TrackOffsets::NONE,
        can_undo: false,
        target_moves: true,
    };
    let intent = if phase == TrackPhase::Over { Intent::Position } else { Intent::Track };
    let mut snapshot = Snapshot { intent, program_track: Some(view), ..rig::quiet() };
    snapshot.state.measured = Some(states::measured(134.0, 20.0 + off_deg, motion));
    let mut model = rig::model(rig::quiet());
    let mut antenna = rig::antenna(Antenna::genius("Mast", "192.168.1.250:9006"), snapshot);
    refresh(&mut antenna, &mut Recent::default(), model.station.site, |number| {
        model.pass_lists.satellite(number)
    });
    model.shown_mut().antennas = vec![antenna];
    model
}

/// Returns a Genius that tracks NOAA 20 with these offsets.
pub(super) fn tracking(offsets: TrackOffsets) -> Model {
    let mut model = following(TrackPhase::Tracking, 0.0, AxisMotion::Plus);
    let snapshot = Arc::make_mut(&mut model.shown_mut().antennas[0].snapshot);
    if let Some(view) = &mut snapshot.program_track {
        view.offsets = offsets;
        view.can_undo = !offsets.is_none();
    }
    model
}

#[test]
fn the_sentence_says_what_is_waited_for_followed_and_over() {
    use AxisMotion::{Plus, Still};
    let waiting = TrackPhase::Waiting { aos: add_seconds(rig::now(), 192.0) };
    for (phase, off_deg, motion, wanted) in [
        (waiting, 0.0, Plus, "Moving to meet NOAA 20, which rises at 11:18:42Z, in 3:12."),
        (
            waiting,
            0.0,
            Still,
            "Waiting at 134°, 20° for NOAA 20, which rises at 11:18:42Z, in 3:12.",
        ),
        (
            TrackPhase::Tracking,
            0.4,
            Plus,
            "Following NOAA 20 position by position. The antenna is 0.40° off, inside its 20.00° \
             beam.",
        ),
        (
            TrackPhase::Tracking,
            11.0,
            Plus,
            "Following NOAA 20 position by position. The antenna is 11.00° off, outside its 20.00° \
             beam.",
        ),
        (TrackPhase::Over, 0.0, Still, "The pass of NOAA 20 is over. Holding at 134°, 20°."),
    ] {
        assert_eq!(states::sentence(&following(phase, off_deg, motion)), wanted);
    }
}

#[test]
fn the_sentence_predicts_the_arrival_on_target() {
    let mut model = following(TrackPhase::Tracking, 40.0, AxisMotion::Minus);
    for (until, wanted) in [
        (
            Some(add_seconds(rig::now(), 20.0)),
            "Following NOAA 20. The antenna is still turning, 40.00° off target, expected there at \
             11:15:50Z, in 0:20.",
        ),
        (None, "Following NOAA 20. The antenna is still turning, 40.00° off target."),
    ] {
        let snapshot = Arc::make_mut(&mut model.shown_mut().antennas[0].snapshot);
        if let Some(view) = &mut snapshot.program_track {
            view.on_path = Some(OnPath::OnItsWay { arrival: until });
        }
        assert_eq!(states::sentence(&model), wanted);
    }
}

#[test]
fn the_chip_and_the_prediction_are_those_of_the_target() {
    let model = following(TrackPhase::Tracking, 0.4, AxisMotion::Plus);
    let antenna = &model.antennas[0];
    assert_eq!(
        (activity(&model, antenna), antenna.tracked_number()),
        ("Tracking", Some(rig::NOAA_20))
    );
    assert_eq!(antenna.prediction.unwrap().direction, WANTED);
    let off_deg = antenna.error().unwrap().off_beam.degrees();
    assert!((off_deg - 0.4).abs() < 1e-9, "{off_deg}");

    let waiting = TrackPhase::Waiting { aos: add_seconds(rig::now(), 192.0) };
    let model = following(waiting, 0.0, AxisMotion::Still);
    assert_eq!(activity(&model, &model.antennas[0]), "Waiting");
    assert_eq!(model.antennas[0].prediction, None);
    let model = following(TrackPhase::Over, 0.0, AxisMotion::Still);
    assert_eq!(
        (model.antennas[0].tracked_number(), activity(&model, &model.antennas[0])),
        (None, "Holding")
    );
}

#[test]
fn the_plot_shows_where_the_antenna_was_sent() {
    for (phase, is_shown) in [(TrackPhase::Tracking, true), (TrackPhase::Over, false)] {
        let window = rig::window(rig::LARGE, following(phase, 0.4, AxisMotion::Plus));
        let ring = window.query_all_by_label_contains("Commanded, azimuth 134").next().is_some();
        assert_eq!(ring, is_shown, "{phase:?}");
    }
}

#[test]
fn a_target_beyond_the_travel_is_out_of_reach_and_waited_for() {
    let mut model = following(TrackPhase::Tracking, 40.0, AxisMotion::Still);
    let Mount::AzEl { azimuth_from_deg, elevation_to_deg, .. } =
        &mut Arc::make_mut(&mut model.shown_mut().antennas[0].config).mount
    else {
        panic!("a Genius turns azimuth and elevation")
    };
    // The target is at 134 degrees. The axes could also reach it over the zenith.
    (*azimuth_from_deg, *elevation_to_deg) = (180.0, 90.0);
    let said = states::sentence(&model);
    assert!(said.contains("NOAA 20, which is out of reach. Waiting at 134°"), "{said}");
    assert_eq!(activity(&model, &model.antennas[0]), "Waiting");
}

#[test]
fn a_position_that_is_missing_is_not_said_to_be_out_of_reach() {
    let mut model = following(TrackPhase::Tracking, 0.4, AxisMotion::Still);
    let snapshot = Arc::make_mut(&mut model.shown_mut().antennas[0].snapshot);
    snapshot.state.measured.as_mut().unwrap().pointing.azimuth = None;
    assert_eq!(
        states::sentence(&model),
        "Following NOAA 20. The unit reports no azimuth: it is not calibrated, or a sensor is missing."
    );
}

#[test]
fn after_a_lost_link_it_is_said_to_follow_on() {
    let mut model = following(TrackPhase::Tracking, 0.4, AxisMotion::Still);
    let back =
        Event::Back { after: Duration::from_secs(20), found: Found::Still, is_explained: true };
    model.shown_mut().antennas[0].news = Some((back, model.now));
    let said = states::sentence(&model);
    assert!(said.ends_with("It is still following."), "{said}");
}

#[test]
fn after_the_pass_it_is_told_how_well_it_was_followed() {
    let mut stats = TrackStats::default();
    stats.commands = 206;
    stats.take(Angle::from_degrees(0.6));
    stats.take(Angle::from_degrees(0.8));
    let mut model = following(TrackPhase::Over, 0.0, AxisMotion::Still);
    let over = Event::ProgramTrackOver { name: "NOAA 20 (JPSS-1)".to_owned(), stats };
    model.shown_mut().antennas[0].news = Some((over, model.now));
    let wanted = "The pass of NOAA 20 is over. It was followed with an error of 0.71° rms, 0.80° \
                  at worst, using 206 commands.";
    assert_eq!(states::sentence(&model), wanted);
}

#[test]
fn the_selected_pass_and_the_later_ones_are_followed() {
    let model = rig::model(rig::quiet());
    let passes = &model.pass_lists.favourites.passes;
    let of = |number: u32| passes.iter().filter(move |predicted| predicted.number() == number);
    let rises_again = |predicted: &&PredictedPass| of(predicted.number()).count() > 1;
    let first = passes.iter().find(rises_again).unwrap();
    let (antenna, floor) = (&model.antennas[0].config, model.station.elevation_floor());
    let follow = first.follow(antenna, floor);
    assert_eq!(follow.target.catalog_number(), Some(first.number()));
    let listed: Vec<_> = of(first.number()).collect();
    assert!(follow.passes.len() > listed.len(), "a week ahead, whatever is listed");
    for (pass, (aos, los)) in listed.iter().zip(&follow.passes) {
        let off_s = seconds_between(pass.pass.aos.time, *aos).abs();
        assert!(off_s < 0.01 && seconds_between(pass.pass.los.time, *los).abs() < 0.01);
    }

    let fixed = passes.iter().find(|predicted| predicted.is_always_up()).unwrap();
    assert_eq!(fixed.follow(antenna, floor).passes, []);
}

/// Chooses this entry of the menu beside Track, and returns the commands.
fn chosen(size: [f32; 2], antenna: Antenna, entry: &str) -> Vec<UiCommand> {
    let mut snapshot = states::holding();
    snapshot.link = LinkState::Up { start: Instant::now() };
    snapshot.state.motion_lock = Some(false);
    let mut model = rig::model(rig::quiet());
    model.shown_mut().antennas = vec![rig::antenna(antenna, snapshot)];
    let mut window = rig::window(size, model);
    let key = window.get_by_role_and_label(Role::Button, "Follow something else");
    key.scroll_to_me();
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Follow something else").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, entry).click();
    rig::asked(&mut window)
}

fn followed(size: [f32; 2], antenna: Antenna, entry: &str) -> ProgramTrack {
    match chosen(size, antenna, entry).as_slice() {
        [
            UiCommand::Station(contract::Command::Antenna(
                AntennaId(1),
                Command::ProgramTrack(follow),
            )),
        ] => (**follow).clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn sun_moon_and_a_direction_are_followed_by_one_click() {
    let genius = || Antenna::genius("Mast", "192.168.1.250:9006");
    for size in rig::sizes() {
        let site = rig::station().site;
        let always = |target| ProgramTrack::new(target, site, Vec::new());
        assert_eq!(followed(size, genius(), "Follow the Sun"), always(Target::Sun));
        assert_eq!(followed(size, genius(), "Follow the Moon"), always(Target::Moon));
        let kept = followed(size, genius(), "Keep pointing at 343°, 5°");
        let Target::Fixed(direction) = kept.target else { panic!("{kept:?}") };
        assert!(direction.separation(AzEl::from_degrees(343.1, 5.0)).degrees() < 1e-6);
    }
}

#[test]
fn a_unit_that_tracks_by_itself_can_be_sent_from_here_all_the_same() {
    let satrak = Antenna::satrak("Dish", "192.168.10.21:4001");
    let entry = "Follow NOAA 20 position by position, from here";
    let Some(UiCommand::Station(contract::Command::Track { pass, .. })) =
        Some(rig::track_noaa_20())
    else {
        unreachable!()
    };
    let wanted =
        [UiCommand::Station(contract::Command::ProgramTrackPass { antenna: AntennaId(1), pass })];
    assert_eq!(chosen(rig::LARGE, satrak, entry), wanted);
}
