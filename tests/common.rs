//! Parts shared by the tests of several subjects.

pub(crate) mod clock;
pub(crate) mod dice;
mod mast;
pub(crate) mod network;
pub(crate) mod rig;
mod written;

pub(crate) use mast::mast;
pub(crate) use written::comes_back;
