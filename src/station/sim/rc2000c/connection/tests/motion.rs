//! Tests of motion by a client's requests.

use super::*;
use crate::protocol::rc2000c::{
    Alarm, AxisDrive, Direction, DriveReset, Jog, LimitEnd, Polarity, PolarizationCode,
    PolarizationMotion, PolarizationMove, PolarizationUnits, Position, Sense, Setting, Speed,
};

fn jog(direction: Direction, speed: Speed, ms: u64) -> Request {
    let jog = Jog::new(direction, speed, Duration::from_millis(ms)).unwrap();
    Request::Motion(Motion::Jog(jog))
}

fn turn(polarization_move: PolarizationMove) -> Request {
    Request::Motion(Motion::Polarization(polarization_move))
}

fn reset(drive: DriveReset) -> Request {
    Request::Motion(Motion::ResetDrive(drive))
}

#[tokio::test(start_paused = true)]
async fn a_jog_ends_by_itself_and_the_axis_runs_out_untold() {
    let (mut client, control) = Client::new();
    let status = client.status_after(jog(Direction::CounterClockwise, Speed::Fast, 800)).await;
    assert_eq!(status.azimuth_drive, AxisDrive::Moving(Sense::Negative));
    drop(client);
    // The unit rounds the 800 ms of the jog up to 900 ms.
    seconds(0.9).await;
    let mut client = Client::attached(&control);
    let status = client.status().await;
    assert!(!status.is_moving() && control.state().is_turning);
    seconds(2.0).await;
    let stood = control.state();
    assert!(!stood.is_turning && (1470..1500).contains(&stood.az_counts), "{stood:?}");
}

#[tokio::test(start_paused = true)]
async fn a_jog_lasts_whole_steps_of_150_ms() {
    let (mut client, _control) = Client::new();
    client.status_after(jog(Direction::Clockwise, Speed::Slow, 160)).await;
    // A status takes about 60 ms from command to reply.
    sleep(Duration::from_millis(140)).await;
    assert!(client.status().await.is_moving());
    sleep(Duration::from_millis(60)).await;
    assert!(!client.status().await.is_moving());
}

#[tokio::test(start_paused = true)]
async fn one_axis_jogs_at_a_time_and_stop_ends_it() {
    let (mut client, control) = Client::new();
    client.status_after(jog(Direction::Clockwise, Speed::Fast, 9000)).await;
    seconds(1.0).await;
    let status = client.status_after(jog(Direction::Up, Speed::Slow, 9000)).await;
    assert_eq!(status.azimuth_drive, AxisDrive::Still);
    assert_eq!(status.elevation_drive, AxisDrive::Moving(Sense::Positive));
    let status = client.status_after(Request::Stop).await;
    assert!(!status.is_moving());
    seconds(1.5).await;
    assert!(!control.state().is_turning);
}

#[tokio::test(start_paused = true)]
async fn an_auto_move_runs_until_it_is_there() {
    let (mut client, control) = Client::new();
    let status = client.status_after(to_satellite("GALAXY 5")).await;
    assert_eq!(status.azimuth_drive, AxisDrive::AutoMove);
    assert_eq!(status.elevation_drive, AxisDrive::AutoMove);
    seconds(20.0).await;
    let status = client.status().await;
    assert!(!status.is_moving());
    assert_eq!(status.satellite.as_str(), "GALAXY 5");
    assert_eq!((control.state().az_counts, control.state().el_counts), (1100, 640));
    client.refused(to_satellite("GALAXY")).await;
    client.refused(to_position(29, 640)).await;
    client.refused(to_position(1100, 1831)).await;
    assert!(!client.status().await.is_moving());
}

#[tokio::test(start_paused = true)]
async fn stop_ends_an_auto_move_unless_the_quirk_spares_it() {
    let (mut client, control) = Client::new();
    client.status_after(to_position(3000, 750)).await;
    assert!(!client.status_after(Request::Stop).await.is_moving());
    control.set_quirk(Quirk::StopSparesAutoMove, true);
    client.status_after(to_position(3000, 750)).await;
    assert!(client.status_after(Request::Stop).await.is_moving());
}

#[tokio::test(start_paused = true)]
async fn at_a_limit_a_word_stands_for_the_number() {
    let (mut client, control) = Client::new();
    client.status_after(to_position(30, 1830)).await;
    seconds(60.0).await;
    let status = client.status().await;
    assert_eq!(status.azimuth, Position::Limit(LimitEnd::CounterClockwise));
    assert_eq!(status.elevation, Position::Limit(LimitEnd::Up));
    control.set_quirk(Quirk::LeftWords, true);
    assert_eq!(client.status().await, status);
    client.status_after(jog(Direction::Up, Speed::Slow, 300)).await;
    seconds(0.2).await;
    let status = client.status().await;
    assert_eq!((status.elevation_drive, status.alarm), (AxisDrive::Limit, Alarm::Elevation));
    control.set_quirk(Quirk::RefuseAtLimit, true);
    client.refused(jog(Direction::Up, Speed::Slow, 300)).await;
    client.status_after(jog(Direction::Down, Speed::Slow, 900)).await;
    seconds(2.0).await;
    let status = client.status().await;
    assert!(matches!(status.elevation, Position::Counts(1820..1830)), "{status:?}");
    assert_eq!(status.alarm, Alarm::None);
}

