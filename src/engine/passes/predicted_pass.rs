//! One pass of one satellite. Its outline is computed at first use, because a list may hold
//! a hundred thousand passes.

use std::sync::{Arc, OnceLock};

use jiff::Timestamp;

use super::PassKey;
use crate::{
    astro::{Angle, Site, time::add_seconds},
    orbit::{Elements, Pass, PassSearch, Propagator, passes},
    plan::{MountLimits, ProgramTrack, Sample, Target, Trackability, trackability},
    station::{Antenna, Station},
};

/// Maximum number of samples in a drawn track.
const MAX_SAMPLES: f64 = 600.0;
/// Span ahead for the later passes of a satellite in program track.
const LATER_S: f64 = 7.0 * 86_400.0;

/// Smallest distance between samples of the outline: one point of a thumbnail.
const OUTLINE_STEP_DEG: f64 = 3.0;

/// A satellite of a list.
#[derive(Debug)]
pub struct ListedSatellite {
    pub elements: Elements,
    pub propagator: Propagator,
}

impl ListedSatellite {
    /// The name up to the first opening bracket.
    pub fn short_name(&self) -> &str {
        let name = self.elements.name();
        name.split_once(" (").map_or(name, |(short, _)| short)
    }
}

/// Site, horizon and antennas of a station, as far as passes depend on them.
#[derive(Debug, Clone, PartialEq)]
pub struct Observer {
    pub site: Site,
    /// Elevation of AOS and LOS.
    pub aos_elevation: Angle,
    /// Mount limits of the antennas, in their order.
    pub antennas: Vec<MountLimits>,
}

impl Observer {
    /// The observer of a station; its first antenna sets the horizon.
    pub fn of(station: &Station) -> Self {
        let antenna = station.antennas.first();
        Self {
            site: station.site,
            aos_elevation: Angle::from_degrees(
                antenna.map_or(0.0, |antenna| antenna.limits.minimum_elevation_deg),
            ),
            antennas: station.antennas.iter().map(mount_limits).collect(),
        }
    }
}

/// A pass with everything that is shown of it.
#[derive(Debug, Clone)]
pub struct PredictedPass {
    pub satellite: Arc<ListedSatellite>,
    pub pass: Pass,
    observer: Arc<Observer>,
    outline: OnceLock<Box<Outline>>,
}

/// Computed figures of a pass.
#[derive(Debug, Clone)]
struct Outline {
    path: Vec<Sample>,
    /// By the index of the antenna.
    trackability: Vec<Trackability>,
    track: OnceLock<Vec<Sample>>,
}

impl PredictedPass {
    /// A pass of `satellite` seen from `observer`.
    pub fn new(satellite: Arc<ListedSatellite>, pass: Pass, observer: Arc<Observer>) -> Self {
        Self { satellite, pass, observer, outline: OnceLock::new() }
    }

    pub fn key(&self) -> PassKey {
        (self.number(), self.pass.aos.time)
    }

    /// The program track for this pass and, in the next days, later passes of its satellite
    /// that reach `floor`.
    pub fn follow(&self, floor: Angle) -> ProgramTrack {
        let mut los = self.pass.los.time;
        // The end of the search has cut this pass: look for its true LOS.
        let from = if self.pass.ends_after { self.pass.tca.time } else { los };
        let search = PassSearch {
            aos_elevation: self.observer.aos_elevation,
            floor,
            ..PassSearch::new(self.observer.site, from, add_seconds(from, LATER_S))
        };
        let mut spans = Vec::new();
        if !self.is_always_up() {
            let found = passes(&self.satellite.propagator, &search, &|| false);
            if let Some(whole) = found.first().filter(|_| self.pass.ends_after)
                && whole.starts_before
            {
                los = whole.los.time;
            }
            let later = found.iter().filter(|pass| !pass.starts_before);
            spans.push((self.pass.aos.time, los));
            spans.extend(later.map(|pass| (pass.aos.time, pass.los.time)));
        }
        let elements = Box::new(self.satellite.elements.clone());
        let target = Target::Satellite(elements);
        ProgramTrack { target, site: self.observer.site, passes: spans }
    }

