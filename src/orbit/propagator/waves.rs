//! Coefficients of SGP4's periodic terms of the gravity field and of the drag, once a revolution.

use sgp4::WGS72;

use crate::simd::{Lanes, set_all};

/// Coefficients of the periodic terms of the gravity field.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Waves<N = f64> {
    /// Factors 1 - cos²i, 7 cos²i - 1 and 3 cos²i - 1.
    pub(super) square: N,
    pub(super) seven: N,
    pub(super) three: N,
    /// Effect of the odd part of the gravity field on the eccentricity vector and on the mean
    /// angle.
    pub(super) odd_vector: N,
    pub(super) odd_angle: N,
}

impl Waves {
    pub(super) fn new(sin_inclination: f64, cos_inclination: f64) -> Self {
        let square = cos_inclination * cos_inclination;
        let odd = -0.5 * (WGS72.j3 / WGS72.j2) * sin_inclination;
        // The lower bound avoids a division by zero for an equatorial orbit against the rotation of
        // the Earth.
        let with_turn =
            if (1.0 + cos_inclination).abs() > 1.5e-12 { 1.0 + cos_inclination } else { 1.5e-12 };
        Self {
            square: 1.0 - square,
            seven: 7.0 * square - 1.0,
            three: 3.0 * square - 1.0,
            odd_vector: odd,
            odd_angle: 0.5 * odd * (3.0 + 5.0 * cos_inclination) / with_turn,
        }
    }
}

/// Coefficients of the periodic terms of the drag.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct DragWave<N = f64> {
    /// Mean anomaly: at the epoch, and its change per minute without drag.
    pub(super) anomaly: [N; 2],
    pub(super) eta: N,
    /// Perigee against mean anomaly: the factor, its share of the epoch, and its growth per minute.
    pub(super) angle: [N; 3],
    /// Eccentricity: the factor, and the sine at the epoch.
    pub(super) eccentricity: [N; 2],
}

impl DragWave<Lanes> {
    pub(super) fn set(&mut self, lane: usize, drag: &DragWave) {
        set_all(&mut self.anomaly, lane, &drag.anomaly);
        self.eta.set(lane, drag.eta);
        set_all(&mut self.angle, lane, &drag.angle);
        set_all(&mut self.eccentricity, lane, &drag.eccentricity);
    }
}

impl Waves<Lanes> {
    pub(super) fn set(&mut self, lane: usize, waves: &Waves) {
        self.square.set(lane, waves.square);
        self.seven.set(lane, waves.seven);
        self.three.set(lane, waves.three);
        self.odd_vector.set(lane, waves.odd_vector);
        self.odd_angle.set(lane, waves.odd_angle);
    }
}
