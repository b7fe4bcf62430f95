//! The recorded passes by day, the newest first.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};
use jiff::Timestamp;

use super::{
    PADDING, RecordState,
    state::{Listed, found},
};
use crate::{
    contract::{record::RecordedPass, recorded::MissedPass},
    model::Model,
    plan::pass_report::PassVerdict,
    ui::{
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        tokens::Tokens,
        widgets::{
            button::Button,
            list::{List, paint_divider},
            paint,
        },
        words::{automatic, record as words},
    },
};

const DAY: f32 = 28.0;
const ROW: f32 = 50.0;
/// Height of a row with the cause of its loss or error, points.
const HIGH_ROW: f32 = 66.0;
const FOOT: f32 = 44.0;

pub(super) fn show(ui: &mut Ui, rect: Rect, model: &Model, state: &mut RecordState) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, theme::tokens(ui).field);
    let list = List::new(ui, rect, "recorded passes", "Recorded passes", ROW);
    ui.painter().vline(rect.right() - 0.5, rect.y_range(), (1.0, t.line));
    let shown = state.shown(model);
    let scrolls = std::mem::take(&mut state.scrolls);
    let mut chosen = None;
    list.show_scrolling(ui, |ui, area| {
        area.show(ui, |ui| {
            let listed = RecordState::listed(model);
            let day = |entry: &Listed<'_>| format::date(entry.aos());
            for of_day in listed.chunk_by(|a, b| day(a) == day(b)) {
                let (_, place) = ui.allocate_space(vec2(rect.width(), DAY));
                head(ui, place, of_day);
                for entry in of_day {
                    let pass = match entry {
                        Listed::Tracked(pass) => pass,
                        Listed::NotTracked(pass) => {
                            let (_, place) = ui.allocate_space(vec2(rect.width(), HIGH_ROW));
                            missed(ui, place, model.now, pass);
                            continue;
                        }
                    };
                    let cause = words::cause_in_short(pass);
                    let height = if cause.is_some() { HIGH_ROW } else { ROW };
                    let (_, place) = ui.allocate_space(vec2(rect.width(), height));
                    let is_shown = shown == Some(pass.id);
                    if row(ui, &list, place, model.now, pass, cause.as_deref(), is_shown) {
                        chosen = Some(pass.id);
                    }
                    if is_shown && scrolls {
                        ui.scroll_to_rect(place, None);
                    }
                }
            }
            let left = RecordState::page(model).map_or(0, |page| page.matching - on_page(page));
            let missed = found(model).map_or(0, |found| found.missed.len());
            let has_more = usize::try_from(state.query.count).is_ok_and(|count| count <= missed);
            if left > 0 || has_more {
                let (_, place) = ui.allocate_space(vec2(rect.width(), FOOT));
                let word = match left {
                    0 => "Older passes".to_owned(),
                    left => format!("Older passes ({left})"),
                };
                let button = Button::normal(&word);
                let size = vec2(button.width(ui), 32.0);
                let bounds = Rect::from_min_size(place.min + vec2(PADDING, 6.0), size);
                if button.show(ui, "older passes", bounds).clicked() {
                    state.list_more();
                }
            }
        });
    });
    if let Some(id) = chosen {
        state.choose(id);
    }
}

/// Returns the number of passes on the page, including unreadable ones.
fn on_page(page: &crate::contract::record::PassPage) -> u32 {
    let passes = u32::try_from(page.passes.len()).unwrap_or(u32::MAX);
    passes.saturating_add(page.unreadable).min(page.matching)
}

