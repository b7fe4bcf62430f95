//! The plan of a station carried out against simulated units.

use std::{
    borrow::Cow,
    io::{self, Write},
    num::NonZeroU32,
    path::Path,
    process::ExitCode,
    sync::Arc,
};

use anyhow::Context as _;
use clap::Args;
use jiff::Timestamp;
use serde::Serialize;

use super::{
    input::{self, EXIT_CODES, InputOptions, Satellites},
    passes::written,
};
use crate::{
    astro::time,
    contract::rehearsal::{Rehearsed, RehearsedPass},
    controller::SPECS,
    export::{ListFormat, RowFormat, Time, civil, minutes, rounded, write_rows},
    orbit::{Catalog, ReadReport},
    rehearsal::{self, Fault, Rehearsal},
    sim::Mechanics,
    station::{self, Station},
    ui::words::{
        automatic::day_line,
        rehearsal::{outcome, verdict},
    },
};

/// Highest speed besides the highest possible, in multiples of real time.
const MAX_SPEED: u32 = 200;

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(super) struct Options {
    #[command(flatten)]
    input: InputOptions,
    /// Start of the rehearsal: `now`, a date (0 h UTC), or a time with Z or an offset
    #[arg(long = "from", value_name = "TIME", default_value = "now", value_parser = input::instant)]
    start: Timestamp,
    /// Length of the rehearsal in hours; passes that have begun by then are rehearsed to their end
    #[arg(long, value_name = "H", default_value_t = 24.0, value_parser = input::hours, allow_negative_numbers = true)]
    hours: f64,
    /// Seed of all randomness: the same seed gives the same rehearsal
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Speed in multiples of real time, 1 to 200, or `max`; the result is the same
    #[arg(long, value_name = "SPEED", default_value = "max", value_parser = speed)]
    speed: Speed,
    /// Fault to add; may be repeated. Its kind first: link-lost, power-cut, silence, noise, refusal,
    /// slow-drives=SHARE, clock-late=MS, track-late=MS, clock-drift=S (a day) or late-replies=MS;
    /// then, each after a comma, antenna=NAME (or all), after=MIN from the start and for=S (or to the end)
    #[arg(long = "fault", value_name = "FAULT")]
    faults: Vec<Fault>,
    #[command(flatten, next_help_heading = "Drives and sensors of all antennas")]
    mechanics: Mechanics,
    /// How the passes are written
    #[arg(long, value_enum, default_value_t = ListFormat::Table)]
    format: ListFormat,
}

/// `None` for as fast as it can.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Speed(Option<NonZeroU32>);

fn speed(text: &str) -> Result<Speed, String> {
    if text == "max" {
        return Ok(Speed(None));
    }
    let read = text.parse::<NonZeroU32>().ok().filter(|speed| speed.get() <= MAX_SPEED);
    read.map(|speed| Speed(Some(speed))).ok_or_else(|| format!("not max, or 1 to {MAX_SPEED}"))
}

pub(super) fn run(station: Option<&Path>, options: &Options) -> anyhow::Result<ExitCode> {
    let own = station::settings_path().filter(|_| station.is_none());
    let path = station.or(own.as_deref()).context("this user has no folder for settings")?;
    let unusable = || format!("The station file {} cannot be used", path.display());
    let place = options.input.place(Some(path))?;
    let station = station::load(path, SPECS).with_context(unusable)?.station;
    let Satellites { mut list, is_complete } =
        options.input.satellites(Some(path), options.start)?;
    options.input.keep_planned(&mut list, &station.favourites);
    // Automatic operation takes passes of favourites alone.
    let numbers: Vec<u32> = list.iter().map(|object| object.elements.catalog_number()).collect();
    let favourites = station.favourites.with_numbers(&numbers);
    let end = time::add_seconds(options.start, options.hours * 3600.0);
    input::caution(&list, options.start, end);
    let mut elements = Catalog::default();
    let read = list.into_iter().map(|satellite| satellite.elements).collect();
    elements.merge(ReadReport { elements: read, ..ReadReport::default() }, "rehearsal");
    let names: Vec<_> =
        station.antennas.iter().map(|antenna| (antenna.id, antenna.name.clone())).collect();
    let rehearsed = rehearsal::run(
        &Rehearsal {
            station: Station { site: place.site, favourites, ..station },
            elements: Arc::new(elements),
            start: options.start,
            hours: options.hours,
            seed: options.seed,
            mechanics: options.mechanics,
            faults: options.faults.clone(),
            speed: options.speed.0,
        },
        &|_| (),
        &|| false,
    )
    .context("The rehearsal came to nothing")?;
    input::note("Rehearsal against simulated units: no antenna has moved.");
    for name in &rehearsed.left_out {
        input::note(&format!("{name} is left out: there is no simulated unit of its make."));
    }
    for line in &rehearsed.interruptions {
        let name = names.iter().find(|(id, _)| *id == line.antenna).map(|(_, name)| name.as_str());
        let (time_text, words) =
            (civil(line.time, "%Y-%m-%dT%H:%M:%SZ"), day_line(line, line.time));
        input::note(&format!("{}, {time_text}: {words}", name.unwrap_or_default()));
    }
    let written = match options.format {
        ListFormat::Table => written(|out| table(&rehearsed, out)),
        ListFormat::Csv => written(|out| csv(&rehearsed, out)),
        ListFormat::Json => written(|out| {
            serde_json::to_writer_pretty(&mut *out, &rehearsed)?;
            writeln!(out)
        }),
    };
    written.context("The rehearsal cannot be written")?;
    Ok(input::exit_code(is_complete && rehearsed.left_out.is_empty()))
}

