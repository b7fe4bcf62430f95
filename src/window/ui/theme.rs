//! Installation of the colours and the fonts in egui.

use egui::{Context, CornerRadius, Id, Stroke, TextStyle};

use super::{
    keys::digits::DigitKeys, lean_shapes::LeanShapes, reading_order::ReadingOrder, text,
    tokens::Tokens,
};
use crate::model::ThemeName;

/// Returns the current colours.
pub fn tokens(ctx: &Context) -> &'static Tokens {
    name(ctx).tokens()
}

/// Returns the name of the current theme.
pub fn name(ctx: &Context) -> ThemeName {
    ctx.data(|data| data.get_temp(Id::unique("azel theme"))).unwrap_or_default()
}

/// Installs fonts, text styles, the theme and the egui plugins. The plugins rewrite shapes, sort
/// the accessibility tree and handle digit keys. Call this function once, when the window opens.
pub fn install(ctx: &Context, theme: ThemeName) {
    ctx.set_fonts(text::definitions());
    ctx.add_plugin(LeanShapes);
    ctx.add_plugin(ReadingOrder);
    ctx.add_plugin(DigitKeys);
    // The scale is a setting, and the zoom keys of egui would change it without saving.
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
    set(ctx, theme);
}

/// Changes the theme within one frame; sizes keep their values.
pub fn set(ctx: &Context, theme: ThemeName) {
    ctx.data_mut(|data| data.insert_temp(Id::unique("azel theme"), theme));
    let egui_theme = match theme {
        ThemeName::Light => egui::Theme::Light,
        ThemeName::Dark | ThemeName::Night => egui::Theme::Dark,
    };
    ctx.set_theme(egui_theme);
    ctx.style_mut_of(egui_theme, |style| apply(style, theme.tokens()));
}

fn apply(style: &mut egui::Style, t: &Tokens) {
    style.text_styles = [
        (TextStyle::Heading, text::title()),
        (TextStyle::Body, text::body()),
        (TextStyle::Button, text::body_medium()),
        (TextStyle::Small, text::small()),
        (TextStyle::Monospace, text::raw()),
    ]
    .into();
    style.animation_time = 0.0;
    style.spacing.item_spacing = egui::vec2(8.0, 8.0);
    style.spacing.button_padding = egui::vec2(12.0, 4.0);
    style.spacing.interact_size = egui::vec2(32.0, 24.0);

    // Content fades at a cut edge of a scroll area, so that the operator sees that it continues.
    let scroll = &mut style.spacing.scroll;
    scroll.dormant_handle_opacity = 0.5;
    scroll.floating_width = 4.0;
    scroll.bar_width = 8.0;
    scroll.fade.strength = 0.9;

    let visuals = &mut style.visuals;
    visuals.panel_fill = t.bg1;
    visuals.window_fill = t.bg2;
    visuals.window_stroke = Stroke::new(1.0, t.edge);
    visuals.extreme_bg_color = t.field;
    visuals.faint_bg_color = t.bg2;
    visuals.hyperlink_color = t.sat;
    visuals.warn_fg_color = t.warn;
    visuals.error_fg_color = t.bad;
    visuals.selection.bg_fill = t.bgsel;
    visuals.selection.stroke = Stroke::new(1.0, t.sat);
    visuals.window_shadow = egui::Shadow::NONE;
    visuals.popup_shadow = egui::Shadow::NONE;
    visuals.text_cursor.blink = false;
    visuals.override_text_color = Some(t.t1);
    // The weak colour is for hints in empty fields.
    visuals.weak_text_color = Some(t.t3);
    let widgets = &mut visuals.widgets;
    for widget in [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        widget.bg_fill = t.bg3;
        widget.weak_bg_fill = t.bg3;
        widget.bg_stroke = Stroke::new(1.0, t.edge);
        widget.fg_stroke = Stroke::new(1.0, t.t1);
        widget.corner_radius = CornerRadius::same(5);
        widget.expansion = 0.0;
    }
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, t.line);
    widgets.hovered.bg_stroke = Stroke::new(1.0, t.t2);
    widgets.active.bg_stroke = Stroke::new(1.0, t.sat);
}
