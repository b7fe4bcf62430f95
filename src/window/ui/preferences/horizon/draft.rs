//! Draft of the mask, the keep-outs and the Sun avoidance. A typing error loses nothing, and the
//! plot keeps the last valid value.

use std::{borrow::Cow, ops::RangeInclusive};

use super::Chosen;
use crate::{
    astro::{HorizonMask, Zone},
    device::settings::number,
    station::{Antenna, Entered, KeepOut, Station, SunAvoidance, ranges},
    ui::{
        preferences::{
            draft::Draft,
            fields::Problem,
            search::Spot,
            section::{DraftSection, Finding},
        },
        widgets::form::{Entry, Mark, standing},
        words,
    },
};

/// Range for the azimuth of a corner, degrees: one turn, and one more in each direction.
pub(super) const AZIMUTH: RangeInclusive<f64> = -360.0..=720.0;

/// Draft of the whole horizon page.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui::preferences) struct Skies {
    /// Text of the mask, as [`HorizonMask::import`] reads it; empty without a mask.
    pub(in crate::ui::preferences) mask: String,
    pub(super) zones: Vec<ZoneDraft>,
    pub(super) sun: SunDraft,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct ZoneDraft {
    pub(super) name: String,
    pub(super) reason: String,
    pub(super) antenna: Option<String>,
    pub(super) entered: Entered,
    pub(super) margin: Cell,
    pub(super) corners: Vec<Corner>,
    /// The saved keep-out; `None` for a new one.
    was: Option<Box<KeepOut>>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Corner {
    pub(super) azimuth: Cell,
    pub(super) elevation: Cell,
}

/// A number field.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    pub(super) entry: Entry,
    /// Last valid value.
    saved: f64,
    range: (f64, f64),
}

/// Draft of the distance that antennas keep from the Sun.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SunDraft {
    pub(super) is_on: bool,
    pub(super) radius: Cell,
    pub(super) ahead: Cell,
}

impl Cell {
    fn new(value: f64, is_saved: bool, range: &RangeInclusive<f64>) -> Self {
        let entry = if is_saved { Entry::saved } else { Entry::added };
        let range = (*range.start(), *range.end());
        Self { entry: entry(written(value)), saved: value, range }
    }

    /// Returns the last valid value.
    pub(super) fn saved(&self) -> f64 {
        self.saved
    }

    fn typed(&self) -> Option<f64> {
        let (low, high) = self.range;
        number(self.entry.text.trim()).filter(|value| (low..=high).contains(value))
    }

    /// Takes the entered text if it is valid.
    pub(super) fn take(&mut self) {
        self.saved = self.typed().unwrap_or(self.saved);
    }

    /// Sets a value, clamped to the range.
    pub(super) fn set(&mut self, value: f64) {
        let (low, high) = self.range;
        self.saved = value.clamp(low, high);
        self.entry.text = written(self.saved);
    }

    /// Returns the problem of the entered text, and the value used instead.
    pub(super) fn problem(&self) -> Option<String> {
        let (low, high) = self.range;
        self.typed().is_none().then(|| {
            let words = format!("{low} to {high}. The plot keeps {}°.", written(self.saved));
            words.replace('-', "−")
        })
    }

    /// Returns the state of the field, and the words next to it.
    pub(super) fn state(&self) -> (Mark, String) {
        standing(self.problem(), self.entry.was())
    }

    fn is_edited(&self) -> bool {
        self.entry.is_new() || self.entry.is_edited()
    }
}

/// Formats a value with one decimal, or with as many as it has.
fn written(value: f64) -> String {
    let tenths = value * 10.0;
    let is_short = (tenths - tenths.round()).abs() < 1e-9;
    if is_short { format!("{value:.1}") } else { value.to_string() }
}

impl Corner {
    fn new(point: (f64, f64), is_saved: bool) -> Self {
        Self {
            azimuth: Cell::new(point.0, is_saved, &AZIMUTH),
            elevation: Cell::new(point.1, is_saved, &ranges::CORNER_ELEVATION_DEG),
        }
    }

