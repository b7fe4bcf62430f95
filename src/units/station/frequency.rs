//! Frequencies of satellites, for their Doppler shift.

use serde::{Deserialize, Serialize};

use super::ranges;
use crate::device::settings::{Unfit, number};

/// A carrier of a satellite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frequency {
    /// Catalog number of the satellite.
    pub satellite: u32,
    pub mhz: f64,
    /// Name of the carrier, such as `HRD`; may be empty.
    pub name: String,
}

impl Frequency {
    /// Returns frequencies as the operator types them: a catalogue number, MHz and a name on each
    /// line.
    pub fn list_text(list: &[Self]) -> String {
        let line = |frequency: &Self| {
            format!("{} {} {}", frequency.satellite, frequency.mhz, frequency.name)
        };
        list.iter()
            .map(|frequency| line(frequency).trim_end().to_owned())
            .collect::<Vec<_>>()
            .join("\n")
    }

    /// Reads frequencies in the form of [`Self::list_text`].
    pub fn read_list(text: &str) -> Result<Vec<Self>, Unfit> {
        let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let read = lines.map(|(index, line)| {
            Self::read_line(line).ok_or_else(|| {
                Unfit::Text(format!(
                    "line {} must be a catalogue number, MHz and a name, such as 25544 145.8 Voice",
                    index + 1
                ))
            })
        });
        read.collect()
    }

    fn read_line(line: &str) -> Option<Self> {
        let (satellite, rest) = line.trim().split_once(char::is_whitespace)?;
        let rest = rest.trim();
        let (mhz, name) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
        let mhz = number(mhz).filter(|mhz| ranges::FREQUENCY_MHZ.contains(mhz))?;
        Some(Self { satellite: satellite.parse().ok()?, mhz, name: name.trim().to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back_and_a_wrong_line_is_named() {
        let frequency =
            |satellite, mhz, name: &str| Frequency { satellite, mhz, name: name.to_owned() };
        let list = vec![
            frequency(25_544, 145.8, "Voice"),
            frequency(43_013, 7812.0, "HRD, X band"),
            frequency(1, 1.5, ""),
        ];
        assert_eq!(Frequency::read_list(&Frequency::list_text(&list)), Ok(list));
        assert_eq!(
            Frequency::read_list("\n 25544\t145,8 \n"),
            Ok(vec![frequency(25_544, 145.8, "")])
        );
        for (text, line) in [("x 145.8", 1), ("25544 145.8\n25544", 2), ("25544 -3", 1)] {
            let message = Frequency::read_list(text).unwrap_err().to_string();
            assert!(message.starts_with(&format!("line {line} ")), "{text}: {message}");
        }
    }
}
