//! Sunlight on a satellite.

use glam::DVec3;
use jiff::Timestamp;

use super::State;
use crate::astro::{frames, sun_moon};

/// Returns `true` if a satellite in `state` (TEME, valid at `time`) is in sunlight; see [`is_lit`].
pub fn is_sunlit(state: &State, time: Timestamp) -> bool {
    is_lit(state.position_km, sun_moon::sun_teme_km(time))
}

/// Returns `true` if a satellite is in sunlight. Its position and the Sun's position are from the
/// centre of the Earth, in the same axes.
///
/// The shadow is a cylinder as wide as the equator. At its edge, half of the Sun's disc is hidden.
/// The edge is the middle of the penumbra, which a low satellite crosses in about 8 s. The model
/// neglects flattening and refraction.
pub fn is_lit(position_km: DVec3, sun_km: DVec3) -> bool {
    let sun = sun_km.normalize();
    let along_km = position_km.dot(sun);
    let across_km = (position_km - sun * along_km).length();
    along_km > 0.0 || across_km > frames::WGS84_RADIUS_KM
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shadow_lies_behind_the_earth_only() {
        let time: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let sun = sun_moon::sun_teme_km(time).normalize();
        let side = sun.any_orthonormal_vector();
        let lit = |position_km| is_sunlit(&State { position_km, velocity_km_s: DVec3::ZERO }, time);
        assert!(lit(sun * 7000.0));
        assert!(!lit(sun * -7000.0));
        assert!(!lit(sun * -7000.0 + side * 6377.0));
        assert!(lit(sun * -7000.0 + side * 6380.0));
        assert!(lit(side * 7000.0));
    }
}
