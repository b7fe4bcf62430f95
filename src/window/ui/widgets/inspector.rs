//! The panel at the right of a view that shows the selected item. It has a background, a head with
//! name and countdown, a scrolling body, and a foot with buttons.

use egui::{Align2, Rect, RichText, ScrollArea, Sense, Ui, UiBuilder, vec2};

use super::paint;
use crate::ui::{
    text::{self, Weight},
    theme,
};

/// Distance of the contents from the edges of a panel, points.
pub const PADDING: f32 = 16.0;
const HEAD: f32 = 56.0;
const GAP: f32 = 8.0;

/// Places of the parts of a panel.
#[derive(Debug, Clone, Copy)]
pub struct Parts {
    pub head: Rect,
    pub body: Rect,
    pub foot: Rect,
}

impl Parts {
    /// Returns the parts of a panel in `rect`; the foot is `foot` points high.
    pub fn new(rect: Rect, foot: f32) -> Self {
        let (head, rest) = rect.split_top_bottom_at_y(rect.top() + HEAD);
        let (body, foot) = rest.split_top_bottom_at_y(rest.bottom() - foot);
        Self { head, body, foot }
    }
}

/// Paints the background of a panel and the line at its left.
pub fn show_ground(ui: &Ui, rect: Rect) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
}

/// Shows that nothing is selected, and how to select an item.
pub fn show_nothing(ui: &mut Ui, rect: Rect, title: &str, words: &str) {
    let builder = UiBuilder::new().id_salt("nothing selected").max_rect(rect.shrink(PADDING));
    ui.scope_builder(builder, |ui| {
        let colour = theme::tokens(ui).t2;
        ui.label(RichText::new(title).font(text::value()));
        ui.label(RichText::new(words).font(text::body()).color(colour));
    });
}

/// Words of the head.
#[derive(Debug, Clone, Copy)]
pub struct Head<'a> {
    pub name: &'a str,
    /// Detail below the name.
    pub detail: &'a str,
    /// Next event, above the time until that event.
    pub event: &'a str,
    pub countdown: &'a str,
    /// Room for a control at the left of the name, points.
    pub indent: f32,
}

/// Draws the head of the panel `salt`: the name at the left, the countdown at the right.
pub fn show_head(ui: &Ui, rect: Rect, salt: &str, head: Head<'_>) {
    let t = theme::tokens(ui);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let line = |y: f32| {
        Rect::from_x_y_ranges(inner.x_range(), rect.top() + y - 12.0..=rect.top() + y + 12.0)
    };
    let (left, right) = (Align2::LEFT_CENTER, Align2::RIGHT_CENTER);
    let event = paint::text_in(ui, line(16.0), right, head.event, text::small(), t.t3);
    let font = text::sized(20.0, Weight::SemiBold);
    let countdown = paint::text_in(ui, line(37.0), right, head.countdown, font, t.t1);
    let words = format!("{} {}", head.event, head.countdown);
    if !words.trim().is_empty() {
        paint::name_text(ui, (salt, "countdown"), event.union(countdown), words.trim());
    }
    let line = |y: f32| line(y).with_min_x(inner.left() + head.indent);
    let room = line(19.0).with_max_x(event.left() - GAP);
    paint::text_in(ui, room, left, head.name, text::title(), t.t1);
    let room = line(40.0).with_max_x(countdown.left() - GAP);
    let detail = paint::text_in(ui, room, left, head.detail, text::small(), t.t2);
    let words = format!("{}, {}", head.name, head.detail);
    paint::name_text(ui, (salt, "selected"), detail, &words).on_hover_text(&words);
}

/// Draws the body of the panel `salt`, which scrolls.
pub fn show_body(ui: &mut Ui, rect: Rect, salt: &str, contents: impl FnOnce(&mut Ui)) {
    ui.scope_builder(UiBuilder::new().id_salt((salt, "body")).max_rect(rect), |ui| {
        ui.set_clip_rect(rect.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        let area = ScrollArea::vertical().id_salt((salt, "rows")).auto_shrink(false);
        area.show(ui, |ui| {
            contents(ui);
            paint::follow_focus(ui);
        });
    });
}

/// Returns a place of this height across the body.
pub fn place(ui: &mut Ui, width: f32, height: f32) -> Rect {
    ui.allocate_exact_size(vec2(width, height), Sense::hover()).0
}
