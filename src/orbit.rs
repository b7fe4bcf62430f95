//! Elements, propagation, look angles, passes. Pure functions; the clock comes in.
