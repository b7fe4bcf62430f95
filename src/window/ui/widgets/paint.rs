//! Text, borders and accessible names for painted content.

use egui::{
    Align2, Color32, CornerRadius, FontId, Pos2, Rect, Response, Role, Sense, Shape, Stroke,
    StrokeKind, Ui, UiBuilder, Vec2, WidgetInfo, pos2,
    text::{LayoutJob, TextFormat, TextWrapping},
};

use crate::ui::{text, theme};

/// Max number of characters of a satellite's number in its constellation, such as M072.
const MAX_NUMBER_CHARS: usize = 6;
/// Min number of letters before the number; fewer letters are meaningless.
const MIN_HEAD_CHARS: usize = 3;
/// Dash and gap of the border of a locked or blocked control, points.
const DASH: (f32, f32) = (3.0, 2.0);
/// Distance and width of the focus ring, points.
const FOCUS: f32 = 2.0;

/// Paints one line of text with its `anchor` at `position`, never cut.
pub fn text(
    ui: &Ui,
    position: Pos2,
    anchor: Align2,
    text: impl ToString,
    font: FontId,
    colour: Color32,
) -> Rect {
    ui.painter().text(position, anchor, text, font, colour)
}

/// Paints one line of text, anchored in `rect` and cut with an ellipsis at its width.
pub fn text_in(
    ui: &Ui,
    rect: Rect,
    anchor: Align2,
    text: &str,
    font: FontId,
    colour: Color32,
) -> Rect {
    cut_text_in(ui, rect, anchor, text, font, colour).0
}

/// Paints like [`text_in`]. Returns the painted rectangle, and `true` if the text was cut.
fn cut_text_in(
    ui: &Ui,
    rect: Rect,
    anchor: Align2,
    text: &str,
    font: FontId,
    colour: Color32,
) -> (Rect, bool) {
    let mut job = LayoutJob::single_section(text.to_owned(), TextFormat::simple(font, colour));
    job.wrap = TextWrapping::truncate_at_width(rect.width());
    let galley = ui.painter().layout_job(job);
    let (place, is_cut) = (anchor.align_size_within_rect(galley.size(), rect), galley.elided);
    ui.painter().galley(place.min, galley, colour);
    (place, is_cut)
}

/// Paints like [`text_in`] and adds an accessible name. The tool-tip shows a cut text completely.
pub fn named_text_in(
    ui: &Ui,
    salt: impl egui::AsIdSalt,
    rect: Rect,
    anchor: Align2,
    text: &str,
    font: FontId,
    colour: Color32,
) -> Rect {
    let (place, is_cut) = cut_text_in(ui, rect, anchor, text, font, colour);
    let named = name_text(ui, salt, rect, text);
    if is_cut {
        named.on_hover_text(text);
    }
    place
}

/// Paints a name at the left of `line` and its value at the right. The tool-tip shows both
/// completely if one was cut. Returns the rectangle of the value.
pub fn fact_in(
    ui: &Ui,
    salt: impl egui::AsIdSalt,
    line: Rect,
    name: &str,
    value: &str,
    colour: Color32,
) -> Rect {
    let (font, ink) = (text::small(), theme::tokens(ui).t2);
    let (left, is_name_cut) = cut_text_in(ui, line, Align2::LEFT_CENTER, name, font.clone(), ink);
    let room = line.with_min_x(left.right() + 8.0);
    let (drawn, is_cut) = cut_text_in(ui, room, Align2::RIGHT_CENTER, value, font, colour);
    let words = format!("{name}: {value}");
    let named = name_text(ui, salt, line, &words);
    if is_name_cut || is_cut {
        named.on_hover_text(words);
    }
    drawn
}

/// Paints the name of a satellite on one line, anchored in `rect`. A long name is cut before its
/// number. Cut at their ends, all names of a constellation would read the same.
pub fn name_in(
    ui: &Ui,
    rect: Rect,
    anchor: Align2,
    name: &str,
    font: FontId,
    colour: Color32,
) -> Rect {
    let fits = |words: &str| text_width(ui, words, font.clone()) <= rect.width();
    let number = name.rsplit([' ', '-']).next().unwrap_or_default();
    let is_number = number.len() < name.len()
        && number.chars().count() <= MAX_NUMBER_CHARS
        && number.chars().any(|letter| letter.is_ascii_digit());
    if !is_number || fits(name) {
        return text_in(ui, rect, anchor, name, font, colour);
    }
    let head = name.strip_suffix(number).unwrap_or(name);
    let cuts = head.char_indices().map(|(index, _)| index).skip(MIN_HEAD_CHARS).collect::<Vec<_>>();
    let cut = cuts.into_iter().rev().find_map(|index| {
        let words = format!("{}… {number}", head.get(..index)?.trim_end());
        fits(&words).then_some(words)
    });
    text_in(ui, rect, anchor, cut.as_deref().unwrap_or(name), font, colour)
}

/// Paints text from `position` on, wrapped at `width`. Returns the painted rectangle.
pub fn paragraph(
    ui: &Ui,
    position: Pos2,
    width: f32,
    text: &str,
    font: FontId,
    colour: Color32,
) -> Rect {
    let galley = ui.painter().layout(text.to_owned(), font, colour, width);
    let rect = Rect::from_min_size(position, galley.size());
    ui.painter().galley(position, galley, colour);
    rect
}

