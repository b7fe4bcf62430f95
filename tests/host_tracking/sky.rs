//! Real passes to track, from the bundled catalog.

use azel::{
    astro::{Site, time::add_seconds},
    orbit::{Elements, Pass, PassSearch, Propagator, bundled, passes},
    plan::{ProgramTrack, Target},
};

/// Catalog numbers of satellites in low orbits.
const NUMBERS: [u32; 6] = [43013, 25544, 37849, 25994, 27424, 49260];
/// Length of the pass search, days.
const DAYS: f64 = 10.0;

/// A satellite and one of its passes.
pub(super) struct Scene {
    pub(super) elements: Elements,
    pub(super) pass: Pass,
}

impl Scene {
    /// Returns a program track of this pass alone.
    pub(super) fn follow(&self) -> ProgramTrack {
        ProgramTrack::new(
            Target::Satellite(Box::new(self.elements.clone())),
            site(),
            vec![(self.pass.aos.time, self.pass.los.time)],
        )
    }

    /// Returns the azimuths at equal intervals of the pass, degrees.
    fn azimuths_deg(&self) -> Vec<f64> {
        let propagator = Propagator::new(&self.elements).unwrap();
        let look = |step: u32| {
            let share = f64::from(step) / 50.0;
            let at = add_seconds(self.pass.aos.time, self.pass.duration_s() * share);
            propagator.look_from(site(), at).unwrap().direction.azimuth_deg()
        };
        (0..=50).map(look).collect()
    }

    /// Returns the fraction of the pass after which it crosses north, 0 to 1.
    fn north(&self) -> Option<f64> {
        let azimuths = self.azimuths_deg();
        let at = azimuths.windows(2).position(|two| (two[1] - two[0]).abs() > 180.0)?;
        Some(at as f64 / 50.0)
    }

    fn max_deg(&self) -> f64 {
        self.pass.max_elevation().degrees()
    }
}

pub(super) fn site() -> Site {
    Site::new(41.01, 29.17, 100.0).unwrap()
}

fn scenes() -> impl Iterator<Item = Scene> {
    let catalog = bundled().unwrap();
    NUMBERS.into_iter().flat_map(move |number| {
        let elements = catalog.get(number).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let from = elements.epoch();
        let search = PassSearch::new(site(), from, add_seconds(from, DAYS * 86_400.0));
        let found = passes(&propagator, &search, &|| false).into_iter();
        found
            .filter(|pass| !pass.starts_before && !pass.ends_after)
            .map(move |pass| Scene { elements: elements.clone(), pass })
    })
}

/// Returns a pass of medium height that stays away from north.
pub(super) fn usual() -> Scene {
    let is_it = |scene: &Scene| (35.0..50.0).contains(&scene.max_deg()) && scene.north().is_none();
    scenes().find(is_it).unwrap()
}

/// Returns a pass whose azimuth crosses north about its middle.
pub(super) fn through_north() -> Scene {
    let is_it = |scene: &Scene| {
        (20.0..60.0).contains(&scene.max_deg())
            && scene.north().is_some_and(|at| (0.3..0.7).contains(&at))
    };
    scenes().find(is_it).unwrap()
}

/// Returns a pass that comes within some 2 degrees of the zenith and stays away from north.
pub(super) fn overhead() -> Scene {
    let is_it = |scene: &Scene| (87.5..88.5).contains(&scene.max_deg()) && scene.north().is_none();
    scenes().find(is_it).unwrap()
}
