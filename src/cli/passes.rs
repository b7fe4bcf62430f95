//! Predictions of passes from element files, for the terminal and for other programs.

mod progress;

use std::{
    io::{self, BufWriter, Write as _},
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::Context as _;
use clap::Args;
use jiff::Timestamp;

use self::progress::Progress;
use super::input::{self, EXIT_CODES, Elevations, InputOptions, Place, Satellites};
use crate::{
    astro::{Angle, HorizonMask, time},
    export::{EventFormat, ExportedPass, PassList, PassQuery},
    orbit::{PassSearch, decoded, found_passes},
};

/// Limits of the predictions, for `--help`.
pub(super) const LEFT_OUT: &str = "All times are UTC. UT1 is taken as UTC, and there is no polar \
    motion; that comes to less than 0.1 s.";

/// Refraction in the list of passes, for `--help`.
const GEOMETRIC: &str = "Directions, AOS and LOS are geometric without --elevations apparent: refraction is \
    left out. It lifts a satellite at the horizon by 0.6 degrees, so that a low one comes up some 10 \
    s before its AOS and goes down as much after its LOS.";

/// Fields of CSV and JSON, for `--help`.
const FIELDS: &str = "CSV has a line for each pass; lines end with LF. JSON has format_version 1 and, \
    under passes, an object with the same fields for each pass: catalog_number, name; aos_time, \
    aos_azimuth_deg, aos_elevation_deg; tca_time, tca_azimuth_deg, tca_elevation_deg; los_time, \
    los_azimuth_deg, los_elevation_deg; max_elevation_deg, duration_s; starts_before and ends_after (the \
    window cuts the pass); epoch and age_days (of the elements, at AOS); range_km and sunlit at TCA; \
    designator; dark_at_site at TCA; aos_range_km, los_range_km; aos_range_rate_km_s, \
    tca_range_rate_km_s, los_range_rate_km_s; with --doppler aos_doppler_hz, tca_doppler_hz, \
    los_doppler_hz.";

/// Places where a pass is not sharp, for `--help`.
const NOT_SHARP: &str = "TCA of a geosynchronous satellite may be off by a quarter of an hour or, \
    where its elevation is the same every day, by days; it is then lower by less than 0.00002 \
    degrees. Far from its epoch, a propagated orbit may \
    pass below the Earth's surface; LOS of such a pass is not reliable.";

#[derive(Debug, Args)]
#[command(after_help = format!("{FIELDS}\n\n{GEOMETRIC} {LEFT_OUT}\n\n{NOT_SHARP}\n\n{EXIT_CODES}"))]
pub(super) struct Options {
    #[command(flatten)]
    input: InputOptions,
    /// Start of the window: `now`, a date (0 h UTC), or a time with Z or an offset
    #[arg(long = "from", value_name = "TIME", default_value = "now", value_parser = input::instant)]
    start: Timestamp,
    /// Length of the window in hours
    #[arg(long, value_name = "H", default_value_t = 24.0, value_parser = input::hours, allow_negative_numbers = true)]
    hours: f64,
    /// Leave out passes whose maximum elevation stays below this; the elevation floor of the
    /// station, or 0, when left out
    #[arg(long, value_name = "DEG", value_parser = input::elevation, allow_negative_numbers = true)]
    floor: Option<f64>,
    /// Minimum duration of a pass, seconds from AOS to LOS
    #[arg(long, value_name = "S", default_value_t = 0.0, value_parser = input::duration_s, allow_negative_numbers = true)]
    min_duration: f64,
    /// Maximum number of passes, earliest AOS first [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    max_passes: Option<u32>,
    /// Elevation of AOS and LOS; that of the station, or 0, when left out
    #[arg(long, value_name = "DEG", value_parser = input::elevation, allow_negative_numbers = true)]
    aos: Option<f64>,
    /// AOS, TCA, LOS and all elevations, also those of --aos and --floor: `geometric`, or `apparent`
    /// with the refraction of radio waves; that of the station, or geometric, when left out
    #[arg(long, value_enum, value_name = "KIND")]
    elevations: Option<Elevations>,
    /// Horizon mask: lines of azimuth and elevation in degrees. Each stretch of
    /// a pass that clears it is a row of its own
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Add the Doppler shift of this frequency, sent by the satellite, to CSV and JSON
    #[arg(long, value_name = "MHZ", value_parser = input::megahertz, allow_negative_numbers = true)]
    doppler: Option<f64>,
    /// Give each event of a calendar an alarm, this many minutes before AOS
    #[arg(long, value_name = "MIN", value_parser = input::minutes, allow_negative_numbers = true)]
    alarm: Option<f64>,
    /// Threads to compute with; as many as there are cores when left out
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    threads: Option<u16>,
    /// How the passes are written
    #[arg(long, value_enum, default_value_t = EventFormat::Table)]
    format: EventFormat,
}

pub(super) fn run(station: Option<&Path>, options: &Options) -> anyhow::Result<ExitCode> {
    options.input.check("passes", station)?;
    if options.alarm.is_some() && options.format != EventFormat::Ics {
        return Err(input::usage("passes", "--alarm is for events and needs --format ics").into());
    }
    let place = options.input.place(station)?;
    let angle = |own: Option<f64>, of_place| own.map_or(of_place, Angle::from_degrees);
    let (start, end) = (options.start, time::add_seconds(options.start, options.hours * 3600.0));
    let site = options.elevations.map_or(Ok(place.site), |kind| kind.in_passes(place.site))?;
    let search = PassSearch {
        site,
        start,
        end,
        aos_elevation: angle(options.aos, place.aos_elevation),
        floor: angle(options.floor, place.floor),
    };
    let mask = options.mask.as_ref().map(read_mask).transpose()?;
    let query = PassQuery { search, mask };
    let threads = options.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    pool.install(|| write_passes(station, options, &place, &query))
}

/// Reads, searches and writes, with all threads of the rayon pool in which this is called.
fn write_passes(
    station: Option<&Path>,
    options: &Options,
    place: &Place,
    query: &PassQuery,
) -> anyhow::Result<ExitCode> {
    let PassQuery { search, mask } = query;
    let Satellites { list: satellites, is_complete } =
        options.input.satellites(station, options.start)?;
    input::caution(&satellites, search.start, search.end);
    let progress = Progress::new(satellites.len());
    let mut found = found_passes(&satellites, search, &|done| progress.show(done), &|| false);
    if mask.is_some() {
        found.divide(|index, pass| {
            let satellite = satellites.get(index);
            satellite.map_or_else(Vec::new, |satellite| query.parts(&satellite.propagator, pass))
        });
    }
    found.retain(|pass| pass.duration_s() >= options.min_duration);
    progress.end();

    let max = options.max_passes.map_or(usize::MAX, |max| max as usize);
    let rows = found.in_order().take(max).filter_map(|(index, pass)| {
        let satellite = satellites.get(index)?;
        Some(ExportedPass { satellite, pass })
    });
    let list = PassList {
        query,
        place: place.name.as_deref(),
        carrier_hz: options.doppler.map(|megahertz| megahertz * 1e6),
        alarm_before_s: options.alarm.map(|minutes| minutes * 60.0),
        now: Timestamp::now(),
    };
    written(|out| list.write(out, options.format, rows)).context("The passes cannot be written")?;
    Ok(input::exit_code(is_complete))
}

fn read_mask(path: &PathBuf) -> anyhow::Result<HorizonMask> {
    let bytes = std::fs::read(path)
        .with_context(|| format!("The horizon mask {} cannot be read", path.display()))?;
    HorizonMask::parse(&decoded(&bytes))
        .with_context(|| format!("{} is not a horizon mask", path.display()))
}

/// Size of the buffer in front of standard output, bytes.
const WRITTEN_AT_ONCE: usize = 1 << 16;

/// Writes to standard output. A reader that stops early, as `head` does, is no error.
pub(super) fn written(
    write: impl FnOnce(&mut BufWriter<io::StdoutLock<'static>>) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(WRITTEN_AT_ONCE, io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}