/// Paints text at the left of `rect`, wrapped at its width and centred in its height.
pub fn paragraph_in(ui: &Ui, rect: Rect, text: &str, font: FontId, colour: Color32) -> Rect {
    let galley = ui.painter().layout(text.to_owned(), font, colour, rect.width());
    let place = Align2::LEFT_CENTER.align_size_within_rect(galley.size(), rect);
    ui.painter().galley(place.min, galley, colour);
    place
}

/// Returns the width of one line of text, points.
pub fn text_width(ui: &Ui, text: &str, font: FontId) -> f32 {
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER).size().x
}

/// Returns `true` if a line of text fits the width of `rect`.
pub fn fits(ui: &Ui, text: &str, font: FontId, rect: Rect) -> bool {
    text_width(ui, text, font) <= rect.width()
}

/// Returns a square of `side` around `centre`, for an icon.
pub fn square(centre: Pos2, side: f32) -> Rect {
    Rect::from_center_size(centre, Vec2::splat(side))
}

/// Paints a dashed border just inside `rect`, for a locked or blocked control.
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

/// Paints the ring around the focused control. Scrolls to a control that gains the focus by a key.
pub fn focus_ring(ui: &Ui, response: &Response, radius: u8) {
    if response.gained_focus() && !ui.input(|input| input.pointer.any_down()) {
        response.scroll_to_me(None);
    }
    if response.has_focus() {
        ring_around(ui, response.rect, radius);
    }
}

/// Scrolls to the control in `ui` that gained the focus by a key, for controls that [`focus_ring`]
/// does not scroll to. Call this function at the end of the scrolling content.
pub fn follow_focus(ui: &Ui) {
    let focused = ui.memory(egui::Memory::focused);
    let key = ui.scope_id().with("followed focus");
    let before = ui.data_mut(|data| {
        let before = data.get_temp::<Option<egui::Id>>(key).flatten();
        data.insert_temp(key, focused);
        before
    });
    let Some(id) = focused.filter(|_| focused != before) else { return };
    let widget = ui.ctx().viewport(|viewport| viewport.this_pass.widgets.get(id).copied());
    let Some(widget) = widget.filter(|widget_rect| widget_rect.layer_id == ui.layer_id()) else {
        return;
    };
    let is_inside = ui.min_rect().contains(widget.rect.center());
    if is_inside && !ui.input(|input| input.pointer.any_down()) {
        ui.scroll_to_rect(widget.rect, None);
    }
}

/// Paints a focus ring around `rect`.
pub fn ring_around(ui: &Ui, rect: Rect, radius: u8) {
    let stroke = Stroke::new(FOCUS, theme::tokens(ui).sat);
    let radius = CornerRadius::same(radius.saturating_add(2));
    ui.painter().rect_stroke(rect.expand(FOCUS), radius, stroke, StrokeKind::Outside);
}

/// Adds a control with its role and name in a given rectangle. A disabled control ignores
/// clicks and Tab skips it.
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

/// Adds a button with an icon and without text. Its tool-tip shows its name.
pub fn icon_control(ui: &Ui, salt: impl egui::AsIdSalt, rect: Rect, name: &str) -> Response {
    control(ui, salt, rect, Role::Button, true, name).on_hover_text(name)
}

/// Adds a button that acts while the operator holds it down.
pub fn held_control(
    ui: &Ui,
    salt: impl egui::AsIdSalt,
    rect: Rect,
    enabled: bool,
    name: &str,
) -> Response {
    // egui ends a press on a click-sensing control after 0.8 s, or when the
    // pointer moves a little; a drag lasts until the release.
    let sense = if enabled { Sense::drag() } else { Sense::hover() };
    let response = ui.interact(rect, ui.make_persistent_id(salt), sense);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
    response
}

/// Returns a `Ui` for the marks of a drawing. Their nodes are children of its node.
pub fn marks_of(ui: &mut Ui, drawing: &Response) -> Ui {
    let builder = UiBuilder::new().id_salt("marks").max_rect(drawing.rect);
    ui.new_child(builder.accessibility_parent(drawing.id))
}

/// Adds an accessibility node for painted text, for screen readers and tests.
pub fn name_text(ui: &Ui, salt: impl egui::AsIdSalt, rect: Rect, name: &str) -> Response {
    let response = ui.interact(rect, ui.make_persistent_id(salt), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
    response
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;

    use super::{super::testing, *};

    /// Returns the painted text of `name` in a width, points.
    fn painted(name: &'static str, width: f32) -> String {
        let window: Harness<'_, ()> = testing::window([400.0, 60.0], (), move |ui, ()| {
            let rect = Rect::from_min_size(Pos2::ZERO, Vec2::new(width, 20.0));
            name_in(ui, rect, Align2::LEFT_CENTER, name, text::body(), Color32::WHITE);
        });
        let texts = window.output().shapes.iter().filter_map(|clipped| match &clipped.shape {
            Shape::Text(text) => Some(text.galley.rows.first()?.text()),
            _ => None,
        });
        texts.collect()
    }

    #[test]
    fn a_name_without_room_keeps_its_number() {
        assert_eq!(painted("GLOBALSTAR M072", 300.0), "GLOBALSTAR M072");
        let cut = painted("GLOBALSTAR M072", 90.0);
        assert!(cut.starts_with("GLO") && cut.ends_with("… M072"), "{cut}");
        let is_cut = |width| painted("COSMOS-2251", width).ends_with("… 2251");
        assert!((40..100_u8).any(|width| is_cut(f32::from(width))), "some width cuts it there");
        let cut = painted("AN ASTRONOMICAL NAME", 60.0);
        assert!(cut.starts_with("AN") && !cut.contains("NAME"), "{cut}");
    }
}
