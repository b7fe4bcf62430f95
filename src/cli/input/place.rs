//! Site of the command line, completed from a station file.

use std::{fs, path::Path};

use anyhow::{Context as _, anyhow, bail};

use super::InputOptions;
use crate::{
    astro::{Angle, Refraction, Site},
    controller::SPECS,
    station::{self, NoteReason, Station},
};

/// Site, and the elevations that a pass must reach there.
pub(in crate::cli) struct Place {
    pub(in crate::cli) site: Site,
    pub(in crate::cli) name: Option<String>,
    /// Elevation of AOS and LOS at the station; the horizon without a station.
    pub(in crate::cli) aos_elevation: Angle,
    /// Elevation that a pass of the station must reach.
    pub(in crate::cli) floor: Angle,
}

/// Settings whose default must not be used silently, by the beginnings of their paths. The
/// first antenna sets the elevation of AOS.
const NEEDED: [&str; 3] =
    ["elevation_floor_deg", "antenna[0].limits.minimum_elevation_deg", "antenna[0].connection"];

impl InputOptions {
    /// Site of the command line, with missing values from `station`.
    pub(in crate::cli) fn place(&self, station: Option<&Path>) -> anyhow::Result<Place> {
        let own = [self.lat, self.lon, self.alt];
        let is_whole = own.iter().all(Option::is_some);
        let station = station.map(|path| read_station(path, !is_whole)).transpose()?;
        let of_station = station.as_ref().map(|station| station.site);
        let [lat, lon, alt] = own;
        let or_station = |value: Option<f64>, default_at: &dyn Fn(Site) -> f64| {
            value.or_else(|| of_station.map(default_at)).context("The site is not known.")
        };
        let site = Site::new(
            or_station(lat, &|site| site.latitude().degrees())?,
            or_station(lon, &|site| site.longitude().degrees())?,
            or_station(alt, &Site::altitude_m)?,
        )?
        .with_refraction(of_station.map_or_else(Refraction::default, Site::refraction))?;
        Ok(Place {
            site,
            aos_elevation: station.as_ref().map_or(Angle::ZERO, Station::aos_elevation),
            floor: station.as_ref().map_or(Angle::ZERO, Station::elevation_floor),
            name: station.map(|station| station.name),
        })
    }
}

fn read_station(path: &Path, needs_site: bool) -> anyhow::Result<Station> {
    let unusable = || format!("The station file {} cannot be used", path.display());
    let loaded = station::load(path, SPECS).with_context(unusable)?;
    let is_needed = |place: &str| {
        NEEDED.iter().any(|needed| place.starts_with(needed))
            || (needs_site && place.starts_with("site"))
    };
    for note in &loaded.notes {
        if let (true, NoteReason::Invalid(reason)) = (is_needed(&note.place), &note.reason) {
            return Err(anyhow!("{}: {reason}", note.place)).with_context(unusable);
        }
    }
    // If it is missing the reader uses the default, which is right only for a window that
    // shows it.
    let table: toml::Table = toml::from_str(&fs::read_to_string(path)?)?;
    if needs_site && !table.contains_key("site") {
        bail!("{}: it has no site", unusable());
    }
    Ok(loaded.station)
}
