//! Comparison of an antenna's state with its prediction.

mod past_track;

use std::{collections::VecDeque, sync::Arc};

use crate::{
    astro::{Site, time::seconds_between},
    clock::Instant,
    contract::{
        antenna::{AntennaModel, Prediction},
        driver::StopState,
        passes::ListedSatellite,
    },
    device::{Measured, Phase},
};
use past_track::past_track;

/// Min span for measured rates, seconds; a shorter span would show rounding.
const RATE_SPAN_S: f64 = 0.9;

/// Measurements from which the rates of the axes are computed.
#[derive(Debug, Default)]
pub struct Recent(VecDeque<Measured>);

/// Compares the measurement in the snapshot with the prediction. `followed` finds a satellite by
/// catalog number.
pub fn refresh<'a>(
    antenna: &mut AntennaModel,
    recent: &mut Recent,
    site: Site,
    followed: impl Fn(u32) -> Option<&'a Arc<ListedSatellite>>,
) {
    let is_told = |pressed: &Instant| match antenna.snapshot.stop {
        StopState::Ready => false,
        StopState::Stopping { .. } | StopState::NotConfirmed { .. } => true,
        StopState::Stopped { time: instant } => instant >= *pressed,
    };
    antenna.stop_pressed = antenna.stop_pressed.filter(|pressed| !is_told(pressed));
    let Some(measured) = antenna.snapshot.state.measured else { return };
    if recent.0.back().is_some_and(|last| last.received == measured.received) {
        return;
    }
    take_rate(antenna, recent, measured);
    let before = antenna.prediction.map(|prediction| prediction.catalog_number);
    antenna.prediction = if antenna.follows() {
        followed_prediction(antenna)
    } else {
        // An untracked satellite, or one below the horizon, is no error.
        antenna.tracked_number().filter(|_| is_on_course(antenna)).and_then(|number| {
            let propagator = &followed(number)?.propagator;
            let satellite = |time| Some(propagator.look_from(site, time).ok()?.direction);
            let is_up = satellite(measured.time)?.elevation_deg() >= 0.0;
            let direction = antenna.snapshot.meant_offsets().demanded(measured.time, satellite)?;
            is_up.then_some(Prediction {
                catalog_number: Some(number),
                time: measured.time,
                direction,
            })
        })
    };
    if antenna.prediction.map(|prediction| prediction.catalog_number) != before {
        let errors = std::mem::take(&mut antenna.errors);
        let name = antenna.errors_of.take().unwrap_or_default();
        if let Some(track) = past_track(name, &errors) {
            antenna.past_tracks.push(track);
        }
    }
    if let Some(error) = antenna.error() {
        if antenna.errors_of.is_none() {
            antenna.errors_of = antenna.tracked_name().map(str::to_owned);
        }
        antenna.errors.push(error);
    }
}

fn take_rate(antenna: &mut AntennaModel, recent: &mut Recent, measured: Measured) {
    while recent.0.len() > 1
        && recent
            .0
            .get(1)
            .is_some_and(|next| seconds_between(next.time, measured.time) >= RATE_SPAN_S)
    {
        recent.0.pop_front();
    }
    antenna.rates_deg_s = recent.0.front().and_then(|before| {
        let span_s = seconds_between(before.time, measured.time);
        if !(RATE_SPAN_S / 2.0..=10.0).contains(&span_s) {
            return None;
        }
        // At the zenith the sky angles jump, but the axis angles do not.
        if antenna.config.mount.is_flipped(measured.axes[1].angle_deg)
            != antenna.config.mount.is_flipped(before.axes[1].angle_deg)
        {
            return None;
        }
        let (now, earlier) = (measured.pointing, before.pointing);
        let azimuth = (now.azimuth? - earlier.azimuth?).wrapped_180();
        let elevation = now
            .elevation
            .zip(earlier.elevation)
            .map(|(now, earlier)| (now - earlier).degrees() / span_s);
        Some((azimuth.degrees() / span_s, elevation.unwrap_or_default()))
    });
    recent.0.push_back(measured);
}

/// Returns the prediction of program track from the session, which has the target.
fn followed_prediction(antenna: &AntennaModel) -> Option<Prediction> {
    let view = antenna.snapshot.program_track.as_ref()?;
    let predicted = view.predicted?;
    Some(Prediction {
        catalog_number: view.catalog_number,
        time: predicted.time,
        direction: predicted.direction,
    })
}

/// Returns `true` while the unit should point at its target: from the opening of the tracking
/// window to the end of the pass.
fn is_on_course(antenna: &AntennaModel) -> bool {
    antenna.snapshot.state.program.is_some_and(|program| {
        program.enabled && matches!(program.phase, Phase::Tracking | Phase::Unknown(_))
    })
}
