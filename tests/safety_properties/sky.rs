//! Passes of real satellites over the site of the station.

use std::sync::LazyLock;

use azel::{
    astro::{
        Angle,
        time::{add_seconds, seconds_between},
    },
    device::TrackTarget,
    orbit::{Elements, PassSearch, Propagator, bundled, passes},
    plan::{OnBoardPass, ProgramTrack, Target},
    station::Station,
};
use jiff::Timestamp;

use crate::common::dice::Dice;

/// Catalog numbers of satellites in low orbits.
const NUMBERS: [u32; 4] = [43013, 25544, 37849, 25994];
/// Length of the pass search, days.
const DAYS: f64 = 3.0;
/// Min height of a pass, degrees; a lower pass is soon over.
const MIN_HEIGHT_DEG: f64 = 30.0;
/// Elevation of AOS and LOS, degrees: above the minimum elevation of every random antenna.
const AOS_DEG: f64 = 16.0;

static ELEMENTS: LazyLock<Vec<Elements>> = LazyLock::new(|| {
    let catalog = bundled().unwrap();
    NUMBERS.into_iter().map(|number| catalog.get(number).unwrap().clone()).collect()
});

static OVERFLIGHTS: LazyLock<Vec<Overflight>> = LazyLock::new(|| {
    let found = all_elements().iter().flat_map(|elements| {
        let from = elements.epoch();
        let site = Station::default().site;
        let aos_elevation = Angle::from_degrees(AOS_DEG);
        let to = add_seconds(from, DAYS * 86_400.0);
        let search = PassSearch { aos_elevation, ..PassSearch::new(site, from, to) };
        let found = passes(&Propagator::new(elements).unwrap(), &search, &|| false);
        found.into_iter().filter(|pass| pass.max_elevation().degrees() > MIN_HEIGHT_DEG).map(
            |pass| Overflight {
                elements: elements.clone(),
                aos: pass.aos.time,
                culmination: pass.tca.time,
                los: pass.los.time,
            },
        )
    });
    found.collect()
});

/// Returns the satellites that the units know.
pub(super) fn all_elements() -> &'static [Elements] {
    &ELEMENTS
}

/// One pass of a satellite.
pub(super) struct Overflight {
    pub(super) elements: Elements,
    pub(super) aos: Timestamp,
    pub(super) culmination: Timestamp,
    pub(super) los: Timestamp,
}

impl Overflight {
    pub(super) fn any(dice: &mut Dice) -> &'static Self {
        &OVERFLIGHTS[dice.below(OVERFLIGHTS.len())]
    }

    /// Draws a time between a minute before the pass and 60 % of it.
    pub(super) fn some_time(&self, dice: &mut Dice) -> Timestamp {
        let duration_s = seconds_between(self.aos, self.los);
        add_seconds(self.aos, dice.between(-60.0, duration_s * 0.6))
    }

    pub(super) fn program_track(&self) -> ProgramTrack {
        ProgramTrack::new(
            Target::Satellite(Box::new(self.elements.clone())),
            Station::default().site,
            vec![(self.aos, self.los)],
        )
    }

    pub(super) fn on_board(&self) -> OnBoardPass {
        OnBoardPass {
            target: TrackTarget {
                catalog_number: self.elements.catalog_number(),
                name: self.elements.name().into(),
                element_file: None,
                start: self.aos,
                end: self.los,
            },
            elements: self.elements.clone(),
            site: Station::default().site,
            is_agreed: false,
        }
    }
}
