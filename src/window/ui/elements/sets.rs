//! Held sets of the selected object, each compared with the set in use.

use egui::{Align2, Color32, Rect, Response, Role, Sense, Ui, WidgetInfo, pos2, vec2};
use jiff::Timestamp;

use super::{PADDING, set_menu, words};
use crate::{
    model::{
        Model,
        object_detail::{ObjectDetail, SetShift},
    },
    orbit::{Catalog, Elements},
    ui::{
        confirm::Question,
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
    },
};

const TITLE: f32 = 30.0;
const HEAD: f32 = 18.0;
const LINE: f32 = 18.0;
/// Height of the line about the newest set, which appears while an older set is in use, points.
const SIDE_WIDTH: f32 = 30.0;

/// Returns the computed detail of the object, if it is ready.
pub(super) fn detail(model: &Model, number: u32) -> Option<&ObjectDetail> {
    let detail = model.catalog_table.detail.as_ref();
    detail.filter(|object_detail| object_detail.key.elements.catalog_number() == number)
}

/// Returns the height of the part, points. `has_aside` adds the line that appears while an older
/// set is in use.
pub(super) fn height(detail: Option<&ObjectDetail>, has_aside: bool) -> f32 {
    let others = detail.map_or(0, |detail| detail.sets.len());
    let side_width = if has_aside { SIDE_WIDTH } else { 0.0 };
    TITLE + HEAD + (others + 1) as f32 * LINE + side_width + 8.0
}

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    elements: &Elements,
    catalog: &Catalog,
    detail: Option<&ObjectDetail>,
    question: &mut Option<Question>,
) {
    let t = theme::tokens(ui);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let title = inner.with_max_y(inner.top() + TITLE);
    let font = text::sized(13.0, Weight::SemiBold);
    paint::text_in(ui, title, Align2::LEFT_CENTER, "Stored sets", font, t.t1);
    let pass = detail.and_then(|detail| detail.passes.first());
    let time_text = pass.map(|predicted| format::moment(predicted.pass.tca.time, model.now));
    let [shown, spoken] = match time_text {
        None => ["no pass to compare them at"; 2].map(str::to_owned),
        Some(time_text) => [
            format!("differences at {time_text}"),
            format!("differences from the one in use at {time_text}"),
        ],
    };
    let room = title.with_min_x(title.left() + 80.0);
    paint::text_in(ui, room, Align2::RIGHT_CENTER, &shown, text::caption(), t.t2);
    let spoken = format!("Stored sets, {spoken}");
    paint::name_text(ui, "sets held", title, &spoken).on_hover_text(&spoken);
    let line = |index: f32| {
        let min = pos2(inner.left(), title.bottom() + index);
        Rect::from_min_size(min, vec2(inner.width(), LINE))
    };
    let head = line(0.0);
    cells(ui, head, ["Epoch", "Source", "Time s", "Angle °"], [t.t3; 4]);
    let start_text = catalog.source_of(elements.catalog_number()).unwrap_or_default();
    let first = line(HEAD);
    let newest = catalog.set_aside(elements.catalog_number());
    let (icon, colour) = match newest {
        Some(_) => (Icon::Warning, t.warn),
        None => (Icon::Check, t.ok),
    };
    cells(
        ui,
        first,
        [&format::minute(elements.epoch(), model.now), start_text, "", "in use"],
        [t.t1, t.t2, t.t1, colour],
    );
    let position = pos2(first.right() - paint::text_width(ui, "in use", text::small()) - 10.0, 0.0);
    let position = pos2(position.x, first.center().y);
    icons::paint(ui.painter(), paint::square(position, 11.0), icon, colour);
    let half_beam_deg = model.antenna().map(|antenna| antenna.config.beam_width_deg / 2.0);
    let menu = set_menu::Menu { model, elements, newest, detail };
    for (index, set) in detail
        .map(|object_detail| object_detail.sets.as_slice())
        .unwrap_or_default()
        .iter()
        .enumerate()
    {
        let row = line(HEAD + (index + 1) as f32 * LINE);
        let response = one(ui, row, index, set, half_beam_deg, model.now);
        set_menu::show(&response, &menu, set, question);
    }
    if let Some(newest) = newest {
        let line = Rect::from_x_y_ranges(
            inner.x_range(),
            rect.bottom() - 8.0 - SIDE_WIDTH..=rect.bottom() - 8.0,
        );
        side(ui, line, &menu, newest, question);
    }
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
}

