//! Parts of the predicted passes that the horizon mask, the keep-outs and the Sun block.

use std::ops::Range;

use super::{Compare, PassTrack};
use crate::{
    astro::{
        Angle, AzEl, HorizonMask, Site, sun_moon,
        time::{add_seconds, seconds_between},
    },
    plan::Sample,
    station::{Entered, KeepOut, SunAvoidance},
};

/// Interval between two computed positions of the Sun, seconds. The Sun moves a tenth of a degree
/// in this time.
const SUN_STEP_S: f64 = 24.0;

/// The obstacles for the passes of an antenna.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacles {
    /// Horizon mask of the site; `None` without a mask.
    pub mask: Option<HorizonMask>,
    /// Keep-outs of the station.
    pub keep_outs: Vec<KeepOut>,
    /// Sun avoidance; `None` if it is off.
    pub sun: Option<SunAvoidance>,
}

/// A question: the obstacles to compare.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// Saved obstacles.
    pub before: Obstacles,
    /// Edited obstacles.
    pub after: Obstacles,
    /// Antenna whose passes Azel evaluates; `None` at a site without an antenna.
    pub antenna: Option<String>,
    /// Half of the beam width of the antenna.
    pub half_beam: Angle,
    /// Site from which the passes are seen.
    pub site: Site,
}

/// Effect of a keep-out on the passes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Toll {
    /// Number of passes that touch the zone.
    pub passes: usize,
    /// Total time of these passes inside the zone, seconds.
    pub time_s: f64,
    /// Parts of the tracks inside the zone: index of the track and range of its samples.
    pub blocked: Vec<(usize, Range<usize>)>,
}

/// Effect of all obstacles on the passes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tally {
    /// Passes that a keep-out or the Sun touches.
    pub touched: usize,
    /// Time lost to the Sun and to keep-outs that do more than warn, seconds.
    pub lost_s: f64,
    /// Passes without any clear part.
    pub impossible: usize,
    /// Passes that the mask cuts.
    pub masked: usize,
    /// Effect of each keep-out, in the order of the keep-outs.
    pub of_each: Vec<Toll>,
    /// Effect of the Sun; `None` without Sun avoidance.
    pub of_sun: Option<Toll>,
}

impl Compare for Question {
    type Tally = Tally;
    /// Every third sample, one each 6 s.
    const EVERY: usize = 3;

    fn tallies(&self, ways: &[PassTrack]) -> [Tally; 2] {
        [&self.before, &self.after].map(|obstacles| tally(obstacles, self, ways))
    }
}

fn tally(obstacles: &Obstacles, question: &Question, ways: &[PassTrack]) -> Tally {
    let mut tally = Tally::default();
    tally.of_each.resize(obstacles.keep_outs.len(), Toll::default());
    tally.of_sun = obstacles.sun.map(|_| Toll::default());
    for (index, way) in ways.iter().enumerate() {
        let is_masked = |sample: &Sample| {
            let skyline = obstacles
                .mask
                .as_ref()
                .map(|horizon_mask| horizon_mask.elevation_at(sample.direction.azimuth));
            skyline.is_some_and(|skyline| sample.direction.elevation < skyline)
        };
        let visible: Vec<bool> = way.samples.iter().map(|sample| !is_masked(sample)).collect();
        tally.masked += usize::from(visible.contains(&false));
        let mut free = visible.clone();
        let mut is_touched = false;
        for (keep_out, toll) in obstacles.keep_outs.iter().zip(&mut tally.of_each) {
            let holds = question.antenna.as_ref().is_none_or(|name| keep_out.holds_for(name));
            if !holds {
                continue;
            }
            let is_inside: Vec<bool> = way
                .samples
                .iter()
                .zip(&visible)
                .map(|(sample, is_visible)| {
                    let margin = keep_out.margin() + question.half_beam;
                    *is_visible && keep_out.zone.clearance(sample.direction) < margin
                })
                .collect();
            let stretches = stretches(&is_inside);
            if stretches.is_empty() {
                continue;
            }
            is_touched = true;
            toll.add(index, way, stretches);
            if keep_out.entered != Entered::Warn {
                for (free, is_inside) in free.iter_mut().zip(&is_inside) {
                    *free &= !is_inside;
                }
            }
        }
        if let (Some(sun), Some(toll)) = (obstacles.sun, &mut tally.of_sun) {
            let is_inside = near_sun(sun, question.site, way, &visible);
            let stretches = stretches(&is_inside);
            if !stretches.is_empty() {
                is_touched = true;
                toll.add(index, way, stretches);
                for (free, is_inside) in free.iter_mut().zip(&is_inside) {
                    *free &= !is_inside;
                }
            }
        }
        tally.touched += usize::from(is_touched);
        let blocked: Vec<bool> =
            visible.iter().zip(&free).map(|(is_visible, free)| *is_visible && !free).collect();
        let lost_s: f64 = stretches(&blocked).iter().map(|stretch| time_s(way, stretch)).sum();
        tally.lost_s += lost_s;
        tally.impossible += usize::from(lost_s > 0.0 && !free.contains(&true));
    }
    tally
}

