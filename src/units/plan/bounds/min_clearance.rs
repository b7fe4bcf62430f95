//! Smallest clearances among the samples of a range of positions.
//!
//! A clearance changes by no more than the direction does. So a check of the middle rules out a
//! part of the range that cannot come nearer than an earlier result.

use super::{Angle, BoundsAt, Sweep};

/// Samples of both axes, from the first to the last of each.
type SampleRange = [(usize, usize); 2];

impl BoundsAt<'_> {
    /// Returns the smallest clearance, among the samples of `place`, from each group of barriers.
    /// `groups` contains the group of each barrier in order; `None` for an ignored barrier.
    pub(super) fn min_in_groups<const GROUPS: usize>(
        &self,
        place: Sweep,
        groups: &[Option<usize>],
    ) -> [Angle; GROUPS] {
        let mut minima = [Angle::from_degrees(f64::INFINITY); GROUPS];
        self.lower_to_min(place, groups, &mut minima);
        minima
    }

    pub(super) fn lower_to_min(
        &self,
        place: Sweep,
        groups: &[Option<usize>],
        minima: &mut [Angle],
    ) {
        let samples = place.sampled();
        let whole: SampleRange = samples.steps.map(|steps| (0, steps));
        let all: Vec<usize> = (0..groups.len()).collect();
        let mut open = vec![(whole, all)];
        while let Some((part, barriers)) = open.pop() {
            let middle = part.map(|(first, last)| usize::midpoint(first, last));
            let here_deg = samples.sample(middle);
            let ends_deg = [0, 1].map(|end| {
                samples.sample(part.map(|(first, last)| if end == 0 { first } else { last }))
            });
            let off_deg = ends_deg
                .map(|end_deg| (end_deg[0] - here_deg[0]).abs() + (end_deg[1] - here_deg[1]).abs());
            let radius = Angle::from_degrees(off_deg[0].max(off_deg[1]) * self.max_beam_turn());
            let aim = self.aim(here_deg);
            let mut near = Vec::new();
            let mut pending = barriers.iter().copied().peekable();
            for (index, barrier) in self.barriers(aim).enumerate() {
                if pending.next_if_eq(&index).is_none() {
                    continue;
                }
                let Some(min) =
                    groups.get(index).copied().flatten().and_then(|group| minima.get_mut(group))
                else {
                    continue;
                };
                let limit = *min + radius;
                let angle = barrier.angle_unless_from(limit);
                if angle < *min {
                    *min = angle;
                }
                if angle < limit {
                    near.push(index);
                }
            }
            if !near.is_empty() {
                open.extend(halves(part).into_iter().flatten().map(|half| (half, near.clone())));
            }
        }
    }
}

/// Returns both halves of a part of more than one sample.
fn halves(part: SampleRange) -> Option<[SampleRange; 2]> {
    let [first, second] = part;
    let span = |(start, end): (usize, usize)| end - start;
    if span(first).max(span(second)) == 0 {
        return None;
    }
    let cut = |(first, last): (usize, usize)| {
        let middle = usize::midpoint(first, last);
        [(first, middle), (middle + 1, last)]
    };
    Some(if span(first) >= span(second) {
        cut(first).map(|half| [half, second])
    } else {
        cut(second).map(|half| [first, half])
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        plan::Bounds,
        station::{Antenna, Entered, KeepOut, Mount, Station, SunAvoidance},
    };

    fn keep_out(index: usize, at_deg: (f64, f64), size_deg: (f64, f64)) -> KeepOut {
        let ((azimuth, elevation), (width, height)) = (at_deg, size_deg);
        let corners = [
            (azimuth, elevation),
            (azimuth + width, elevation),
            (azimuth + width / 2.0, elevation + height),
        ];
        KeepOut {
            name: format!("zone {index}"),
            reason: String::new(),
            entered: Entered::Hard,
            antenna: None,
            margin_deg: 1.0,
            zone: KeepOut::zone_of(&corners).unwrap(),
        }
    }

    proptest! {
        #[test]
        fn no_sample_is_nearer_and_one_is_as_near(
            zones in prop::collection::vec(((0.0..340.0, -5.0..60.0), (5.0..60.0, 5.0..25.0)), 0..6),
            from_deg in (0.0..360.0, 0.0..90.0),
            widths_deg in (0.0..360.0, 0.0..90.0),
            (is_crossed, tilt_deg) in (any::<bool>(), -4.0..4.0),
        ) {
            let mut antenna = Antenna::satrak("Dish", "memory:1");
            if !is_crossed {
                antenna.mount = Mount::AzEl {
                    azimuth_from_deg: 0.0,
                    azimuth_to_deg: 360.0,
                    elevation_from_deg: 0.0,
                    elevation_to_deg: 90.0,
                };
                antenna.pointing_model.tilt_east_deg = tilt_deg;
            }
            let keep_outs = zones.into_iter().enumerate();
            let station = Station {
                keep_outs: keep_outs.map(|(index, (corner, size))| keep_out(index, corner, size)).collect(),
                sun_avoidance: Some(SunAvoidance { radius_deg: 5.0, ahead_min: 0.0 }),
                ..Station::default()
            };
            let bounds = Bounds::new(&station, &antenna);
            let now = bounds.at_time("2026-08-12T10:00:00Z".parse().unwrap());
            let ends_deg = [(from_deg.0, widths_deg.0), (from_deg.1, widths_deg.1)];
            let place = Sweep(ends_deg.map(|(start, width)| (start, start + width)));
            let clearances = now.each_in(place);
            for (index, (_, min, _)) in clearances.iter().enumerate() {
                let clear_deg = place.samples().map(|sample| {
                    now.barriers(now.aim(sample)).nth(index).unwrap().angle().degrees()
                });
                let wanted_deg = clear_deg.fold(f64::INFINITY, f64::min);
                prop_assert!((min.degrees() - wanted_deg).abs() < 1e-9, "{min:?} {wanted_deg}");
            }
        }
    }
}
