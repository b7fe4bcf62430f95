//! Satellite on the unit, and the source of its elements.

use egui::{Rect, Sense, Ui, vec2};

use crate::ui::antennas::cards::{CardEffects, fields};
use crate::{
    controller::satrak::settings::{
        ADDRESS, FILE, FILE_NAME, FTP, GENERAL, PASSWORD, PORT, SATELLITE, TLE_SOURCE, URL, USER,
        WEB,
    },
    device::settings::{Access, Group, Kind, Values},
    ui::{
        antennas::{
            form::{Count, Form},
            row,
            unit::ShownUnit,
        },
        icons::{self, Icon},
        source_test::{self, TypedSource},
        text, theme,
        widgets::{
            button::{Button, HEIGHT},
            paint, segmented,
        },
        words,
    },
};

/// Groups in the order of the codes of [`TLE_SOURCE`]; their titles are the tabs.
static SOURCES: [&Group; 3] = [&FILE, &WEB, &FTP];
const TABS: f32 = 216.0;

pub(super) fn show(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    effects: &mut CardEffects<'_>,
) {
    let used = used(unit);
    let shown = form.tab.or(used).unwrap_or(FILE.key);
    if let Some(tab) = tabs(ui, unit, form, used, shown) {
        form.tab = Some(tab);
    }
    row::head(ui);
    fields(ui, unit, form, shown, |_| true);
    let t = theme::tokens(ui);
    if shown == FTP.key {
        let words = "The unit sends this password in clear text. Azel never logs it.";
        row::note(ui, Some(Icon::Info), words, t.t2);
    }
    if let Some(group) = source(shown).filter(|_| used != Some(shown)) {
        use_it(ui, unit, form, group, effects);
    }
    test_from_here(ui, unit, form, shown, effects);
}

/// Shows the test that fetches elements from the typed source.
fn test_from_here(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    shown: &'static str,
    effects: &mut CardEffects<'_>,
) {
    let (Some(group), Some(current)) = (source(shown), unit.values(shown)) else { return };
    let draft = form.draft(shown);
    let text = |key: &str| {
        group.field(key).map_or_else(String::new, |field| draft.text(field, Some(current)))
    };
    // Without a typed password, use the password on the unit.
    let password = match (text(PASSWORD.name), PASSWORD.get(current)) {
        (typed, Some(secret)) if typed.is_empty() => secret.reveal().to_owned(),
        (typed, _) => typed,
    };
    let [url, address, port, user, file, satellite] =
        [URL.name, ADDRESS.name, PORT.name, USER.name, FILE_NAME.name, SATELLITE.name].map(text);
    let typed = if shown == WEB.key {
        TypedSource::Web { url: &url }
    } else if shown == FTP.key {
        TypedSource::Server {
            address: &address,
            port: &port,
            user: &user,
            password: &password,
            file: &file,
            satellite: &satellite,
        }
    } else {
        return;
    };
    ui.add_space(8.0);
    let (model, commands) = (unit.model, &mut *effects.commands);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 6.0;
        source_test::show(ui, model, unit.index, typed, &mut form.source_test, commands);
    });
}

/// Returns the group of the source that the unit uses.
fn used(unit: &ShownUnit<'_>) -> Option<&'static str> {
    let code = TLE_SOURCE.get(unit.values(GENERAL.key)?)?;
    SOURCES.get(usize::try_from(code).ok()?).map(|group| group.key)
}

fn source(key: &str) -> Option<&'static Group> {
    SOURCES.into_iter().find(|group| group.key == key)
}

fn tabs(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &Form,
    used: Option<&str>,
    shown: &'static str,
) -> Option<&'static str> {
    let t = theme::tokens(ui);
    ui.add_space(6.0);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let tabs = SOURCES.map(|group| (group.title, group.key));
    let place = rect.with_max_x(rect.left() + TABS);
    let mut tab = shown;
    let name = "Source of the elements";
    let is_clicked = segmented::choose(ui, "source", place, name, &tabs, &mut tab);
    let word = |subject: &str| source(subject).map_or("", |group| group.title);
    let elsewhere = SOURCES.iter().filter(|group| group.key != shown);
    let edited: Vec<&str> = elsewhere
        .filter(|group| form.count(unit, &[group.key]).edited > 0)
        .map(|group| group.title)
        .collect();
    let spoken = match used {
        _ if !edited.is_empty() => format!("Also edited: {}", edited.join(" and ")),
        Some(used) if used == shown => format!("{} is in use", word(used)),
        Some(used) => format!("{} is in use, not {}", word(used), word(shown)),
        None => "Source in use unknown".to_owned(),
    };
    let room = Rect::from_min_max(place.right_top() + vec2(12.0, 0.0), rect.max);
    let (icon, colour) = match used {
        _ if !edited.is_empty() => (Icon::Pencil, t.sat),
        Some(used) if used == shown => (Icon::Check, t.ok),
        _ => (Icon::Info, t.t2),
    };
    icons::paint(
        ui.painter(),
        paint::square(room.left_center() + vec2(7.0, 0.0), 14.0),
        icon,
        colour,
    );
    row::status_text(
        ui,
        room.with_min_x(room.left() + 20.0),
        &spoken,
        text::small(),
        t.t2,
        &spoken,
    );
    is_clicked.then_some(tab)
}

/// Shows the button that selects this source. The unit uses the source that it received last, so
/// Azel sends an unchanged value.
fn use_it(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    group: &'static Group,
    effects: &mut CardEffects<'_>,
) {
    let t = theme::tokens(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 32.0), Sense::hover());
    let values = again(group, unit.values(group.key));
    let is_free = form.count(unit, &[group.key]) == Count::default();
    let hindrance = unit.hindrance().map(words::hindrance);
    let refusal = if let Some(reason) = &hindrance {
        Some(reason.as_str())
    } else if !is_free {
        Some("Apply selects it and sends the edits.")
    } else if !unit.is_fresh(group.key) || values.is_empty() {
        Some("Its values have not been read yet.")
    } else {
        None
    };
    let words = format!("Use {}", group.title);
    let button = Button::normal(&words).locked(refusal.is_some());
    let place = rect.with_max_x(rect.left() + button.width(ui)).with_min_y(rect.top() + 6.0);
    if button.show(ui, "use source", place).clicked() {
        form.begin_report();
        form.send(unit, group, values, effects.commands);
    }
    let room = place.with_min_x(place.right() + 8.0).with_max_x(rect.right());
    let spoken = refusal.unwrap_or("Sends its values unchanged, which selects it as the source.");
    row::status_text(ui, room, spoken, text::small(), t.t3, spoken);
}

/// Returns the first editable value unchanged, which is enough to send the whole group again.
fn again(group: &Group, current: Option<&Values>) -> Values {
    let plain = |kind: &Kind| !matches!(kind, Kind::Password(_));
    let editable = group.fields.iter().filter(|f| f.access == Access::Edit && plain(&f.kind));
    let value = editable.filter_map(|field| Some((field.key, current?.get(field.key)?.clone())));
    value.take(1).collect()
}
