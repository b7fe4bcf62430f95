//! The kind of elevations that lists have.

use crate::astro::{Air, Refraction, Site, SiteError};

/// Elevations of satellites.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(in crate::cli) enum Elevations {
    /// Without refraction
    Geometric,
    /// Where satellites appear, with the refraction of radio waves
    Apparent,
}

impl Elevations {
    /// The site with these elevations in lists of passes.
    pub(in crate::cli) fn in_passes(self, site: Site) -> Result<Site, SiteError> {
        let in_passes = self == Self::Apparent;
        site.with_refraction(Refraction { in_passes, ..self.with_air(site).refraction() })
    }

    /// The site with these elevations in look angles.
    pub(in crate::cli) fn in_looks(self, site: Site) -> Site {
        match self {
            Self::Geometric => site.airless(),
            Self::Apparent => self.with_air(site),
        }
    }

    /// A station without refraction has no air to show apparent elevations by.
    fn with_air(self, site: Site) -> Site {
        let mut refraction = site.refraction();
        if self == Self::Apparent && refraction.air == Air::None {
            refraction.air = Air::Standard;
        }
        site.with_refraction(refraction).unwrap_or(site)
    }
}
