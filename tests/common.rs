//! Parts shared by the tests of several subjects.

pub(crate) mod clock;
pub(crate) mod dice;
mod mast;
pub(crate) mod network;
pub(crate) mod rig;
pub(crate) mod turns;
pub(crate) mod units;
pub(crate) mod workers;
mod written;

pub(crate) use mast::mast;
pub(crate) use written::comes_back;
