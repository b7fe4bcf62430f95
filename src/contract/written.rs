//! Serialisation of those parts of snapshots and commands whose types need the list of makes.

/// Serialisation of a station, as in its file.
pub mod station {
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

    use crate::{
        controller::SPECS,
        station::{Station, from_toml},
    };

    pub fn serialize<S: Serializer>(station: &Station, serializer: S) -> Result<S::Ok, S::Error> {
        station.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>, T: From<Station>>(
        deserializer: D,
    ) -> Result<T, D::Error> {
        let (station, notes) = from_toml(toml::Table::deserialize(deserializer)?, SPECS);
        match notes.first() {
            None => Ok(station.into()),
            Some(note) => Err(D::Error::custom(format!("{note:?}"))),
        }
    }
}

/// Serialisation of an antenna, as in the station file.
pub mod antenna {
    use serde::{Deserializer, Serialize, Serializer, de::Error as _};

    use crate::station::{Antenna, Station};

    #[derive(Serialize)]
    struct Alone<'a> {
        antenna: [&'a Antenna; 1],
    }

    pub fn serialize<S: Serializer>(antenna: &Antenna, serializer: S) -> Result<S::Ok, S::Error> {
        Alone { antenna: [antenna] }.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>, T: From<Antenna>>(
        deserializer: D,
    ) -> Result<T, D::Error> {
        let mut station: Station = crate::written::station::deserialize(deserializer)?;
        let antenna = station.antennas.pop();
        antenna.map(T::from).ok_or_else(|| D::Error::custom("there is no antenna"))
    }
}

/// Serialisation of the element files of a make, as the key of the make.
pub mod element_files {
    use serde::{Deserialize, Deserializer, Serializer, de::Error as _, ser::Error as _};

    use crate::{controller::SPECS, device::ElementFiles};

    pub fn serialize<S: Serializer>(
        takes: &'static ElementFiles,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let make = SPECS.iter().find(|make| make.element_files == Some(takes));
        serializer
            .serialize_str(make.ok_or_else(|| S::Error::custom("no make takes files so"))?.key)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<&'static ElementFiles, D::Error> {
        let key = String::deserialize(deserializer)?;
        let make = SPECS.iter().find(|make| make.key == key);
        make.and_then(|make| make.element_files)
            .ok_or_else(|| D::Error::custom(format!("{key} takes no files of elements")))
    }
}