    /// Returns a new corner.
    pub(super) fn added(azimuth_deg: f64, elevation_deg: f64) -> Self {
        Self::new((azimuth_deg, elevation_deg), false)
    }

    pub(super) fn point(&self) -> (f64, f64) {
        (self.azimuth.saved, self.elevation.saved)
    }

    pub(super) fn problem(&self) -> Option<String> {
        self.azimuth.problem().or_else(|| self.elevation.problem())
    }

    /// Returns the common state of both fields, and the words next to them.
    pub(super) fn state(&self) -> (Mark, String) {
        let entries = [&self.azimuth.entry, &self.elevation.entry];
        let was: Vec<&str> = entries.into_iter().filter_map(Entry::was).collect();
        match standing(self.problem(), (!was.is_empty()).then(|| was.join(", ")).as_deref()) {
            (Mark::Plain, _) if self.azimuth.entry.is_new() => (Mark::Edited, "New".to_owned()),
            state => state,
        }
    }
}

impl ZoneDraft {
    fn new(keep_out: &KeepOut) -> Self {
        let corners = KeepOut::corners_deg(&keep_out.zone);
        let margin_deg = keep_out.margin_deg;
        Self {
            name: keep_out.name.clone(),
            reason: keep_out.reason.clone(),
            antenna: keep_out.antenna.clone(),
            entered: keep_out.entered,
            margin: Cell::new(margin_deg, true, &ranges::MARGIN_DEG),
            corners: corners.into_iter().map(|point| Corner::new(point, true)).collect(),
            was: Some(Box::new(keep_out.clone())),
        }
    }

    /// Returns a new keep-out.
    pub(super) fn added(name: String, corners: &[(f64, f64)]) -> Self {
        Self {
            name,
            reason: String::new(),
            antenna: None,
            entered: Entered::Hard,
            margin: Cell::new(KeepOut::DEFAULT_MARGIN_DEG, false, &ranges::MARGIN_DEG),
            corners: corners.iter().map(|point| Corner::new(*point, false)).collect(),
            was: None,
        }
    }

    /// Returns a copy with another name, as a new keep-out.
    pub(super) fn copied(&self, name: String) -> Self {
        let corners: Vec<(f64, f64)> = self.corners.iter().map(Corner::point).collect();
        let mut copy = Self::added(name, &corners);
        copy.margin.set(self.margin.saved);
        let (reason, antenna) = (self.reason.clone(), self.antenna.clone());
        Self { reason, antenna, entered: self.entered, ..copy }
    }

    /// Returns the corners as plotted, degrees.
    pub(super) fn corners_deg(&self) -> Vec<(f64, f64)> {
        self.corners.iter().map(Corner::point).collect()
    }

    /// Returns the zone as plotted, or the reason why the corners make no zone.
    pub(super) fn zone(&self) -> Result<Zone, String> {
        KeepOut::zone_of(&self.corners_deg())
            .map_err(|error| words::capitalised(&error.to_string()))
    }

    /// Returns the keep-out as plotted; `None` if the corners make no zone.
    pub(super) fn keep_out(&self) -> Option<KeepOut> {
        Some(KeepOut {
            name: self.name.trim().to_owned(),
            reason: self.reason.trim().to_owned(),
            entered: self.entered,
            antenna: self.antenna.clone(),
            margin_deg: self.margin.saved,
            zone: self.zone().ok()?,
        })
    }

    pub(super) fn is_new(&self) -> bool {
        self.was.is_none()
    }

    /// Returns the number of changed values.
    pub(super) fn edits(&self) -> usize {
        let Some(was) = &self.was else { return 1 };
        let removed = KeepOut::corners_deg(&was.zone).len().saturating_sub(self.corners.len());
        let corners = self.corners.iter().flat_map(|corner| [&corner.azimuth, &corner.elevation]);
        corners.chain([&self.margin]).filter(|cell| cell.is_edited()).count()
            + usize::from(was.name != self.name)
            + usize::from(was.reason != self.reason)
            + usize::from(was.antenna != self.antenna)
            + usize::from(was.entered != self.entered)
            + removed
    }
}

