//! Parts that the tests of several subjects share.

pub(crate) mod clock;
pub(crate) mod dice;
pub(crate) mod network;
pub(crate) mod rig;
