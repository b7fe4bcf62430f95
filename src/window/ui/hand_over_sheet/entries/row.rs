//! Words of an entry in its row.

use jiff::Timestamp;

use crate::{
    astro::AzEl,
    plan::schedule::{Class, Entry, sets_out},
    station::BetweenPasses,
    ui::{format, hand_over_sheet::HandOverSheet},
};

/// Spare time below which the sheet marks it as short, seconds.
const SHORT_S: f64 = 60.0;
/// Duration below which the sheet does not mention it, seconds.
const MIN_S: f64 = 1.0;

pub(super) struct Row {
    /// UTC day of the row.
    pub(super) day: String,
    pub(super) sets_out: Timestamp,
    pub(super) aos: String,
    /// Max elevation and its azimuth.
    pub(super) max: String,
    pub(super) los: String,
    pub(super) name: String,
    pub(super) priority: String,
    pub(super) antenna: String,
    pub(super) counts: String,
    pub(super) shortened: String,
    pub(super) spare: String,
    pub(super) is_spare_short: bool,
    /// Track of the pass over the sky, and the part that the antenna takes.
    pub(super) whole: Vec<AzEl>,
    pub(super) part: Vec<AzEl>,
}

impl Row {
    pub(super) fn new(sheet: &HandOverSheet<'_>, entry: &Entry) -> Self {
        let number = entry.pass.satellite;
        let pass = sheet.pass(entry.pass);
        let whole = pass.map_or((entry.start, entry.end), |pass| (pass.aos.time, pass.los.time));
        let max = pass.map(|pass| {
            let (azimuth_deg, elevation_deg) =
                (pass.tca.direction.azimuth_deg(), pass.max_elevation().degrees());
            format!("{} {}", format::degrees(elevation_deg, 0), format::azimuth(azimuth_deg))
        });
        let antenna = sheet.station.antennas.iter().find(|config| config.id == entry.antenna);
        let between_passes =
            antenna.map_or(BetweenPasses::default(), |antenna| antenna.automatic.between_passes);
        let priority = match entry.class {
            Class::Always => "A".to_owned(),
            Class::Priority(priority) => priority.number().to_string(),
            Class::Fixed | Class::All | Class::Kept => {
                sheet.station.priority(number).unwrap_or_default().number().to_string()
            }
        };
        let sets_out = sets_out(entry, between_passes);
        Self {
            day: format::date(sets_out),
            sets_out,
            aos: format::second_of_day(entry.pass.aos),
            max: max.unwrap_or_default(),
            los: pass.map(|pass| format::second_of_day(pass.los.time)).unwrap_or_default(),
            name: sheet.name(number),
            priority,
            antenna: sheet.antenna(entry.antenna),
            counts: format::duration(entry.counted_s),
            shortened: shortened(sheet, entry),
            spare: entry.spare_s.map_or_else(|| "\u{2013}".to_owned(), format::duration),
            is_spare_short: entry.spare_s.is_some_and(|spare_s| spare_s < SHORT_S),
            whole: sheet.track(number, whole.0, whole.1),
            part: sheet.track(number, entry.start, entry.end),
        }
    }
}

/// Describes the parts of a pass that the antenna misses, and the antenna that takes the rest.
fn shortened(sheet: &HandOverSheet<'_>, entry: &Entry) -> String {
    let share = |seconds: f64, word: &str| {
        (seconds >= MIN_S).then(|| format!("{word} {}", format::duration(seconds)))
    };
    let shared = entry.shared_with.map(|other| format!("with {}", sheet.antenna(other)));
    let lost_s = entry.lost.map_or(0.0, |lost| lost.seconds);
    let parts = [
        shared,
        share(entry.late_s, "late"),
        share(entry.early_s, "early"),
        share(lost_s, "loses"),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