impl SunDraft {
    fn new(sun: Option<SunAvoidance>) -> Self {
        const DEFAULT_RADIUS_DEG: f64 = 5.0;
        let radius = sun.map_or(DEFAULT_RADIUS_DEG, |sun| sun.radius_deg);
        let ahead = sun.map_or(SunAvoidance::DEFAULT_AHEAD_MIN, |sun| sun.ahead_min);
        Self {
            is_on: sun.is_some(),
            radius: Cell::new(radius, sun.is_some(), &ranges::SUN_RADIUS_DEG),
            ahead: Cell::new(ahead, sun.is_some(), &ranges::SUN_AHEAD_MIN),
        }
    }

    /// Returns the Sun avoidance as plotted; `None` if it is off.
    pub(super) fn saved(&self) -> Option<SunAvoidance> {
        self.is_on
            .then_some(SunAvoidance { radius_deg: self.radius.saved, ahead_min: self.ahead.saved })
    }

    fn problem(&self) -> Option<String> {
        let problem = self.radius.problem().or_else(|| self.ahead.problem());
        problem.filter(|_| self.is_on)
    }
}

impl Skies {
    pub(in crate::ui::preferences) fn new(station: &Station) -> Self {
        Self {
            mask: station.horizon_mask.as_ref().map(ToString::to_string).unwrap_or_default(),
            zones: station.keep_outs.iter().map(ZoneDraft::new).collect(),
            sun: SunDraft::new(station.sun_avoidance),
        }
    }

    /// Returns the mask, or the reason why the text is not a mask.
    pub(super) fn read_mask(&self) -> Result<Option<HorizonMask>, String> {
        if self.mask.trim().is_empty() {
            return Ok(None);
        }
        let (mask, _) = HorizonMask::import(&self.mask).map_err(|error| error.to_string())?;
        Ok(Some(mask))
    }

    /// Returns an unused name for a new keep-out.
    pub(super) fn free_name(&self, expected: &str) -> String {
        let others: Vec<&str> = self.zones.iter().map(|zone| &*zone.name).collect();
        Antenna::free_name(expected, &others)
    }

    /// Returns the problem that prevents saving a keep-out, apart from its number fields.
    pub(super) fn problem_of(&self, index: usize, antennas: &[String]) -> Option<String> {
        let zone = self.zones.get(index)?;
        if zone.name.trim().is_empty() {
            return Some("A keep-out needs a name.".to_owned());
        }
        let mut others = self.zones.iter().enumerate().filter(|(other, _)| *other != index);
        if others.any(|(_, other)| Antenna::same_name(&other.name, &zone.name)) {
            return Some("Another keep-out has this name.".to_owned());
        }
        let is_there =
            |name: &String| antennas.iter().any(|subject| Antenna::same_name(subject, name));
        if let Some(name) = zone.antenna.as_ref().filter(|name| !is_there(name)) {
            return Some(format!("No antenna is called {name}."));
        }
        let before = self.zones.iter().take(index).map(|other| other.corners.len());
        if let Some(reason) = KeepOut::excess(before, zone.corners.len()) {
            return Some(words::sentence(&reason));
        }
        zone.zone().err().map(|reason| format!("{reason}."))
    }

    /// Returns all problems with their places, for the message next to Save.
    fn problems(&self, antennas: &[String]) -> Vec<String> {
        let mut problems = Vec::new();
        if self.read_mask().is_err() {
            problems.push("skyline".to_owned());
        }
        for (index, zone) in self.zones.iter().enumerate() {
            let name = zone.name.trim();
            for (number, corner) in (1..).zip(&zone.corners) {
                if corner.problem().is_some() {
                    problems.push(format!("{name}, corner {number}"));
                }
            }
            if zone.margin.problem().is_some() {
                problems.push(format!("{name}, safety margin"));
            }
            if self.problem_of(index, antennas).is_some() {
                problems.push(if name.is_empty() {
                    "keep-out".to_owned()
                } else {
                    name.to_owned()
                });
            }
        }
        if self.sun.problem().is_some() {
            problems.push("Sun".to_owned());
        }
        problems
    }

