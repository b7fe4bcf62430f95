//! Behaviour of each controller without I/O.
