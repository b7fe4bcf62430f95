//! Session of an antenna against a simulated RC2000C: the operator's view, and the unit's
//! commands.

pub(crate) mod rig;

mod actions;
mod alarms;
mod connect;
mod jog;
mod line;
mod polarization;
mod position;
mod real;
mod stop;
mod sway;
mod track;
