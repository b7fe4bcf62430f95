//! Sentences about how a unit will read a source.

use egui::Ui;
use jiff::Timestamp;

use crate::{
    astro::time::seconds_between,
    contract::transfer::{FileObject, SatelliteMatch, UnitView},
    orbit::Refusal,
    ui::{
        format,
        widgets::status_line::{Tone, line},
        words::OLD_ELEMENTS_S,
    },
};

/// Max number of refused objects in the list.
const MAX_TOLD: usize = 3;

/// Shows the sentences about `view`, fetched at `time`, for `satellite`.
pub(super) fn show(ui: &mut Ui, view: &UnitView, satellite: &str, time: Timestamp, now: Timestamp) {
    for (tone, words) in sentences(view, satellite, time, now) {
        line(ui, tone, &words);
    }
}

fn sentences(
    view: &UnitView,
    satellite: &str,
    time: Timestamp,
    now: Timestamp,
) -> Vec<(Tone, String)> {
    let mut lines = vec![found(view, satellite, now)];
    if !view.is_tle {
        let words = "The file is not in TLE format, the only one that units are known to read.";
        lines.push((Tone::Bad, words.to_owned()));
    }
    let refused = view.refused.len() + view.refused_unlisted;
    if refused > 0 {
        let one = |refusal: &Refusal| {
            let object = refusal.object.as_deref().unwrap_or("an object");
            format!("{object} in line {}: {}", refusal.line, refusal.reason)
        };
        let texts: Vec<String> = view.refused.iter().take(MAX_TOLD).map(one).collect();
        let words = format!("{refused} objects cannot be read: {}.", texts.join("; "));
        lines.push((Tone::Caution, words));
    }
    let words = format!(
        "Fetched {}: {} bytes, {} objects, SHA-256 {}.",
        format::moment(time, now),
        view.bytes,
        view.objects,
        view.sha256
    );
    lines.push((Tone::Plain, words));
    lines
}

fn found(view: &UnitView, satellite: &str, now: Timestamp) -> (Tone, String) {
    match &view.satellite {
        SatelliteMatch::Found(object) => {
            let age_s = seconds_between(object.epoch, now);
            let words = format!("The unit will find {}.", new(object, now));
            let tone = if view.is_tle { Tone::Good } else { Tone::Plain };
            if age_s > OLD_ELEMENTS_S {
                (Tone::Caution, format!("{words} They are old."))
            } else {
                (tone, words)
            }
        }
        SatelliteMatch::Several(objects) => {
            let list: Vec<String> = objects.iter().map(|object| new(object, now)).collect();
            let words = format!(
                "Several objects have this name; the unit takes one of them: {}.",
                list.join("; ")
            );
            (Tone::Caution, words)
        }
        SatelliteMatch::Missing { similar } if similar.is_empty() => {
            (Tone::Bad, format!("The unit will not find {satellite}: it is not in the file."))
        }
        SatelliteMatch::Missing { similar } => {
            let words = format!(
                "The unit will not find {satellite}. The file has {}; names must match exactly.",
                similar.join(", ")
            );
            (Tone::Bad, words)
        }
    }
}

fn new(object: &FileObject, now: Timestamp) -> String {
    format!(
        "{} ({}), elements of {}, {} old",
        object.name,
        object.catalog_number,
        format::dated(object.epoch),
        format::age(seconds_between(object.epoch, now))
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::time::add_seconds,
        orbit::{bundled, write_tle},
        transfer::what_a_unit_sees,
    };

    const NAME: &str = "NOAA 20 (JPSS-1)";

    fn file() -> (Vec<u8>, Timestamp) {
        let catalog = bundled().unwrap();
        let elements = catalog.get(43_013).unwrap();
        let mut bytes = Vec::new();
        write_tle([elements], &mut bytes).unwrap();
        (bytes, elements.epoch())
    }

    fn first(bytes: &[u8], satellite: &str, age_s: f64) -> (Tone, String) {
        let now = add_seconds(file().1, age_s);
        sentences(&what_a_unit_sees(bytes, satellite), satellite, now, now).remove(0)
    }

    #[test]
    fn what_the_unit_will_find_is_said_with_its_age() {
        let (bytes, _) = file();
        let (tone, words) = first(&bytes, NAME, 7300.0);
        assert_eq!(tone, Tone::Good);
        assert!(words.contains("NOAA 20 (JPSS-1) (43013)") && words.contains("2 h 1 min old"));
        assert_eq!(first(&bytes, NAME, 40.0 * 86_400.0).0, Tone::Caution);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let (bytes, _) = file();
        let (tone, words) = first(&bytes, "noaa 20", 0.0);
        assert!(tone == Tone::Bad && words.contains("must match exactly"), "{words}");
        let (tone, words) = first(b"<html>gone</html>", NAME, 0.0);
        assert!(tone == Tone::Bad && words.contains("not in the file"), "{words}");
        let twice = [bytes.clone(), bytes].concat();
        assert_eq!(first(&twice, NAME, 0.0).0, Tone::Caution);
    }
}
