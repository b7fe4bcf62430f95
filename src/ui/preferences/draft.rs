//! The station as typed: nothing is lost by a typing error, and nothing is
//! used before all of it is right.

use crate::{
    astro::{HorizonMask, MaskTextError, Site},
    station::{
        Antenna, Connection, Direction, MotionLimits, Mount, PollRates, Station, check_address,
    },
};

/// What may stand in a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Text,
    /// May stay empty.
    OptionalText,
    Address,
    /// Catalogue numbers, with commas between.
    Numbers,
    /// Azimuth and elevation of a horizon mask, one point a line. May stay empty.
    Mask,
    Range {
        low: f64,
        high: f64,
        unit: &'static str,
    },
}

impl Kind {
    /// The unit that stands behind the field.
    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::Range { unit, .. } => unit,
            _ => "",
        }
    }
}

/// One line of the form.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Field {
    pub(super) label: &'static str,
    pub(super) kind: Kind,
    pub(super) text: String,
}

impl Field {
    fn new(label: &'static str, kind: Kind, text: impl std::fmt::Display) -> Self {
        Self { label, kind, text: format!("{text}") }
    }

    /// Why the text cannot be used.
    pub(super) fn problem(&self) -> Option<String> {
        match self.kind {
            Kind::Text if self.text.trim().is_empty() => Some("must not be empty".to_owned()),
            Kind::Text | Kind::OptionalText => None,
            Kind::Address => check_address(self.text.trim()).err().map(str::to_owned),
            Kind::Numbers => self.numbers().is_none().then(|| {
                "must be catalogue numbers with commas between, such as 43013, 25544".to_owned()
            }),
            Kind::Mask => self.mask().err().map(|error| mask_problem(&error)),
            Kind::Range { low, high, unit } => self.number().is_none().then(|| {
                let gap = if unit == "°" { "" } else { " " };
                format!("must be a number from {low} to {high}{gap}{unit}").replace('-', "−")
            }),
        }
    }

    fn number(&self) -> Option<f64> {
        let Kind::Range { low, high, .. } = self.kind else { return None };
        let number: f64 = self.text.trim().replace(',', ".").replace('−', "-").parse().ok()?;
        (low..=high).contains(&number).then_some(number)
    }

    /// The horizon mask, and none for an empty text.
    fn mask(&self) -> Result<Option<HorizonMask>, MaskTextError> {
        if self.text.trim().is_empty() {
            return Ok(None);
        }
        HorizonMask::parse(&self.text).map(Some)
    }

    fn numbers(&self) -> Option<Vec<u32>> {
        let parts = self.text.split(',').map(str::trim).filter(|part| !part.is_empty());
        parts.map(|part| part.parse().ok().filter(|number| *number <= 999_999_999)).collect()
    }
}

/// Why a text is no mask, to stand behind the name of its field.
fn mask_problem(error: &MaskTextError) -> String {
    match error {
        MaskTextError::Format { line } => {
            format!("line {line} must be an azimuth and an elevation, such as 120 8.5")
        }
        MaskTextError::Point { .. } => error.to_string().replace('-', "−"),
        MaskTextError::Mask(_) => "must hold points, such as 120 8.5, or nothing".to_owned(),
    }
}

/// The whole form.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Draft {
    pub(super) station: [Field; 7],
    pub(super) antennas: Vec<[Field; 14]>,
}

impl Draft {
    pub(super) fn of(station: &Station) -> Self {
        let range = |low, high, unit| Kind::Range { low, high, unit };
        let favourites: Vec<String> = station.favourites.iter().map(u32::to_string).collect();
        let site = station.site;
        let mask = station.horizon_mask.as_ref().map(HorizonMask::to_string);
        Self {
            station: [
                Field::new("Name", Kind::Text, &station.name),
                Field::new("Latitude", range(-90.0, 90.0, "°"), rounded(site.latitude().degrees())),
                Field::new(
                    "Longitude, east",
                    range(-180.0, 360.0, "°"),
                    rounded(site.longitude().degrees()),
                ),
                Field::new("Altitude", range(-1000.0, 10_000.0, "m"), site.altitude_m()),
                Field::new("Elevation floor", range(0.0, 89.0, "°"), station.elevation_floor_deg),
                Field::new("Satellites", Kind::Numbers, favourites.join(", ")),
                Field::new("Horizon mask", Kind::Mask, mask.unwrap_or_default()),
            ],
            antennas: station.antennas.iter().map(fields_of).collect(),
        }
    }

    /// One more antenna, to be filled in.
    pub(super) fn add_antenna(&mut self) {
        let names: Vec<&str> = self.antennas.iter().map(|[name, ..]| &*name.text).collect();
        let name = Antenna::free_name("Satrak", &names);
        self.antennas.push(fields_of(&Antenna::satrak(&name, "192.168.10.21:4001")));
    }

    /// Why each field of an antenna cannot be used.
    pub(super) fn antenna_problems(&self, index: usize) -> Vec<Option<String>> {
        let Some(fields) = self.antennas.get(index) else { return Vec::new() };
        let mut problems: Vec<Option<String>> = fields.iter().map(Field::problem).collect();
        if let (Some(None), Some(twin)) = (problems.first(), self.twin(index)) {
            let clash = format!("must differ from that of antenna {}", twin + 1);
            problems.splice(..1, [Some(clash)]);
        }
        problems
    }

