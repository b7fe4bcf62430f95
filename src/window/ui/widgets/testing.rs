//! A headless window for the tests of the widgets.

use egui::{Ui, Vec2};
use egui_kittest::Harness;

use super::sentence::Span;
use crate::{model::ThemeName, ui::theme};

/// Returns a window of `size` with the fonts and colours of Azel.
pub(crate) fn window<'a, State: 'a>(
    size: impl Into<Vec2>,
    state: State,
    show: impl FnMut(&mut Ui, &mut State) + 'a,
) -> Harness<'a, State> {
    Harness::builder()
        .with_size(size)
        .with_context_setup(|ctx| theme::install(ctx, ThemeName::Dark))
        .build_ui_state(show, state)
}

pub(crate) const fn plain(text: &str) -> Span<'_> {
    Span { text, bold: false }
}

pub(crate) const fn bold(text: &str) -> Span<'_> {
    Span { text, bold: true }
}
