//! Tests of track mode, entered by an auto move to an inclined satellite.

use super::*;
use crate::protocol::rc2000c::{
    Band, Direction, Jog, MIN_JOG, Polarity, PolarizationMove, Setting, Speed, Submode, TrackBand,
};
use crate::sim::rc2000c::Mode;

const RESTART: Request = Request::Motion(Motion::RestartTracking);

async fn tracking() -> (Client, Control) {
    let (mut client, control) = Client::new();
    client.refused(RESTART).await;
    client.status_after(to_satellite("GSTAR 3")).await;
    while control.state().mode != Mode::Track {
        seconds(0.1).await;
    }
    (client, control)
}

fn submode(status: &Status) -> Submode {
    status.track.unwrap().submode
}

#[tokio::test(start_paused = true)]
async fn an_inclined_satellite_leads_to_the_track_mode() {
    let (mut client, control) = tracking().await;
    assert_eq!(submode(&client.status().await), Submode::Setup);
    seconds(2.0).await;
    assert_eq!(submode(&client.status().await), Submode::Search);
    seconds(4.0).await;
    let status = client.status().await;
    assert_eq!(submode(&status), Submode::Step);
    assert!(status.is_moving() && !status.receiver.unwrap().allows_polarization);
    assert_eq!(control.state().mode, Mode::Track, "polls do not end it");
    seconds(10.0).await;
    let status = client.status().await;
    assert!(!status.is_moving() && status.receiver.unwrap().allows_polarization);
    assert_eq!((control.state().az_counts, control.state().el_counts), (1830, 860));
    assert_eq!(status.track.unwrap().band, TrackBand::K);
    let status = client.status_after(Request::Setting(Setting::Band(Band::C))).await;
    assert_eq!(status.track.unwrap().band, TrackBand::C);
}

#[tokio::test(start_paused = true)]
async fn a_peak_up_refuses_jogs_of_the_polarization_and_keeps_the_rest_for_later() {
    let (mut client, control) = tracking().await;
    seconds(6.0).await;
    client.refused(Request::Motion(Motion::Polarization(PolarizationMove::JogClockwise))).await;
    let vertical = PolarizationMove::ToStored(Polarity::Vertical);
    let before = control.state().polarization_units;
    client.status_after(Request::Motion(Motion::Polarization(vertical))).await;
    seconds(2.0).await;
    assert_eq!(control.state().polarization_units, before);
    seconds(15.0).await;
    assert_eq!(control.state().polarization_units, 580);
}

#[tokio::test(start_paused = true)]
async fn stop_ends_the_track_mode_unless_the_quirk_spares_it() {
    let (mut client, control) = tracking().await;
    control.set_quirk(Quirk::StopSparesTracking, true);
    client.status_after(Request::Stop).await;
    assert_eq!(control.state().mode, Mode::Track);
    seconds(6.0).await;
    let jog = Jog::new(Direction::Up, Speed::Slow, MIN_JOG).unwrap();
    client.refused(Request::Motion(Motion::Jog(jog))).await;
    control.set_quirk(Quirk::StopSparesTracking, false);
    let status = client.status_after(Request::Stop).await;
    assert_eq!((submode(&status), control.state().mode), (Submode::Off, Mode::Remote));
    client.refused(Request::Setting(Setting::Band(Band::K))).await;
    seconds(60.0).await;
    assert_eq!(control.state().mode, Mode::Remote);
}

#[tokio::test(start_paused = true)]
async fn an_error_waits_for_its_restart() {
    let (mut client, control) = tracking().await;
    control.set_fault(Fault::PeakLimit, true);
    seconds(8.0).await;
    assert_eq!(submode(&client.status().await), Submode::PeakLimitError);
    control.set_fault(Fault::PeakLimit, false);
    let status = client.status_after(RESTART).await;
    assert_eq!(submode(&status), Submode::Setup);
    control.set_fault(Fault::AzimuthJam, true);
    seconds(10.0).await;
    assert_eq!(submode(&client.status().await), Submode::JammedError);
}

#[tokio::test(start_paused = true)]
async fn what_ends_the_auto_move_ends_the_track_mode_to_come() {
    let jog = Jog::new(Direction::Up, Speed::Slow, MIN_JOG).unwrap();
    for ending in [Request::Stop, to_position(1600, 750), Request::Motion(Motion::Jog(jog))] {
        let (mut client, control) = Client::new();
        client.status_after(to_satellite("GSTAR 3")).await;
        seconds(1.0).await;
        client.status_after(ending).await;
        seconds(30.0).await;
        assert_eq!(control.state().mode, Mode::Remote, "{ending:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn an_auto_move_ends_the_track_mode() {
    let (mut client, control) = tracking().await;
    let status = client.status_after(to_position(1600, 750)).await;
    assert_eq!((submode(&status), control.state().mode), (Submode::Off, Mode::Remote));
    seconds(30.0).await;
    assert_eq!((control.state().az_counts, control.state().el_counts), (1600, 750));
}

#[tokio::test(start_paused = true)]
async fn the_panel_ends_the_track_mode() {
    let (mut client, control) = tracking().await;
    control.use_panel();
    seconds(10.0).await;
    assert!(control.state().mode == Mode::Manual && !control.state().is_turning);
    assert_eq!(submode(&client.status().await), Submode::Off);
}
