//! Head and verdict of a report.

use egui::{Align2, Popup, Rect, Ui, pos2, vec2};
use jiff::Timestamp;

use super::{PADDING, list, lock};
use crate::{
    contract::record::RecordedPass,
    model::{
        Model, UiCommand,
        export::{Export, ReportFormat},
        replay::Stretch,
    },
    ui::{
        format, replay, text, theme,
        widgets::{
            button::{Button, HEIGHT as BUTTON},
            menu, paint,
        },
        words::record as words,
    },
};

pub(super) const HEAD: f32 = 56.0;
/// Padding around the sentence in its box, points.
const INSET: f32 = 12.0;
const FORMATS: [(ReportFormat, &str); 3] = [
    (ReportFormat::Html, "Page to print (HTML)"),
    (ReportFormat::Csv, "Points (CSV)"),
    (ReportFormat::Json, "Report (JSON)"),
];

pub(super) fn head(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    pass: &RecordedPass,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let button = Button::normal("Export report").chevron().locked_by(replay::lock(model));
    let size = vec2(button.width(ui), BUTTON);
    let area =
        Rect::from_min_size(pos2(inner.right() - size.x, rect.center().y - BUTTON / 2.0), size);
    let response = button.show(ui, "export report", area);
    menu::show(&response, Popup::menu(&response).accessible_name("Export report"), |ui| {
        for (format, word) in FORMATS {
            if ui.button(word).clicked() {
                commands.push(UiCommand::Save(Export::Report { format }));
            }
        }
    });
    let button = Button::primary("Replay").locked_by(lock(model));
    let size = vec2(button.width(ui), BUTTON);
    let area =
        Rect::from_min_size(pos2(area.left() - 8.0 - size.x, rect.center().y - BUTTON / 2.0), size);
    if button.show(ui, "replay", area).clicked() {
        commands.push(replay_of(pass, None));
    }
    let room = inner.with_max_x(area.left() - PADDING);
    let line = |y: f32| {
        Rect::from_x_y_ranges(room.x_range(), rect.top() + y - 12.0..=rect.top() + y + 12.0)
    };
    let left = Align2::LEFT_CENTER;
    let report = &pass.report;
    let name = report.elements.name();
    let author = format!(
        "{}, {}, {}",
        report.elements.catalog_number(),
        pass.antenna_name,
        words::tracked_by(report.track.tracked_by)
    );
    let drawn = paint::text_in(ui, line(19.0), left, name, text::title(), t.t1);
    let bounds = line(20.0).with_min_x(drawn.right() + 8.0);
    paint::text_in(ui, bounds, left, &author, text::small(), t.t2);
    let when = format!(
        "{}, {}, max {}",
        format::stretch(report.start, report.end, model.now),
        format::duration(report.report.counted_s),
        format::degrees(report.max_elevation_deg, 1)
    );
    paint::text_in(ui, line(40.0), left, &when, text::small(), t.t2);
    paint::name_text(ui, "report head", room, &format!("{name}, {author}, {when}"));
}

/// Returns the command that replays the pass, from `time` or from shortly before its track.
pub(super) fn replay_of(pass: &RecordedPass, time: Option<Timestamp>) -> UiCommand {
    let stretch = Stretch::new(pass);
    let time = time.unwrap_or(stretch.start);
    UiCommand::BeginReplay(stretch, time)
}

pub(super) fn verdict_height(ui: &Ui, width: f32, model: &Model, pass: &RecordedPass) -> f32 {
    let words = words::verdict_sentence(&pass.report, model.now);
    let room = width - 2.0 * PADDING - 2.0 * INSET;
    let galley = ui.painter().layout(words, text::body(), theme::tokens(ui).t1, room);
    galley.size().y + 4.0 * INSET
}

pub(super) fn verdict(ui: &Ui, rect: Rect, model: &Model, pass: &RecordedPass) {
    let t = theme::tokens(ui);
    let card = rect.shrink2(vec2(PADDING, INSET));
    ui.painter().rect_filled(card, 4.0, t.bg2);
    let (_, colour) = list::mark(pass.report.report.verdict, t);
    ui.painter().rect_filled(card.with_max_x(card.left() + 3.0), 1.0, colour);
    let words = words::verdict_sentence(&pass.report, model.now);
    let position = card.min + vec2(INSET + 2.0, INSET);
    let place =
        paint::paragraph(ui, position, card.width() - 2.0 * INSET, &words, text::body(), t.t1);
    paint::name_text(ui, "verdict", place, &words);
}
