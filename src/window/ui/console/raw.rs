//! The bytes of a line on the screen.

use egui::{
    Color32, FontFamily, FontId, Pos2, Rect, Ui,
    text::{LayoutJob, TextFormat, TextWrapping},
};

use crate::model::{Piece, pieces};
use crate::ui::{text, theme};

/// Font size for the names of unprintable bytes, points.
const CODE_POINTS: f32 = 10.0;

/// Shows one line of bytes in `rect`, cut with an ellipsis at its width.
pub(super) fn show(ui: &Ui, rect: Rect, bytes: &[u8], colour: Color32) {
    let mut job = job(ui, bytes, colour);
    job.wrap = TextWrapping::truncate_at_width(rect.width());
    let galley = ui.painter().layout_job(job);
    let position = Pos2::new(rect.left(), rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(position, galley, colour);
}

/// Lays out the text, with unprintable bytes as small tags.
fn job(ui: &Ui, bytes: &[u8], colour: Color32) -> LayoutJob {
    let t = theme::tokens(ui);
    let mut job = LayoutJob::default();
    for piece in pieces(bytes) {
        match piece {
            Piece::Text(words) => job.append(&words, 0.0, TextFormat::simple(text::raw(), colour)),
            Piece::Code(code) => {
                let font = FontId::new(CODE_POINTS, FontFamily::Monospace);
                let mut tag = TextFormat::simple(font, t.t2);
                tag.background = t.bg3;
                job.append(&code, 3.0, tag);
            }
        }
    }
    job
}
