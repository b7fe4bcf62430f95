//! The real window on a virtual screen, driven as an operator drives it.
//!
//! The tests need Xvfb, xdotool, `ImageMagick` and a software OpenGL. They are ignored by
//! default and run by name where those are installed.

mod deaths;
mod pictures;
mod processes;
mod recorded;
mod screen;
mod stories;
mod unit;
