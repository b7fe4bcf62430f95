//! One pass of one satellite. The outline is computed at first use, because a list may hold a
//! hundred thousand passes.

use std::sync::{Arc, OnceLock};

use jiff::Timestamp;

use crate::{
    astro::{Angle, HorizonMask, Site, time::add_seconds},
    orbit::{Elements, Pass, PassSearch, Propagator, clear_stretches, passes},
    passes::PassListKey,
    plan::{MountLimits, ProgramTrack, Sample, Target, Trackability, trackability},
    station::{Antenna, Station},
};

/// Max number of samples in a drawn track.
const MAX_SAMPLES: f64 = 600.0;
/// Search span for the later passes of a satellite in program track, seconds.
const LATER_S: f64 = 7.0 * 86_400.0;

/// Min distance between samples of the outline, degrees: one point of a thumbnail.
const OUTLINE_STEP_DEG: f64 = 3.0;

/// A satellite of a pass list, with its elements and its propagator.
#[derive(Debug)]
pub struct ListedSatellite {
    pub elements: Elements,
    pub propagator: Propagator,
}

impl ListedSatellite {
    pub fn short_name(&self) -> &str {
        self.elements.short_name()
    }
}

/// Site, horizon and antennas of a station on which passes depend.
#[derive(Debug, Clone, PartialEq)]
pub struct Observer {
    pub site: Site,
    /// Elevation of AOS and LOS.
    pub aos_elevation: Angle,
    pub horizon_mask: Option<HorizonMask>,
    /// Mount limits of the antennas, in the order of the station.
    pub antennas: Vec<MountLimits>,
}

impl Observer {
    pub fn from_station(station: &Station) -> Self {
        Self {
            site: station.site,
            aos_elevation: station.aos_elevation(),
            horizon_mask: station.horizon_mask.clone(),
            antennas: station.antennas.iter().map(mount_limits).collect(),
        }
    }
}

/// A pass with all its displayed data.
#[derive(Debug, Clone)]
pub struct PredictedPass {
    pub satellite: Arc<ListedSatellite>,
    pub pass: Pass,
    /// Catalog number, stored here because long lists are searched by it and satellites are
    /// scattered in memory.
    number: u32,
    observer: Arc<Observer>,
    outline: OnceLock<Box<Outline>>,
}

/// Data of a pass that are computed from its track.
#[derive(Debug, Clone)]
struct Outline {
    path: Vec<Sample>,
    /// Stretches above the horizon mask, in order; `None` if the mask cuts nothing off.
    clear: Option<Vec<Pass>>,
    /// Trackability by the index of the antenna.
    trackability: Vec<Trackability>,
    track: OnceLock<Vec<Sample>>,
}

impl PredictedPass {
    /// Creates a pass of `satellite` seen from `observer`.
    pub fn new(satellite: Arc<ListedSatellite>, pass: Pass, observer: Arc<Observer>) -> Self {
        let number = satellite.elements.catalog_number();
        Self { satellite, pass, number, observer, outline: OnceLock::new() }
    }

    pub fn key(&self) -> PassListKey {
        (self.number(), self.pass.aos.time)
    }

    /// Returns the program track of an antenna for this pass and for later passes of its satellite
    /// within seven days that reach `floor`. Each pass begins at AOS, or where the satellite rises
    /// above the antenna's own minimum elevation.
    pub fn follow(&self, antenna: &Antenna, floor: Angle) -> ProgramTrack {
        let lowest = Angle::from_degrees(antenna.limits.minimum_elevation_deg);
        let lowest_deg = self.observer.site.pass_elevation(lowest).degrees();
        let aos_elevation =
            Angle::from_degrees(self.observer.aos_elevation.degrees().max(lowest_deg));
        let search = |start, floor| PassSearch {
            aos_elevation,
            floor,
            ..PassSearch::new(self.observer.site, start, add_seconds(start, LATER_S))
        };
        let found = |search| passes(&self.satellite.propagator, &search, &|| false);
        let mut spans = Vec::new();
        if !self.is_always_up() {
            // The end of the search may have cut this pass; its track then continues to the true
            // LOS.
            let end = if self.pass.ends_after { None } else { Some(self.pass.los.time) };
            let of_this = found(search(self.pass.aos.time, aos_elevation));
            let of_this = of_this.iter().take_while(|stay| match end {
                Some(end) => stay.aos.time < end,
                None => stay.starts_before || stay.aos.time <= self.pass.tca.time,
            });
            spans.extend(of_this.map(|stay| (stay.aos.time, stay.los.time)));
            let start = spans.last().map_or(self.pass.los.time, |(_, los)| *los);
            let later = found(search(start, floor));
            let later = later.iter().filter(|pass| !pass.starts_before);
            spans.extend(later.map(|pass| (pass.aos.time, pass.los.time)));
        }
        let elements = Box::new(self.satellite.elements.clone());
        let target = Target::Satellite(elements);
        ProgramTrack::new(target, self.observer.site, spans)
    }