    /// Catalog number of its satellite.
    pub fn number(&self) -> u32 {
        self.satellite.elements.catalog_number()
    }

    /// Returns `true` if the satellite neither rises nor sets within the list.
    pub fn is_always_up(&self) -> bool {
        self.pass.starts_before && self.pass.ends_after
    }

    /// Returns `true` if the satellite is up at `now`.
    pub fn in_progress(&self, now: Timestamp) -> bool {
        self.pass.aos.time <= now && now < self.pass.los.time
    }

    /// Samples from AOS to LOS, every 2 s or a little more; computed at the first call and
    /// kept.
    pub fn track(&self) -> &[Sample] {
        self.outline().track.get_or_init(|| self.sampled())
    }

    /// The track with no more points than a small picture needs.
    pub fn path(&self) -> &[Sample] {
        &self.outline().path
    }

    /// Trackability of the pass with this antenna; `None` without one.
    pub fn trackability(&self, antenna: usize) -> Option<Trackability> {
        self.outline().trackability.get(antenna).copied()
    }

    fn outline(&self) -> &Outline {
        self.outline.get_or_init(|| {
            let track = self.sampled();
            let antennas = self.observer.antennas.iter();
            Box::new(Outline {
                trackability: antennas.map(|limits| trackability(&track, *limits)).collect(),
                path: thinned(&track),
                track: OnceLock::new(),
            })
        })
    }

    fn sampled(&self) -> Vec<Sample> {
        let duration_s = self.pass.duration_s();
        let step_s = (duration_s / MAX_SAMPLES).max(2.0);
        let count = (duration_s / step_s).ceil() as usize;
        (0..=count)
            .map(|index| add_seconds(self.pass.aos.time, (index as f64 * step_s).min(duration_s)))
            .filter_map(|time| {
                let look = self.satellite.propagator.look_from(self.observer.site, time).ok()?;
                Some(Sample { time, direction: look.direction })
            })
            .collect()
    }
}

fn mount_limits(antenna: &Antenna) -> MountLimits {
    MountLimits {
        mount: antenna.mount,
        maximum_rate_deg_s: antenna.limits.maximum_rate_deg_s,
        half_beam: Angle::from_degrees(antenna.beam_width_deg / 2.0),
        has_elevation: antenna.connection.variant().capabilities.has_elevation(),
    }
}

fn thinned(track: &[Sample]) -> Vec<Sample> {
    let mut path: Vec<Sample> = Vec::new();
    let last = track.len().saturating_sub(1);
    for (index, sample) in track.iter().enumerate() {
        let is_far = path.last().is_none_or(|kept| {
            kept.direction.separation(sample.direction).degrees() >= OUTLINE_STEP_DEG
        });
        if is_far || index == last {
            path.push(*sample);
        }
    }
    path.shrink_to_fit();
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{makes::DemoAddresses, orbit::bundled};

    #[test]
    fn an_outline_has_the_ends_and_the_verdict_of_the_whole_track() {
        let elements = bundled().unwrap().get(25_544).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let from: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let station = Station::demo(&DemoAddresses::default());
        let search = PassSearch::new(station.site, from, add_seconds(from, 86_400.0));
        let observer = Arc::new(Observer::of(&station));
        let found = passes(&propagator, &search, &|| false);
        let satellite = Arc::new(ListedSatellite { elements, propagator });
        assert!(found.len() > 3);
        for pass in found {
            let predicted = PredictedPass::new(Arc::clone(&satellite), pass, Arc::clone(&observer));
            let (path, track) = (predicted.path(), predicted.track());
            assert_eq!((path.first(), path.last()), (track.first(), track.last()));
            assert!(path.len() > 10 && path.len() < 70, "{}", path.len());
            assert!(track.len() as f64 >= pass.duration_s() / 2.0);
            for (index, limits) in observer.antennas.iter().enumerate() {
                assert_eq!(predicted.trackability(index), Some(trackability(track, *limits)));
            }
        }
    }

    #[test]
    fn a_hundred_thousand_passes_are_small() {
        assert!(
            size_of::<PredictedPass>() * 100_000 < 15_000_000,
            "{}",
            size_of::<PredictedPass>()
        );
    }
}
