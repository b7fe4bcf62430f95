//! A check box with its label.

use egui::{Checkbox, Response, Stroke, Ui, Widget};

use super::{button::RADIUS, paint};
use crate::ui::theme;

/// Side of the box, points.
const SIDE: f32 = 16.0;
/// Distance of the words from the box, points.
const GAP: f32 = 8.0;
/// Width of a check box without its words, points.
pub const WIDTH: f32 = SIDE + GAP;

pub struct CheckBox<'a> {
    is_on: &'a mut bool,
    words: &'a str,
}

impl<'a> CheckBox<'a> {
    pub fn new(is_on: &'a mut bool, words: &'a str) -> Self {
        Self { is_on, words }
    }
}

impl Widget for CheckBox<'_> {
    fn ui(self, ui: &mut Ui) -> Response {
        let t = theme::tokens(ui);
        let Self { is_on, words } = self;
        ui.scope(|ui| {
            ui.spacing_mut().icon_width = SIDE;
            ui.spacing_mut().icon_spacing = GAP;
            let widgets = &mut ui.visuals_mut().widgets;
            for look in [
                &mut widgets.noninteractive,
                &mut widgets.inactive,
                &mut widgets.hovered,
                &mut widgets.active,
            ] {
                if *is_on {
                    look.bg_fill = t.sat;
                    look.bg_stroke.color = t.sat;
                    look.fg_stroke = Stroke::new(2.0, t.onsat);
                } else {
                    look.bg_fill = t.field;
                }
            }
            let response = ui.add(Checkbox::new(is_on, words));
            paint::focus_ring(ui, &response, RADIUS);
            response
        })
        .inner
    }
}
