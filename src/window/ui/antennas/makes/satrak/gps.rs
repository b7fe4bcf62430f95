//! GPS settings: the location the unit uses.

use egui::Ui;

use crate::ui::antennas::cards::{fields, subtitle};
use crate::{
    astro::{Site, frames},
    controller::satrak::settings::{
        GPS, IS_AUTOMATIC, IS_VALID, LATITUDE_DEG, LONGITUDE_DEG, RECEIVER,
    },
    ui::{
        antennas::{form::Form, row, unit::ShownUnit},
        format,
        icons::Icon,
        theme,
    },
};

/// Max distance between the unit's location and the site, km. At a greater distance, the unit sees
/// other passes than Azel. The unit's rounding to 0.01° causes at most 0.8 km.
const FAR_KM: f64 = 1.0;

pub(super) fn show(ui: &mut Ui, unit: &ShownUnit<'_>, form: &mut Form) {
    row::head(ui);
    fields(ui, unit, form, GPS.key, |_| true);
    site_check(ui, unit);
    subtitle(ui, "GPS receiver");
    fields(ui, unit, form, RECEIVER.key, |_| true);
}

fn site_check(ui: &mut Ui, unit: &ShownUnit<'_>) {
    let t = theme::tokens(ui);
    let Some(away_km) = place(unit).map(|place| distance_km(place, unit.model.station.site)) else {
        return row::plain(ui, "Distance to site", "not known", None);
    };
    let distance = format::distance(away_km, 1, unit.model.appearance.distances);
    let words = format!("{distance} from the station's site");
    if away_km <= FAR_KM {
        let verdict = Some((Some(Icon::Check), "Agrees", t.t3));
        return row::plain(ui, "Distance to site", &words, verdict);
    }
    row::plain(ui, "Distance to site", &words, Some((Some(Icon::Warning), "Differs", t.warn)));
    let reason = "The unit tracks from its own location and Azel predicts from the station's: one \
               of them is wrong.";
    row::note(ui, Some(Icon::Warning), reason, t.warn);
}

/// Returns the location that the unit uses: the receiver's, or the one entered on the unit.
fn place(unit: &ShownUnit<'_>) -> Option<Site> {
    let reported = unit.values(GPS.key)?;
    let is_automatic = IS_AUTOMATIC.get(reported) == Some(true);
    let from_gps = unit
        .values(RECEIVER.key)
        .filter(|receiver| is_automatic && IS_VALID.get(receiver) == Some(true));
    let altitude_m = unit.model.station.site.altitude_m();
    let values = from_gps.unwrap_or(reported);
    Site::new(LATITUDE_DEG.get(values)?, LONGITUDE_DEG.get(values)?, altitude_m).ok()
}

fn distance_km(a: Site, b: Site) -> f64 {
    frames::site_ecef_km(a).distance(frames::site_ecef_km(b))
}
