//! The pointing model of a mount.

use crate::{
    astro::Term,
    plan::pointing::Kind,
    record::{NoiseOf, PointingFit},
};

pub fn pointing_term(term: Term) -> &'static str {
    match term {
        Term::AzimuthOffset => "Azimuth offset",
        Term::ElevationOffset => "Elevation offset",
        Term::TiltNorth => "Tilt to the north",
        Term::TiltEast => "Tilt to the east",
        Term::Collimation => "Collimation",
        Term::NonPerpendicularity => "Non-perpendicularity",
        Term::ElevationScale => "Elevation scale",
        Term::Sag => "Sag",
    }
}

/// What a model was fitted to.
pub fn fitted_to(fit: &PointingFit) -> String {
    let passes =
        if fit.passes == 1 { "1 pass".to_owned() } else { format!("{} passes", fit.passes) };
    let noise = fit.noise.iter().find(|of| of.of == Kind::Satellite);
    noise.map_or(passes.clone(), |NoiseOf { points, noise_deg, .. }| {
        format!("{passes}, {points} points, each axis within {noise_deg:.3}° of the model (1 σ).")
    })
}
