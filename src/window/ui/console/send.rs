//! Line for sending questions. It shows the finished frame before it sends anything, and sends only
//! questions.

use egui::{
    Align, Align2, Color32, Key, Layout, Modifiers, Rect, RichText, Role, Sense, TextEdit, Ui,
    UiBuilder, WidgetInfo, pos2, vec2,
};

use super::{PADDING, entry::Entry, raw};
use crate::{
    contract::{antenna::AntennaModel, driver},
    device::Question,
    model::{Model, UiCommand},
    ui::{
        bar::glyph,
        icons::{self, Icon},
        replay, text, theme,
        widgets::{
            button::{Button, HEIGHT as BUTTON},
            drop_down::DropDown,
            paint,
        },
    },
};

/// Height of the line with the note below it, points.
pub(super) const HEIGHT: f32 = 88.0;
/// Hint where the operator changes settings and moves antennas.
const ELSEWHERE: &str = "Change settings in Antennas; move antennas in Operate.";
const GAP: f32 = 8.0;
const ANTENNA: f32 = 112.0;
const PICK: f32 = 96.0;
const SEND: f32 = 72.0;
const FRAME: f32 = 240.0;

/// Draws the line for the selected antenna.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    entry: &mut Entry,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 12.0));
    let (line, below) = inner.split_top_bottom_at_y(inner.top() + BUTTON);
    antenna(ui, line.with_max_x(line.left() + ANTENNA), model);
    let send = line.with_min_x(line.right() - SEND);
    let frame = line.with_min_x(send.left() - GAP - FRAME).with_max_x(send.left() - GAP);
    let field = line.with_min_x(line.left() + ANTENNA + GAP).with_max_x(frame.left() - GAP);
    let questions = model.antenna().map_or(&[][..], |one| &one.snapshot.state.questions);
    let is_entered = fields(ui, field, questions, entry);

    let read = model.antenna().and_then(|antenna| read(antenna, &entry.text));
    let link = model.antenna().is_some_and(|antenna| antenna.snapshot.link.is_open());
    let ready = match &read {
        Some(Ok(question)) if link && model.replay.is_none() => Some(*question),
        _ => None,
    };
    if let Some(Ok(question)) = &read {
        finished(ui, frame, question);
    }
    let (icon, words, colour) = match (&read, ready) {
        _ if model.replay.is_some() => {
            let name = model.antenna().map_or("the antennas", |antenna| &antenna.config.name);
            (Icon::Lock, replay::locked(name), t.t2)
        }
        (Some(Err(reason)), _) => (Icon::Lock, format!("Not sent. {reason}"), t.warn),
        (_, Some(question)) => {
            (Icon::Check, format!("{}. The answer will appear in the log.", question.subject), t.t2)
        }
        (None, _) => {
            let sentence =
                questions.first().map_or_else(String::new, |one| format!(", such as {},", one.key));
            let words = format!("Queries{sentence} can be sent. {ELSEWHERE}");
            (Icon::Info, words, t.t2)
        }
        (Some(Ok(_)), None) => (Icon::Lock, "Not sent. There is no link.".to_owned(), t.warn),
    };
    say(ui, below, icon, &words, colour);

    let button = Button::primary("Send").locked(ready.is_none());
    let is_clicked = button.show(ui, "send query", send).clicked();
    if let Some(question) = ready.filter(|_| is_clicked || is_entered) {
        let command = driver::Command::Ask(question.key.clone());
        entry.sent();
        commands.extend(
            model.antenna().map(|model_antenna| UiCommand::antenna(model_antenna.id(), command)),
        );
    }
}

/// Parses the typed question, in any case and with or without the question sign. An error gives the
/// reason why the input is no question. Returns `None` without input.
fn read<'a>(antenna: &'a AntennaModel, typed: &str) -> Option<Result<&'a Question, String>> {
    let text = typed.trim().to_uppercase();
    if text.is_empty() {
        return None;
    }
    let mut questions = antenna.snapshot.state.questions.iter();
    let found = questions.find(|question| bare(&question.key) == bare(&text));
    Some(found.ok_or_else(|| match antenna.spec().why_no_question {
        Some(refuse) => refuse(&text),
        None => "The unit does not answer this query: pick one from the list.".to_owned(),
    }))
}

