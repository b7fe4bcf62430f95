//! `azel pointing`: the pointing model of an antenna, fitted to what the record holds of it.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context as _, bail};
use clap::{Args, ValueEnum};
use jiff::Timestamp;
use serde::Serialize;

use super::{input, passes::written, record::record_of};
use crate::{
    astro::{AzEl, PointingModel, Site, Term, time::seconds_between},
    makes,
    plan::{
        pass_report::TrackPoint,
        pointing::{self, Fit, Kind, Point},
    },
    record::{self, PassQuery},
    station::{self, Antenna, Mount, Station},
};

/// Time between two points of a pass that are used, seconds: what a drive is off by changes little
/// in less, and points that are alike would make the model look surer than it is.
const APART_S: f64 = 10.0;
/// Positions further from the satellite are a slew, or no track at all, degrees.
const NEAR_DEG: f64 = 10.0;

#[derive(Debug, Args)]
pub(super) struct Options {
    /// The antenna [default: the only one]
    #[arg(long, value_name = "NAME")]
    antenna: Option<String>,
    /// Only passes that end after this: `now`, a date (0 h UTC), or a time with Z or an offset
    #[arg(long, value_name = "TIME", value_parser = input::instant)]
    from: Option<Timestamp>,
    /// Only passes that end before this, in the same forms
    #[arg(long, value_name = "TIME", value_parser = input::instant)]
    to: Option<Timestamp>,
    /// A peak of the Sun's noise: when it was, and the angles of the axes there, in degrees; may be
    /// repeated
    #[arg(long, value_name = "TIME,AZ,EL", value_parser = peak, allow_negative_numbers = true)]
    sun: Vec<Peak>,
    /// A peak of the Moon's noise, in the same form
    #[arg(long, value_name = "TIME,AZ,EL", value_parser = peak, allow_negative_numbers = true)]
    moon: Vec<Peak>,
    /// Read this record file instead of the station's
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    /// How the model is written
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Table,
    Json,
}

/// Where the axes stood when the noise of the Sun or the Moon was greatest.
#[derive(Debug, Clone, Copy)]
struct Peak {
    at: Timestamp,
    axes: AzEl,
}

fn peak(text: &str) -> Result<Peak, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [at, azimuth, elevation] = parts.as_slice() else {
        return Err("not a time, an azimuth and an elevation, with commas between".to_owned());
    };
    let angle = |text: &str, from: f64, to: f64| {
        let read = text.trim().parse::<f64>().ok().filter(|deg| (from..=to).contains(deg));
        read.ok_or_else(|| format!("{text} is not an angle from {from} to {to}"))
    };
    let axes = AzEl::from_degrees(angle(azimuth, -360.0, 720.0)?, angle(elevation, -10.0, 90.0)?);
    Ok(Peak { at: input::instant(at.trim())?, axes })
}

pub(super) fn run(station: Option<&Path>, options: &Options) -> anyhow::Result<ExitCode> {
    let own = station::settings_path().filter(|_| station.is_none());
    let path = station.or(own.as_deref()).context("this user has no folder for settings")?;
    let unusable = || format!("The station file {} cannot be used", path.display());
    let of = station::load(path, makes::SPECS).with_context(unusable)?.station;
    let antenna = chosen(&of, options.antenna.as_deref())?;
    if matches!(antenna.mount, Mount::Xy { .. }) {
        bail!(
            "{} has an X/Y mount. The terms of this model are those of an azimuth axis and an \
             elevation axis.",
            antenna.name
        );
    }
    let record = match &options.file {
        Some(file) => file.clone(),
        None => record_of(Some(path.to_owned()))?,
    };
    let (passes, mut points) = recorded(&record, antenna, of.site, options)?;
    let peaks = |kind: fn(Site, Timestamp, AzEl, f64) -> Point, of_body: &[Peak]| {
        of_body.iter().map(|peak| kind(of.site, peak.at, peak.axes, 1.0)).collect::<Vec<_>>()
    };
    points.extend(peaks(Point::of_sun, &options.sun));
    points.extend(peaks(Point::of_moon, &options.moon));
    let fit = pointing::fit(&points).with_context(|| {
        format!("{} has no pointing model in {passes} recorded passes", antenna.name)
    })?;
    let told = Told::of(&antenna.name, passes, &fit);
    let written = match options.format {
        Format::Table => written(|out| table(&told, out)),
        Format::Json => written(|out| {
            serde_json::to_writer_pretty(&mut *out, &told)?;
            writeln!(out)
        }),
    };
    written.context("The pointing model cannot be written")?;
    input::note(
        "Nothing of it is applied. Preferences, the page of the antenna, takes it over for the tracks \
         that Azel leads.",
    );
    Ok(ExitCode::SUCCESS)
}

fn chosen<'a>(station: &'a Station, name: Option<&str>) -> anyhow::Result<&'a Antenna> {
    let names = || {
        let names: Vec<&str> = station.antennas.iter().map(|it| it.name.as_str()).collect();
        names.join(", ")
    };
    match (name, station.antennas.as_slice()) {
        (None, [only]) => Ok(only),
        (None, []) => bail!("The station has no antenna."),
        (None, _) => bail!("Name one with --antenna: {}.", names()),
        (Some(name), all) => all
            .iter()
            .find(|antenna| antenna.name == name)
            .with_context(|| format!("There is no antenna {name}: {}.", names())),
    }
}

