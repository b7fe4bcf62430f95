//! The list box of every view. It scrolls rows of one height, is a single Tab stop, handles keys,
//! and gives roles and names to screen readers.

use std::hash::Hash;

use egui::{
    Color32, EventFilter, Key, Modifiers, Rect, Response, Role, ScrollArea, Sense, StrokeKind, Ui,
    UiBuilder, WidgetInfo, pos2, vec2,
};

use super::paint;
use crate::ui::{text, theme};

/// Width of the stripe at the left of a selected row, points.
const STRIPE: f32 = 3.0;
/// Distance of the sentence of an empty list from its edges, points.
const MARGIN: f32 = 16.0;

/// Scroll position of a list, kept from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scroll {
    /// Distance between the first row and the upper edge, points.
    pub offset: f32,
    /// Offset at which the next frame begins, points.
    next: Option<f32>,
    /// Row that the next frame scrolls to.
    requested: Option<usize>,
}

impl Scroll {
    /// Begins the next frame at this offset.
    pub fn set(&mut self, offset: f32) {
        self.next = Some(offset.max(0.0));
    }

    /// Scrolls to a row in the next frame.
    pub fn bring_into_view(&mut self, row: usize) {
        self.requested = Some(row);
    }

    /// Returns the requested offset of a list with rows of `height`, points, if there is a request.
    fn take(&mut self, height: f32, view: f32) -> Option<f32> {
        let offset = self.next.take();
        let Some(row) = self.requested.take() else { return offset };
        let top = row as f32 * height;
        Some(offset.unwrap_or(self.offset).min(top).max(top + height - view))
    }
}

/// Movement by a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Number of rows downwards; the extremes mean the first and the last row.
    pub rows: isize,
    /// `true` if Shift extends the selection.
    pub extends: bool,
}

impl Step {
    /// Returns the row after a step from row `start` of `rows`.
    pub fn target(self, start: usize, rows: usize) -> Option<usize> {
        Some(start.saturating_add_signed(self.rows).min(rows.checked_sub(1)?))
    }
}

/// A list box in its place.
pub struct List {
    /// Response of the list as one control, which has the focus of all rows.
    pub response: Response,
    row: f32,
}

impl List {
    /// Adds the list box `name` in `rect`, with rows of height `row`.
    pub fn new(ui: &Ui, rect: Rect, salt: &str, name: &str, row: f32) -> Self {
        let id = ui.make_persistent_id(salt);
        let response = ui.interact(rect, id, Sense::CLICK | Sense::FOCUSABLE);
        response.widget_info(|| WidgetInfo::labeled(Role::ListBox, true, name));
        if response.clicked() {
            response.request_focus();
        }
        if response.has_focus() {
            let arrows = EventFilter {
                horizontal_arrows: true,
                vertical_arrows: true,
                ..EventFilter::default()
            };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
        }
        Self { response, row }
    }

    /// Takes the key that moves between rows, while the list has the focus.
    pub fn step(&self, ui: &Ui) -> Option<Step> {
        let page = ((self.response.rect.height() / self.row) as isize - 1).max(1);
        let others = [
            (Key::PageUp, -page),
            (Key::PageDown, page),
            (Key::Home, isize::MIN),
            (Key::End, isize::MAX),
        ];
        self.arrow_step(ui).or_else(|| self.step_by(ui, others))
    }

    /// Takes an arrow key that moves between rows, for a view that uses the other keys.
    pub fn arrow_step(&self, ui: &Ui) -> Option<Step> {
        self.step_by(ui, [(Key::ArrowUp, -1), (Key::ArrowDown, 1)])
    }

    fn step_by<const N: usize>(&self, ui: &Ui, keys: [(Key, isize); N]) -> Option<Step> {
        if !self.response.has_focus() {
            return None;
        }
        let mut step = None;
        for (key, rows) in keys {
            for (modifiers, extends) in [(Modifiers::SHIFT, true), (Modifiers::NONE, false)] {
                let count = ui.input_mut(|input| input.count_and_consume_key(modifiers, key));
                if let Ok(count @ 1..) = isize::try_from(count) {
                    step = Some(Step { rows: rows.saturating_mul(count), extends });
                }
            }
        }
        step
    }