/// Returns the text without the question sign.
fn bare(text: &str) -> &str {
    text.strip_suffix('?').unwrap_or(text).trim_end()
}

/// Shows the note below the line.
fn say(ui: &Ui, below: Rect, icon: Icon, words: &str, colour: Color32) {
    let position = pos2(below.left() + 7.0, below.bottom() - 10.0);
    icons::paint(ui.painter(), paint::square(position, 14.0), icon, colour);
    let room = below.with_min_x(below.left() + 22.0).with_min_y(below.bottom() - 20.0);
    paint::text_in(ui, room, Align2::LEFT_CENTER, words, text::small(), colour);
    paint::name_text(ui, "send line", room, words);
}

/// Shows the selected antenna, which receives the question.
fn antenna(ui: &Ui, rect: Rect, model: &Model) {
    let t = theme::tokens(ui);
    let Some(antenna) = model.antenna() else {
        paint::text_in(ui, rect, Align2::LEFT_CENTER, "No antenna", text::body(), t.t3);
        return;
    };
    let link = glyph(model, antenna);
    let (icon, colour) = link.look(t);
    let position = pos2(rect.left() + 7.0, rect.center().y);
    icons::paint(ui.painter(), paint::square(position, 14.0), icon, colour);
    let name = &antenna.config.name;
    let room = rect.with_min_x(rect.left() + 22.0);
    paint::text_in(ui, room, Align2::LEFT_CENTER, name, text::body_medium(), t.t1);
    let words = format!("Asks {name}, link {}", link.word());
    paint::name_text(ui, "asked antenna", rect, &words).on_hover_text(words);
}

/// Shows the list of questions and the field, where Up and Down recall earlier questions. Returns
/// `true` when the operator presses Enter in the field.
fn fields(ui: &mut Ui, rect: Rect, questions: &[Question], entry: &mut Entry) -> bool {
    let t = theme::tokens(ui);
    let layout = Layout::left_to_right(Align::Center);
    let builder = UiBuilder::new().id_salt("send fields").max_rect(rect).layout(layout);
    let shown = ui.scope_builder(builder, |ui| {
        let button = Button::normal("Query");
        let queries = DropDown { button, salt: "queries", name: "Pick a query" };
        let (place, _) = ui.allocate_exact_size(vec2(PICK, BUTTON), Sense::hover());
        queries.show(ui, place, |ui| {
            for Question { key, subject: description, .. } in questions {
                let words = RichText::new(format!("{key}  {description}")).font(text::small());
                if ui.selectable_label(false, words).clicked() {
                    entry.text = key.to_string();
                }
            }
        });
        let hint = questions.first().map_or("", |one| one.key.as_str());
        let hint = RichText::new(hint).color(t.t3);
        let id = ui.scope_id().with("send");
        let mut is_entered = false;
        if ui.memory(|memory| memory.has_focus(id)) {
            let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
            if pressed(Key::ArrowUp) {
                entry.older();
            }
            if pressed(Key::ArrowDown) {
                entry.newer();
            }
            is_entered = pressed(Key::Enter);
        }
        // Enter keeps the focus in the field, for the next question.
        let edit = TextEdit::singleline(&mut entry.text).id(id).return_key(None);
        let edit = edit.font(text::raw()).hint_text(hint);
        let edit = ui.add(edit.desired_width(ui.available_width() - GAP));
        edit.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Query to send"));
        is_entered
    });
    shown.inner
}

/// Shows the frame that the button sends.
fn finished(ui: &Ui, rect: Rect, question: &Question) {
    let t = theme::tokens(ui);
    let word = paint::text_in(ui, rect, Align2::LEFT_CENTER, "sends", text::small(), t.t3);
    raw::show(ui, rect.with_min_x(word.right() + 6.0), &question.bytes, t.sat);
    let text = String::from_utf8_lossy(&question.bytes);
    paint::name_text(ui, "frame", rect, &format!("sends {}", text.trim_end()));
}
