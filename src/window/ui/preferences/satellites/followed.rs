//! Fields of the satellites that the station follows.

use crate::{
    device::settings::{Kind, Value},
    station::{Favourites, Frequency, Station},
    ui::preferences::fields::{Description, Placed, placed},
};

type FollowedDescription = Description<Followed>;

/// Titles of the cards of these fields.
const SATELLITES: &str = "Satellites";
const FREQUENCIES: &str = "Frequencies";

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Followed {
    pub(super) favourites: Favourites,
    pub(super) frequencies: Vec<Frequency>,
}

impl Followed {
    pub(super) fn new(station: &Station) -> Self {
        Self { favourites: station.favourites.clone(), frequencies: station.frequencies.clone() }
    }
}

pub(super) fn fields() -> Vec<Placed<Followed>> {
    let mut all = placed(SATELLITES, [satellites()]);
    all.extend(placed(FREQUENCIES, [frequencies()]));
    all
}

fn satellites() -> FollowedDescription {
    FollowedDescription::new(
        "Satellites",
        Kind::Text(|_| Ok(())),
        |followed| Some(Value::Text(favourites(followed))),
        put_favourites,
    )
    .wrapped()
    .described("The favourites, by their catalogue numbers.")
}

fn frequencies() -> FollowedDescription {
    FollowedDescription::new(
        "Frequencies",
        Kind::Text(|text| Frequency::read_list(text).map(drop)),
        |followed| Some(Value::Text(Frequency::list_text(&followed.frequencies))),
        |followed, value| {
            if let Value::Text(text) = value {
                followed.frequencies =
                    Frequency::read_list(&text).map_err(|reason| reason.to_string())?;
            }
            Ok(())
        },
    )
    .of_lines("Number, MHz, name, one per line")
    .described("For the Doppler shift; a satellite may have several.")
}

/// Returns the catalog numbers, separated by commas.
fn favourites(followed: &Followed) -> String {
    let numbers: Vec<String> = followed.favourites.numbers().iter().map(u32::to_string).collect();
    numbers.join(", ")
}

fn put_favourites(followed: &mut Followed, value: Value) -> Result<(), String> {
    let Value::Text(text) = value else { return Ok(()) };
    let parts = text.split(',').map(str::trim).filter(|part| !part.is_empty());
    let numbers: Option<Vec<u32>> =
        parts.map(|part| part.parse().ok().filter(|number| *number <= 999_999_999)).collect();
    let numbers =
        numbers.ok_or("must be catalogue numbers separated by commas, such as 43013, 25544")?;
    followed.favourites = followed.favourites.with_numbers(&numbers);
    Ok(())
}