/// Shows the newest set, which is not in use, and the button that uses it again.
fn side(
    ui: &Ui,
    line: Rect,
    menu: &set_menu::Menu<'_>,
    newest: &Elements,
    question: &mut Option<Question>,
) {
    let t = theme::tokens(ui);
    let lock = words::sources_lock(menu.model);
    let button = Button::normal("Use the newest").locked_by(lock);
    let size = vec2(button.width(ui), SMALL_HEIGHT);
    let place = Rect::from_center_size(line.right_center() - vec2(size.x / 2.0, 0.0), size);
    let newest_epoch = format::minute(newest.epoch(), menu.model.now);
    let room = line.with_max_x(place.left() - 8.0);
    let words = format!("Newest: {newest_epoch}");
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::small(), t.warn);
    let words = format!("Not in use: the newest, {newest_epoch}");
    paint::name_text(ui, "set aside", room, &words).on_hover_text(&words);
    if button.show(ui, "use the newest set", place).clicked() {
        *question = Some(menu.ask(newest.epoch()));
    }
}

/// Draws the row of a set that is not in use, which opens its menu.
fn one(
    ui: &Ui,
    row: Rect,
    index: usize,
    shift: &SetShift,
    half_beam_deg: Option<f64>,
    now: Timestamp,
) -> Response {
    let t = theme::tokens(ui);
    let set = &shift.set;
    let is_outside = shift
        .deviation
        .zip(half_beam_deg)
        .is_some_and(|(deviation, half_beam_deg)| deviation.degrees() > half_beam_deg);
    let time = shift
        .late_s
        .map_or_else(|| "–".to_owned(), |late_s| format::signed(late_s, time_decimals(late_s)));
    let angle = shift
        .deviation
        .map_or_else(|| "–".to_owned(), |deviation| format::number(deviation.degrees(), 2));
    let colour = if is_outside { t.bad } else { t.t1 };
    let when = format::minute(set.elements.epoch(), now);
    let response = ui.interact(
        row,
        ui.make_persistent_id(("held set", index)),
        Sense::CLICK | Sense::FOCUSABLE,
    );
    if response.hovered() {
        ui.painter().rect_filled(row.expand2(vec2(6.0, 0.0)), 3, t.bg3);
    }
    cells(ui, row, [&when, &set.source, &time, &angle], [t.t1, t.t2, t.t1, colour]);
    let beam = if is_outside { ", outside the beam" } else { "" };
    let difference = match (shift.late_s, shift.deviation) {
        (Some(late_s), Some(deviation)) => {
            let way = if late_s < 0.0 { "early" } else { "late" };
            let (time, angle) = (
                format::number(late_s.abs(), time_decimals(late_s)),
                format::degrees(deviation.degrees(), 2),
            );
            format!("{time} s {way}, {angle}{beam}")
        }
        (None, Some(deviation)) => {
            format!("no such pass, {}{beam}", format::degrees(deviation.degrees(), 2))
        }
        (_, None) => "cannot be compared".to_owned(),
    };
    let words = format!("Set of {when} from {}: {difference}", set.source);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &words));
    paint::focus_ring(ui, &response, 3);
    response.on_hover_text(&words)
}

/// Returns the decimals of a time difference: none from 100 s on, where parts of a second mean
/// nothing.
pub(super) fn time_decimals(late_s: f64) -> usize {
    if late_s.abs() < 100.0 { 2 } else { 0 }
}

fn cells(ui: &Ui, row: Rect, words: [&str; 4], colours: [Color32; 4]) {
    let right = row.right();
    let places = [
        (row.with_max_x(row.left() + 92.0), Align2::LEFT_CENTER),
        (row.with_min_x(row.left() + 98.0).with_max_x(right - 112.0), Align2::LEFT_CENTER),
        (row.with_min_x(right - 112.0).with_max_x(right - 56.0), Align2::RIGHT_CENTER),
        (row.with_min_x(right - 56.0), Align2::RIGHT_CENTER),
    ];
    for (((place, anchor), words), colour) in places.into_iter().zip(words).zip(colours) {
        paint::text_in(ui, place, anchor, words, text::small(), colour);
    }
}
