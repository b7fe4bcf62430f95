//! Parts that the tests of several subjects share.

pub(crate) mod clock;
pub(crate) mod dice;
mod mast;
pub(crate) mod network;
pub(crate) mod rig;

pub(crate) use mast::mast;