    /// Shows the reason why the list has no rows.
    pub fn show_empty(&self, ui: &Ui, salt: &str, words: &str) {
        let rect = self.response.rect;
        let corner = rect.left_top() + vec2(MARGIN, 12.0);
        let (width, colour) = (rect.width() - 2.0 * MARGIN, theme::tokens(ui).t2);
        let place = paint::paragraph(ui, corner, width, words, text::body(), colour);
        paint::name_text(ui, salt, place, words);
        self.show_focus(ui);
    }

    /// Draws the visible rows of `count` rows.
    pub fn show_rows(
        &self,
        ui: &mut Ui,
        count: usize,
        scroll: &mut Scroll,
        mut row: impl FnMut(&mut Ui, Rect, usize),
    ) {
        let height = self.row;
        let offset = scroll.take(height, self.response.rect.height());
        self.show_scrolling(ui, |ui, mut area| {
            if let Some(offset) = offset {
                area = area.vertical_scroll_offset(offset);
            }
            let output = area.show_rows(ui, height, count, |ui, range| {
                let (left, top) = (ui.max_rect().left(), ui.max_rect().top());
                for (place, index) in range.enumerate() {
                    let min = pos2(left, top + place as f32 * height);
                    row(ui, Rect::from_min_size(min, vec2(ui.max_rect().width(), height)), index);
                }
            });
            scroll.offset = output.state.clamped_offset().y;
        });
    }

    /// Draws rows of different heights in the given area.
    pub fn show_scrolling(&self, ui: &mut Ui, contents: impl FnOnce(&mut Ui, ScrollArea)) {
        let rect = self.response.rect;
        let builder = UiBuilder::new().id_salt(self.response.id).max_rect(rect);
        ui.scope_builder(builder, |ui| {
            ui.set_clip_rect(rect.intersect(ui.clip_rect()));
            ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
            // The end may move by several rows within a frame, and the scroll area would spring
            // back.
            ui.spacing_mut().scroll.kinetic.rubber_band = false;
            let id = self.response.id.with("rows");
            contents(ui, ScrollArea::vertical().id_salt(id).auto_shrink(false));
        });
        self.show_focus(ui);
    }

    fn show_focus(&self, ui: &Ui) {
        if self.response.has_focus() {
            let rect = self.response.rect.shrink(1.0);
            let ring = (2.0, theme::tokens(ui).sat);
            ui.painter().rect_stroke(rect, 0.0, ring, StrokeKind::Inside);
        }
    }

    /// Draws the row `key` as an option of the list with its background, which is `tint` if not
    /// selected. A click gives the list the focus.
    pub fn option(
        &self,
        ui: &Ui,
        rect: Rect,
        key: impl Hash + std::fmt::Debug,
        is_selected: bool,
        tint: Color32,
        spoken: impl Fn() -> String,
    ) -> Response {
        let response = ui.interact(rect, self.response.id.with(key), Sense::CLICK);
        response
            .widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_selected, spoken()));
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_selected(is_selected));
        if is_selected && self.response.has_focus() {
            let option = response.id.accesskit_id();
            let list = self.response.id;
            ui.ctx().accesskit_node_builder(list, |node| node.set_active_descendant(option));
        }
        fill_ground(ui, rect, is_selected, response.hovered(), tint);
        paint_divider(ui, rect);
        if is_selected {
            paint_stripe(ui, rect);
        }
        if response.clicked() {
            self.response.request_focus();
        }
        response
    }
}

fn fill_ground(ui: &Ui, rect: Rect, is_selected: bool, is_hovered: bool, tint: Color32) {
    let t = theme::tokens(ui);
    let ground = match (is_selected, is_hovered) {
        (true, _) => t.bgsel,
        (false, true) => t.bg3,
        (false, false) => tint,
    };
    ui.painter().rect_filled(rect, 0.0, ground);
}

/// Paints the background of a row that is not an option of a list, with its stripe.
pub fn paint_ground(ui: &Ui, rect: Rect, is_selected: bool, is_hovered: bool) {
    fill_ground(ui, rect, is_selected, is_hovered, Color32::TRANSPARENT);
    if is_selected {
        paint_stripe(ui, rect);
    }
}

/// Paints the stripe at the left of a selected row.
pub fn paint_stripe(ui: &Ui, rect: Rect) {
    ui.painter().rect_filled(rect.with_max_x(rect.left() + STRIPE), 0.0, theme::tokens(ui).sat);
}

/// Paints the line below a row.
pub fn paint_divider(ui: &Ui, rect: Rect) {
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, theme::tokens(ui).line));
}
