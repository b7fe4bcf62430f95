//! Elements of the selected object on each antenna, as far as the unit reports them.

use egui::{Align2, Rect, Ui, pos2, vec2};
use jiff::Timestamp;

use super::{PADDING, words};
use crate::{
    astro::time::seconds_between,
    clock::Instant,
    contract::{antenna::AntennaModel, driver::LinkState, uploads::Stage},
    model::Model,
    orbit::Elements,
    ui::{
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::{paint, status_line::Tone},
    },
};

const TITLE: f32 = 30.0;
const LINE: f32 = 38.0;
/// Max difference between the epochs of one set, seconds: a TLE rounds its epoch.
const SAME_EPOCH_S: f64 = 0.01;

pub(super) fn height(model: &Model) -> f32 {
    TITLE + model.antennas.len().max(1) as f32 * LINE + 8.0
}

pub(super) fn show(ui: &Ui, rect: Rect, model: &Model, elements: &Elements) {
    let t = theme::tokens(ui);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let title = inner.with_max_y(inner.top() + TITLE);
    let font = text::sized(13.0, Weight::SemiBold);
    paint::text_in(ui, title, Align2::LEFT_CENTER, "On the antennas", font, t.t1);
    if model.antennas.is_empty() {
        let line = title.translate(vec2(0.0, TITLE));
        paint::text_in(ui, line, Align2::LEFT_CENTER, "No antenna.", text::small(), t.t2);
    }
    for (index, antenna) in model.antennas.iter().enumerate() {
        let min = pos2(inner.left(), title.bottom() + index as f32 * LINE);
        let line = Rect::from_min_size(min, vec2(inner.width(), LINE));
        one(ui, line, model, antenna, elements);
    }
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
}

fn one(ui: &Ui, line: Rect, model: &Model, antenna: &AntennaModel, elements: &Elements) {
    let t = theme::tokens(ui);
    let name = &antenna.config.name;
    let uploaded = uploaded_epoch(model, antenna, elements.catalog_number());
    let (tone, words) = holds(antenna, elements, uploaded);
    let start_text = known_since(antenna, model.steady);
    let (icon, colour) = match tone {
        Tone::Good => (Some(Icon::Check), t.ok),
        Tone::Caution | Tone::Bad => (Some(Icon::Warning), t.warn),
        Tone::Plain | Tone::Now => (None, t.t2),
    };
    if tone == Tone::Caution {
        ui.painter().rect_filled(line.shrink2(vec2(-8.0, 1.0)), 4, t.warnbg);
    }
    let (first, second) = line.shrink2(vec2(0.0, 2.0)).split_top_bottom_at_fraction(0.5);
    let drawn = paint::text_in(ui, first, Align2::LEFT_CENTER, name, text::body_medium(), t.t1);
    let room = first.with_min_x(drawn.right() + 8.0);
    paint::text_in(ui, room, Align2::RIGHT_CENTER, &start_text, text::small(), t.t2);
    let mut left = second.left();
    if let Some(icon) = icon {
        let position = pos2(left + 6.0, second.center().y);
        icons::paint(ui.painter(), paint::square(position, 12.0), icon, colour);
        left += 18.0;
    }
    let room = second.with_min_x(left);
    let colour = if tone == Tone::Caution { t.warn } else { t.t1 };
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::small(), colour);
    let spoken = format!("{name}: {words} {start_text}");
    let named = paint::name_text(ui, ("holds", name), line, spoken.trim());
    if !paint::fits(ui, &words, text::small(), room) {
        named.on_hover_text(spoken.trim());
    }
}

/// Describes the elements on an antenna. `uploaded` is the epoch of the set that an upload verified
/// there.
fn holds(
    antenna: &AntennaModel,
    elements: &Elements,
    uploaded: Option<Timestamp>,
) -> (Tone, String) {
    if !antenna.variant().capabilities.has_program {
        if antenna.tracked_number() == Some(elements.catalog_number()) {
            return (Tone::Good, "Azel tracks it with this antenna now.".to_owned());
        }
        return (Tone::Plain, "Stores no elements: Azel tracks with the set in use.".to_owned());
    }
    let Some(satellite) = &antenna.snapshot.state.on_board.satellite else {
        return (Tone::Plain, "What it holds has not been read yet.".to_owned());
    };
    if satellite.catalog_number == 0 && satellite.name.is_empty() {
        return (Tone::Plain, "Holds no satellite.".to_owned());
    }
    if satellite.catalog_number != elements.catalog_number() {
        return (Tone::Plain, format!("Holds another satellite, {}.", satellite.name));
    }
    let Some(epoch) = uploaded else {
        let words = "Holds this satellite; it does not report the epoch of its set.";
        return (Tone::Plain, words.to_owned());
    };
    let older_s = seconds_between(epoch, elements.epoch());
    if older_s.abs() < SAME_EPOCH_S {
        return (Tone::Good, "Holds the same set, as uploaded.".to_owned());
    }
    let age = words::age(older_s.abs());
    let way = if older_s > 0.0 { "older" } else { "newer" };
    (Tone::Caution, format!("Holds a set that is {age} {way}, as uploaded."))
}

/// Returns the epoch of an object in the file that Azel verified on the unit of `antenna`.
fn uploaded_epoch(model: &Model, antenna: &AntennaModel, number: u32) -> Option<Timestamp> {
    let uploads = &model.uploads;
    let Stage::Proved(proved) = &uploads.stage else { return None };
    if uploads.antenna != antenna.config.name {
        return None;
    }
    let objects = &proved.uploaded.objects;
    objects.iter().find(|object| object.catalog_number == number).map(|object| object.epoch)
}

/// Returns the age of the knowledge about a unit, as text.
fn known_since(antenna: &AntennaModel, now: Instant) -> String {
    let snapshot = &antenna.snapshot;
    let start = match snapshot.link {
        LinkState::Off | LinkState::Connecting { .. } => None,
        LinkState::Up { .. } => snapshot.state.measured.map(|measured| measured.received),
        LinkState::Stale { as_of } => Some(as_of),
        LinkState::Lost { start, .. } => Some(start),
    };
    match start {
        Some(start) => {
            let age_s = now.saturating_duration_since(start).as_secs_f64();
            format!("{} ago", format::age(age_s))
        }
        None if snapshot.link.is_open() => "now".to_owned(),
        None => "not connected".to_owned(),
    }
}