    /// Another antenna with the name of this one.
    fn twin(&self, index: usize) -> Option<usize> {
        let [name, ..] = self.antennas.get(index)?;
        self.antennas.iter().enumerate().position(|(other, [other_name, ..])| {
            other != index && Antenna::same_name(&other_name.text, &name.text)
        })
    }

    /// The station, when every field is right.
    pub(super) fn read(&self) -> Option<Station> {
        if (0..self.antennas.len()).any(|index| self.twin(index).is_some()) {
            return None;
        }
        let [name, latitude, longitude, altitude, floor, favourites, mask] = &self.station;
        Some(Station {
            name: text(name)?,
            site: Site::new(latitude.number()?, longitude.number()?, altitude.number()?).ok()?,
            horizon_mask: mask.mask().ok()?,
            elevation_floor_deg: floor.number()?,
            favourites: favourites.numbers()?,
            antennas: self.antennas.iter().map(read_antenna).collect::<Option<_>>()?,
        })
    }
}

/// Enough digits for a centimetre, without the noise of the conversion.
fn rounded(degrees: f64) -> f64 {
    (degrees * 1e7).round() / 1e7
}

fn fields_of(antenna: &Antenna) -> [Field; 14] {
    let range = |low, high, unit| Kind::Range { low, high, unit };
    let Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, travel_to_deg } = antenna.mount else {
        return fields_of(&Antenna::satrak("", ""));
    };
    let Connection::Satrak { address, element_file } = &antenna.connection else {
        return fields_of(&Antenna::satrak("", ""));
    };
    let limits = antenna.limits;
    [
        Field::new("Name", Kind::Text, &antenna.name),
        Field::new("Address of the Satrak", Kind::Address, address),
        Field::new("Element file on the unit", Kind::OptionalText, element_file),
        Field::new("Azimuth of the lower axis", range(0.0, 180.0, "°"), lower_axis_azimuth_deg),
        Field::new("Travel from", range(-180.0, 90.0, "°"), travel_from_deg),
        Field::new("Travel to", range(90.0, 360.0, "°"), travel_to_deg),
        Field::new("Beam width", range(0.01, 180.0, "°"), antenna.beam_width_deg),
        Field::new("Park azimuth", range(0.0, 360.0, "°"), antenna.park.azimuth_deg),
        Field::new("Park elevation", range(0.0, 90.0, "°"), antenna.park.elevation_deg),
        Field::new("Minimum elevation", range(0.0, 90.0, "°"), limits.minimum_elevation_deg),
        Field::new("Maximum rate", range(0.01, 30.0, "°/s"), limits.maximum_rate_deg_s),
        Field::new("Maximum step", range(0.01, 90.0, "°"), limits.maximum_step_deg),
        Field::new("Poll while standing", range(2.0, 10.0, "Hz"), antenna.poll.idle_hz),
        Field::new("Poll while moving", range(2.0, 10.0, "Hz"), antenna.poll.moving_hz),
    ]
}

fn read_antenna(fields: &[Field; 14]) -> Option<Antenna> {
    let [
        name,
        address,
        element_file,
        lower_axis,
        travel_from,
        travel_to,
        beam,
        park_azimuth,
        park_elevation,
        minimum_elevation,
        maximum_rate,
        maximum_step,
        idle,
        moving,
    ] = fields;
    if address.problem().is_some() {
        return None;
    }
    Some(Antenna {
        name: text(name)?,
        connection: Connection::Satrak {
            address: address.text.trim().to_owned(),
            element_file: element_file.text.trim().to_owned(),
        },
        mount: Mount::Xy {
            lower_axis_azimuth_deg: lower_axis.number()?,
            travel_from_deg: travel_from.number()?,
            travel_to_deg: travel_to.number()?,
        },
        beam_width_deg: beam.number()?,
        park: Direction {
            azimuth_deg: park_azimuth.number()?,
            elevation_deg: park_elevation.number()?,
        },
        limits: MotionLimits {
            minimum_elevation_deg: minimum_elevation.number()?,
            maximum_rate_deg_s: maximum_rate.number()?,
            maximum_step_deg: maximum_step.number()?,
        },
        poll: PollRates { idle_hz: idle.number()?, moving_hz: moving.number()? },
        ..Antenna::satrak("", "")
    })
}

fn text(field: &Field) -> Option<String> {
    let text = field.text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_touched_comes_back_as_it_was() {
        let horizon_mask = HorizonMask::parse("0 2.5\n120 -0.3\n240.25 11").ok();
        let station = Station { horizon_mask, ..Station::demo("127.0.0.1:4001") };
        assert_eq!(Draft::of(&station).read(), Some(station));
    }

    #[test]
    fn a_wrong_field_says_why_and_keeps_the_typing() {
        let mut draft = Draft::of(&Station::demo("127.0.0.1:4001"));
        for (index, typed) in [(1, "91"), (1, "x"), (3, ""), (5, "25544, NOAA"), (6, "0 2\n90")] {
            let before = draft.clone();
            draft.station[index].text = typed.to_owned();
            assert!(draft.station[index].problem().is_some(), "{typed}");
            assert_eq!(draft.read(), None);
            draft = before;
        }
        draft.antennas[0][1].text = "nowhere".to_owned();
        assert_eq!(draft.read(), None);
        assert_eq!(draft.antennas[0][1].text, "nowhere");
    }

    #[test]
    fn a_decimal_comma_is_understood() {
        let mut draft = Draft::of(&Station::default());
        draft.station[1].text = "41,5".to_owned();
        let site = draft.read().unwrap().site;
        assert!((site.latitude().degrees() - 41.5).abs() < 1e-9);
    }
}
