//! Figures of the map in words.

use jiff::Timestamp;

use super::Shown;
use crate::{
    astro::{Angle, GroundPoint},
    model::{
        Model,
        globe::{GlobeSatellite, NextPass},
    },
    ui::format,
};

/// Eight compass directions, clockwise from north.
const WINDS: [&str; 8] =
    ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

/// Formats a place, such as "37.9° N, 41.5° E".
pub(super) fn place(place: GroundPoint) -> String {
    format!("{}, {}", latitude(place), longitude(place))
}

pub(super) fn latitude(place: GroundPoint) -> String {
    format::latitude(place.latitude.degrees(), 1)
}

pub(super) fn longitude(place: GroundPoint) -> String {
    format::longitude(place.longitude.degrees(), 1)
}

/// Returns the second line of the view bar, such as "13 favourites, 2 above the mask at Şile 1".
pub(super) fn summary(model: &Model, shown: Shown) -> String {
    let counted: Vec<_> =
        model.globe.satellites.iter().filter(|satellite| shown.counts(satellite)).collect();
    let up = counted.iter().filter(|satellite| satellite.is_up).count();
    let kind = match (shown, counted.len()) {
        (Shown::Favourites, 1) => "favourite",
        (Shown::Favourites, _) => "favourites",
        (Shown::Tracked, _) => "tracked",
    };
    let (count, lowest) = (counted.len(), lowest(model));
    format!("{count} {kind}, {up} above {lowest} at {}", model.station.name)
}

/// Returns the limit above which a satellite is up: "the mask" or "5°".
fn lowest(model: &Model) -> String {
    if model.station.horizon_mask.is_some() {
        return "the mask".to_owned();
    }
    elevation(model.globe.aos_elevation)
}

/// Formats an elevation of the settings without needless decimals, such as "5°" or "2.5°".
pub(super) fn elevation(elevation: Angle) -> String {
    let degrees = elevation.degrees();
    let is_whole = (degrees - degrees.round()).abs() < 0.05;
    format::degrees(degrees, usize::from(!is_whole))
}

pub(super) fn goes(heading: Option<Angle>) -> &'static str {
    let Some(heading) = heading else { return "stationary" };
    let wind = (heading.wrapped_360().degrees() / 45.0).round() as usize;
    WINDS.get(wind % WINDS.len()).copied().unwrap_or_default()
}

/// Returns [`goes`] with a word that replaces the column head.
pub(super) fn motion(heading: Option<Angle>) -> String {
    let goes = goes(heading);
    if heading.is_some() { format!("heading {goes}") } else { goes.to_owned() }
}

pub(super) fn light(is_sunlit: bool) -> &'static str {
    if is_sunlit { "sunlit" } else { "in shadow" }
}

/// Returns the start of the next pass, or its end once the pass is under way.
pub(super) fn next(satellite: &GlobeSatellite, model: &Model) -> String {
    match satellite.next {
        Some(pass) => times(pass, model.now),
        None => match Search::new(satellite, model) {
            Search::None => "not computed".to_owned(),
            Search::UnderWay => "…".to_owned(),
            Search::Done => "none in 48 h".to_owned(),
        },
    }
}

/// Returns a sentence that there is no later pass, or the reason why none is known.
pub(super) fn no_later_pass(satellite: &GlobeSatellite, model: &Model) -> &'static str {
    match Search::new(satellite, model) {
        Search::None => "Passes are computed for favourites only.",
        Search::UnderWay => "Passes are being computed.",
        Search::Done => "No later pass in the next 48 h.",
    }
}

/// State of the search for the passes of a satellite.
enum Search {
    None,
    UnderWay,
    Done,
}

impl Search {
    fn new(new: &GlobeSatellite, model: &Model) -> Self {
        let list = &model.pass_lists.favourites;
        let mut listed =
            list.satellites.iter().map(|satellite| satellite.elements.catalog_number());
        match () {
            () if !new.is_favourite => Self::None,
            () if list.made_at.is_some() && listed.any(|number| number == new.number()) => {
                Self::Done
            }
            () => Self::UnderWay,
        }
    }
}

fn times(pass: NextPass, now: Timestamp) -> String {
    if pass.is_always_up {
        "always up".to_owned()
    } else if pass.aos <= now {
        format!("until {}", format::minute(pass.los, now))
    } else {
        format::minute(pass.aos, now)
    }
}

/// Returns the tooltip of a satellite.
pub(super) fn tip(satellite: &GlobeSatellite, model: &Model) -> String {
    let direction = satellite.look.direction;
    format!(
        "{}\n{}\nHeight {}\nAz {}  El {}\nNext: {}",
        satellite.satellite.short_name(),
        place(satellite.below.point),
        format::distance(satellite.below.height_km, 0, model.appearance.distances),
        format::azimuth(direction.azimuth_deg()),
        format::degrees(direction.elevation_deg(), 1),
        next(satellite, model),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_has_its_wind() {
        for (degrees, expected) in [
            (0.0, "north"),
            (350.0, "north"),
            (359.9, "north"),
            (44.0, "north-east"),
            (190.0, "south"),
        ] {
            assert_eq!(goes(Some(Angle::from_degrees(degrees))), expected, "{degrees}");
        }
        assert_eq!(goes(None), "stationary");
    }

    #[test]
    fn a_pass_of_another_day_has_its_date() {
        let now: Timestamp = "2026-11-14T18:13:40Z".parse().unwrap();
        let pass = |aos: &str, los: &str| NextPass {
            aos: aos.parse().unwrap(),
            los: los.parse().unwrap(),
            max_elevation: Angle::from_degrees(38.0),
            is_always_up: false,
        };
        let today = pass("2026-11-14T23:20Z", "2026-11-14T23:31:00Z");
        assert_eq!(times(today, now), "23:20Z");
        let running = pass("2026-11-14T18:08:00Z", "2026-11-14T18:21Z");
        assert_eq!(times(running, now), "until 18:21Z");
        let tomorrow = pass("2026-11-15T00:13:10Z", "2026-11-15T00:20:00Z");
        assert_eq!(times(tomorrow, now), "15 Nov 00:13Z");
        let standing = NextPass { is_always_up: true, ..running };
        assert_eq!(times(standing, now), "always up");
    }

    #[test]
    fn an_elevation_has_no_needless_decimals() {
        let text = |degrees| elevation(Angle::from_degrees(degrees));
        assert_eq!((text(5.0), text(2.5), text(0.0)), ("5°".into(), "2.5°".into(), "0°".into()));
    }
}
