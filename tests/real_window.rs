//! The real window on a virtual screen, driven as an operator drives it.
//!
//! Needs Xvfb, xdotool, `ImageMagick` and a software OpenGL; the tests are
//! ignored by default and run by name where those are installed.

// A test ends loudly, and its desk is part of it.
#![allow(clippy::expect_used, clippy::panic)]

#[cfg(target_os = "linux")]
mod real_window {
    mod deaths;
    mod desk;
    mod processes;
    mod stories;
    mod unit;
}
