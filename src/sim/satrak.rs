//! Satrak simulator.