fn table(rehearsed: &Rehearsed, out: &mut impl Write) -> io::Result<()> {
    let width = |name: fn(&RehearsedPass) -> &str| {
        rehearsed.passes.iter().map(|pass| name(pass).chars().count()).max().unwrap_or(0).max(9)
    };
    let (antennas, names) = (
        width(|rehearsed_pass| &rehearsed_pass.antenna_name),
        width(|rehearsed_pass| &rehearsed_pass.satellite_name),
    );
    writeln!(
        out,
        "{:<antennas$}  {:<names$}  {:<19}  {:<8}  {:>7}  {:>6}  {:>6}  {:>6}  {:<8}  Outcome",
        "Antenna", "Satellite", "AOS (UTC)", "LOS", "promise", "got", "rms", "worst", "Verdict"
    )?;
    let degrees = |deg: Option<f64>| deg.map_or_else(String::new, |deg| format!("{deg:.2}"));
    for pass in &rehearsed.passes {
        writeln!(
            out,
            "{:<antennas$}  {:<names$}  {}  {}  {:>7}  {:>6}  {:>6}  {:>6}  {:<8}  {}",
            pass.antenna_name,
            pass.satellite_name,
            civil(pass.aos, "%Y-%m-%d %H:%M:%S"),
            civil(pass.los, "%H:%M:%S"),
            minutes(pass.promised_s),
            minutes(pass.got_s()),
            degrees(pass.rms_deg()),
            degrees(pass.worst_deg()),
            verdict(pass),
            outcome(pass, rehearsed.start),
        )?;
    }
    Ok(())
}

/// A rehearsed pass with its columns.
#[derive(Default, Serialize)]
struct Row<'a> {
    antenna: Cow<'a, str>,
    catalog_number: u32,
    name: Cow<'a, str>,
    aos_time: Time,
    los_time: Time,
    from_time: Time,
    to_time: Time,
    promised_s: f64,
    got_s: f64,
    rms_deg: Option<f64>,
    worst_deg: Option<f64>,
    verdict: &'static str,
    outcome: String,
}

fn csv(rehearsed: &Rehearsed, out: &mut impl Write) -> io::Result<()> {
    let csv = RowFormat::Csv;
    let rows = rehearsed.passes.iter().map(|pass| Row {
        antenna: csv.text(&pass.antenna_name),
        catalog_number: pass.satellite,
        name: csv.text(&pass.satellite_name),
        aos_time: Time(pass.aos),
        los_time: Time(pass.los),
        from_time: Time(pass.start),
        to_time: Time(pass.end),
        promised_s: rounded(pass.promised_s, 1e3),
        got_s: rounded(pass.got_s(), 1e3),
        rms_deg: pass.rms_deg(),
        worst_deg: pass.worst_deg(),
        verdict: verdict(pass),
        outcome: csv.text(&outcome(pass, rehearsed.start)).into_owned(),
    });
    write_rows(out, csv, ("passes", &[]), &Row::default(), rows)
}
