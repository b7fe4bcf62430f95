//! The slow motion of several orbits, one a lane.

use super::{
    round::{DragWave, Waves},
    secular::{Plane, Secular},
};
use crate::orbit::lanes::{Lanes, set};

impl Secular<Lanes> {
    /// Puts an orbit into a lane.
    pub(in crate::orbit) fn set(&mut self, lane: usize, orbit: &Secular) {
        let Self { plane, root_axis, drag_wave, waves } = self;
        plane.set(lane, &orbit.plane);
        set_all(root_axis, lane, &orbit.root_axis);
        drag_wave.set(lane, &orbit.drag_wave);
        waves.set(lane, &orbit.waves);
    }
}

impl Plane<Lanes> {
    /// Puts the plane of an orbit into a lane.
    pub(in crate::orbit) fn set(&mut self, lane: usize, plane: &Plane) {
        set(&mut self.sin_inclination, lane, plane.sin_inclination);
        set(&mut self.cos_inclination, lane, plane.cos_inclination);
        set_all(&mut self.node, lane, &plane.node);
        set_all(&mut self.argument, lane, &plane.argument);
        set_all(&mut self.perigee, lane, &plane.perigee);
        set_all(&mut self.eccentricity, lane, &plane.eccentricity);
    }
}

impl DragWave<Lanes> {
    fn set(&mut self, lane: usize, drag: &DragWave) {
        set_all(&mut self.anomaly, lane, &drag.anomaly);
        set(&mut self.eta, lane, drag.eta);
        set_all(&mut self.angle, lane, &drag.angle);
        set_all(&mut self.eccentricity, lane, &drag.eccentricity);
    }
}

impl Waves<Lanes> {
    fn set(&mut self, lane: usize, waves: &Waves) {
        set(&mut self.square, lane, waves.square);
        set(&mut self.seven, lane, waves.seven);
        set(&mut self.three, lane, waves.three);
        set(&mut self.odd_vector, lane, waves.odd_vector);
        set(&mut self.odd_angle, lane, waves.odd_angle);
    }
}

fn set_all<const COUNT: usize>(all: &mut [Lanes; COUNT], lane: usize, numbers: &[f64; COUNT]) {
    for (lanes, number) in all.iter_mut().zip(numbers) {
        set(lanes, lane, *number);
    }
}
