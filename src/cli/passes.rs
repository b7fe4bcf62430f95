//! Predicts passes from element files, for the terminal and for other programs.

mod input;
mod progress;

use std::{
    io::{self, BufWriter, Write as _},
    path::PathBuf,
    process::ExitCode,
};

use anyhow::Context as _;
use clap::Args;
use jiff::Timestamp;

use self::{input::Input, progress::Progress};
use crate::{
    astro::{Angle, HorizonMask, Site, time},
    orbit::{Pass, PassSearch, clear_stretches, passes_of_all},
    plan::pass_export::{ExportedPass, PassFormat, write_passes},
};

/// Passes were written, but some object was refused.
const SOME_REFUSED: u8 = 3;

#[derive(Debug, Args)]
#[command(after_help = "Exit code: 0 when every object was used, 3 when some were refused \
    (each is named on standard error), 1 when nothing could be done, 2 for a wrong command line.")]
pub(super) struct Options {
    /// Element files: TLE, or OMM in JSON, CSV, XML or KVN; `-` reads standard
    /// input. The newest set of an object is used
    #[arg(long, value_name = "FILE", num_args = 1.., required = true)]
    elements: Vec<PathBuf>,
    /// Latitude of the site in degrees, north positive
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    lat: f64,
    /// Longitude of the site in degrees, east positive
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    lon: f64,
    /// Altitude of the site above the WGS84 ellipsoid in metres
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    alt: f64,
    /// Only these objects
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    catalog_number: Vec<u32>,
    /// Start of the window, such as 2026-08-12T00:00:00Z; now when left out
    #[arg(long, value_name = "RFC3339")]
    from: Option<Timestamp>,
    /// Length of the window in hours
    #[arg(long, value_name = "H", default_value_t = 24.0, value_parser = hours, allow_negative_numbers = true)]
    hours: f64,
    /// Leave out passes whose maximum elevation stays below this
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = elevation, allow_negative_numbers = true)]
    floor: f64,
    /// Elevation of AOS and LOS
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = elevation, allow_negative_numbers = true)]
    aos: f64,
    /// Horizon mask: lines of azimuth and elevation in degrees. Each stretch of
    /// a pass that clears it is a row of its own
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Threads to compute with; as many as there are cores when left out
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    threads: Option<u16>,
    /// How the passes are written
    #[arg(long, value_enum, default_value_t = PassFormat::Table)]
    format: PassFormat,
}

fn hours(text: &str) -> Result<f64, String> {
    let hours: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    let most = 24.0 * 366.0;
    if hours > 0.0 && hours <= most {
        Ok(hours)
    } else {
        Err(format!("not between 0 and {most} hours"))
    }
}

fn elevation(text: &str) -> Result<f64, String> {
    let degrees: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (-90.0..=90.0).contains(&degrees) {
        Ok(degrees)
    } else {
        Err("not between -90 and 90 degrees".to_owned())
    }
}

pub(super) fn run(options: &Options) -> anyhow::Result<ExitCode> {
    let now = Timestamp::now();
    let from = options.from.unwrap_or(now);
    let search = PassSearch {
        site: Site::new(options.lat, options.lon, options.alt)?,
        from,
        to: time::add_seconds(from, options.hours * 3600.0),
        aos_elevation: Angle::from_degrees(options.aos),
        floor: Angle::from_degrees(options.floor),
    };
    let mask = options.mask.as_ref().map(read_mask).transpose()?;
    let threads = options.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;

    let Input { satellites, any_refused } =
        input::read(&options.elements, &options.catalog_number)?;
    let progress = Progress::new(satellites.len());
    let found = pool.install(|| {
        let found = passes_of_all(&satellites, &search, &|done| progress.show(done), &|| false);
        match &mask {
            Some(mask) => clear_of(mask, &search, &satellites, found),
            None => found.collect(),
        }
    });
    progress.end();

    let mut rows: Vec<_> = found
        .iter()
        .filter_map(|(index, pass)| {
            Some(ExportedPass { elements: &satellites.get(*index)?.elements, pass })
        })
        .collect();
    rows.sort_by_key(|row| (row.pass.aos.time, row.elements.catalog_number()));
    write(options.format, &rows, now).context("The passes cannot be written")?;
    Ok(if any_refused { ExitCode::from(SOME_REFUSED) } else { ExitCode::SUCCESS })
}

fn read_mask(path: &PathBuf) -> anyhow::Result<HorizonMask> {
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("The horizon mask {} cannot be read", path.display()))?;
    HorizonMask::parse(&text).with_context(|| format!("{} is no horizon mask", path.display()))
}

/// The stretches of `found` that clear `mask` and reach the floor.
fn clear_of(
    mask: &HorizonMask,
    search: &PassSearch,
    satellites: &[input::Satellite],
    found: impl Iterator<Item = (usize, Pass)>,
) -> Vec<(usize, Pass)> {
    use rayon::prelude::*;

    found
        .collect::<Vec<_>>()
        .par_iter()
        .flat_map_iter(|(index, pass)| {
            let stretches = satellites
                .get(*index)
                .map(|satellite| clear_stretches(&satellite.propagator, search.site, mask, pass));
            stretches.into_iter().flatten().map(|stretch| (*index, stretch))
        })
        .filter(|(_, stretch)| stretch.max_elevation() >= search.floor)
        .collect()
}

/// Whoever reads may stop early, as `head` does.
fn write(format: PassFormat, rows: &[ExportedPass<'_>], now: Timestamp) -> io::Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    match write_passes(&mut out, format, rows, now).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}
