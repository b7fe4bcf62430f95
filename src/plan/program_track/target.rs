//! Targets and where they stand.

use std::borrow::Cow;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{AzEl, Site, sun_moon},
    orbit::{Elements, PropagationError, Propagator},
};

/// A target to track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// A satellite, by its elements.
    Satellite(Box<Elements>),
    /// The Sun, as a source of known noise.
    Sun,
    /// The Moon.
    Moon,
    /// A direction that does not move, such as a geostationary satellite or a
    /// mast.
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

    /// Up to nine digits; `None` for what is no satellite.
    pub fn catalog_number(&self) -> Option<u32> {
        match self {
            Self::Satellite(elements) => Some(elements.catalog_number()),
            Self::Sun | Self::Moon | Self::Fixed(_) => None,
        }
    }
}

/// A target seen from a site, prepared for many looks.
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
    /// Fails where the elements of `target` describe no orbit.
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
