//! Part of a pass that an azimuth axis of less than a turn can reach. The rest counts as lost
//! without a closer check.

use super::{Reach, TURN_DEG};
use crate::{
    astro::Angle,
    plan::{
        Sample,
        schedule::{
            sight::Samples,
            way::{Span, ms},
        },
    },
    station::Mount,
};

/// Elevation at two samples below which the satellite stays below [`TOP_DEG`] between them.
const HIGH_DEG: f64 = 45.0;
const TOP_DEG: f64 = 60.0;

impl Reach {
    /// Returns the span from the first to the last of `samples` near which the beam can contain the
    /// satellite; `None` without such a sample.
    pub(super) fn within_travel(&self, samples: &Samples, span: Span) -> Option<Span> {
        // An axis that waits outside may wait in a keep-out.
        let Some(touches) = self.touches().filter(|_| !self.has_barriers()) else {
            return Some(span);
        };
        let pairs = samples.list.iter().zip(samples.list.iter().skip(1));
        let touched = pairs.filter(|(start, end)| touches(start, end));
        touched
            .map(|(start, end)| Span { from_ms: ms(start.time), to_ms: ms(end.time) })
            .reduce(|first, last| Span { to_ms: last.to_ms, ..first })
    }

    /// Returns a test of whether the beam may contain the satellite between two samples; `None` if
    /// the axes reach all of the sky.
    fn touches(&self) -> Option<impl Fn(&Sample, &Sample) -> bool> {
        let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_to_deg, .. } =
            self.drives.mount
        else {
            return None;
        };
        // Up to this elevation, a direction is no nearer to the meridian of an azimuth than this.
        let sin_beam = self.half_beam.radians().sin() / TOP_DEG.to_radians().cos();
        let beam_deg = if sin_beam < 1.0 { sin_beam.asin().to_degrees() } else { TURN_DEG };
        let half_deg = (azimuth_to_deg - azimuth_from_deg) / 2.0 + beam_deg;
        let middle = Angle::from_degrees(f64::midpoint(azimuth_from_deg, azimuth_to_deg));
        let off_deg = |a: Angle, b: Angle| (a - b).wrapped_180().abs().degrees();
        (half_deg < TURN_DEG / 2.0 && elevation_to_deg <= 90.0).then_some(
            move |start: &Sample, end: &Sample| {
                let [first, last] = [start.direction, end.direction];
                first.elevation_deg().max(last.elevation_deg()) > HIGH_DEG
                    || off_deg(first.azimuth, middle)
                        <= half_deg + off_deg(first.azimuth, last.azimuth)
            },
        )
    }
}
