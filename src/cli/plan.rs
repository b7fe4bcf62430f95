//! The schedule of a station, for the terminal and for other programs.

use std::{
    collections::BTreeMap,
    io::{self, Write as _},
    path::Path,
    process::ExitCode,
};

use anyhow::Context as _;
use clap::{Args, ValueEnum};
use jiff::Timestamp;
use rayon::prelude::*;

use super::{
    input::{self, EXIT_CODES, InputOptions, Satellites},
    passes::written,
};
use crate::{
    astro::time,
    controller::SPECS,
    export::{EventFormat, ExportedPass, PassQuery, PlanList, Satellite},
    orbit::{Pass, PassSearch, passes_of_all},
    plan::schedule::{
        Candidate, Common, LeftOut, Partial, PlannedAntenna, Request, Schedule, Steadiness, plan,
    },
    station::{self, AntennaId, ChooseBy, Partly, Scheduling, Station},
    ui::{hand_over_sheet::HandOverSheet, words},
};

/// Least part of a pass that is worth taking, seconds.
const MIN_PART_S: f64 = 60.0;

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(super) struct Options {
    #[command(flatten)]
    input: InputOptions,
    /// Start of the schedule: `now`, a date (0 h UTC), or a time with Z or an offset
    #[arg(long = "from", value_name = "TIME", default_value = "now", value_parser = input::instant)]
    start: Timestamp,
    /// Length of the schedule in hours
    #[arg(long, value_name = "H", default_value_t = 24.0, value_parser = input::hours, allow_negative_numbers = true)]
    hours: f64,
    /// What is best; as the station file says without it
    #[arg(long, value_enum)]
    choose_by: Option<Rule>,
    /// Passes may be shortened to this share, 0 to 1; as the station file says without it
    #[arg(long = "least-share", value_name = "SHARE", value_parser = input::share)]
    min_share: Option<f64>,
    /// Passes may be handed from one antenna to another where they may be shortened
    #[arg(long)]
    hand_over: bool,
    /// How the schedule is written
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Table,
    Csv,
    Json,
    /// Events of a calendar: only what is taken
    Ics,
    /// A page to print for the next shift: the first 24 hours
    Html,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Rule {
    /// Priority, then the seconds that count times the sine of the maximum elevation
    Elevation,
    /// Priority, then the seconds that count
    Duration,
    /// Most passes
    Passes,
    /// Most minutes
    Minutes,
}

impl Rule {
    fn choose_by(self) -> ChooseBy {
        match self {
            Self::Elevation => ChooseBy::Elevation,
            Self::Duration => ChooseBy::Duration,
            Self::Passes => ChooseBy::MostPasses,
            Self::Minutes => ChooseBy::MostMinutes,
        }
    }
}

/// How passes are planned: as the station file says, unless the command line says otherwise.
fn scheduling(station: &Station, options: &Options) -> Scheduling {
    let own = station.scheduling;
    let partly = options.min_share.map(|share| Partly {
        min_percent: 100.0 * share,
        min_s: own.partly.map_or(MIN_PART_S, |partly| partly.min_s),
    });
    Scheduling {
        choose_by: options.choose_by.map_or(own.choose_by, Rule::choose_by),
        partly: partly.or(own.partly),
        hand_over: own.hand_over || options.hand_over,
        ..own
    }
}

pub(super) fn run(station: Option<&Path>, options: &Options) -> anyhow::Result<ExitCode> {
    let own = station::settings_path().filter(|_| station.is_none());
    let path = station.or(own.as_deref()).context("this user has no folder for settings")?;
    let unusable = || format!("The station file {} cannot be used", path.display());
    let place = options.input.place(Some(path))?;
    let station = station::load(path, SPECS).with_context(unusable)?.station;
    let scheduling = scheduling(&station, options);
    let station = Station { site: place.site, scheduling, ..station };
    let Satellites { list: mut satellites, is_complete } =
        options.input.satellites(Some(path), options.start)?;
    options.input.keep_planned(&mut satellites, &station.favourites);
    let (start, end) = (options.start, time::add_seconds(options.start, options.hours * 3600.0));
    input::caution(&satellites, start, end);

    let antennas: Vec<PlannedAntenna> = station
        .antennas
        .iter()
        .map(|antenna| PlannedAntenna::from_station(&station, antenna, options.start))
        .collect();
    let query = PassQuery { search: search(&station, start, end), mask: None };
    let found = planned_passes(&satellites, &query.search);
    let candidates = candidates(&station, &antennas, &found);
    let schedule = plan(&Request {
        antennas: &antennas,
        candidates: &candidates,
        choose_by: station.scheduling.choose_by,
        partial: Partial::from_scheduling(&station.scheduling),
        previous: None,
        steadiness: Steadiness::default(),
        fixed: &[],
    });
    if let Some(unproved) = words::schedule::unproved(&schedule) {
        input::note(&unproved);
    }
    let now = Timestamp::now();
    let list = |format| write_list(&station, &schedule, &satellites, (&found, &query), now, format);
    let written = match options.format {
        Format::Table => list(EventFormat::Table),
        Format::Csv => list(EventFormat::Csv),
        Format::Json => list(EventFormat::Json),
        Format::Ics => list(EventFormat::Ics),
        Format::Html => write_sheet(&station, &schedule, &satellites, (start, end), now),
    };
    written.context("The schedule cannot be written")?;
    Ok(input::exit_code(is_complete))
}

fn write_list(
    station: &Station,
    schedule: &Schedule,
    satellites: &[Satellite],
    (passes, query): (&[ExportedPass<'_>], &PassQuery),
    now: Timestamp,
    format: EventFormat,
) -> io::Result<()> {
    let names: BTreeMap<u32, String> = satellites
        .iter()
        .map(|satellite| {
            (satellite.elements.catalog_number(), satellite.elements.name().to_owned())
        })
        .collect();
    let name = |number: u32| names.get(&number).cloned().unwrap_or_else(|| number.to_string());
    let antennas: BTreeMap<AntennaId, String> = station
        .antennas
        .iter()
        .map(|configured| (configured.id, configured.name.clone()))
        .collect();
    let names_in_reasons = words::schedule::Names {
        pass: &|(number, _)| name(number),
        antenna: &|id| antennas.get(&id).cloned().unwrap_or_default(),
    };
    let list = PlanList {
        schedule,
        satellites: &names,
        antennas: &antennas,
        reason: &|left: &LeftOut| words::schedule::left_out_reason(names_in_reasons, &left.reason),
        passes,
        query,
        now,
    };
    written(|out| list.write(out, format))
}

fn write_sheet(
    station: &Station,
    schedule: &Schedule,
    satellites: &[Satellite],
    span: (Timestamp, Timestamp),
    now: Timestamp,
) -> io::Result<()> {
    let satellites = satellites
        .iter()
        .map(|satellite| {
            (satellite.elements.catalog_number(), (&satellite.elements, &satellite.propagator))
        })
        .collect();
    let sheet = HandOverSheet::new(station, schedule, &satellites, span, now);
    written(|out| out.write_all(sheet.html().as_bytes()))
}

fn search(station: &Station, start: Timestamp, end: Timestamp) -> PassSearch {
    PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, start, end)
    }
}

/// The passes that can be planned, ordered by AOS.
fn planned_passes<'a>(satellites: &'a [Satellite], search: &PassSearch) -> Vec<ExportedPass<'a>> {
    // A satellite that neither rises nor sets would keep an antenna from everything else.
    let rises_or_sets = |pass: &Pass| !(pass.starts_before && pass.ends_after);
    let found = passes_of_all(satellites, search, &|_| (), &|| false);
    let exported = found.filter(|(_, pass)| rises_or_sets(pass)).filter_map(|(index, pass)| {
        let satellite = satellites.get(index)?;
        Some(ExportedPass { satellite, pass })
    });
    let mut passes: Vec<ExportedPass<'a>> = exported.collect();
    passes.sort_by_key(|row| (row.pass.aos.time, row.satellite.elements.catalog_number()));
    passes
}

fn candidates(
    station: &Station,
    antennas: &[PlannedAntenna],
    passes: &[ExportedPass<'_>],
) -> Vec<Candidate> {
    let floor = station.elevation_floor();
    let max_age_s = station.scheduling.max_element_age_d.map(|days| days * time::DAY_S);
    let common = Common { site: station.site, floor, antennas, max_age_s };
    let judged = passes.par_iter().map(|ExportedPass { satellite, pass }| {
        Candidate::from_station(station, &satellite.elements, &satellite.propagator, pass, common)
    });
    judged.collect()
}
