//! Satrak codec.
