//! The chips of the antennas, and one chip for all antennas without room.

use egui::{Align2, Popup, Rect, Response, Role, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::{
    model::UiCommand,
    ui::{
        icons,
        text::{self, Weight},
        theme,
        widgets::{
            link_chip::{self, ChipForm, ChipModel, LinkGlyph, TWO_LINES_WIDTH},
            menu, paint,
        },
    },
};

const MORE_WIDTH: f32 = 56.0;
/// Additional width of that chip for the word of an alarm, points.
const ALARM_WIDTH: f32 = 38.0;
/// Max number of chips with details; more chips show only glyph and name.
const FULL_CHIPS: usize = 4;

/// Shows the chips at the right end of `rect`. Returns their left end.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    chips: &[ChipModel<'_>],
    wide: bool,
    commands: &mut Vec<UiCommand>,
) -> f32 {
    let gap = if wide { 8.0 } else { 6.0 };
    let form = match (chips.len() > FULL_CHIPS, wide) {
        (true, _) => ChipForm::Name,
        (false, true) => ChipForm::TwoLines,
        (false, false) => ChipForm::OneLine,
    };
    let widths: Vec<f32> = chips.iter().map(|chip| chip.width(ui, form)).collect();
    // The chip reserves room for an alarm of any antenna, shown or hidden.
    let any_alarm = chips.iter().any(|chip| chip.alarm.is_some());
    let more_width = if any_alarm { MORE_WIDTH + ALARM_WIDTH } else { MORE_WIDTH };
    let shown = how_many_fit(&widths, gap, rect.width(), more_width);
    let hidden = chips.get(shown..).unwrap_or_default();
    let more = if hidden.is_empty() { 0.0 } else { more_width + gap };
    let used: f32 = widths.iter().take(shown).map(|width| width + gap).sum::<f32>() + more - gap;
    let start = rect.right() - used.max(0.0);
    let mut x = start;
    for (index, (chip, width)) in chips.iter().zip(&widths).take(shown).enumerate() {
        let place = Rect::from_min_size(pos2(x, rect.top()), vec2(*width, rect.height()));
        if link_chip::show(ui, place, chip, form).clicked() {
            commands.push(UiCommand::SelectAntenna(index));
        }
        x += width + gap;
    }
    if !hidden.is_empty() {
        let place = Rect::from_min_size(pos2(x, rect.top()), vec2(more_width, rect.height()));
        let response = more_chip(ui, place, hidden);
        menu::show(
            &response,
            Popup::menu(&response).width(TWO_LINES_WIDTH).accessible_name("More antennas"),
            |ui| {
                for (index, chip) in hidden.iter().enumerate() {
                    let (place, _) =
                        ui.allocate_exact_size(vec2(TWO_LINES_WIDTH, 40.0), egui::Sense::hover());
                    if link_chip::show(ui, place, chip, ChipForm::TwoLines).clicked() {
                        commands.push(UiCommand::SelectAntenna(shown + index));
                        ui.close();
                    }
                }
            },
        );
    }
    start
}

/// Returns the number of chips that fit. If not all fit, the chip for the others takes the width
/// `more`.
fn how_many_fit(widths: &[f32], gap: f32, room: f32, more: f32) -> usize {
    let all: f32 = widths.iter().map(|width| width + gap).sum::<f32>() - gap;
    if all <= room {
        return widths.len();
    }
    let mut left = room - more;
    widths
        .iter()
        .take_while(|width| {
            left -= *width + gap;
            left >= 0.0
        })
        .count()
}

/// Shows the chip that represents the hidden chips and has their worst state.
fn more_chip(ui: &Ui, rect: Rect, hidden: &[ChipModel<'_>]) -> Response {
    let t = theme::tokens(ui);
    let worst = hidden.iter().map(|chip| chip.link).max_by_key(|link| badness(*link));
    let worst = worst.unwrap_or_default();
    let in_alarm = hidden.iter().filter(|chip| chip.alarm.is_some()).count();
    let alarms = if in_alarm > 0 { format!(", {in_alarm} in alarm") } else { String::new() };
    let name =
        format!("{} more antennas{alarms}, the worst link is {}", hidden.len(), worst.word());
    let response = paint::control(ui, "more chips", rect, Role::Button, true, &name);
    let selected = hidden.iter().any(|chip| chip.selected);
    let border = match (selected, in_alarm) {
        (true, _) => t.sat,
        (false, 0) => t.line,
        (false, _) => t.bad,
    };
    let border = Stroke::new(1.0, border);
    ui.painter().rect(rect, 6.0, t.bg2, border, StrokeKind::Inside);
    let (icon, colour) = worst.look(t);
    let glyph = paint::square(pos2(rect.left() + 16.0, rect.center().y), 13.0);
    icons::paint(ui.painter(), glyph, icon, colour);
    let position = pos2(rect.left() + 28.0, rect.center().y);
    let font = text::sized(13.0, Weight::SemiBold);
    let count = format!("+{}", hidden.len());
    let count = paint::text(ui, position, Align2::LEFT_CENTER, count, font.clone(), t.t1);
    if in_alarm > 0 {
        let room = rect.with_min_x(count.right() + 6.0).with_max_x(rect.right() - 4.0);
        paint::text_in(ui, room, Align2::LEFT_CENTER, link_chip::ALARM, font, t.bad);
    }
    paint::focus_ring(ui, &response, 6);
    response
}

fn badness(link: LinkGlyph) -> u8 {
    match link {
        LinkGlyph::Live => 0,
        LinkGlyph::Off => 1,
        LinkGlyph::Late => 2,
        LinkGlyph::Silent => 3,
        LinkGlyph::Lost => 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_room_goes_into_the_last_chip() {
        assert_eq!(how_many_fit(&[100.0, 100.0], 8.0, 208.0, MORE_WIDTH), 2);
        assert_eq!(how_many_fit(&[100.0, 100.0, 100.0], 8.0, 280.0, MORE_WIDTH), 2);
        assert_eq!(how_many_fit(&[100.0, 100.0, 100.0], 8.0, 260.0, MORE_WIDTH), 1);
        assert_eq!(how_many_fit(&[], 8.0, 0.0, MORE_WIDTH), 0);
    }
}
