//! The set-up step for the site.

use egui::{Response, RichText, Ui};

use super::{draft::SetupDraft, words};
use crate::{
    astro::{read_locator, sun_moon},
    model::{DistanceUnit, Model},
    ui::{
        preferences::form,
        text, theme,
        widgets::{
            card,
            form::{LABEL, note, text_field},
            input::focus_to_replace,
            status_line::{Tone, line},
        },
    },
};

const CARD: f32 = 638.0;
/// Width of the field of the locator, points.
const LOCATOR: f32 = 240.0;
/// Number of decimals, degrees, of a position from a locator or a unit.
const OF_LOCATOR: usize = 4;
const OF_UNIT: usize = 5;

pub(super) fn show(ui: &mut Ui, model: &Model, draft: &mut SetupDraft, wants_focus: &mut bool) {
    card::show(ui, CARD, |ui| {
        let name = fields(ui, draft, 0..1);
        if let Some(name) = name.first()
            && std::mem::take(wants_focus)
        {
            let typed = draft.form.ground.fields.first().map_or("", |field| &field.entry.text);
            focus_to_replace(ui, name, typed);
        }
        locator(ui, draft, model.appearance.distances);
        fields(ui, draft, 1..super::draft::SITE_FIELDS);
    });
    for (name, place) in draft.places(model) {
        let place_text = crate::ui::words::place(place.latitude_deg, place.longitude_deg);
        if ui.button(format!("Use the location of {name}: {place_text}")).clicked() {
            draft.put_place(place.latitude_deg, place.longitude_deg, OF_UNIT);
            draft.locator.clear();
        }
    }
    let Some(site) = draft.place() else { return };
    card::show(ui, CARD, |ui| {
        let place_text =
            crate::ui::words::place(site.latitude().degrees(), site.longitude().degrees());
        let t = theme::tokens(ui);
        ui.label(RichText::new(place_text).font(text::value()).color(t.t1));
        line(ui, Tone::Now, &crate::ui::words::sun_there(sun_moon::sun(site, model.now)));
        if let Some((name, km)) = draft.off_the_told_km(model) {
            let (tone, words) =
                crate::ui::words::off_the_told(&name, km, model.appearance.distances);
            line(ui, tone, &words);
        }
    });
}

fn fields(ui: &mut Ui, draft: &mut SetupDraft, range: std::ops::Range<usize>) -> Vec<Response> {
    let standings = draft.site_standings();
    let standings = standings.get(range.clone()).unwrap_or_default();
    let fields = draft.form.ground.fields.get_mut(range).unwrap_or_default();
    form::fields(ui, "site", fields, standings)
}

/// Shows the locator field, which fills latitude and longitude.
fn locator(ui: &mut Ui, draft: &mut SetupDraft, unit: DistanceUnit) {
    let t = theme::tokens(ui);
    let hint = "such as KN41ob, or type degrees";
    let response = text_field(ui, ("Locator", hint), [LABEL, LOCATOR], &mut draft.locator);
    if response.changed()
        && let Ok(square) = read_locator(&draft.locator)
    {
        let (latitude, longitude) = (square.centre.latitude, square.centre.longitude);
        draft.put_place(latitude.degrees(), longitude.degrees(), OF_LOCATOR);
    }
    let (words, colour) = match read_locator(&draft.locator) {
        // The line always takes its room, so that no field moves under the pointer.
        _ if draft.locator.trim().is_empty() => {
            ("A Maidenhead locator fills in latitude and longitude.".to_owned(), t.t3)
        }
        Ok(square) => (words::square(square, unit), t.t3),
        Err(locator_error) => (format!("Locator {locator_error}."), t.bad),
    };
    note(ui, &words, colour);
}
