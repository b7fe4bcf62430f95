//! Words for the pointing model of a mount.

use crate::{
    astro::Term,
    contract::record::{FittedNoise, PeakBody, PointingFit},
    plan::pointing::Kind,
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

pub fn peak_of(body: PeakBody) -> &'static str {
    match body {
        PeakBody::Sun => "Sun",
        PeakBody::Moon => "Moon",
    }
}

/// Describes the data that a model was fitted to.
pub fn fitted_to(fit: &PointingFit) -> String {
    let passes =
        if fit.passes == 1 { "1 pass".to_owned() } else { format!("{} passes", fit.passes) };
    let words_for = |FittedNoise { kind, points, noise_deg }: &FittedNoise| {
        let peaks = if *points == 1 { "1 peak".to_owned() } else { format!("{points} peaks") };
        let subject = match kind {
            Kind::Satellite => format!("{passes}, {points} points"),
            Kind::Sun => format!("{peaks} of the Sun"),
            Kind::Moon => format!("{peaks} of the Moon"),
        };
        format!("{subject}, each axis within {noise_deg:.3}° of the model (1 σ).")
    };
    fit.noise.iter().map(words_for).collect::<Vec<_>>().join(" ")
}
