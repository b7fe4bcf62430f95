//! Details of the selected line: its values by their number in the make's document,
//! and its bytes.

use egui::{Rect, RichText, ScrollArea, Ui, UiBuilder, pos2, vec2};
use jiff::Timestamp;

use super::{ConsoleState, PADDING};
use crate::{
    device::{Direction, Explained, ExplainedValue, Finding, panel::Tone},
    model::{ConsoleLine, Model},
    ui::{
        format, text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            inspector, paint,
        },
        words,
    },
};

const ROW: f32 = 22.0;
const NUMBER: f32 = 24.0;
/// Bytes per line of the dump.
const BYTES: usize = 8;

/// Draws the panel; a drawer gets a close button.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    state: &mut ConsoleState,
    is_drawer: bool,
) {
    inspector::show_ground(ui, rect);
    let inner = rect.shrink(PADDING);
    if is_drawer {
        let close = Button::quiet("Close");
        let width = close.width(ui);
        let min = pos2(inner.right() - width, inner.top());
        let place = Rect::from_min_size(min, vec2(width, SMALL_HEIGHT));
        if close.show(ui, "close details", place).clicked() {
            state.inspector_is_open = false;
        }
    }
    let Some(line) = state.selected() else {
        let words = "Click a line to see its values and its bytes.";
        return inspector::show_nothing(ui, rect, "No line selected", words);
    };
    let builder = UiBuilder::new().id_salt("inspector").max_rect(inner);
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(rect.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing.y = 4.0;
        details(ui, line, explained(model, line).as_ref(), model.now);
    });
}

fn details(ui: &mut Ui, line: &ConsoleLine, explained: Option<&Explained>, now: Timestamp) {
    let t = theme::tokens(ui);
    ui.label(RichText::new(title(line, explained)).font(text::value()));
    let small = |words: String| RichText::new(words).font(text::small());
    ui.label(small(when(line, now)).color(t.t2));
    let colour = match line.meaning.tone {
        Tone::Bad => t.bad,
        Tone::Caution => t.warn,
        Tone::Good => t.ok,
        Tone::Plain | Tone::Change => t.t1,
    };
    ui.label(RichText::new(format!("{}.", line.meaning.text)).font(text::body()).color(colour));
    ScrollArea::vertical().id_salt("details").auto_shrink(false).show(ui, |ui| {
        let values = explained.map_or(&[][..], |explained| &explained.values);
        if !values.is_empty() {
            ui.add_space(8.0);
            ui.label(small(format!("Values, {}", values.len())).color(t.t3));
            ui.spacing_mut().item_spacing.y = 0.0;
            for value in values {
                show_value(ui, value);
            }
            ui.spacing_mut().item_spacing.y = 4.0;
        }
        if line.wire().length > 0 {
            ui.add_space(8.0);
            bytes(ui, line);
        }
    });
}

/// Explains the line with the rules of its antenna's make.
fn explained(model: &Model, line: &ConsoleLine) -> Option<Explained> {
    let antenna = model.antennas.iter().find(|antenna| *antenna.config.name == *line.antenna);
    let explain = antenna.and_then(|antenna| antenna.spec().explain);
    explain.map(|explain| explain(line.wire()))
}

fn title(line: &ConsoleLine, explained: Option<&Explained>) -> String {
    let kind = match (line.wire().finding, line.wire().direction) {
        (Finding::NoReply { .. }, _) => return "No reply".to_owned(),
        (_, Direction::Sent) => "request",
        (_, Direction::Received) => "reply",
    };
    match explained {
        Some(Explained { name: Some(name), .. }) => format!("{name} {kind}"),
        None if line.wire().finding.is_good() => words::capitalised(kind),
        _ => "Unknown frame".to_owned(),
    }
}

fn when(line: &ConsoleLine, now: Timestamp) -> String {
    let after = line.round_trip().map(|after| format!(", {after} after the request"));
    format!(
        "{}, {}Z{}",
        line.antenna,
        format::millisecond(line.wire().time, now),
        after.unwrap_or_default()
    )
}

fn show_value(ui: &mut Ui, value: &ExplainedValue) {
    let t = theme::tokens(ui);
    let size = vec2(ui.available_width(), ROW);
    let (row, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let shown = match value.stands_for {
        "" => format!("{}{}", value.raw, value.unit),
        word => format!("{} ({word})", value.raw),
    };
    let left = egui::Align2::LEFT_CENTER;
    let number = value.number.to_string();
    paint::text_in(ui, row.with_max_x(row.left() + NUMBER), left, &number, text::small(), t.t3);
    let room = row.with_min_x(row.left() + NUMBER).with_max_x(row.right() - 6.0);
    let name = paint::text_in(ui, room, left, value.name, text::small(), t.t2);
    let room = room.with_min_x(name.right() + 8.0);
    let right = egui::Align2::RIGHT_CENTER;
    paint::text_in(ui, room, right, &shown, text::small(), t.t1);
    let words = format!("{number} {}: {shown}", value.name);
    let named = paint::name_text(ui, ("value", value.number), row, &words);
    if !paint::fits(ui, &shown, text::small(), room) {
        named.on_hover_text(&words);
    }
}

fn bytes(ui: &mut Ui, line: &ConsoleLine) {
    let t = theme::tokens(ui);
    let wire = line.wire();
    let length = format::number(wire.length as f64, 0);
    let sum = match wire.finding {
        Finding::Good if wire.is_shortened => "",
        Finding::Good => ", checksum good",
        Finding::BadChecksum { .. } => ", checksum wrong",
        _ => "",
    };
    let small = |words: String| RichText::new(words).font(text::small());
    ui.label(small(format!("Bytes, {length}{sum}")).color(t.t3));
    if wire.is_shortened {
        let words =
            "Some bytes are not kept: they may hold the FTP password, or there are too many.";
        ui.label(small(words.to_owned()).color(t.warn));
        ui.label(RichText::new(&line.raw).font(text::raw()).color(t.t2));
        return;
    }
    for (place, bytes) in wire.bytes.chunks(BYTES).enumerate() {
        let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
        let dot = |byte: &u8| if (0x20..0x7f).contains(byte) { char::from(*byte) } else { '.' };
        let printed: String = bytes.iter().map(dot).collect();
        let words = format!("{:04X} {:<23}  {printed}", place * BYTES, hex.join(" "));
        ui.label(RichText::new(words).font(text::raw()).color(t.t2));
    }
}
