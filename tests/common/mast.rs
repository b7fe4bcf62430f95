//! A mast in the way, as a keep-out.

use azel::station::{Entered, KeepOut};

/// Returns a hard keep-out with a margin of one degree around an outline. Its corners are azimuth
/// and elevation, degrees.
pub(crate) fn mast(corners_deg: &[(f64, f64)]) -> KeepOut {
    KeepOut {
        name: "mast".to_owned(),
        reason: String::new(),
        entered: Entered::Hard,
        antenna: None,
        margin_deg: 1.0,
        zone: KeepOut::zone_of(corners_deg).unwrap(),
    }
}
