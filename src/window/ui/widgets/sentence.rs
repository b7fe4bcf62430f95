//! The state sentence: the activity of an antenna, its reason, and the next step.

use egui::{
    Color32, CornerRadius, Pos2, Rect, Role, Sense, Ui, WidgetInfo,
    accesskit::Live,
    pos2,
    text::{LayoutJob, TextFormat},
    vec2,
};

use super::copy_menu;
use crate::ui::{
    text::{self, Weight},
    theme,
    tokens::Tokens,
};

const RADIUS: u8 = 6;
const BAR: f32 = 3.0;
const LINE: f32 = 20.0;
/// Line height of a sentence that does not fit at the default height, points.
const DENSE_LINE: f32 = 16.0;
/// Height reserved for the sentence, points: four lines, or six dense ones. The controls below then
/// do not move under the operator's hand when the sentence changes.
const ROOM: f32 = 96.0;
/// [`ROOM`] in a small window, points: four lines, or five dense ones.
const SMALL_ROOM: f32 = 80.0;
/// Width below which the block belongs to a small window, points.
const SMALL: f32 = 300.0;

/// Kind of the sentence, which sets the colour of the bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SentenceKind {
    /// Tracking within the beam.
    Tracking,
    /// Moving or waiting on command.
    Commanded,
    /// Holding, or state unknown.
    #[default]
    Holding,
    /// Outside the beam, or late.
    Caution,
    /// Stopped by a fault, a limit or the link.
    Fault,
}

impl SentenceKind {
    fn colour(self, t: &Tokens) -> Color32 {
        match self {
            Self::Tracking => t.ok,
            Self::Commanded => t.cmd,
            Self::Holding => t.edge,
            Self::Caution => t.warn,
            Self::Fault => t.bad,
        }
    }
}

/// A part of a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span<'a> {
    /// Words, with the spaces around them.
    pub text: &'a str,
    /// `true` for a name that must stand out.
    pub bold: bool,
}

#[derive(Debug, Clone, Copy, Default)]
pub struct Sentence<'a> {
    pub kind: SentenceKind,
    pub spans: &'a [Span<'a>],
}

impl Sentence<'_> {
    /// Returns the words without their weights.
    pub fn plain_text(&self) -> String {
        self.spans.iter().map(|span| span.text).collect()
    }
}

/// Shows the sentence at `position`, wrapped at `width`, with `foot` points of room below it.
/// Returns the rectangle of the block. Screen readers read the sentence again when it changes.
pub fn show(ui: &Ui, position: Pos2, width: f32, foot: f32, sentence: &Sentence<'_>) -> Rect {
    let room = if width < SMALL { SMALL_ROOM } else { ROOM };
    show_in(ui, position, width, (room, foot), sentence)
}

/// Shows the sentence where controls below may move: as high as two lines, or higher.
pub fn show_short(ui: &Ui, position: Pos2, width: f32, sentence: &Sentence<'_>) -> Rect {
    show_in(ui, position, width, (2.0 * LINE, 0.0), sentence)
}

fn show_in(
    ui: &Ui,
    position: Pos2,
    width: f32,
    (room, foot): (f32, f32),
    sentence: &Sentence<'_>,
) -> Rect {
    let t = theme::tokens(ui);
    let padding = if width < SMALL { vec2(13.0, 6.0) } else { vec2(15.0, 10.0) };
    let lines = |line: f32| {
        let mut job = LayoutJob::default();
        job.wrap.max_width = width - padding.x - 10.0;
        for span in sentence.spans {
            let weight = if span.bold { Weight::SemiBold } else { Weight::Regular };
            let mut format = TextFormat::simple(text::sized(13.0, weight), t.t1);
            format.line_height = Some(line);
            job.append(span.text, 0.0, format);
        }
        ui.painter().layout_job(job)
    };
    let mut galley = lines(LINE);
    if galley.size().y + foot > room {
        galley = lines(DENSE_LINE);
    }
    let height = (galley.size().y + foot).max(room);
    let rect = Rect::from_min_size(position, vec2(width, height + 2.0 * padding.y));
    ui.painter().rect_filled(rect, RADIUS, t.bg2);
    let bar = Rect::from_min_max(rect.min, pos2(rect.left() + BAR, rect.bottom()));
    let radius = CornerRadius { nw: 3, sw: 3, ne: 0, se: 0 };
    ui.painter().rect_filled(bar, radius, sentence.kind.colour(t));
    ui.painter().galley(position + padding, galley, t.t1);
    let response = ui.interact(rect, ui.make_persistent_id("sentence"), Sense::CLICK);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, sentence.plain_text()));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_live(Live::Polite));
    copy_menu::offer(ui, &response, "this sentence", || sentence.plain_text());
    rect
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing::{self, bold, plain};
    use egui_kittest::kittest::{NodeT as _, Queryable as _};

    #[test]
    fn sentences_of_one_and_of_six_lines_take_the_same_room() {
        let long = "The antenna holds. ".repeat(11);
        let heights = vec![0.0; 2];
        let window = testing::window([400.0, 300.0], heights, move |ui, heights| {
            for (height, words) in heights.iter_mut().zip(["It holds.", long.as_str()]) {
                let sentence = Sentence { kind: SentenceKind::Holding, spans: &[plain(words)] };
                ui.push_id(words, |ui| {
                    *height = show(ui, pos2(10.0, 10.0), 312.0, 0.0, &sentence).height();
                });
            }
        });
        let heights = window.state();
        assert!((heights[0] - heights[1]).abs() < 0.01, "{heights:?}");
    }

    #[test]
    fn the_sentence_is_one_live_region() {
        let window = testing::window([400.0, 200.0], (), |ui, ()| {
            let spans = [plain("Waiting at 205° for "), bold("SUOMI NPP"), plain(".")];
            let sentence = Sentence { kind: SentenceKind::Commanded, spans: &spans };
            show(ui, pos2(10.0, 10.0), 312.0, 0.0, &sentence);
        });
        let node = window.get_by_label("Waiting at 205° for SUOMI NPP.");
        assert_eq!(node.accesskit_node().live(), Live::Polite);
    }
}
