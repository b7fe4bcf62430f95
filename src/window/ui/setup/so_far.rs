//! The station as entered so far: each part and its state.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};

use super::{
    PADDING, Step,
    draft::SetupDraft,
    steps::{Passed, Progress},
};
use crate::{
    contract::{CatalogState, driver::TimeSync},
    model::Model,
    ui::{
        format,
        icons::{self, Icon},
        text, theme,
        tokens::Tokens,
        widgets::{paint, status_line::Tone},
        words::OLD_ELEMENTS_S,
    },
};

const ROW: f32 = 28.0;

pub(super) struct Part {
    pub(super) name: String,
    pub(super) tone: Tone,
    pub(super) state: String,
}

fn part(name: impl Into<String>, (tone, state): (Tone, String)) -> Part {
    Part { name: name.into(), tone, state }
}

/// Returns all parts in the order of the steps.
pub(super) fn parts(model: &Model, draft: &SetupDraft, progress: Progress) -> Vec<Part> {
    let clock = match model.time_sync {
        TimeSync::Synchronised => (Tone::Good, "synchronised"),
        TimeSync::NotSynchronised => (Tone::Bad, "not synchronised"),
        TimeSync::NotKnown => (Tone::Plain, "sync unknown"),
    };
    let mut parts =
        vec![part("Clock", (clock.0, clock.1.to_owned())), part("Site", site(draft, progress))];
    for index in 0..draft.form.antennas.len() {
        parts.push(part(
            draft.antenna_name(index),
            crate::ui::words::link_test_state(draft.form.test(index, model)),
        ));
    }
    if draft.form.antennas.is_empty() {
        parts.push(part("Antennas", (Tone::Plain, "none".to_owned())));
    }
    parts.push(part("Satellites", satellites(draft)));
    parts.push(part("Elements", elements(model, draft)));
    parts
}

/// Returns the number of ready parts, such as "4 of 7".
pub(super) fn ready(parts: &[Part]) -> String {
    let good = parts.iter().filter(|part| part.tone == Tone::Good).count();
    format!("{good} of {}", parts.len())
}

pub(super) fn site(draft: &SetupDraft, progress: Progress) -> (Tone, String) {
    match (progress.outcome(Step::Site), draft.site()) {
        (Passed::Skipped, _) => (Tone::Caution, "skipped: as in the demo".to_owned()),
        (_, Some((_, site))) => {
            let words =
                crate::ui::words::place(site.latitude().degrees(), site.longitude().degrees());
            (Tone::Good, words)
        }
        (_, None) => (Tone::Plain, "to do".to_owned()),
    }
}

pub(super) fn satellites(draft: &SetupDraft) -> (Tone, String) {
    match draft.favourites.iter().count() {
        0 => (Tone::Caution, "none".to_owned()),
        count => (Tone::Good, format!("{} chosen", format::number(count as f64, 0))),
    }
}

/// Describes the max age of the elements of the chosen satellites, or the number of satellites
/// without elements.
pub(super) fn elements(model: &Model, draft: &SetupDraft) -> (Tone, String) {
    let catalog = match &model.catalog {
        CatalogState::Loading => return (Tone::Plain, "being read".to_owned()),
        CatalogState::Failed => return (Tone::Bad, "none could be read".to_owned()),
        CatalogState::Ready(catalog) => catalog,
    };
    let chosen = draft.favourites.numbers().into_iter().filter_map(|number| catalog.get(number));
    let Some(age_s) = chosen.map(|set| set.age_s(model.now)).reduce(f64::max) else {
        return (Tone::Good, crate::ui::elements::objects(catalog.len()));
    };
    let tone = if age_s > OLD_ELEMENTS_S { Tone::Caution } else { Tone::Good };
    (tone, format!("up to {} old", format::age(age_s)))
}

pub(super) fn show(ui: &Ui, rect: Rect, model: &Model, draft: &SetupDraft, progress: Progress) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 16.0));
    let parts = parts(model, draft, progress);
    paint::text(ui, inner.min, Align2::LEFT_TOP, "Your station so far", text::title(), t.t1);
    let head = inner.with_min_y(inner.top() + 40.0);
    let head = head.with_max_y(head.top() + ROW);
    paint::text_in(ui, head, Align2::LEFT_CENTER, "Ready", text::body_medium(), t.t1);
    paint::text_in(ui, head, Align2::RIGHT_CENTER, &ready(&parts), text::small(), t.t2);
    for (index, part) in parts.iter().enumerate() {
        let top = head.bottom() + ROW * index as f32;
        let row = Rect::from_min_size(pos2(inner.left(), top), vec2(inner.width(), ROW));
        ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
        let (icon, colour) = look(part.tone, t);
        let position = pos2(row.left() + 6.0, row.center().y);
        icons::paint(ui.painter(), paint::square(position, 12.0), icon, colour);
        let name = row.with_min_x(row.left() + 24.0).with_max_x(row.left() + 112.0);
        paint::text_in(ui, name, Align2::LEFT_CENTER, &part.name, text::body(), t.t1);
        let state = row.with_min_x(name.right() + 4.0);
        let colour = if part.tone == Tone::Good { t.t2 } else { colour };
        paint::text_in(ui, state, Align2::RIGHT_CENTER, &part.state, text::small(), colour);
        let spoken = format!("{}: {}", part.name, part.state);
        let named = paint::name_text(ui, ("part", index), row, &spoken);
        let has_room = paint::fits(ui, &part.name, text::body(), name)
            && paint::fits(ui, &part.state, text::small(), state);
        if !has_room {
            named.on_hover_text(&spoken);
        }
    }
}

pub(super) fn look(tone: Tone, t: &Tokens) -> (Icon, Color32) {
    match tone {
        Tone::Good => (Icon::Check, t.ok),
        Tone::Caution => (Icon::Warning, t.warn),
        Tone::Bad => (Icon::Cross, t.bad),
        Tone::Plain | Tone::Now => (Icon::Dash, t.t3),
    }
}
