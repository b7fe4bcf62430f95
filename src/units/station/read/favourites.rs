//! Reading of favourites and groups of satellites with their priorities and limits.

use toml::Value;

use super::{TableFields, catalog_number};
use crate::station::{
    AntennaId, Favourite, Favourites, Light, PassLimits, Priority, SatelliteGroup, ranges,
};

impl TableFields<'_> {
    pub(super) fn favourites(&mut self, default: Favourites, antennas: &[AntennaId]) -> Favourites {
        let entries = match self.table.remove("favourites") {
            None => return default,
            Some(Value::Array(entries)) => entries,
            Some(_) => {
                self.invalid("favourites", "must be a list of catalogue numbers");
                return default;
            }
        };
        let mut favourites = Favourites::default();
        for (index, entry) in entries.into_iter().enumerate() {
            let place = format!("favourites[{index}]");
            match entry {
                Value::Table(table) => {
                    let read = self.entry(&place, table, |fields| fields.favourite(antennas));
                    match read {
                        Some(favourite) => favourites.put(favourite),
                        None => self.leave_out(&place),
                    }
                }
                number => {
                    if let Some(satellite) = catalog_number(&number) {
                        favourites.mark(satellite, true);
                    } else {
                        self.invalid(&place, "must be a catalogue number");
                        self.leave_out(&place);
                    }
                }
            }
        }
        favourites
    }

    fn favourite(&mut self, antennas: &[AntennaId]) -> Option<Favourite> {
        let (priority, limits) = (self.priority(), self.pass_limits(antennas));
        let sources = self.sources();
        Some(Favourite { satellite: self.satellite()?, priority, limits, sources })
    }

    /// Reads names of sources, each once. Another file lists the sources, so any name is valid.
    fn sources(&mut self) -> Vec<String> {
        const KEY: &str = "sources";
        let Some(value) = self.table.remove(KEY) else { return Vec::new() };
        let Ok(entries) = value.try_into::<Vec<String>>() else {
            self.invalid(KEY, "must be a list of names of element sources");
            return Vec::new();
        };
        let mut names: Vec<String> = Vec::new();
        for name in entries {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    /// Reads a group. Omits a group without a name, because rules could not name it.
    pub(super) fn satellite_group(&mut self, antennas: &[AntennaId]) -> Option<SatelliteGroup> {
        let group = SatelliteGroup {
            name: self.text("name", ""),
            satellites: self.catalog_numbers("satellites", Vec::new()),
            priority: self.priority(),
            limits: self.pass_limits(antennas),
        };
        if group.name.is_empty() {
            self.invalid("name", "must be a text that is not empty");
        }
        Some(group).filter(|group| !group.name.is_empty())
    }

    fn priority(&mut self) -> Option<Priority> {
        let number = self.table.remove("priority")?.as_integer().unwrap_or_default();
        Priority::try_from(number)
            .map_err(|no_priority| self.invalid("priority", no_priority.to_string()))
            .ok()
    }

    fn pass_limits(&mut self, antennas: &[AntennaId]) -> PassLimits {
        let light = [
            ("day", Some(Light::Day)),
            ("night", Some(Light::Night)),
            ("sunlit", Some(Light::Sunlit)),
        ];
        PassLimits {
            min_max_elevation_deg: self.optional("min_max_elevation_deg", &ranges::ELEVATION_DEG),
            min_duration_s: self.optional("min_duration_s", &ranges::MIN_DURATION_S),
            light: self.one_of("light", &light, None),
            antennas: self.antennas_of_limits(antennas),
            max_per_day: self
                .optional("max_per_day", &ranges::PASSES_PER_DAY)
                .map(|number| number as u32),
        }
    }

    /// Reads the antennas of a limit. Omits unknown antennas with a note. If no antenna remains,
    /// none may take the passes, because a limit must not become wider.
    fn antennas_of_limits(&mut self, antennas: &[AntennaId]) -> Option<Vec<AntennaId>> {
        const KEY: &str = "antennas";
        let ids: Result<Vec<u32>, toml::de::Error> = self.table.remove(KEY)?.try_into();
        let Ok(ids) = ids else {
            self.invalid(KEY, "must be a list of ids of antennas");
            return None;
        };
        let (valid, unknown): (Vec<_>, Vec<_>) =
            ids.into_iter().map(AntennaId).partition(|id| antennas.contains(id));
        if !unknown.is_empty() {
            self.invalid(KEY, "names an antenna that the station does not have");
        }
        Some(valid)
    }
}