    /// Returns the number of values that differ from `before`.
    fn edited(&self, before: &Self) -> usize {
        let removed = before
            .zones
            .iter()
            .filter(|old| !self.zones.iter().any(|new| new.was.is_some() && new.was == old.was));
        usize::from(self.mask != before.mask)
            + self.zones.iter().map(ZoneDraft::edits).sum::<usize>()
            + removed.count()
            + usize::from(self.sun != before.sun)
    }

    /// Writes the draft into `station` if it has no problems. `renamed` contains old and new names
    /// of the antennas.
    fn put_renamed_into(&self, station: &mut Station, renamed: &[(String, String)]) -> Option<()> {
        let mut moved = self.clone();
        for zone in &mut moved.zones {
            let named = zone.antenna.as_ref();
            let found = renamed
                .iter()
                .find(|(before, _)| named.is_some_and(|name| Antenna::same_name(before, name)));
            if let Some((_, now)) = found {
                zone.antenna = Some(now.clone());
            }
        }
        let antennas: Vec<String> = renamed.iter().map(|(_, now)| now.clone()).collect();
        if !moved.problems(&antennas).is_empty() {
            return None;
        }
        station.horizon_mask = moved.read_mask().ok()?;
        station.keep_outs = moved.zones.iter().map(ZoneDraft::keep_out).collect::<Option<_>>()?;
        station.sun_avoidance = moved.sun.saved();
        Some(())
    }
}

impl DraftSection for Skies {
    fn edits(&self, before: &Draft) -> usize {
        self.edited(&before.skies)
    }

    fn findings(&self, draft: &Draft) -> Vec<Finding> {
        let problems = self.problems(&draft.antenna_names()).into_iter();
        problems.map(|label| Finding { label, problem: Problem::new("is not valid") }).collect()
    }

    /// Returns the items of the page by their names.
    fn labels(&self) -> Vec<(Cow<'static, str>, Spot)> {
        let fixed = [("Skyline", Chosen::Skyline), ("Sun avoidance", Chosen::Sun)];
        let zones = self.zones.iter().enumerate();
        let zones =
            zones.map(|(index, zone)| (zone.name.trim().to_owned().into(), Chosen::Zone(index)));
        let all = fixed.map(|(name, chosen)| (name.into(), chosen)).into_iter().chain(zones);
        all.map(|(name, chosen)| (name, Spot::Horizon(chosen))).collect()
    }

