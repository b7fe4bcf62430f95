//! Motion of an azimuth axis through a pass. An axis with ends cannot follow every turn of the sky,
//! so its initial turn decides whether it must slew a whole turn in the middle.

const TURN_DEG: f64 = 360.0;

/// Ends of an azimuth axis, in degrees from north through east as the axis counts: usually 0 to
/// 360, also 0 to 450 or -180 to 540, or less than a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AzimuthRange {
    from_deg: f64,
    to_deg: f64,
}

impl AzimuthRange {
    /// Creates the range from `from_deg` to `to_deg`; `None` for an empty range or for values that
    /// are not numbers.
    pub(super) fn new((from_deg, to_deg): (f64, f64)) -> Option<Self> {
        let is_one = from_deg.is_finite() && to_deg > from_deg && to_deg.is_finite();
        is_one.then_some(Self { from_deg, to_deg })
    }

    fn holds(self, axis_deg: f64) -> bool {
        (self.from_deg..=self.to_deg).contains(&axis_deg)
    }

    /// Returns all positions of the axis that point to `azimuth_deg`, in ascending order.
    fn positions(self, azimuth_deg: f64) -> impl Iterator<Item = f64> {
        let lowest = self.from_deg + (azimuth_deg - self.from_deg).rem_euclid(TURN_DEG);
        let turns = (0..).map(move |turn: u32| lowest + TURN_DEG * f64::from(turn));
        turns.take_while(move |position| *position <= self.to_deg)
    }

    fn nearest_end(self, azimuth_deg: f64) -> f64 {
        let distance = |end_deg: f64| {
            let deviation = (azimuth_deg - end_deg).rem_euclid(TURN_DEG);
            deviation.min(TURN_DEG - deviation)
        };
        if distance(self.to_deg) < distance(self.from_deg) { self.to_deg } else { self.from_deg }
    }
}

/// Positions of an azimuth axis along a pass.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct AzimuthWrap {
    /// Axis positions, degrees as the axis counts, one per azimuth.
    pub(super) positions_deg: Vec<f64>,
    /// Indices of the positions that the axis reaches by slewing a whole turn, because it is at an
    /// end.
    pub(super) slews: Vec<usize>,
}

impl AzimuthWrap {
    /// Returns the positions along `azimuths_deg`, which are unwrapped and a few degrees apart,
    /// with the fewest slews of a whole turn. `axis_now_deg` is the current position: among wraps
    /// with the same number of slews, takes the one with the nearer beginning. If no position of
    /// the axis points to an azimuth, the axis waits at an end. Before the first azimuth that it
    /// reaches and after the last, this is the end next to that azimuth; otherwise the nearer end.
    pub(super) fn along(
        azimuths_deg: &[f64],
        range: AzimuthRange,
        axis_now_deg: Option<f64>,
    ) -> Self {
        let is_reached = |azimuth_deg: &f64| range.positions(*azimuth_deg).next().is_some();
        let reached = azimuths_deg.iter().position(is_reached);
        let reached = reached.zip(azimuths_deg.iter().rposition(is_reached));
        let mut wrap = Self::default();
        let mut start = 0;
        while let Some(first) = azimuths_deg.get(start) {
            let rest = azimuths_deg.get(start..).unwrap_or_default();
            if !is_reached(first) {
                let next_to = reached.map_or(start, |(first, last)| start.clamp(first, last));
                wrap.go_on(range.nearest_end(*azimuths_deg.get(next_to).unwrap_or(first)));
                start += 1;
                continue;
            }
            let near = wrap.positions_deg.last().copied().or(axis_now_deg);
            let mut best: Option<(usize, f64, f64)> = None;
            for position in range.positions(*first) {
                let shift = position - first;
                let lasts =
                    rest.iter().take_while(|degrees| range.holds(**degrees + shift)).count();
                let way = near.map_or(0.0, |near| (position - near).abs());
                let is_better = best.is_none_or(|(max, _, shortest)| {
                    lasts > max || (lasts == max && way < shortest)
                });
                if is_better {
                    best = Some((lasts, shift, way));
                }
            }
            // Rounding may put a position just outside an end.
            let (lasts, shift, _) = best.unwrap_or((1, 0.0, 0.0));
            for axis_deg in rest.iter().take(lasts.max(1)) {
                wrap.go_on(axis_deg + shift);
            }
            start += lasts.max(1);
        }
        wrap
    }

