//! A pass as seen from the site: when it is above a height and the horizon mask, and where it is.

use super::way::{Span, at_ms, ms};
use crate::{
    astro::{Angle, HorizonMask, Site},
    orbit::{Pass, Propagator, clear_stretches},
    plan::Sample,
};

/// Distance between samples, seconds, and their greatest numbers.
const FINE_S: f64 = 2.0;
const COARSE_S: f64 = 20.0;
const MAX_FINE: f64 = 600.0;
const MAX_COARSE: f64 = 60.0;
/// Halvings that find when a height is crossed, to some milliseconds.
const HALVINGS: usize = 18;

/// Directions at equal intervals.
#[derive(Debug, Clone, Default)]
pub(super) struct Samples {
    pub(super) list: Vec<Sample>,
    pub(super) step_s: f64,
}

/// One pass, prepared for all antennas of a site.
pub struct Sight<'a> {
    propagator: &'a Propagator,
    site: Site,
    mask: Option<&'a HorizonMask>,
    pass: &'a Pass,
    /// What was sampled last, coarse and fine.
    kept: [Option<(Span, Samples)>; 2],
    clear: Option<Vec<Span>>,
}

impl<'a> Sight<'a> {
    pub fn new(
        propagator: &'a Propagator,
        site: Site,
        mask: Option<&'a HorizonMask>,
        pass: &'a Pass,
    ) -> Self {
        Self { propagator, site, mask, pass, kept: [None, None], clear: None }
    }

    /// From the first to the last moment at `elevation` or higher; `None` if the pass stays below.
    pub(super) fn above(&self, elevation: Angle) -> Option<Span> {
        let [aos, tca, los] = [self.pass.aos, self.pass.tca, self.pass.los];
        if tca.direction.elevation < elevation {
            return None;
        }
        let top_ms = ms(tca.time);
        let end = |end_ms: i64, at: Angle| {
            if at >= elevation { end_ms } else { self.crossing(end_ms, top_ms, elevation) }
        };
        let from_ms = end(ms(aos.time), aos.direction.elevation);
        let to_ms = end(ms(los.time), los.direction.elevation);
        (from_ms < to_ms).then_some(Span { from_ms, to_ms })
    }

    fn crossing(&self, mut below_ms: i64, mut above_ms: i64, elevation: Angle) -> i64 {
        for _ in 0..HALVINGS {
            let middle_ms = i64::midpoint(below_ms, above_ms);
            let look = self.propagator.look_from(self.site, at_ms(middle_ms));
            if look.is_ok_and(|look| look.direction.elevation >= elevation) {
                above_ms = middle_ms;
            } else {
                below_ms = middle_ms;
            }
        }
        above_ms
    }

    /// The parts of `span` above the horizon mask.
    pub(super) fn clear(&mut self, span: Span) -> Vec<Span> {
        let Some(mask) = self.mask else { return vec![span] };
        let (propagator, site, pass) = (self.propagator, self.site, self.pass);
        let clear = self.clear.get_or_insert_with(|| {
            let stretches = clear_stretches(propagator, site, mask, pass);
            let span = |it: &Pass| Span { from_ms: ms(it.aos.time), to_ms: ms(it.los.time) };
            stretches.iter().map(span).filter(|span| span.from_ms < span.to_ms).collect()
        });
        Span::both(clear, &[span])
    }

    pub(super) fn samples(&mut self, span: Span, fine: bool) -> &Samples {
        let (propagator, site) = (self.propagator, self.site);
        let [coarse, dense] = &mut self.kept;
        let kept = if fine { dense } else { coarse };
        if kept.as_ref().is_some_and(|(of, _)| *of != span) {
            *kept = None;
        }
        let kept = kept.get_or_insert_with(|| (span, sampled(propagator, site, span, fine)));
        &kept.1
    }
}

fn sampled(propagator: &Propagator, site: Site, span: Span, fine: bool) -> Samples {
    let seconds = span.length_ms() as f64 / 1000.0;
    let (least_s, most) = if fine { (FINE_S, MAX_FINE) } else { (COARSE_S, MAX_COARSE) };
    let step_s = least_s.max(seconds / most);
    let steps = (seconds / step_s).ceil().max(1.0);
    let step_s = seconds / steps;
    let list = (0..=steps as i64)
        .map(|step| at_ms(span.from_ms + (step as f64 * step_s * 1000.0).round() as i64))
        .filter_map(|time| {
            let direction = propagator.look_from(site, time).ok()?.direction;
            Some(Sample { time, direction })
        })
        .collect();
    Samples { list, step_s }
}
