//! Conditions of a track: elements, commands to the antenna, and clocks.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::PADDING;
use crate::{
    contract::record::OpenedPass,
    model::{Model, UiCommand, View},
    ui::{
        text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
        words::flown_with::{Fact, FactKind, clock_first, facts},
    },
};

pub(super) const HEIGHT: f32 = 316.0;
const BAR: f32 = 32.0;
const LINE: f32 = 19.0;

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    opened: &OpenedPass,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
    let bar = rect.with_max_y(rect.top() + BAR);
    ui.painter().rect_filled(bar, 0.0, t.bg2);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let title = bar.with_min_x(inner.left());
    paint::text_in(
        ui,
        title,
        Align2::LEFT_CENTER,
        "Tracking conditions",
        text::small_strong(),
        t.t1,
    );
    if let Some(place) = model.place(opened.pass.antenna) {
        let button = Button::normal("Unit settings");
        let size = vec2(button.width(ui), SMALL_HEIGHT);
        let position = pos2(inner.right() - size.x, bar.center().y - size.y / 2.0);
        if button.show(ui, "recorded unit", Rect::from_min_size(position, size)).clicked() {
            commands.push(UiCommand::SelectAntenna(place));
            commands.push(UiCommand::Show(View::Antennas));
        }
    }
    let mut y = bar.bottom() + 8.0;
    for (index, Fact { name, value, kind }) in
        facts(&opened.pass.report, model.now).into_iter().enumerate()
    {
        let colour = match kind {
            FactKind::Plain => t.t1,
            FactKind::Caution => t.warn,
            FactKind::NotKnown => t.t2,
        };
        let line = Rect::from_min_size(pos2(inner.left(), y), vec2(inner.width(), LINE));
        paint::fact_in(ui, ("flown with", index), line, name, &value, colour);
        y += LINE;
    }
    let Some(words) = clock_first(&opened.pass.report) else { return };
    let width = inner.width() - 24.0;
    let galley = ui.painter().layout(words.to_owned(), text::small(), t.warn, width);
    let note = Rect::from_min_size(
        pos2(inner.left(), y + 6.0),
        vec2(inner.width(), galley.size().y + 16.0),
    );
    ui.painter().rect_filled(note, 4.0, t.warnbg);
    ui.painter().galley(note.min + vec2(12.0, 8.0), galley, t.warn);
    paint::name_text(ui, "clock note", note, words);
}