impl Toll {
    fn add(&mut self, index: usize, way: &PassTrack, stretches: Vec<Range<usize>>) {
        self.passes += 1;
        self.time_s += stretches.iter().map(|stretch| time_s(way, stretch)).sum::<f64>();
        self.blocked.extend(stretches.into_iter().map(|stretch| (index, stretch)));
    }
}

/// Returns a flag for each sample. The flag is `true` if the sample is `visible` and too close to
/// the Sun at its time or within the look-ahead time.
fn near_sun(sun: SunAvoidance, site: Site, way: &PassTrack, visible: &[bool]) -> Vec<bool> {
    let (Some(first), Some(last)) = (way.samples.first(), way.samples.last()) else {
        return Vec::new();
    };
    let span_s = seconds_between(first.time, last.time) + sun.ahead_min * 60.0;
    let steps = (span_s / SUN_STEP_S).ceil().max(0.0) as u32;
    let suns: Vec<AzEl> = (0..=steps)
        .map(|step| sun_moon::sun(site, add_seconds(first.time, f64::from(step) * SUN_STEP_S)))
        .collect();
    let place = |after_s: f64| (after_s / SUN_STEP_S).max(0.0) as usize;
    let is_near = |(sample, is_visible): (&Sample, &bool)| {
        let after_s = seconds_between(first.time, sample.time);
        let ahead = suns.iter().take(place(after_s + sun.ahead_min * 60.0) + 1);
        let mut ahead = ahead.skip(place(after_s));
        *is_visible
            && ahead
                .any(|direction| sample.direction.separation(*direction).degrees() < sun.radius_deg)
    };
    way.samples.iter().zip(visible).map(is_near).collect()
}

/// Returns the unbroken runs of `flags`.
fn stretches(flags: &[bool]) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for (index, _) in flags.iter().enumerate().filter(|(_, is_inside)| **is_inside) {
        match found.last_mut() {
            Some(last) if last.end == index => last.end = index + 1,
            _ => found.push(index..index + 1),
        }
    }
    found
}

