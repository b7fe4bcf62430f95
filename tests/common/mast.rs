//! A mast in the way, as a keep-out.

use azel::station::{Entered, KeepOut};

/// A mast that nothing may enter, given by the corners of its outline in azimuth and
/// elevation, degrees, with a margin of one degree.
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
