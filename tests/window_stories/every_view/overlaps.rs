//! Texts that must not overlap.

use crate::window_stories::{
    every_view::{Findings, painted},
    rig::Window,
};

/// Finds texts that lie on another one. Counts all texts.
pub(super) fn check(window: &Window, findings: &mut Findings) {
    findings.count(painted::texts(window).len());
    for [below, above] in painted::on_each_other(window) {
        findings.add(&format!("{above:?} on {below:?}"));
    }
}