/// Returns the duration of a stretch, seconds. The stretch extends by half a step at each end where
/// the track continues.
fn time_s(way: &PassTrack, stretch: &Range<usize>) -> f64 {
    let time = |index: usize| way.samples.get(index).map(|sample| sample.time);
    let (Some(first), Some(last)) = (time(stretch.start), time(stretch.end.saturating_sub(1)))
    else {
        return 0.0;
    };
    let before = stretch.start.checked_sub(1).and_then(time).unwrap_or(first);
    let after = time(stretch.end).unwrap_or(last);
    seconds_between(first, last)
        + seconds_between(before, first) / 2.0
        + seconds_between(last, after) / 2.0
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    /// Returns a track at 20 degrees of elevation from north over east to south, one degree every 6
    /// s.
    fn way() -> PassTrack {
        let start: Timestamp = "2026-11-14T12:00:00Z".parse().unwrap();
        let samples = (0..=180).map(|step| Sample {
            time: add_seconds(start, f64::from(step) * 6.0),
            direction: AzEl::from_degrees(f64::from(step), 20.0),
        });
        PassTrack { number: 1, samples: samples.collect() }
    }

    fn keep_out(from_deg: f64, to_deg: f64, entered: Entered) -> KeepOut {
        let corners = [(from_deg, 0.0), (from_deg, 30.0), (to_deg, 30.0), (to_deg, 0.0)];
        KeepOut {
            name: from_deg.to_string(),
            reason: String::new(),
            entered,
            antenna: None,
            margin_deg: 0.0,
            zone: KeepOut::zone_of(&corners).unwrap(),
        }
    }

    fn effect(keep_outs: Vec<KeepOut>, mask: &str) -> Tally {
        let after = Obstacles { mask: HorizonMask::parse(mask).ok(), keep_outs, sun: None };
        let question = question(after);
        let [before, after] = question.tallies(&[way()]);
        assert_eq!(before, Tally::default());
        after
    }

    fn question(after: Obstacles) -> Question {
        Question {
            before: Obstacles { mask: None, keep_outs: Vec::new(), sun: None },
            after,
            antenna: Some("Satrak".to_owned()),
            half_beam: Angle::ZERO,
            site: Site::new(41.0, 29.0, 100.0).unwrap(),
        }
    }

    #[test]
    fn a_pass_through_the_surroundings_of_the_sun_is_counted() {
        let site = Site::new(41.0, 29.0, 100.0).unwrap();
        let start: Timestamp = "2026-08-12T10:00:00Z".parse().unwrap();
        let track_through = |place: AzEl| {
            // The track rises from 20 degrees below the horizon to 20 degrees above, one degree
            // every 6 s.
            let samples = (-20..=20).map(|step| Sample {
                time: add_seconds(start, f64::from(step + 20) * 6.0),
                direction: AzEl {
                    elevation: place.elevation + Angle::from_degrees(f64::from(step)),
                    ..place
                },
            });
            PassTrack { number: 1, samples: samples.collect() }
        };
        let tally = |way: &PassTrack, sun| {
            let after = Obstacles { mask: None, keep_outs: Vec::new(), sun };
            let [_, after] = question(after).tallies(std::slice::from_ref(way));
            after
        };
        let radius_deg = 5.5;
        let now = Some(SunAvoidance { radius_deg, ahead_min: 0.0 });
        let way = track_through(sun_moon::sun(site, start));
        assert_eq!(tally(&way, None), Tally::default());
        let outcome = tally(&way, now);
        let toll = outcome.of_sun.clone().unwrap();
        assert_eq!((outcome.touched, toll.passes, outcome.impossible), (1, 1, 0));
        assert!((outcome.lost_s - 66.0).abs() < 7.0, "{outcome:?}");

        let later = track_through(sun_moon::sun(site, add_seconds(start, 50.0 * 60.0)));
        assert_eq!(tally(&later, now).touched, 0);
        let ahead = Some(SunAvoidance { radius_deg, ahead_min: 60.0 });
        assert_eq!(tally(&later, ahead).touched, 1, "where it will be");
    }

    #[test]
    fn the_time_in_a_keep_out_is_counted() {
        let tally = effect(vec![keep_out(39.5, 59.5, Entered::Hard)], "");
        assert_eq!((tally.touched, tally.impossible, tally.masked), (1, 0, 0));
        assert!((tally.lost_s - 120.0).abs() < 1e-6, "{}", tally.lost_s);
        assert_eq!(tally.of_each[0].blocked, [(0, 40..60)]);
    }

    #[test]
    fn what_only_warns_costs_nothing_and_what_is_hidden_is_not_lost_twice() {
        let tally = effect(vec![keep_out(39.5, 59.5, Entered::Warn)], "");
        assert_eq!((tally.touched, tally.of_each[0].passes), (1, 1));
        assert!(tally.lost_s.abs() < 1e-9);
        let hidden = "0 0\n38 0\n39 25\n61 25\n62 0";
        let tally = effect(vec![keep_out(39.5, 59.5, Entered::Hard)], hidden);
        assert_eq!((tally.touched, tally.masked), (0, 1));
        assert!(tally.lost_s.abs() < 1e-9);
    }

    #[test]
    fn keep_outs_that_leave_nothing_make_a_pass_impossible() {
        let zones =
            vec![keep_out(-1.0, 90.5, Entered::Hard), keep_out(80.0, 181.0, Entered::GoRound)];
        let tally = effect(zones, "");
        assert_eq!((tally.touched, tally.impossible), (1, 1));
        assert!((tally.lost_s - 1080.0).abs() < 1e-6, "an overlap counts once: {}", tally.lost_s);
        let other =
            KeepOut { antenna: Some("Genius".to_owned()), ..keep_out(-1.0, 181.0, Entered::Hard) };
        assert_eq!(effect(vec![other], "").touched, 0);
    }
}