    /// Returns the catalog number of the satellite.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// Returns `true` if the satellite neither rises nor sets within the list.
    pub fn is_always_up(&self) -> bool {
        self.pass.starts_before && self.pass.ends_after
    }

    /// Returns `true` if the satellite is up at `now`.
    pub fn in_progress(&self, now: Timestamp) -> bool {
        self.pass.aos.time <= now && now < self.pass.los.time
    }

    /// Returns the samples from AOS to LOS, every 2 s or slightly more. The first call computes and
    /// caches them.
    pub fn track(&self) -> &[Sample] {
        self.outline().track.get_or_init(|| self.sampled())
    }

    /// Returns the track, thinned to the points of a thumbnail.
    pub fn path(&self) -> &[Sample] {
        &self.outline().path
    }

    /// Returns the stretches above the horizon mask, in order. The list is empty if the mask hides
    /// the whole pass, and `None` if the mask cuts nothing off.
    pub fn clear(&self) -> Option<&[Pass]> {
        self.outline().clear.as_deref()
    }

    /// Returns the seconds above the horizon mask; `None` if the mask cuts nothing off.
    pub fn clear_s(&self) -> Option<f64> {
        Some(self.clear()?.iter().map(Pass::duration_s).sum())
    }

    /// Returns the trackability of the pass with the antenna of this index; `None` without such an
    /// antenna.
    pub fn trackability(&self, antenna: usize) -> Option<Trackability> {
        self.observer.antennas.get(antenna)?;
        self.outline().trackability.get(antenna).copied()
    }

    /// Returns `true` once the outline is computed, which takes a tenth of a millisecond.
    pub fn has_outline(&self) -> bool {
        self.outline.get().is_some()
    }

    /// Returns the same as [`Self::trackability`] without caching, for a scan of a long list.
    pub fn judge(&self, antenna: usize) -> Option<Trackability> {
        if let Some(outline) = self.outline.get() {
            return outline.trackability.get(antenna).copied();
        }
        let limits = self.observer.antennas.get(antenna)?;
        Some(trackability(&self.sampled(), *limits))
    }

    fn outline(&self) -> &Outline {
        self.outline.get_or_init(|| {
            let track = self.sampled();
            let antennas = self.observer.antennas.iter();
            Box::new(Outline {
                clear: self.cut_by_mask(),
                trackability: antennas.map(|limits| trackability(&track, *limits)).collect(),
                path: thinned(&track),
                track: OnceLock::new(),
            })
        })
    }

    fn cut_by_mask(&self) -> Option<Vec<Pass>> {
        let (site, pass) = (self.observer.site, &self.pass);
        let mask = self.observer.horizon_mask.as_ref()?;
        let clear = clear_stretches(&self.satellite.propagator, site, mask, pass);
        let is_whole = matches!(clear[..], [only]
            if only.aos.time == pass.aos.time && only.los.time == pass.los.time);
        (!is_whole).then_some(clear)
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

/// Returns the mount limits on which the trackability of a pass depends.
pub fn mount_limits(antenna: &Antenna) -> MountLimits {
    MountLimits {
        mount: antenna.track_mount(),
        maximum_rate_deg_s: antenna.limits.maximum_rate_deg_s,
        half_beam: Angle::from_degrees(antenna.beam_width_deg / 2.0),
        has_elevation: antenna.connection.variant().capabilities.has_elevation(),
        min_elevation: Angle::from_degrees(antenna.limits.minimum_elevation_deg),
    }
}

fn thinned(track: &[Sample]) -> Vec<Sample> {
    let mut path: Vec<Sample> = Vec::new();
    let final_index = track.len().saturating_sub(1);
    for (index, sample) in track.iter().enumerate() {
        let is_far = path.last().is_none_or(|last| {
            last.direction.separation(sample.direction).degrees() >= OUTLINE_STEP_DEG
        });
        if is_far || index == final_index {
            path.push(*sample);
        }
    }
    path.shrink_to_fit();
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{demo::DemoAddresses, orbit::bundled};

    #[test]
    fn an_outline_has_the_ends_and_the_verdict_of_the_whole_track() {
        let elements = bundled().unwrap().get(25_544).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let station = Station::demo(&DemoAddresses::default());
        let search = PassSearch::new(station.site, start, add_seconds(start, 86_400.0));
        let observer = Arc::new(Observer::from_station(&station));
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
                let looked_at =
                    PredictedPass::new(Arc::clone(&satellite), pass, Arc::clone(&observer));
                let judged = Some(trackability(track, *limits));
                assert_eq!(
                    (predicted.trackability(index), looked_at.judge(index)),
                    (judged, judged)
                );
            }
        }
    }

