//! Targets and their directions.

use std::borrow::Cow;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{AzEl, Site, sun_moon},
    orbit::{Elements, PropagationError, Propagator},
};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// A satellite, by its elements.
    Satellite(Box<Elements>),
    /// The Sun, as a source of known noise.
    Sun,
    Moon,
    /// A direction that does not move, such as that of a geostationary satellite or a mast.
    Fixed(AzEl),
}

impl Target {
    pub fn name(&self) -> Cow<'static, str> {
        match self {
            Self::Satellite(elements) => elements.label().into(),
            Self::Sun => "Sun".into(),
            Self::Moon => "Moon".into(),
            Self::Fixed(_) => "fixed direction".into(),
        }
    }

    /// Up to nine digits; `None` if the target is not a satellite.
    pub fn catalog_number(&self) -> Option<u32> {
        match self {
            Self::Satellite(elements) => Some(elements.catalog_number()),
            Self::Sun | Self::Moon | Self::Fixed(_) => None,
        }
    }
}

/// A target seen from a site, prepared for repeated evaluation.
#[derive(Debug, Clone)]
pub struct Course {
    site: Site,
    body: Body,
}

#[derive(Debug, Clone)]
enum Body {
    Satellite(Box<Propagator>),
    Sun,
    Moon,
    Fixed(AzEl),
}

impl Course {
    /// Fails if the elements of `target` do not describe an orbit.
    pub fn new(target: &Target, site: Site) -> Result<Self, PropagationError> {
        let body = match target {
            Target::Satellite(elements) => Body::Satellite(Box::new(Propagator::new(elements)?)),
            Target::Sun => Body::Sun,
            Target::Moon => Body::Moon,
            Target::Fixed(direction) => Body::Fixed(*direction),
        };
        Ok(Self { site, body })
    }

    /// Geometric direction at `at`; `None` once the target has decayed.
    pub fn direction(&self, at: Timestamp) -> Option<AzEl> {
        match &self.body {
            Body::Satellite(propagator) => {
                propagator.look_from(self.site, at).ok().map(|look| look.direction)
            }
            Body::Sun => Some(sun_moon::sun(self.site, at)),
            Body::Moon => Some(sun_moon::moon(self.site, at)),
            Body::Fixed(direction) => Some(*direction),
        }
    }
}
