//! The real window on a virtual screen, driven as an operator drives it.
//!
//! The tests need Xvfb, xdotool, `ImageMagick` and a software OpenGL. They are ignored by default:
//! run them by name on a machine that has these programs.

mod deaths;
mod pictures;
mod processes;
mod recorded;
mod screen;
mod stories;
mod unit;