#[tokio::test(start_paused = true)]
async fn angles_show_instead_of_counts_when_configured() {
    let (mut client, control) = Client::new();
    control.set_quirk(Quirk::AngleDisplay, true);
    let status = client.status().await;
    assert_eq!(status.azimuth, Position::TenthsOfDegree(1648));
    assert_eq!(status.elevation, Position::TenthsOfDegree(360));
}

#[tokio::test(start_paused = true)]
async fn a_jam_is_an_alarm_until_it_is_reset() {
    let (mut client, control) = Client::new();
    control.set_fault(Fault::AzimuthJam, true);
    client.status_after(to_position(1600, 750)).await;
    seconds(2.0).await;
    let status = client.status().await;
    assert_eq!((status.azimuth_drive, status.alarm), (AxisDrive::Jammed, Alarm::Azimuth));
    control.set_fault(Fault::AzimuthJam, false);
    client.status_after(to_position(1600, 750)).await;
    seconds(5.0).await;
    assert_eq!(control.state().az_counts, 1525, "acknowledged, not carried out");
    assert_eq!(client.status_after(reset(DriveReset::Azimuth)).await.alarm, Alarm::None);
    client.status_after(to_position(1600, 750)).await;
    seconds(5.0).await;
    assert_eq!(control.state().az_counts, 1600);
    client.refused(reset(DriveReset::Polarization)).await;
    control.set_quirk(Quirk::RotatingFeed, true);
    client.status_after(reset(DriveReset::Polarization)).await;
}

#[tokio::test(start_paused = true)]
async fn runaway_and_overcurrent_are_alarms() {
    let (mut client, control) = Client::new();
    control.set_fault(Fault::ElevationOvercurrent, true);
    client.status_after(to_position(1600, 800)).await;
    seconds(1.0).await;
    let status = client.status().await;
    assert_eq!((status.elevation_drive, status.alarm), (AxisDrive::Overcurrent, Alarm::Elevation));
    control.set_fault(Fault::AzimuthRunaway, true);
    seconds(5.0).await;
    client.status_after(Request::Stop).await;
    seconds(5.0).await;
    let status = client.status().await;
    assert_eq!((status.azimuth_drive, status.alarm), (AxisDrive::Runaway, Alarm::Azimuth));
    assert!(control.state().is_turning);
}

#[tokio::test(start_paused = true)]
async fn the_polarization_turns_by_jogs_and_to_stored_places() {
    let (mut client, control) = Client::new();
    let status = client.status_after(turn(PolarizationMove::JogCounterClockwise)).await;
    assert_eq!(status.polarization_motion, PolarizationMotion::JogCounterClockwise);
    seconds(1.0).await;
    assert_eq!(control.state().polarization_units, 293);
    client.status_after(turn(PolarizationMove::ToStored(Polarity::Vertical))).await;
    seconds(6.0).await;
    let mode = client.status().await.polarization_mode.unwrap();
    assert_eq!(mode.code, PolarizationCode::Vertical);
    let half = AutoMove::polarization(PolarizationUnits::new(500).unwrap());
    client.status_after(Request::Motion(Motion::AutoMove(half))).await;
    seconds(3.0).await;
    assert_eq!(client.status().await.feed.units(), Some(500));
    let out_of_range = AutoMove::polarization(PolarizationUnits::new(662).unwrap());
    client.refused(Request::Motion(Motion::AutoMove(out_of_range))).await;
}

#[tokio::test(start_paused = true)]
async fn automatic_polarization_refuses_commands_for_it() {
    let (mut client, _control) = Client::new();
    let status = client.status_after(Request::Setting(Setting::AutoPolarization(true))).await;
    assert!(status.polarization_mode.unwrap().is_automatic);
    client.refused(turn(PolarizationMove::JogClockwise)).await;
    client.refused(turn(PolarizationMove::ToStored(Polarity::Horizontal))).await;
    let name = SatelliteName::new("ANIK E2").unwrap();
    let with_polarity = AutoMove::satellite(name, Some(Polarity::Vertical)).unwrap();
    client.refused(Request::Motion(Motion::AutoMove(with_polarity))).await;
    client.status_after(to_satellite("ANIK E2")).await;
    seconds(40.0).await;
    assert_eq!(client.status().await.feed.units(), Some(240));
}
