//! The pass search against plain sampling, over satellites of every kind.

#![allow(clippy::unwrap_used, reason = "the data is part of the test")]

use azel::{
    astro::{Angle, Site, time},
    orbit::{Elements, PassSearch, Propagator, bundled, passes},
};

const WINDOW_S: f64 = 86_400.0;
const SAMPLE_S: f64 = 20.0;
const STRIDE: usize = 600;

/// Every round orbit is like many others; the eccentric ones are all taken.
fn chosen(catalog: &azel::orbit::Catalog) -> Vec<&Elements> {
    catalog
        .iter()
        .enumerate()
        .filter(|(index, elements)| index % STRIDE == 0 || elements.eccentricity() > 0.3)
        .map(|(_, elements)| elements)
        .collect()
}

#[test]
fn a_satellite_is_up_exactly_within_its_passes() {
    let catalog = bundled().unwrap();
    let from = catalog.newest_epoch().unwrap();
    let to = time::add_seconds(from, WINDOW_S);
    for (site, horizon_deg) in [
        (Site::new(41.02, 29.17, 100.0).unwrap(), 5.0),
        (Site::new(-78.0, 167.0, 0.0).unwrap(), 0.0),
    ] {
        for elements in chosen(&catalog) {
            let propagator = Propagator::new(elements).unwrap();
            let aos_elevation = Angle::from_degrees(horizon_deg);
            let search = PassSearch { aos_elevation, ..PassSearch::new(site, from, to) };
            let found = passes(&propagator, &search, &|| false);
            let mut at_s = 0.0;
            while at_s < WINDOW_S {
                let at = time::add_seconds(from, at_s);
                let Ok(look) = propagator.look_from(site, at) else { break };
                let height_deg = look.direction.elevation_deg() - horizon_deg;
                let within = found.iter().any(|pass| (pass.aos.time..=pass.los.time).contains(&at));
                assert!(
                    within == (height_deg >= 0.0) || height_deg.abs() < 1e-4,
                    "{} {} is {height_deg} degrees above the horizon at {at}",
                    elements.catalog_number(),
                    elements.name(),
                );
                at_s += SAMPLE_S;
            }
        }
    }
}
