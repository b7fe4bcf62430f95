//! The session of an antenna against a simulated Rotator Genius, in paused time:
//! what the operator is shown, and what the device receives byte for byte.

mod rig;
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
mod wire;
