//! What an antenna can be pointed at, and where that stands.

use std::borrow::Cow;

use jiff::Timestamp;

use crate::{
    astro::{AzEl, Site, sun_moon},
    orbit::{Elements, PropagationError, Propagator},
};

/// What an antenna is to follow.
#[derive(Debug, Clone, PartialEq)]
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
    /// As the operator knows it.
    pub fn name(&self) -> Cow<'static, str> {
        match self {
            Self::Satellite(elements) => elements.label().into(),
            Self::Sun => "Sun".into(),
            Self::Moon => "Moon".into(),
            Self::Fixed(_) => "fixed direction".into(),
        }
    }

    /// Of a satellite, up to nine digits.
    pub fn catalog_number(&self) -> Option<u32> {
        match self {
            Self::Satellite(elements) => Some(elements.catalog_number()),
            Self::Sun | Self::Moon | Self::Fixed(_) => None,
        }
    }
}

/// A target over a site, ready to be looked at often.
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
    /// Of `target` over `site`; an error where its elements describe no orbit.
    pub fn new(target: &Target, site: Site) -> Result<Self, PropagationError> {
        let body = match target {
            Target::Satellite(elements) => Body::Satellite(Box::new(Propagator::new(elements)?)),
            Target::Sun => Body::Sun,
            Target::Moon => Body::Moon,
            Target::Fixed(direction) => Body::Fixed(*direction),
        };
        Ok(Self { site, body })
    }

    /// Where the target stands at `at`, geometric; `None` once it has decayed.
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