    fn go_on(&mut self, axis_deg: f64) {
        let before = self.positions_deg.last();
        if before.is_some_and(|before_deg| (axis_deg - before_deg).abs() > TURN_DEG / 2.0) {
            self.slews.push(self.positions_deg.len());
        }
        self.positions_deg.push(axis_deg);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: (f64, f64) = (0.0, 360.0);
    const OVERLAP: (f64, f64) = (0.0, 450.0);

    fn wrap(azimuths_deg: &[f64], ends_deg: (f64, f64), now: Option<f64>) -> AzimuthWrap {
        AzimuthWrap::along(azimuths_deg, AzimuthRange::new(ends_deg).unwrap(), now)
    }

    /// Returns the degrees from `start` to `end`, both included.
    fn sweep(start: i32, end: i32) -> Vec<f64> {
        let step = if start < end { 1 } else { -1 };
        (0..=(end - start).abs()).map(|count| f64::from(start + step * count)).collect()
    }

    fn start(wrap: &AzimuthWrap) -> Option<f64> {
        wrap.positions_deg.first().map(|first| first.round())
    }

    #[test]
    fn a_pass_through_north_slews_once_on_a_plain_axis_and_not_with_an_overlap() {
        for azimuths in [sweep(300, 420), sweep(60, -60)] {
            let plain = wrap(&azimuths, PLAIN, None);
            assert_eq!(plain.slews.len(), 1);
            let overlap = wrap(&azimuths, OVERLAP, None);
            assert!(overlap.slews.is_empty(), "{overlap:?}");
            let jump = overlap.positions_deg.windows(2).map(|two| (two[1] - two[0]).abs());
            assert!(jump.fold(0.0, f64::max) < 1.01);
        }
    }

    #[test]
    fn the_turn_that_lasts_is_taken_even_when_it_begins_further_away() {
        // The sweep turns from 80 down through north to 300: beginning at 440, the axis needs no
        // slew.
        let wrap = wrap(&sweep(80, -60), OVERLAP, Some(75.0));
        assert_eq!(start(&wrap), Some(440.0));
        assert!(wrap.slews.is_empty());
    }

    #[test]
    fn of_two_turns_that_last_the_nearer_is_taken() {
        for (now, first) in [(10.0, 20.0), (400.0, 380.0)] {
            assert_eq!(start(&wrap(&sweep(20, 60), OVERLAP, Some(now))), Some(first), "{now}");
        }
    }

    #[test]
    fn every_position_is_within_the_ends_and_points_where_it_should() {
        for (first, end) in [PLAIN, OVERLAP, (-180.0, 180.0), (-180.0, 540.0), (90.0, 480.0)] {
            for start in (-720..720).step_by(37) {
                for way in [-500, -123, 7, 200, 500] {
                    let azimuths = sweep(start, start + way);
                    let wrap = wrap(&azimuths, (first, end), None);
                    assert_eq!(wrap.positions_deg.len(), azimuths.len());
                    for (axis, azimuth) in wrap.positions_deg.iter().zip(&azimuths) {
                        assert!((first - 1e-6..=end + 1e-6).contains(axis), "{axis}");
                        let turns = (axis - azimuth) / TURN_DEG;
                        assert!((turns - turns.round()).abs() < 1e-6);
                    }
                }
            }
        }
    }

    #[test]
    fn an_axis_of_less_than_a_turn_waits_at_the_better_end() {
        let wrap = wrap(&sweep(280, 440), (0.0, 300.0), None);
        let degrees: Vec<i32> = wrap.positions_deg.iter().map(|axis| axis.round() as i32).collect();
        assert_eq!(degrees[..=20], (280..=300).collect::<Vec<_>>());
        assert!(degrees[20..50].iter().all(|axis| *axis == 300), "{degrees:?}");
        assert!(degrees[51..=80].iter().all(|axis| *axis == 0), "{degrees:?}");
        assert_eq!(degrees[80..], (0..=80).collect::<Vec<_>>());
        assert_eq!(wrap.slews.len(), 1);
    }

    #[test]
    fn before_and_after_what_it_reaches_an_axis_stands_at_the_end_that_is_next_to_it() {
        const SECTOR: (f64, f64) = (90.0, 270.0);
        // The sweep turns from 275 through north to the end at 90, and back.
        let (out, back) = (sweep(275, 460), sweep(460, 275));
        let waits = |wrap: &AzimuthWrap| {
            let at_end =
                wrap.positions_deg.iter().filter(|axis| (**axis - 90.0).abs() < 1e-9).count();
            (at_end, wrap.slews.len())
        };
        assert_eq!(waits(&wrap(&out, SECTOR, None)), (176, 0));
        assert_eq!(waits(&wrap(&back, SECTOR, None)), (176, 0));
        // A sweep that lies wholly beyond the travel has no such end.
        let past_travel = wrap(&sweep(280, 440), SECTOR, None);
        assert_eq!(
            (start(&past_travel), past_travel.positions_deg.last()),
            (Some(270.0), Some(&90.0))
        );
    }

    #[test]
    fn an_axis_must_travel() {
        for ends_deg in [(10.0, 10.0), (f64::NAN, 360.0), (0.0, f64::INFINITY)] {
            assert_eq!(AzimuthRange::new(ends_deg), None);
        }
        assert_eq!(wrap(&[], PLAIN, None), AzimuthWrap::default());
    }
}
