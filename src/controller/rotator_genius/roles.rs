//! Which of the two rotators is which axis of the antenna.

use super::Rotators;
use crate::protocol::rotator_genius::{Rotator, RotatorKind, RotatorNumber, Status};

/// What the two rotators are for the antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Roles {
    /// The rotators of the two axes.
    pub(super) axes: [RotatorNumber; 2],
    /// The second axis is the elevation.
    pub(super) is_pair: bool,
    /// The kinds that the device reports fit the antenna. Otherwise no reading
    /// can be told to be its azimuth or elevation.
    pub(super) is_clear: bool,
}

impl Roles {
    /// With a pair, the kinds decide, whatever their numbers.
    pub(super) fn of(rotators: Rotators, status: &Status) -> Self {
        let [one, two] = status.rotators.each_ref().map(|rotator| rotator.kind);
        let (first, second) = (RotatorNumber::One, RotatorNumber::Two);
        match rotators {
            Rotators::Pair => {
                let is_turned = one == RotatorKind::Elevation && two == RotatorKind::Azimuth;
                let axes = if is_turned { [second, first] } else { [first, second] };
                Self { axes, is_pair: true, is_clear: one != two }
            }
            Rotators::First => Self {
                axes: [first, second],
                is_pair: false,
                is_clear: one == RotatorKind::Azimuth,
            },
            Rotators::Second => Self {
                axes: [second, first],
                is_pair: false,
                is_clear: two == RotatorKind::Azimuth,
            },
        }
    }

    /// Whether the rotator turns this antenna.
    pub(super) fn is_ours(self, number: RotatorNumber) -> bool {
        self.is_pair || self.axes.first() == Some(&number)
    }

    /// Where a rotator stands as its axis counts, degrees. An elevation a little
    /// below the horizon is reported as almost a whole turn.
    pub(super) fn axis_deg(rotator: &Rotator) -> Option<f64> {
        let angle_deg = f64::from(rotator.position.ok()?.degrees());
        let is_below = rotator.kind == RotatorKind::Elevation && angle_deg > 270.0;
        Some(if is_below { angle_deg - 360.0 } else { angle_deg })
    }
}
