//! Random numbers and real satellites for tests, equal on all platforms.

use jiff::Timestamp;

use crate::plan::schedule::{
    Candidate, Common, PassPolicy, PlannedAntenna, Reach, Request, Sight, Steadiness,
};
use crate::{
    astro::time::add_seconds,
    orbit::{Catalog, Elements, Pass, PassSearch, Propagator, bundled, passes},
    station::{
        Antenna, AntennaId, BetweenPasses, ChooseBy, Entered, KeepOut, Mount, PassLimits, Priority,
        Station, SunAvoidance, Take,
    },
};

/// Splitmix64 generator.
pub(in crate::plan) struct Random(u64);

impl Random {
    pub(in crate::plan) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(in crate::plan) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Returns a random number from 0 to below `end`.
    pub(in crate::plan) fn below(&mut self, end: u32) -> u32 {
        (self.next() % u64::from(end)) as u32
    }
}

/// Returns the antennas of the demo station: crossed axes, a rotator over the whole circle, and a
/// rotator over half of it.
pub(in crate::plan) fn three_antennas() -> Station {
    let mut antennas = vec![
        Antenna::satrak("Satrak", ""),
        Antenna::genius("Genius", ""),
        Antenna::rc2000c("Dish", ""),
    ];
    for (antenna, number) in antennas.iter_mut().zip(1..) {
        antenna.id = AntennaId(number);
    }
    // Program track keeps away from both ends: its targets lie from 0 to 360 degrees, like in the
    // days that a general solver has solved.
    antennas[1].mount = Mount::AzEl {
        azimuth_from_deg: -2.5,
        azimuth_to_deg: 362.5,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    antennas[2].mount = Mount::AzEl {
        azimuth_from_deg: 90.0,
        azimuth_to_deg: 270.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    // These days were also solved without refraction.
    let site = Station::default().site.airless();
    Station { site, antennas, ..Station::default() }
}

/// Returns the same antennas with other travels, rates and beams.
pub(in crate::plan) fn any_three_antennas(random: &mut Random) -> Station {
    let mut station = three_antennas();
    let mut uniform =
        |start: f64, end: f64| start + (end - start) * f64::from(random.below(1_000)) / 1e3;
    for antenna in &mut station.antennas {
        antenna.limits.maximum_rate_deg_s = uniform(1.0, 8.0);
        antenna.beam_width_deg = uniform(1.0, 12.0);
        match &mut antenna.mount {
            Mount::Xy { lower_axis_azimuth_deg, .. } => {
                *lower_axis_azimuth_deg = uniform(0.0, 180.0);
            }
            Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } => {
                let travel_deg = *azimuth_to_deg - *azimuth_from_deg;
                *azimuth_from_deg = uniform(-180.0, 180.0);
                // An axis with a full turn reaches some directions twice.
                let more_deg = if travel_deg < 360.0 { 0.0 } else { uniform(0.0, 300.0) };
                *azimuth_to_deg = *azimuth_from_deg + travel_deg + more_deg;
            }
        }
    }
    station
}

/// Adds two zones that no antenna may point into, and the Sun.
pub(in crate::plan) fn add_barriers(station: &mut Station, random: &mut Random) {
    for (name, entered) in [("Mast", Entered::GoRound), ("Yard", Entered::Hard)] {
        let from_deg = f64::from(random.below(360));
        let to_deg = from_deg + 10.0 + f64::from(random.below(40));
        let top_deg = 10.0 + f64::from(random.below(30));
        let corners = [(from_deg, 0.0), (to_deg, 0.0), (to_deg, top_deg), (from_deg, top_deg)];
        station.keep_outs.push(KeepOut {
            name: name.to_owned(),
            reason: String::new(),
            entered,
            antenna: None,
            margin_deg: 1.0,
            zone: KeepOut::zone_of(&corners).unwrap(),
        });
    }
    let radius_deg = 3.0 + f64::from(random.below(10));
    station.sun_avoidance = Some(SunAvoidance { radius_deg, ahead_min: 10.0 });
}

pub(in crate::plan) fn planned(station: &Station, start: Timestamp) -> Vec<PlannedAntenna> {
    let planned_antenna = |antenna: &Antenna| PlannedAntenna {
        id: antenna.id,
        reach: Reach::from_station(station, antenna, None),
        set_up_s: if antenna.name == "Satrak" { 20.0 } else { 2.0 },
        between_passes: BetweenPasses::Wait,
        free_from: start,
        stands_deg: Some([180.0, 45.0]),
        off_reason: None,
    };
    station.antennas.iter().map(planned_antenna).collect()
}

/// Satellites with a priority and the operator's choice.
pub(in crate::plan) struct DrawnSatellite {
    pub(in crate::plan) elements: Elements,
    pub(in crate::plan) priority: Priority,
    pub(in crate::plan) limits: PassLimits,
    /// Operator's choice for all its passes.
    pub(in crate::plan) take: Option<Take>,
}

/// Returns `count` satellites in low orbits, each with a priority.
pub(in crate::plan) fn low_satellites(random: &mut Random, count: usize) -> Vec<DrawnSatellite> {
    let catalog: Catalog = bundled().unwrap();
    let low: Vec<&Elements> = catalog
        .iter()
        .filter(|elements| (5_400.0..6_900.0).contains(&elements.period_s()))
        .collect();
    let mut chosen = Vec::new();
    while chosen.len() < count {
        let set = low[random.below(low.len() as u32) as usize];
        let number = set.catalog_number();
        if chosen.iter().all(|other: &DrawnSatellite| other.elements.catalog_number() != number) {
            let priority = Priority::try_from(1 + random.below(5) as i64).unwrap();
            chosen.push(DrawnSatellite {
                elements: set.clone(),
                priority,
                limits: PassLimits::default(),
                take: None,
            });
        }
    }
    chosen
}

pub(in crate::plan) fn candidates(
    station: &Station,
    antennas: &[PlannedAntenna],
    satellites: &[DrawnSatellite],
    start: Timestamp,
    hours: f64,
) -> Vec<Candidate> {
    let common =
        Common { site: station.site, floor: station.elevation_floor(), antennas, max_age_s: None };
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, start, add_seconds(start, hours * 3600.0))
    };
    let mut found = Vec::new();
    for satellite in satellites {
        let propagator = Propagator::new(&satellite.elements).unwrap();
        for pass in passes(&propagator, &search, &|| false) {
            found.push(candidate(station, satellite, &propagator, &pass, common));
        }
    }
    found
}

fn candidate(
    station: &Station,
    satellite: &DrawnSatellite,
    propagator: &Propagator,
    pass: &Pass,
    common: Common<'_>,
) -> Candidate {
    let mask = station.horizon_mask.as_ref();
    let mut sight = Sight::new(propagator, station.site, mask, pass);
    let DrawnSatellite { priority, limits, take, .. } = satellite;
    let pass_wishes = PassPolicy { priority: *priority, take: *take, limits, by_rule: &|_| None };
    let number = satellite.elements.catalog_number();
    let age_s = satellite.elements.epoch_distance_s(pass.aos.time);
    Candidate::new(number, age_s, (pass, propagator), pass_wishes, &mut sight, common)
}

pub(in crate::plan) fn request<'a>(
    antennas: &'a [PlannedAntenna],
    candidates: &'a [Candidate],
) -> Request<'a> {
    Request {
        antennas,
        candidates,
        choose_by: ChooseBy::default(),
        partial: None,
        previous: None,
        steadiness: Steadiness::default(),
        fixed: &[],
    }
}

pub(in crate::plan) fn noon() -> Timestamp {
    "2026-08-12T12:00:00Z".parse().unwrap()
}
