//! The station file: site, antennas, limits.
