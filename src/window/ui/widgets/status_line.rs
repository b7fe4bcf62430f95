//! Sentences with a mark, and lines of name and value.

use egui::{Label, Response, RichText, Sense, Ui, vec2};

use super::paint;
use crate::ui::{
    icons::{self, Icon},
    text, theme,
};

/// Side of the mark before a sentence, points.
const MARK: f32 = 12.0;
const LINE: f32 = 16.0;

/// Tone of a sentence, which sets its mark and colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    Plain,
    /// A statement about the current activity.
    Now,
    Good,
    /// A statement that needs attention.
    Caution,
    Bad,
}

/// Shows a sentence after the mark of its tone. Colour alone is not enough, since a theme may have
/// only one hue.
pub fn line(ui: &mut Ui, tone: Tone, words: &str) {
    sentence(ui, tone, words);
}

/// Shows a [`line()`] with a tool-tip.
pub fn line_with_tip(ui: &mut Ui, tone: Tone, words: &str, tip: &str) {
    sentence(ui, tone, words).on_hover_text(tip);
}

fn sentence(ui: &mut Ui, tone: Tone, words: &str) -> Response {
    let t = theme::tokens(ui);
    let (mark, colour) = match tone {
        Tone::Plain => (None, t.t2),
        Tone::Now => (Some((Icon::ChevronRight, t.sat)), t.t1),
        Tone::Good => (Some((Icon::Check, t.ok)), t.t1),
        Tone::Caution => (Some((Icon::Warning, t.warn)), t.warn),
        Tone::Bad => (Some((Icon::Cross, t.bad)), t.bad),
    };
    ui.horizontal_top(|ui| {
        let (place, _) = ui.allocate_exact_size(vec2(MARK, LINE), Sense::hover());
        if let Some((icon, colour)) = mark {
            icons::paint(ui.painter(), paint::square(place.center(), MARK), icon, colour);
        }
        let words = RichText::new(words).font(text::body()).color(colour);
        ui.add(Label::new(words).wrap())
    })
    .inner
}

/// Shows a name and its value, in a font that makes single letters distinct.
pub fn fact(ui: &mut Ui, name: &str, value: &str) {
    let t = theme::tokens(ui);
    ui.scope(|ui| {
        // By default a row is as high as a button.
        ui.spacing_mut().interact_size.y = LINE;
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new(name).font(text::small()).color(t.t3));
            ui.add(Label::new(RichText::new(value).font(text::raw()).color(t.t1)).wrap());
        });
    });
}