    fn put_into(&self, draft: &Draft, station: &mut Station) -> Option<()> {
        self.put_renamed_into(station, &draft.renamed_antennas())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(in crate::ui::preferences) fn mast() -> KeepOut {
        KeepOut {
            name: "mast".to_owned(),
            reason: String::new(),
            entered: Entered::Hard,
            antenna: None,
            margin_deg: 2.25,
            zone: KeepOut::zone_of(&[(350.0, 0.0), (350.0, 16.0), (370.0, 24.0), (370.0, 0.0)])
                .unwrap(),
        }
    }

    fn station() -> Station {
        Station {
            keep_outs: vec![mast()],
            sun_avoidance: Some(SunAvoidance { radius_deg: 5.0, ahead_min: 0.5 }),
            horizon_mask: HorizonMask::parse("0 2\n90 14.25").ok(),
            ..Station::default()
        }
    }

    #[test]
    fn what_was_not_touched_is_put_back_as_it_was() {
        let skies = Skies::new(&station());
        let mut empty = Station::default();
        assert_eq!(skies.put_renamed_into(&mut empty, &[]), Some(()));
        assert_eq!(empty, station());
        assert_eq!(skies.edited(&Skies::new(&station())), 0);
    }

    #[test]
    fn a_wrong_cell_keeps_its_text_and_the_plot_its_value() {
        let mut skies = Skies::new(&station());
        let cell = &mut skies.zones[0].corners[1].elevation;
        "97".clone_into(&mut cell.entry.text);
        cell.take();
        assert!((cell.saved() - 16.0).abs() < 1e-12);
        assert_eq!(cell.problem().unwrap(), "−90 to 90. The plot keeps 16.0°.");
        assert_eq!(skies.problems(&[]), ["mast, corner 2"]);
        assert_eq!(skies.put_renamed_into(&mut Station::default(), &[]), None);
        let cell = &mut skies.zones[0].corners[1].elevation;
        "17,5".clone_into(&mut cell.entry.text);
        cell.take();
        assert_eq!(cell.state(), (Mark::Edited, "Edited, was 16.0".to_owned()));
        assert_eq!(skies.edited(&Skies::new(&station())), 1);
    }

    #[test]
    fn a_keep_out_follows_the_new_name_of_its_antenna_and_misses_a_gone_one() {
        let mut skies = Skies::new(&station());
        skies.zones[0].antenna = Some("Satrak".to_owned());
        let mut renamed =
            Station { antennas: vec![Antenna::satrak("Big dish", "h:4001")], ..Station::default() };
        let names = [("Satrak".to_owned(), "Big dish".to_owned())];
        assert_eq!(skies.put_renamed_into(&mut renamed, &names), Some(()));
        assert_eq!(renamed.keep_outs[0].antenna.as_deref(), Some("Big dish"));
        assert_eq!(skies.put_renamed_into(&mut renamed, &[]), None);
        assert_eq!(skies.problems(&["Big dish".to_owned()]), ["mast"]);
    }

    #[test]
    fn a_station_has_no_more_keep_outs_than_can_be_judged_in_time() {
        let mut skies = Skies::new(&station());
        while skies.zones.len() < KeepOut::MAX_NUMBER {
            let name = skies.free_name("mast");
            let copy = skies.zones[0].copied(name);
            skies.zones.push(copy);
        }
        assert_eq!(skies.problems(&[]), Vec::<String>::new());
        let copy = skies.zones[0].copied("one more".to_owned());
        skies.zones.push(copy);
        assert_eq!(skies.problems(&[]), ["one more"]);
        skies.zones.truncate(KeepOut::MAX_NUMBER);
        let all: usize = skies.zones.iter().map(|zone| zone.corners.len()).sum();
        for _ in all..KeepOut::MAX_CORNERS_IN_ALL {
            let min = skies.zones.iter().position(|zone| zone.corners.len() < 100).unwrap();
            skies.zones[min].split(0).unwrap();
        }
        let limit = "All keep-outs have 800 corners at most.";
        let last = skies.zones.len() - 1;
        assert_ne!(skies.problem_of(last, &[]).as_deref(), Some(limit));
        skies.zones[last].split(0).unwrap();
        assert_eq!(skies.problem_of(last, &[]).as_deref(), Some(limit));
    }

    #[test]
    fn names_are_unique_and_not_empty() {
        let mut skies = Skies::new(&station());
        let name = skies.free_name("mast");
        assert_eq!(name, "mast 2");
        let copy = skies.zones[0].copied(name);
        skies.zones.push(copy);
        assert_eq!(skies.problems(&[]), Vec::<String>::new());
        "MAST ".clone_into(&mut skies.zones[1].name);
        assert_eq!(skies.problems(&[]), ["mast", "MAST"]);
        " ".clone_into(&mut skies.zones[1].name);
        assert_eq!(skies.problems(&[]), ["keep-out"]);
        assert_eq!(skies.edited(&Skies::new(&station())), 1, "a new one");
        skies.zones.clear();
        assert_eq!(skies.edited(&Skies::new(&station())), 1, "one is gone");
    }
}