    #[test]
    fn aos_is_that_of_the_site_and_each_antenna_is_judged_by_its_own_minimum() {
        let elements = bundled().unwrap().get(25_544).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let mut station = Station { aos_elevation_deg: 2.0, ..demo() };
        for (antenna, lowest_deg) in station.antennas.iter_mut().zip([30.0, 60.0, 0.0]) {
            antenna.limits.minimum_elevation_deg = lowest_deg;
            antenna.mount = Antenna::genius("", "").mount;
        }
        let observer = Arc::new(Observer::from_station(&station));
        let search = PassSearch {
            aos_elevation: observer.aos_elevation,
            ..PassSearch::new(station.site, start, add_seconds(start, 86_400.0))
        };
        let elevation_at = |time| {
            let look = propagator.look_from(station.site, time).unwrap();
            look.direction.elevation_deg()
        };
        let is_between = |pass: &Pass| (40.0..55.0).contains(&pass.max_elevation().degrees());
        let pass = passes(&propagator, &search, &|| false).into_iter().find(is_between).unwrap();
        assert!((elevation_at(pass.aos.time) - 2.0).abs() < 0.01);
        let satellite = Arc::new(ListedSatellite { elements, propagator: propagator.clone() });
        let predicted = PredictedPass::new(satellite, pass, observer);
        assert_eq!(predicted.trackability(1), Some(Trackability::TooLow));
        assert_ne!(predicted.trackability(0), Some(Trackability::TooLow));
        for (antenna, lowest_deg) in station.antennas.iter().zip([30.0, 60.0, 2.0]) {
            let track = predicted.follow(antenna, Angle::from_degrees(10.0));
            for (aos, los) in &track.passes {
                assert!((elevation_at(*aos) - lowest_deg).abs() < 0.01, "{lowest_deg}");
                assert!((elevation_at(*los) - lowest_deg).abs() < 0.01, "{lowest_deg}");
            }
            let is_this = track.passes.first().is_some_and(|(aos, _)| *aos < pass.los.time);
            assert_eq!(is_this, lowest_deg < 60.0);
        }
    }

    #[test]
    fn the_mask_moves_no_end_of_a_pass_and_tells_what_it_leaves() {
        let elements = bundled().unwrap().get(25_544).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let mask = HorizonMask::from_degrees([(0.0, 3.0), (120.0, 25.0), (240.0, 12.0)]).unwrap();
        let station = Station { horizon_mask: Some(mask.clone()), ..demo() };
        let observer = Arc::new(Observer::from_station(&station));
        let search = PassSearch {
            aos_elevation: observer.aos_elevation,
            ..PassSearch::new(station.site, start, add_seconds(start, 3.0 * 86_400.0))
        };
        let found = passes(&propagator, &search, &|| false);
        let satellite = Arc::new(ListedSatellite { elements, propagator });
        let (mut cut, mut hidden) = (0, 0);
        for pass in found {
            let predicted = PredictedPass::new(Arc::clone(&satellite), pass, Arc::clone(&observer));
            assert_eq!((predicted.pass.aos, predicted.pass.los), (pass.aos, pass.los));
            let is_clear = |sample: &&Sample| {
                sample.direction.elevation > mask.elevation_at(sample.direction.azimuth)
            };
            let track = predicted.track();
            let step_s = pass.duration_s() / (track.len() - 1) as f64;
            let clear_s = track.iter().filter(is_clear).count() as f64 * step_s;
            let told_s = predicted.clear_s().unwrap_or(pass.duration_s());
            assert!((told_s - clear_s).abs() < 3.0 * step_s, "{told_s} {clear_s}");
            cut += usize::from(predicted.clear().is_some());
            hidden += usize::from(predicted.clear().is_some_and(<[Pass]>::is_empty));
        }
        assert!(cut > hidden && hidden > 0, "{cut} {hidden}");
    }

    /// Returns a station without refraction, so that AOS and looks are both geometric and
    /// comparable.
    fn demo() -> Station {
        let mut station = Station::demo(&DemoAddresses::default());
        station.site = station.site.airless();
        station
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
