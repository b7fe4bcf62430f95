//! The buttons and the legend in the corners of the plot.

use egui::{Align2, Popup, PopupCloseBehavior, Rect, Response, Role, Stroke, StrokeKind, Ui, vec2};

use super::{Layers, SkyPlotState, beam_view, geometry::Dome, legend, scene::SkyScene};
use crate::ui::{
    icons::{self, Icon},
    text,
    tokens::Tokens,
    widgets::{check_box::CheckBox, close_key, paint},
};

/// Plot height below which a button opens the legend, points.
const LEGEND_HEIGHT: f32 = 500.0;
const KEYHOLES: &str = "Keyholes";
/// Height at the foot of a plot that the legend button takes, with its margins, points.
pub(in crate::ui) const LEGEND_FOOT: f32 = 48.0;
/// Distance of the texts from the edges of the plot, points.
pub(super) const EDGE: f32 = 16.0;

/// Shows the orientation, the layers button and, in a low plot, the legend button, in the
/// upper right corner.
pub(super) fn upper_right(ui: &Ui, rect: Rect, layers: &mut Layers, t: &Tokens) {
    let corner = rect.right_top() + vec2(-EDGE, 12.0);
    let button = Rect::from_min_size(corner - vec2(28.0, 0.0), vec2(28.0, 24.0));
    let response = icon_button(ui, "layers", button, "Layers", t).on_hover_text("Layers");
    icons::paint(ui.painter(), paint::square(button.center(), 14.0), Icon::Layers, t.t2);
    Popup::from_toggle_button_response(&response)
        .accessible_name("Layers of the sky plot")
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            for (on, name) in [
                (&mut layers.others, "Other satellites"),
                (&mut layers.names, "Names"),
                (&mut layers.sun_and_moon, "Sun and Moon"),
                (&mut layers.keyholes, KEYHOLES),
                (&mut layers.mask, "Horizon mask"),
                (&mut layers.keep_outs, "Keep-outs"),
                (&mut layers.antennas, "Other antennas"),
            ] {
                let response = ui.add(CheckBox::new(on, name));
                if name == KEYHOLES {
                    response.on_hover_text(legend::KEYHOLE);
                }
            }
            close_key::show(ui);
        });

    let position = button.left_center() - vec2(8.0, 0.0);
    let words = "N up, E right";
    let size = vec2(paint::text_width(ui, words, text::small()), 16.0);
    let ground = Align2::RIGHT_CENTER.anchor_size(position, size).expand(2.0);
    ui.painter().rect_filled(ground, 0.0, t.bg0);
    paint::text(ui, position, Align2::RIGHT_CENTER, words, text::small(), t.t2);
}

/// Returns the rectangle of the legend. `None` if something covers it, the plot is too low or the
/// legend would overlap the disc.
fn legend_place(
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    state: &SkyPlotState,
) -> Option<Rect> {
    let size = vec2(legend::WIDTH, legend::height(scene));
    let corner = rect.left_bottom() + vec2(EDGE, -12.0);
    let place = Rect::from_min_size(corner - vec2(0.0, size.y), size);
    let nearest = place.clamp(dome.centre);
    let is_free = nearest.distance(dome.centre) >= dome.radius;
    let is_shown = is_free && rect.height() >= LEGEND_HEIGHT && !state.folds_legend;
    is_shown.then_some(place)
}

/// Shows the legend in the lower left corner, or the button that opens it. In a magnified sky the
/// legend has a background.
pub(super) fn lower_left(
    ui: &Ui,
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    state: &SkyPlotState,
    t: &Tokens,
) {
    if let Some(place) = legend_place(rect, dome, scene, state) {
        if !state.zoom.is_whole() {
            ui.painter().rect_filled(place.expand(4.0), 0.0, t.bg0);
        }
        legend::paint(ui, place.min, scene, t);
        return;
    }
    let button = legend_button(rect);
    let response = icon_button(ui, "legend", button, "Legend", t);
    let icon = paint::square(button.left_center() + vec2(16.0, 0.0), 14.0);
    icons::paint(ui.painter(), icon, Icon::Info, t.t2);
    let position = button.left_center() + vec2(29.0, 0.0);
    paint::text(ui, position, Align2::LEFT_CENTER, "Legend", text::small(), t.t1);
    Popup::from_toggle_button_response(&response)
        .accessible_name("Legend of the sky plot")
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            let size = vec2(legend::WIDTH, legend::height(scene));
            let (place, _) = ui.allocate_exact_size(size, egui::Sense::hover());
            legend::paint(ui, place.min, scene, t);
            close_key::show(ui);
        });
}

fn legend_button(rect: Rect) -> Rect {
    Rect::from_min_size(rect.left_bottom() + vec2(EDGE, -12.0 - 24.0), vec2(80.0, 24.0))
}

fn icon_button(ui: &Ui, salt: &str, rect: Rect, name: &str, t: &Tokens) -> Response {
    let response = paint::control(ui, ("sky plot", salt), rect, Role::Button, true, name);
    let border = if response.hovered() { t.t2 } else { t.edge };
    ui.painter().rect(rect, 5.0, t.bg1, Stroke::new(1.0, border), StrokeKind::Inside);
    paint::focus_ring(ui, &response, 5);
    response
}

/// Returns the boxes in the corners that labels avoid.
pub(super) fn reserved(
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    state: &SkyPlotState,
) -> Vec<Rect> {
    let right =
        Rect::from_min_max(rect.right_top() - vec2(140.0, 0.0), rect.right_top() + vec2(0.0, 40.0));
    let legend = legend_place(rect, dome, scene, state).unwrap_or_else(|| legend_button(rect));
    let mut boxes = vec![right, legend];
    boxes.extend(scene.predicted.map(|_| beam_view::reserved(rect)));
    boxes
}
