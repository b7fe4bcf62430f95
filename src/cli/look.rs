//! Look angles of one satellite in steps, from the same elements as `azel passes`.

use std::{path::Path, process::ExitCode};

use anyhow::{Context as _, bail};
use clap::Args;
use jiff::Timestamp;

use super::{
    input::{self, EXIT_CODES, Elevations, InputOptions, Satellites},
    passes::{LEFT_OUT, written},
};
use crate::{
    astro::time,
    export::{ListFormat, LookList, Satellite},
};

/// Maximum number of names listed if several satellites match.
const MAX_NAMED: usize = 10;

/// Refraction in look angles, for `--help`.
const APPARENT: &str = "Directions are apparent, where an antenna has to point: with the refraction \
    of radio waves by the air of the station, or else by standard air. With --elevations geometric \
    refraction is left out.";

#[derive(Debug, Args)]
#[command(after_help = format!("{APPARENT} {LEFT_OUT}\n\n{EXIT_CODES}"))]
pub(super) struct Options {
    #[command(flatten)]
    input: InputOptions,
    /// First instant: `now`, a date (0 h UTC), or a time with Z or an offset
    #[arg(long = "from", value_name = "TIME", default_value = "now", value_parser = input::instant)]
    start: Timestamp,
    /// How long, in minutes
    #[arg(long, value_name = "MIN", default_value_t = 15.0, value_parser = input::minutes, allow_negative_numbers = true)]
    minutes: f64,
    /// Seconds from one row to the next
    #[arg(long, value_name = "S", default_value_t = 10.0, value_parser = input::step_s, allow_negative_numbers = true)]
    step: f64,
    /// With refraction or without; apparent, or as the station sets it, when left out
    #[arg(long, value_enum, value_name = "KIND")]
    elevations: Option<Elevations>,
    /// Add the Doppler shift of this frequency, sent by the satellite
    #[arg(long, value_name = "MHZ", value_parser = input::megahertz, allow_negative_numbers = true)]
    doppler: Option<f64>,
    /// How the look angles are written
    #[arg(long, value_enum, default_value_t = ListFormat::Table)]
    format: ListFormat,
}

pub(super) fn run(station: Option<&Path>, options: &Options) -> anyhow::Result<ExitCode> {
    options.input.check("look", station)?;
    let site = options.input.place(station)?.site;
    let site = options.elevations.map_or(site, |kind| kind.in_looks(site));
    let Satellites { list, is_complete } = options.input.satellites(station, options.start)?;
    let [satellite] = &list[..] else { bail!("{}", too_many(&list)) };
    let (start, length_s) = (options.start, options.minutes * 60.0);
    input::caution(&list, start, time::add_seconds(start, length_s));
    if let Err(error) = satellite.propagator.state_at(start) {
        bail!("{}: {error}", satellite.elements.label());
    }
    let list = LookList {
        satellite,
        site,
        start,
        // Rounding of the division must not cost the last row.
        count: (length_s / options.step + 1e-9) as u32 + 1,
        step_s: options.step,
        carrier_hz: options.doppler.map(|megahertz| megahertz * 1e6),
    };
    written(|out| list.write(out, options.format)).context("The look angles cannot be written")?;
    Ok(input::exit_code(is_complete))
}

fn too_many(list: &[Satellite]) -> String {
    let named = list.iter().take(MAX_NAMED).map(|satellite| {
        let elements = &satellite.elements;
        format!("{} {}", elements.catalog_number(), elements.name()).trim_end().to_owned()
    });
    let named: Vec<String> = named.collect();
    let more = if list.len() > MAX_NAMED { ", ..." } else { "" };
    format!(
        "{} satellites are meant, and one is looked at; --catalog-number names it: {}{more}",
        list.len(),
        named.join(", ")
    )
}
