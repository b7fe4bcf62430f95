//! Window in which a unit may point to a satellite.

use jiff::Timestamp;

use crate::{
    astro::{Angle, Site, time::add_seconds},
    driver::Refusal,
    orbit::{PassSearch, passes},
    passes::PredictedPass,
    station::Antenna,
};

/// Margin of a search around a known pass, seconds. The ends of the pass are exact to a
/// millisecond.
const EDGE_S: f64 = 0.002;

/// Returns the window in which the unit of `antenna` may point to the satellite of `predicted`. The
/// window holds the whole seconds of the first stay above the antenna's minimum elevation that is
/// not over. The stay is geometric, because units ignore refraction.
///
/// # Errors
/// Returns [`Refusal::TooLow`] if there is no such stay.
pub fn window(
    predicted: &PredictedPass,
    antenna: &Antenna,
    site: Site,
    now: Timestamp,
) -> Result<(Timestamp, Timestamp), Refusal> {
    let lowest_deg = antenna.limits.minimum_elevation_deg;
    let lowest = Angle::from_degrees(lowest_deg);
    let (aos, los) = (predicted.pass.aos.time, predicted.pass.los.time);
    let search = PassSearch {
        aos_elevation: lowest,
        floor: lowest,
        ..PassSearch::new(site.airless(), add_seconds(aos, -EDGE_S), add_seconds(los, EDGE_S))
    };
    let stays = passes(&predicted.satellite.propagator, &search, &|| false);
    let clipped = stays.iter().map(|stay| (stay.aos.time.max(aos), stay.los.time.min(los)));
    let mut whole = clipped.map(|(start, end)| (first_second(start), last_second(end)));
    whole.find(|(start, end)| start < end && now < *end).ok_or(Refusal::TooLow {
        highest_deg: predicted.pass.max_elevation().degrees(),
        lowest_deg,
    })
}

/// Returns the whole seconds within a span.
pub fn whole_seconds((start, end): (Timestamp, Timestamp)) -> (Timestamp, Timestamp) {
    (first_second(start), last_second(end))
}

fn first_second(time: Timestamp) -> Timestamp {
    let cut = last_second(time);
    if cut == time { time } else { add_seconds(cut, 1.0) }
}

fn last_second(time: Timestamp) -> Timestamp {
    Timestamp::from_second(time.as_second()).unwrap_or(time)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        astro::time::seconds_between,
        orbit::{Pass, Propagator, bundled},
        passes::{ListedSatellite, Observer},
        station::Station,
    };

    fn length_s((start, end): (Timestamp, Timestamp)) -> f64 {
        seconds_between(start, end)
    }

    fn now() -> Timestamp {
        "2026-08-12T00:00:00Z".parse().unwrap()
    }

    fn station(lowest_deg: [f64; 2]) -> Station {
        let mut antennas = vec![Antenna::genius("First", ""), Antenna::satrak("Second", "")];
        for (antenna, lowest_deg) in antennas.iter_mut().zip(lowest_deg) {
            antenna.limits.minimum_elevation_deg = lowest_deg;
        }
        Station { antennas, ..Station::default() }
    }

    /// Returns the first pass above 60 degrees, as the station lists it.
    fn predicted_pass(station: &Station) -> PredictedPass {
        let elements = bundled().unwrap().get(25_544).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let observer = Observer::from_station(station);
        let search = PassSearch {
            aos_elevation: observer.aos_elevation,
            ..PassSearch::new(station.site, now(), add_seconds(now(), 5.0 * 86_400.0))
        };
        let high = |pass: &Pass| pass.max_elevation().degrees() > 60.0;
        let pass = passes(&propagator, &search, &|| false).into_iter().find(high).unwrap();
        PredictedPass::new(
            Arc::new(ListedSatellite { elements, propagator }),
            pass,
            Arc::new(observer),
        )
    }

    #[test]
    fn the_window_of_an_antenna_keeps_to_its_own_lowest_elevation() {
        let station = station([0.0, 45.0]);
        let predicted = predicted_pass(&station);
        let [first, second] = [0, 1].map(|index| {
            window(&predicted, &station.antennas[index], station.site, now()).unwrap()
        });
        assert!(length_s(first) > 500.0 && length_s(second) < 200.0, "{first:?} {second:?}");
        let aos = predicted.pass.aos.time;
        assert!((0.0..1.01).contains(&seconds_between(aos, first.0)), "{aos} {first:?}");
        let elevation = |time| {
            let look = predicted.satellite.propagator.look_from(station.site, time).unwrap();
            look.direction.elevation_deg()
        };
        for (start, end) in [second] {
            for time in [start, end] {
                assert!((45.0..46.0).contains(&elevation(time)), "{} {time}", elevation(time));
            }
            assert_eq!((start.subsec_nanosecond(), end.subsec_nanosecond()), (0, 0));
        }
    }

    #[test]
    fn a_pass_that_stays_too_low_has_no_window() {
        let station = station([0.0, 89.5]);
        let predicted = predicted_pass(&station);
        let highest_deg = predicted.pass.max_elevation().degrees();
        let refused = window(&predicted, &station.antennas[1], station.site, now());
        assert_eq!(refused, Err(Refusal::TooLow { highest_deg, lowest_deg: 89.5 }));
    }
}