fn head(ui: &Ui, rect: Rect, of_day: &[Listed<'_>]) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg2);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let day = of_day.first().map_or_else(String::new, |listed| format::date(listed.aos()));
    let tracked = of_day.iter().filter_map(|listed| match listed {
        Listed::Tracked(pass) => Some(pass.report.report.verdict),
        Listed::NotTracked(_) => None,
    });
    let verdicts: Vec<PassVerdict> = tracked.collect();
    let count = verdicts.len();
    let good = verdicts.iter().filter(|verdict| **verdict == PassVerdict::Good).count();
    let passes = if count == 1 { "pass" } else { "passes" };
    let missed = of_day.len() - count;
    let words = match (good == count, missed) {
        (true, 0) => format!("{count} {passes}, all good"),
        (false, 0) => format!("{count} {passes}, {good} good"),
        (_, missed) => format!("{count} {passes}, {good} good, {missed} not tracked"),
    };
    let right = Align2::RIGHT_CENTER;
    let counted = paint::text_in(ui, inner, right, &words, text::small(), t.t3);
    let room = inner.with_max_x(counted.left() - 8.0);
    paint::text_in(ui, room, Align2::LEFT_CENTER, &day, text::small_strong(), t.t1);
    paint::name_text(ui, ("record day", &day), rect, &format!("{day}: {words}"));
}

/// Draws the row of a planned pass that was not tracked. It has no report.
fn missed(ui: &Ui, rect: Rect, now: Timestamp, pass: &MissedPass) {
    let t = theme::tokens(ui);
    let aos = format::moment(pass.flown.pass.1, now);
    let cause = pass.flown.cause.map_or_else(String::new, automatic::miss_cause);
    let lines = Lines { name: &pass.flown.name, max: "", aos: &aos, antenna: &pass.antenna_name };
    paint_divider(ui, rect);
    lines.paint(ui, rect, (Icon::Dash, t.t3), (words::NOT_TRACKED, t.t2), Some(&cause));
    let antenna = &pass.antenna_name;
    let spoken = format!("{}, {aos}, {antenna}: not tracked. {cause}", pass.flown.name);
    paint::name_text(ui, ("missed pass", pass.id), rect, &spoken).on_hover_text(&cause);
}

/// Returns mark and colour of a verdict.
pub(super) fn mark(verdict: PassVerdict, t: &Tokens) -> (Icon, Color32) {
    match verdict {
        PassVerdict::Good => (Icon::Check, t.ok),
        PassVerdict::Fair => (Icon::Warning, t.warn),
        PassVerdict::Poor => (Icon::Cross, t.bad),
    }
}

fn row(
    ui: &Ui,
    list: &List,
    rect: Rect,
    now: Timestamp,
    pass: &RecordedPass,
    cause: Option<&str>,
    is_shown: bool,
) -> bool {
    let t = theme::tokens(ui);
    let report = &pass.report;
    let name = report.elements.short_name();
    let max = format!("max {}", format::degrees(report.max_elevation_deg, 0));
    let aos = format::moment(report.start, now);
    let text = words::in_short(&report.report);
    let spoken = format!(
        "{name}, {aos}, {max}, {}: {}, {text}{}",
        pass.antenna_name,
        words::verdict(report.report.verdict),
        cause.map_or_else(String::new, |cause| format!(", {cause}"))
    );
    let clear = Color32::TRANSPARENT;
    let response = list.option(ui, rect, pass.id, is_shown, clear, || spoken.clone());
    let (icon, colour) = mark(report.report.verdict, t);
    let said_in = if report.report.verdict == PassVerdict::Good { t.t1 } else { colour };
    let lines = Lines { name, max: &max, aos: &aos, antenna: &pass.antenna_name };
    lines.paint(ui, rect, (icon, colour), (&text, said_in), cause);
    response.clicked()
}

/// The words of a row.
struct Lines<'a> {
    name: &'a str,
    max: &'a str,
    aos: &'a str,
    antenna: &'a str,
}

impl Lines<'_> {
    fn paint(
        &self,
        ui: &Ui,
        rect: Rect,
        (icon, colour): (Icon, Color32),
        (spoken, said_in): (&str, Color32),
        cause: Option<&str>,
    ) {
        let t = theme::tokens(ui);
        let inner = rect.shrink2(vec2(PADDING, 0.0));
        let line = |y: f32| {
            Rect::from_x_y_ranges(inner.x_range(), rect.top() + y - 9.0..=rect.top() + y + 9.0)
        };
        let (left, right) = (Align2::LEFT_CENTER, Align2::RIGHT_CENTER);
        let time = paint::text_in(ui, line(16.0), right, self.aos, text::small(), t.t1);
        let room = line(16.0).with_max_x(time.left() - 16.0);
        let high = paint::text_in(ui, room, right, self.max, text::small(), t.t2);
        let room = line(16.0).with_max_x(high.left() - 8.0);
        paint::text_in(ui, room, left, self.name, text::sized(13.0, Weight::SemiBold), t.t1);
        let position = pos2(inner.left() + 7.0, rect.top() + 35.0);
        icons::paint(ui.painter(), paint::square(position, 13.0), icon, colour);
        let indent = |y: f32| line(y).with_min_x(inner.left() + 20.0);
        let antenna = paint::text_in(ui, indent(35.0), right, self.antenna, text::small(), t.t3);
        let room = indent(35.0).with_max_x(antenna.left() - 8.0);
        paint::text_in(ui, room, left, spoken, text::small(), said_in);
        if let Some(cause) = cause {
            paint::text_in(ui, indent(52.0), left, cause, text::small(), t.t2);
        }
    }
}
