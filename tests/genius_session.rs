//! Session of an antenna against a simulated Rotator Genius, in paused time: the
//! operator's view, and the unit's commands byte for byte.

pub(crate) mod rig;
mod script;

mod alone;
mod connect;
mod go_to;
mod jog;
mod lock_out;
mod oddities;
mod pair;
mod rescue;
mod settings;
mod socket;
mod stop;
mod sway;
mod wire;