/// The number of passes that count, and their points.
fn recorded(
    path: &Path,
    antenna: &Antenna,
    site: Site,
    options: &Options,
) -> anyhow::Result<(usize, Vec<Point>)> {
    if !path.exists() {
        return Ok((0, Vec::new()));
    }
    let unread = || format!("The record at {} cannot be read", path.display());
    let query = PassQuery { antenna: Some(antenna.id), count: u32::MAX, ..PassQuery::default() };
    let page = record::passes(path, &query).with_context(unread)?;
    let counts = |until: Timestamp| {
        options.from.is_none_or(|from| until >= from) && options.to.is_none_or(|to| until < to)
    };
    let (mut count, mut points) = (0, Vec::new());
    for pass in page.passes.iter().filter(|pass| counts(pass.report.until)) {
        let before = points.len();
        let model = &pass.report.about.pointing_model;
        points.extend(thinned(&record::track(path, pass, site).with_context(unread)?, model));
        count += usize::from(points.len() > before);
    }
    Ok((count, points))
}

fn thinned(track: &[TrackPoint], flown_with: &PointingModel) -> Vec<Point> {
    let mut last: Option<Timestamp> = None;
    let near = track.iter().filter(|point| point.error.off_deg <= NEAR_DEG);
    let apart = near.filter(|point| {
        let is_apart = last.is_none_or(|last| seconds_between(last, point.time) >= APART_S);
        if is_apart {
            last = Some(point.time);
        }
        is_apart
    });
    let point = |point: &TrackPoint| Point {
        kind: Kind::Satellite,
        wanted: point.satellite,
        // What the axes read.
        measured: flown_with.reading(point.antenna).unwrap_or(point.antenna),
        weight: 1.0,
    };
    apart.map(point).collect()
}

/// The model as it is written.
#[derive(Serialize)]
struct Told<'a> {
    antenna: &'a str,
    passes: usize,
    noise: Vec<OfKind>,
    terms: Vec<ToldTerm>,
}

#[derive(Serialize)]
struct OfKind {
    of: Kind,
    points: usize,
    noise_deg: f64,
}

/// By how much the axes read more than the direction in which the beam points.
#[derive(Serialize)]
struct ToldTerm {
    term: Term,
    /// Degrees; for the scale, degrees a degree. `None` where the points cannot tell it.
    value: Option<f64>,
    /// Half of the width of the interval that holds it in 95 of 100 cases.
    half_of_95_percent: Option<f64>,
    /// Terms that the points cannot tell it from.
    not_told_from: Vec<Term>,
}

impl<'a> Told<'a> {
    fn of(antenna: &'a str, passes: usize, fit: &Fit) -> Self {
        let term = |term: Term| {
            let interval = fit.interval(term);
            let alike = fit.alike.iter().find(|alike| alike.term == term);
            ToldTerm {
                term,
                value: interval.map(|interval| interval.value),
                half_of_95_percent: interval.map(|interval| interval.half),
                not_told_from: alike.map(|alike| alike.with.clone()).unwrap_or_default(),
            }
        };
        let noise = |found: &pointing::Found| OfKind {
            of: found.kind,
            points: found.points,
            noise_deg: found.noise_deg,
        };
        Self {
            antenna,
            passes,
            noise: fit.noise.iter().map(noise).collect(),
            terms: Term::ALL.map(term).into(),
        }
    }
}

fn table(told: &Told<'_>, out: &mut impl Write) -> io::Result<()> {
    let of = |kind: Kind| match kind {
        Kind::Satellite => "satellites",
        Kind::Sun => "Sun",
        Kind::Moon => "Moon",
    };
    writeln!(out, "{}, recorded passes: {}", told.antenna, told.passes)?;
    for noise in &told.noise {
        let (of, points, noise_deg) = (of(noise.of), noise.points, noise.noise_deg);
        writeln!(out, "Points on {of}: {points}, noise of an axis {noise_deg:.4}°")?;
    }
    writeln!(out, "\n{:<20}  {:>11}  {:>9}", "Term", "Value", "95 %")?;
    for of in &told.terms {
        write!(out, "{:<20}", name(of.term))?;
        // As in the fields of Preferences.
        let (unit, digits) = if of.term == Term::ElevationScale { ("°/°", 6) } else { ("°", 4) };
        if let (Some(value), Some(half)) = (of.value, of.half_of_95_percent) {
            writeln!(out, "  {value:>+10.digits$}{unit}  ±{half:.digits$}{unit}")?;
        } else {
            let with: Vec<&str> = of.not_told_from.iter().map(|term| name(*term)).collect();
            writeln!(out, "  not told from: {}", with.join(", "))?;
        }
    }
    Ok(())
}

fn name(term: Term) -> &'static str {
    match term {
        Term::AzimuthOffset => "Azimuth offset",
        Term::ElevationOffset => "Elevation offset",
        Term::TiltNorth => "Tilt to the north",
        Term::TiltEast => "Tilt to the east",
        Term::Collimation => "Collimation",
        Term::NonPerpendicularity => "Non-perpendicularity",
        Term::ElevationScale => "Elevation scale",
        Term::Sag => "Sag",
    }
}
