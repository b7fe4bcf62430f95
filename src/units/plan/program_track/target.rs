//! Targets and their directions.

use std::borrow::Cow;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{AzEl, PointingModel, Site, TrackOffsets, sun_moon},
    orbit::{Elements, PropagationError, Propagator},
};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// Satellite, by its elements.
    Satellite(Box<Elements>),
    /// Sun, as a source of known noise.
    Sun,
    Moon,
    /// Fixed direction, such as a geostationary satellite or a mast.
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

    /// Returns the catalog number, up to nine digits; `None` if the target is not a satellite.
    pub fn catalog_number(&self) -> Option<u32> {
        match self {
            Self::Satellite(elements) => Some(elements.catalog_number()),
            Self::Sun | Self::Moon | Self::Fixed(_) => None,
        }
    }

    /// Returns `true` if the target moves over the sky.
    pub fn moves(&self) -> bool {
        !matches!(self, Self::Fixed(_))
    }
}

/// Target seen from a site, prepared for repeated evaluation.
#[derive(Debug, Clone)]
pub struct Course {
    site: Site,
    body: Body,
    pub(super) model: PointingModel,
}

#[derive(Debug, Clone)]
enum Body {
    Satellite(Box<Propagator>),
    Sun,
    Moon,
    Fixed(AzEl),
}

impl Course {
    /// Prepares the target. Fails if the elements of `target` do not describe an orbit.
    pub fn new(target: &Target, site: Site) -> Result<Self, PropagationError> {
        let body = match target {
            Target::Satellite(elements) => Body::Satellite(Box::new(Propagator::new(elements)?)),
            Target::Sun => Body::Sun,
            Target::Moon => Body::Moon,
            Target::Fixed(direction) => Body::Fixed(*direction),
        };
        Ok(Self { site, body, model: PointingModel::default() })
    }

    /// Sets the pointing model of the antenna that follows the target.
    #[must_use]
    pub fn with_model(self, model: PointingModel) -> Self {
        Self { model, ..self }
    }

    /// Returns the required direction of the antenna at `time`; `None` once the target has decayed.
    pub fn direction(&self, time: Timestamp) -> Option<AzEl> {
        match &self.body {
            Body::Satellite(propagator) => {
                propagator.look_from(self.site, time).ok().map(|look| look.direction)
            }
            Body::Sun => Some(sun_moon::sun(self.site, time)),
            Body::Moon => Some(sun_moon::moon(self.site, time)),
            Body::Fixed(direction) => Some(*direction),
        }
    }

    /// Returns the readings that the axes need at `time` with these offsets; `None` once the target
    /// has decayed.
    pub fn demanded(&self, time: Timestamp, offsets: TrackOffsets) -> Option<AzEl> {
        let direction = offsets.demanded(time, |utc| self.direction(utc))?;
        if self.model.is_none() {
            return Some(direction);
        }
        // Near the zenith, where the model has no reading, the axes go to the direction itself.
        Some(self.model.reading(direction).unwrap_or(direction))
    }

    /// Returns the direction on the sky at `time` with these offsets, if the axis offsets and the
    /// pointing model correct errors of the mount. Returns `None` once the target has decayed.
    pub fn on_the_sky(&self, time: Timestamp, offsets: TrackOffsets) -> Option<AzEl> {
        offsets.on_the_sky().demanded(time, |utc| self.direction(utc))
    }

    /// Returns the direction of the beam by the pointing model when the axes read `reading`.
    pub fn beam(&self, reading: AzEl) -> AzEl {
        self.model.direction(reading)
    }
}

#[cfg(test)]
mod tests {
    use jiff::SignedDuration;

    use super::*;
    use crate::{
        astro::{Angle, Offset, time::add_seconds},
        orbit::{PassSearch, bundled, passes},
    };

    fn offsets(step: Offset) -> TrackOffsets {
        TrackOffsets::NONE.plus(step).unwrap()
    }

    #[test]
    fn ahead_in_time_and_ahead_along_the_track_lead_the_same_way() {
        let elements = bundled().unwrap().get(25_544).unwrap().clone();
        let site = Site::new(41.01, 29.17, 100.0).unwrap();
        let propagator = Propagator::new(&elements).unwrap();
        let start = elements.epoch();
        let search = PassSearch::new(site, start, add_seconds(start, 86_400.0));
        let pass = passes(&propagator, &search, &|| false)[0];
        let course = Course::new(&Target::Satellite(Box::new(elements)), site).unwrap();
        for share in [0.1, 0.5, 0.9] {
            let utc = add_seconds(pass.aos.time, pass.duration_s() * share);
            let plain = course.demanded(utc, TrackOffsets::NONE).unwrap();
            assert_eq!(Some(plain), course.direction(utc));
            let time = offsets(Offset::Time(SignedDuration::from_secs(2)));
            let later = course.demanded(utc, time).unwrap();
            assert_eq!(Some(later), course.direction(add_seconds(utc, 2.0)));
            let ahead_deg = plain.separation(later).degrees();
            let along = offsets(Offset::Along(Angle::from_degrees(ahead_deg)));
            let along = course.demanded(utc, along).unwrap();
            assert!(along.separation(later).degrees() < 0.02 * ahead_deg, "{along:?} {later:?}");
        }
    }

    #[test]
    fn a_direction_that_stands_has_no_way() {
        let target = Target::Fixed(AzEl::from_degrees(180.0, 30.0));
        let course = Course::new(&target, Site::new(0.0, 0.0, 0.0).unwrap()).unwrap();
        let along = offsets(Offset::Along(Angle::from_degrees(1.0)));
        let time = Timestamp::UNIX_EPOCH;
        assert_eq!(course.demanded(time, along), course.direction(time));
        assert!(!target.moves() && Target::Sun.moves());
    }
}
