//! The session of an antenna against a simulated RC2000C: what the operator is
//! shown, and what the unit receives.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "a test may end here"
)]

mod rc2000c_session {
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
}
