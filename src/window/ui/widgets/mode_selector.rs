//! The selector of the intent of an antenna.

use egui::{Rect, Ui};

use super::segmented::{self, Segment};
use crate::contract::driver::Intent;

/// All modes in the order in which they are shown.
pub const ALL: [Intent; 5] =
    [Intent::Standby, Intent::Manual, Intent::Position, Intent::Track, Intent::Park];

fn word(mode: Intent) -> &'static str {
    match mode {
        Intent::Standby => "Standby",
        Intent::Manual => "Manual",
        Intent::Position => "Position",
        Intent::Track => "Track",
        Intent::Park => "Park",
    }
}

#[derive(Debug, Clone, Copy, Default)]
pub struct ModeModel<'a> {
    /// The modes that the controller offers; the others are left out.
    pub offered: &'a [Intent],
    /// The mode that the antenna is in.
    pub current: Option<Intent>,
    /// The antenna is in it, but not by this console.
    pub is_foreign: bool,
    /// No mode can be chosen now; the card says why.
    pub is_locked: bool,
    /// The requested mode, until the unit reports it.
    pub pending: Option<Intent>,
}

/// Shows the modes in `rect` and returns a clicked one.
pub fn show(ui: &Ui, rect: Rect, model: &ModeModel<'_>) -> Option<Intent> {
    let modes: Vec<Intent> = ALL.into_iter().filter(|mode| model.offered.contains(mode)).collect();
    let segments: Vec<(&str, Segment)> = modes
        .iter()
        .map(|mode| {
            let state = if model.is_locked {
                Segment::Locked(None)
            } else if model.pending == Some(*mode) {
                Segment::Pending
            } else if model.current == Some(*mode) {
                if model.is_foreign { Segment::Foreign } else { Segment::Chosen }
            } else {
                Segment::Free
            };
            (word(*mode), state)
        })
        .collect();
    let clicked = segmented::show_commands(ui, "mode", rect, "Mode", &segments)?;
    modes.get(clicked).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui::{Key, Role, pos2, vec2};
    use egui_kittest::kittest::{NodeT as _, Queryable as _};

    #[test]
    fn a_mode_click_is_reported_and_missing_modes_are_left_out() {
        let mut window = testing::window([400.0, 80.0], None, |ui, clicked| {
            let rect = Rect::from_min_size(pos2(20.0, 20.0), vec2(312.0, 32.0));
            let model = ModeModel {
                offered: &[Intent::Manual, Intent::Position, Intent::Track],
                current: Some(Intent::Track),
                pending: Some(Intent::Manual),
                ..ModeModel::default()
            };
            *clicked = show(ui, rect, &model).or(*clicked);
        });
        assert!(window.query_by_label("Standby").is_none());
        assert!(window.query_by_label("Park").is_none());
        let track = window.get_by_role_and_label(Role::RadioButton, "Track");
        assert_eq!(track.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True));
        window.get_by_role_and_label(Role::RadioButton, "Position").click();
        window.run();
        assert_eq!(*window.state(), Some(Intent::Position));
    }

    #[test]
    fn an_arrow_key_that_passes_over_a_mode_does_not_command_it() {
        let mut window = testing::window([400.0, 80.0], None, |ui, clicked| {
            let rect = Rect::from_min_size(pos2(20.0, 20.0), vec2(312.0, 32.0));
            let current = Some(Intent::Standby);
            let model = ModeModel { offered: &ALL, current, ..ModeModel::default() };
            *clicked = show(ui, rect, &model).or(*clicked);
        });
        window.get_by_role_and_label(Role::RadioButton, "Standby").focus();
        window.run();
        window.key_press(Key::ArrowLeft);
        window.run();
        assert_eq!(*window.state(), None);
        assert!(window.get_by_role_and_label(Role::RadioButton, "Park").is_focused());
        window.key_press(Key::Enter);
        window.run();
        assert_eq!(*window.state(), Some(Intent::Park));
    }

    #[test]
    fn a_locked_mode_takes_no_click() {
        let mut window = testing::window([400.0, 80.0], None, |ui, clicked| {
            let rect = Rect::from_min_size(pos2(20.0, 20.0), vec2(312.0, 32.0));
            let model = ModeModel { offered: &ALL, is_locked: true, ..ModeModel::default() };
            *clicked = show(ui, rect, &model).or(*clicked);
        });
        let manual = window.get_by_role_and_label(Role::RadioButton, "Manual");
        assert!(manual.accesskit_node().is_disabled());
        manual.click();
        window.run();
        assert_eq!(*window.state(), None);
    }
}
