//! The session of an antenna against a simulated RC2000C: what the operator is
//! shown, and what the unit receives.

mod rig;

mod actions;
mod alarms;
mod connect;
mod jog;
mod line;
mod polarization;
mod position;
mod real;
mod stop;
mod track;
