//! Text, borders and accessible names for what the painter draws.

use egui::{
    Align2, Color32, CornerRadius, FontId, Pos2, Rect, Response, Role, Sense, Shape, Stroke,
    StrokeKind, Ui, Vec2, WidgetInfo, pos2,
    text::{LayoutJob, TextFormat, TextWrapping},
};

use crate::ui::theme;

/// Dash and gap of the border of a control that is locked or blocked.
const DASH: (f32, f32) = (3.0, 2.0);
/// Distance and width of the ring around the control that has the focus.
const FOCUS: f32 = 2.0;

/// One line of text with its `anchor` at `at`, as long as it wants to be.
pub fn text(
    ui: &Ui,
    at: Pos2,
    anchor: Align2,
    text: impl ToString,
    font: FontId,
    colour: Color32,
) -> Rect {
    ui.painter().text(at, anchor, text, font, colour)
}

/// One line of text, anchored in `rect` and cut with an ellipsis at its width.
pub fn text_in(
    ui: &Ui,
    rect: Rect,
    anchor: Align2,
    text: &str,
    font: FontId,
    colour: Color32,
) -> Rect {
    let mut job = LayoutJob::single_section(text.to_owned(), TextFormat::simple(font, colour));
    job.wrap = TextWrapping::truncate_at_width(rect.width());
    let galley = ui.painter().layout_job(job);
    let place = anchor.align_size_within_rect(galley.size(), rect);
    ui.painter().galley(place.min, galley, colour);
    place
}

/// Text that wraps at the width of `rect`, from its upper left corner.
/// Returns the rectangle it took.
pub fn paragraph(ui: &Ui, at: Pos2, width: f32, text: &str, font: FontId, colour: Color32) -> Rect {
    let galley = ui.painter().layout(text.to_owned(), font, colour, width);
    let rect = Rect::from_min_size(at, galley.size());
    ui.painter().galley(at, galley, colour);
    rect
}

/// Width of one line of text, in points.
pub fn text_width(ui: &Ui, text: &str, font: FontId) -> f32 {
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER).size().x
}

/// A square of `side` around `centre`, for an icon.
pub fn square(centre: Pos2, side: f32) -> Rect {
    Rect::from_center_size(centre, Vec2::splat(side))
}

/// A dashed border just inside `rect`, for what is locked or blocked.
pub fn dashed_border(ui: &Ui, rect: Rect, radius: f32, stroke: impl Into<Stroke>) {
    let stroke = stroke.into();
    let rect = rect.shrink(stroke.width / 2.0);
    let mut path = Vec::new();
    for (corner, from_deg) in [
        (pos2(rect.left() + radius, rect.top() + radius), 180.0_f32),
        (pos2(rect.right() - radius, rect.top() + radius), 270.0),
        (pos2(rect.right() - radius, rect.bottom() - radius), 0.0),
        (pos2(rect.left() + radius, rect.bottom() - radius), 90.0),
    ] {
        for step in 0..=3_u8 {
            let angle = (from_deg + 30.0 * f32::from(step)).to_radians();
            path.push(corner + radius * Vec2::angled(angle));
        }
    }
    path.extend(path.first().copied());
    ui.painter().extend(Shape::dashed_line(&path, stroke, DASH.0, DASH.1));
}

/// The ring around the control that has the focus of the keyboard. One that
/// comes to it by the keyboard is brought into sight.
pub fn focus_ring(ui: &Ui, response: &Response, radius: u8) {
    if response.gained_focus() && !ui.input(|input| input.pointer.any_down()) {
        response.scroll_to_me(None);
    }
    if response.has_focus() {
        let stroke = Stroke::new(FOCUS, theme::tokens(ui).sat);
        let radius = CornerRadius::same(radius.saturating_add(2));
        ui.painter().rect_stroke(response.rect.expand(FOCUS), radius, stroke, StrokeKind::Outside);
    }
}

/// A control at a fixed place with its role and name. A control that is not
/// enabled cannot be clicked and is not reached with Tab.
pub fn control(
    ui: &Ui,
    salt: impl egui::AsIdSalt,
    rect: Rect,
    role: Role,
    enabled: bool,
    name: &str,
) -> Response {
    let sense = if enabled { Sense::click() } else { Sense::hover() };
    let response = ui.interact(rect, ui.make_persistent_id(salt), sense);
    response.widget_info(|| WidgetInfo::labeled(role, enabled, name));
    response
}

/// A button that does something as long as it is held down.
pub fn held_control(
    ui: &Ui,
    salt: impl egui::AsIdSalt,
    rect: Rect,
    enabled: bool,
    name: &str,
) -> Response {
    // A press on what senses clicks counts as over after 0.8 s, or when the
    // pointer moves a little; a drag lasts until the release.
    let sense = if enabled { Sense::drag() } else { Sense::hover() };
    let response = ui.interact(rect, ui.make_persistent_id(salt), sense);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
    response
}

/// A node for painted text, so that it can be read aloud and be found.
pub fn name_text(ui: &Ui, salt: impl egui::AsIdSalt, rect: Rect, name: &str) -> Response {
    let response = ui.interact(rect, ui.make_persistent_id(salt), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
    response
}
