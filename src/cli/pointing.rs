//! `azel pointing`: the pointing model of an antenna, fitted to what the record holds of it.

use std::{
    io::{self, Write},
    ops::RangeInclusive,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context as _, bail};
use clap::{Args, ValueEnum};
use jiff::Timestamp;
use serde::Serialize;

use super::{input, passes::written, record::record_of};
use crate::{
    astro::Term,
    contract::record::{ExplainedPasses, Peak, PeakBody, PointingFit},
    controller::SPECS,
    plan::pointing::Kind,
    record::{explain_passes, fit_pointing, read_peaks},
    station::{self, Antenna, Mount, Station},
    ui::words::{pointing::pointing_term, record as words},
};

#[derive(Debug, Args)]
pub(super) struct Options {
    /// The antenna [default: the only one]
    #[arg(long, value_name = "NAME")]
    antenna: Option<String>,
    /// Only passes that end at this time or later, and peaks that were entered: `now`, a date (0 h UTC), or a time with Z or an offset
    #[arg(long = "from", value_name = "TIME", value_parser = input::instant)]
    start: Option<Timestamp>,
    /// Only those up to this time, in the same forms
    #[arg(long = "to", value_name = "TIME", value_parser = input::instant)]
    end: Option<Timestamp>,
    /// A peak of the Sun's noise besides those entered in Preferences: when it was, and the angles of
    /// the axes there, in degrees; may be repeated
    #[arg(long, value_name = "TIME,AZ,EL", value_parser = sun_peak, allow_negative_numbers = true)]
    sun: Vec<Peak>,
    /// A peak of the Moon's noise, in the same form
    #[arg(long, value_name = "TIME,AZ,EL", value_parser = moon_peak, allow_negative_numbers = true)]
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

fn sun_peak(text: &str) -> Result<Peak, String> {
    peak(PeakBody::Sun, text)
}

fn moon_peak(text: &str) -> Result<Peak, String> {
    peak(PeakBody::Moon, text)
}

fn peak(body: PeakBody, text: &str) -> Result<Peak, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [time_text, azimuth, elevation] = parts.as_slice() else {
        return Err("not a time, an azimuth and an elevation, with commas between".to_owned());
    };
    let angle = |text: &str, range: RangeInclusive<f64>| {
        let read = text.trim().parse::<f64>().ok().filter(|deg| range.contains(deg));
        read.ok_or_else(|| {
            format!("{text} is not an angle from {} to {}", range.start(), range.end())
        })
    };
    Ok(Peak {
        body,
        time: input::instant(time_text.trim())?,
        azimuth_deg: angle(azimuth, Peak::AZIMUTHS_DEG)?,
        elevation_deg: angle(elevation, Peak::ELEVATIONS_DEG)?,
    })
}

pub(super) fn run(station: Option<&Path>, options: &Options) -> anyhow::Result<ExitCode> {
    let own = station::settings_path().filter(|_| station.is_none());
    let path = station.or(own.as_deref()).context("this user has no folder for settings")?;
    let unusable = || format!("The station file {} cannot be used", path.display());
    let loaded = station::load(path, SPECS).with_context(unusable)?.station;
    let antenna = chosen(&loaded, options.antenna.as_deref())?;
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
    let span = options.start.unwrap_or(Timestamp::MIN)..=options.end.unwrap_or(Timestamp::MAX);
    let entered = read_peaks(&record).context("The peaks in the record cannot be read")?;
    let entered = entered.for_antenna(antenna.id).filter(|peak| span.contains(&peak.time));
    let peaks: Vec<Peak> = entered.chain(&options.sun).chain(&options.moon).copied().collect();
    let fit = fit_pointing(&record, antenna.id, loaded.site, &span, &peaks, Vec::new())
        .with_context(|| format!("{} has no pointing model", antenna.name))?;
    let causes = explain_passes(&record, antenna.id, antenna.mount, loaded.site, &span)
        .with_context(|| format!("The passes of {} cannot be read", antenna.name))?;
    let output = JsonOutput { antenna: &antenna.name, fit: &fit, causes };
    let written = match options.format {
        Format::Table => written(|out| table(&output, out)),
        Format::Json => written(|out| {
            serde_json::to_writer_pretty(&mut *out, &output)?;
            writeln!(out)
        }),
    };
    written.context("The pointing model cannot be written")?;
    input::note(
        "Nothing of it is applied. Preferences, the page of the antenna, fits it as well, and takes it \
         over for the tracks that Azel leads.",
    );
    Ok(ExitCode::SUCCESS)
}

fn chosen<'a>(station: &'a Station, name: Option<&str>) -> anyhow::Result<&'a Antenna> {
    let names = || {
        let names: Vec<&str> =
            station.antennas.iter().map(|configured| configured.name.as_str()).collect();
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

/// The model as it is written.
#[derive(Serialize)]
struct JsonOutput<'a> {
    antenna: &'a str,
    #[serde(flatten)]
    fit: &'a PointingFit,
    causes: ExplainedPasses,
}

fn table(
    JsonOutput { antenna, fit, causes }: &JsonOutput<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let name = |kind: Kind| match kind {
        Kind::Satellite => "satellites",
        Kind::Sun => "Sun",
        Kind::Moon => "Moon",
    };
    writeln!(out, "{antenna}, recorded passes: {}", fit.passes)?;
    for noise in &fit.noise {
        let (name, points, noise_deg) = (name(noise.kind), noise.points, noise.noise_deg);
        writeln!(out, "Points on {name}: {points}, noise of an axis {noise_deg:.4}°")?;
    }
    writeln!(out, "\n{:<20}  {:>11}  {:>9}", "Term", "Value", "95 %")?;
    for fitted in &fit.terms {
        write!(out, "{:<20}", pointing_term(fitted.term))?;
        // As in the fields of Preferences.
        let (unit, digits) =
            if fitted.term == Term::ElevationScale { ("°/°", 6) } else { ("°", 4) };
        if let Some(value) = fitted.value {
            let half = fitted.half_of_95_percent.map(|half| format!("±{half:.digits$}{unit}"));
            let half = half.unwrap_or_else(|| "not known".to_owned());
            writeln!(out, "  {value:>+10.digits$}{unit}  {half}")?;
        } else {
            let others: Vec<&str> =
                fitted.not_told_from.iter().map(|term| pointing_term(*term)).collect();
            writeln!(out, "  not told from: {}", others.join(", "))?;
        }
    }
    writeln!(out, "\nCauses in the last {} of these passes", causes.passes)?;
    writeln!(out, "{:<40}  {:>9}  {:>9}", "Cause", "Residual", "Explained")?;
    for explanation in &causes.explanations {
        let (left, share) = (explanation.left_deg, words::whole_share(explanation.share));
        writeln!(out, "{:<40}  {left:>8.3}°  {share:>9}", words::causes(explanation))?;
    }
    if causes.explanations.is_empty() {
        writeln!(out, "{}", words::none_explains(causes.passes > 0))?;
    }
    Ok(())
}
