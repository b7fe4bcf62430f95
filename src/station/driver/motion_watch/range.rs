//! Range of angles of an axis.

/// Range, degrees as the mount counts, without a jump at north.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub(super) from_deg: f64,
    pub(super) to_deg: f64,
}

impl Range {
    pub(super) fn with_error(deg: f64, error_deg: f64) -> Self {
        Self { from_deg: deg - error_deg, to_deg: deg + error_deg }
    }

    pub(super) fn widen(self, by_deg: f64) -> Self {
        Self { from_deg: self.from_deg - by_deg, to_deg: self.to_deg + by_deg }
    }

    /// Returns the intersection; `None` if the ranges do not overlap.
    pub(super) fn overlap(self, other: Self) -> Option<Self> {
        let from_deg = self.from_deg.max(other.from_deg);
        let to_deg = self.to_deg.min(other.to_deg);
        (from_deg <= to_deg).then_some(Self { from_deg, to_deg })
    }

    /// Returns the signed distance of `deg` from the range, degrees; 0 inside.
    pub(super) fn off_deg(self, deg: f64) -> f64 {
        (deg - self.to_deg).max(0.0) + (deg - self.from_deg).min(0.0)
    }

    pub(super) fn middle_deg(self) -> f64 {
        f64::midpoint(self.from_deg, self.to_deg)
    }
}
