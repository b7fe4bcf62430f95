//! Controls above the map.

use egui::{
    Align, Align2, Layout, Popup, PopupCloseBehavior, Rect, Response, Ui, UiBuilder, pos2, vec2,
};

use super::{MapLayers, MapState, PADDING, Shown, words};
use crate::{
    model::Model,
    ui::{
        icons::Icon,
        text, theme,
        widgets::{
            button::{self, Button, HEIGHT as BUTTON},
            check_box::{self, CheckBox},
            close_key, paint,
            segmented::{self, Segment},
        },
    },
};

/// Height of the bar, points.
pub(super) const HEIGHT: f32 = 56.0;
const GAP: f32 = 8.0;
/// Distance between two check boxes, points.
const BOX_GAP: f32 = 14.0;
/// Width of the title and the line below it, points.
const TITLE: f32 = 268.0;
const SEGMENTS: f32 = 172.0;
/// Min width of the title in a small window, points.
const SMALL_TITLE: f32 = 160.0;

/// Draws the controls. With `has_drawer`, a button opens the inspector.
pub(super) fn show(ui: &mut Ui, rect: Rect, model: &Model, has_drawer: bool, state: &mut MapState) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let layers = Button::normal("Layers").icon(Icon::Layers);
    let word = if state.inspector_is_open { "Close details" } else { "Details" };
    let details = Button::normal(word);
    let mut right = inner.right_center();
    let details_at =
        has_drawer.then(|| button::row_before(&mut right, BUTTON, [details.width(ui)]));
    let [layers_at] = button::row_before(&mut right, BUTTON, [layers.width(ui)]);
    let right = right.x;
    let boxes = boxes_width(ui);
    let has_boxes = inner.left() + TITLE + SEGMENTS + 2.0 * GAP + boxes <= right;
    let segments = if has_boxes { right - boxes - GAP } else { right };
    let segments = (segments - SEGMENTS).min(inner.left() + TITLE + GAP);
    let segments = segments.max(inner.left() + SMALL_TITLE);
    title(ui, inner.with_max_x(segments - GAP), model, state.shown);
    let place = Rect::from_center_size(
        pos2(segments + SEGMENTS / 2.0, rect.center().y),
        vec2(SEGMENTS, BUTTON),
    );
    scope(ui, place, &mut state.shown);
    if has_boxes {
        let room = rect.with_min_x(right - boxes).with_max_x(right);
        let layout = Layout::left_to_right(Align::Center);
        let builder = UiBuilder::new().id_salt("map layers").max_rect(room).layout(layout);
        ui.scope_builder(builder, |ui| {
            ui.spacing_mut().item_spacing.x = BOX_GAP;
            for (on, name) in first(&mut state.layers) {
                ui.add(CheckBox::new(on, name));
            }
        });
    }
    choose_layers(&layers.show(ui, "map layers", layers_at), state);
    if let Some([place]) = details_at
        && details.show(ui, "map details", place).clicked()
    {
        state.inspector_is_open = !state.inspector_is_open;
    }
}

fn title(ui: &Ui, rect: Rect, model: &Model, shown: Shown) {
    let t = theme::tokens(ui);
    let line = |y: f32| Rect::from_x_y_ranges(rect.x_range(), y - 12.0..=y + 12.0);
    let top = rect.top();
    paint::text_in(ui, line(top + 19.0), Align2::LEFT_CENTER, "Map", text::title(), t.t1);
    let words = words::summary(model, shown);
    let second = line(top + 40.0);
    paint::named_text_in(
        ui,
        "map summary",
        second,
        Align2::LEFT_CENTER,
        &words,
        text::small(),
        t.t2,
    );
}

fn scope(ui: &Ui, place: Rect, shown: &mut Shown) {
    let choices = [(Shown::Favourites, "Favourites"), (Shown::Tracked, "Tracked")];
    let segments = choices.map(|(choice, word)| {
        (word, if choice == *shown { Segment::Chosen } else { Segment::Free })
    });
    let clicked = segmented::show(ui, "map satellites", place, "Satellites on the map", &segments);
    if let Some((choice, _)) = clicked.and_then(|index| choices.get(index)) {
        *shown = *choice;
    }
}

/// Shows all layers in a list that the button or a key opens.
fn choose_layers(button: &Response, state: &mut MapState) {
    if std::mem::take(&mut state.layers_key) {
        Popup::toggle_id(&button.ctx, Popup::default_response_id(button));
    }
    Popup::from_toggle_button_response(button)
        .accessible_name("Layers of the map")
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            for (on, name) in first(&mut state.layers) {
                ui.add(CheckBox::new(on, name));
            }
            ui.add(CheckBox::new(&mut state.layers.other_tracks, "Tracks of the others"));
            ui.add(CheckBox::new(&mut state.layers.grid, "Grid"));
            close_key::show(ui);
        });
}

/// Returns the layers with their own check box in the bar.
fn first(layers: &mut MapLayers) -> [(&mut bool, &'static str); 4] {
    [
        (&mut layers.tracks, "Tracks"),
        (&mut layers.footprints, "Footprints"),
        (&mut layers.terminator, "Terminator"),
        (&mut layers.names, "Names"),
    ]
}

fn boxes_width(ui: &Ui) -> f32 {
    let words = first(&mut MapLayers::default()).map(|(_, word)| word);
    let width =
        |word: &&str| paint::text_width(ui, word, text::body_medium()) + check_box::WIDTH + BOX_GAP;
    words.iter().map(width).sum()
}
