//! Reading of saved offsets. The reader omits unreadable offsets with a note, because a default
//! would point an antenna elsewhere.

use toml::{Table, Value};

use super::{TableFields, catalog_number};
use crate::{
    astro::TrackOffsets,
    station::{AntennaId, KeptOffsets, OffsetsSubject},
};

const KINDS: [&str; 5] = ["time_s", "along_deg", "across_deg", "azimuth_deg", "elevation_deg"];

impl TableFields<'_> {
    pub(super) fn kept_offsets(&mut self, antennas: &[AntennaId]) -> Option<KeptOffsets> {
        let mut table = Table::new();
        for kind in KINDS {
            table.extend(self.table.remove(kind).map(|value| (kind.to_owned(), value)));
        }
        let offsets: Result<TrackOffsets, toml::de::Error> = Value::Table(table).try_into();
        let offsets = offsets.map_err(|error| self.invalid("", error.message())).ok()?;
        let satellite = self.table.remove("satellite");
        let antenna = self.table.remove("antenna");
        let subject = match (satellite, antenna) {
            (Some(number), None) => catalog_number(&number).map(OffsetsSubject::Satellite),
            (None, Some(id)) => catalog_number(&id)
                .map(AntennaId)
                .filter(|id| antennas.contains(id))
                .map(OffsetsSubject::Antenna),
            _ => None,
        };
        if subject.is_none() {
            self.invalid("satellite", "must be a catalogue number, or antenna the id of one");
        }
        Some(KeptOffsets { subject: subject?, offsets })
    }
}
