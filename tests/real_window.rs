//! The real window on a virtual screen, driven as an operator drives it.
//!
//! Needs Xvfb, xdotool, `ImageMagick` and a software OpenGL; the tests are
//! ignored by default and run by name where those are installed.

mod deaths;
mod desk;
mod processes;
mod stories;
mod unit;
