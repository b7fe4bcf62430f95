//! Angles, time, frames and the geometry of mounts. The module is independent of all other layers.

mod angle;
mod azel;
pub mod frames;
mod ground;
mod horizon_mask;
mod locator;
mod pointing_model;
mod refraction;
mod site;
pub mod sun_moon;
pub mod time;
mod track_offsets;
pub mod xy_mount;
mod zone;

pub use angle::Angle;
pub use azel::AzEl;
pub use ground::{Cap, CapRow, GroundPoint};
pub use horizon_mask::{HorizonMask, MAX_MASK_POINTS, MaskError, MaskForm, MaskImportError};
pub use locator::{LocatorError, LocatorSquare, read_locator};
pub use pointing_model::{PointingModel, Term};
pub use refraction::{Air, Refraction, RefractionError};
pub use site::{Site, SiteError};
pub use track_offsets::{MAX_ANGLE_OFFSET, MAX_TIME_OFFSET, Offset, TrackOffsets};
pub use zone::{MAX_CORNERS, MIN_CORNERS, Zone, ZoneError};
