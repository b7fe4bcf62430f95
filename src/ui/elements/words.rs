//! Sentences about sources and the catalog.

use jiff::Timestamp;

use crate::{
    astro::time::seconds_between,
    orbit::{Catalog, FETCH_PAUSE, Source, SourcePlace, SourceReport},
    ui::{format, widgets::told::Tone, words::sentence},
};

/// "1 object", "16 089 objects".
pub(super) fn objects(count: usize) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{} object{plural}", format::number(count as f64, 0))
}

/// All elements in one sentence.
pub(super) fn catalog(catalog: &Catalog, now: Timestamp) -> String {
    let newest = catalog.newest_epoch().map_or_else(String::new, |epoch| {
        format!(", the newest epoch is {}", date_and_age(epoch, now))
    });
    format!("{}{newest}. Of each object the newest elements are used.", objects(catalog.len()))
}

/// "2026-08-11, 3 h old".
fn date_and_age(epoch: Timestamp, now: Timestamp) -> String {
    format!("{}, {} old", epoch.strftime("%Y-%m-%d"), format::age(seconds_between(epoch, now)))
}

/// Location of a source.
pub(super) fn place(source: &Source) -> String {
    match &source.place {
        SourcePlace::File(path) => format!("File {}", path.display()),
        SourcePlace::Folder(path) => format!("Folder {}", path.display()),
        SourcePlace::Web(url) => url.clone(),
    }
}

/// Sentences about the outcome of a source, most important first.
pub(super) fn report(
    source: &Source,
    report: Option<&SourceReport>,
    now: Timestamp,
) -> Vec<(Tone, String)> {
    let Some(report) = report else {
        return vec![(Tone::Caution, "Not read.".to_owned())];
    };
    if report.is_set_aside {
        let words = "Set aside: Azel ended while it read this source. It is read again when you \
                     ask for it.";
        return vec![(Tone::Bad, words.to_owned())];
    }
    let mut lines: Vec<(Tone, String)> = (report.files.iter())
        .filter_map(|file| {
            let (problem, place) = (file.problem.as_ref()?, file.path.display());
            Some((Tone::Bad, format!("Cannot be read: {problem}: {place}.")))
        })
        .collect();
    lines.extend(report.files.iter().filter_map(|file| {
        let (why, place) = (file.merge.nothing?, file.path.display());
        Some((Tone::Caution, format!("No elements, {why}: {place}.")))
    }));
    if report.objects() > 0 || lines.is_empty() {
        lines.insert(0, held(source, report, now));
    }
    if report.refused() > 0 {
        let refused = format::number(report.refused() as f64, 0);
        lines.push((Tone::Plain, format!("{refused} refused: unreadable.")));
    }
    if let Some(problem) = &report.fetch_problem {
        let stays = if report.objects() > 0 { " What was held stays." } else { "" };
        lines.push((Tone::Bad, format!("{}{stays}", sentence(&problem.to_string()))));
    }
    lines.extend(asked(report, now).map(|words| (Tone::Plain, words)));
    lines
}

fn held(source: &Source, report: &SourceReport, now: Timestamp) -> (Tone, String) {
    if report.objects() == 0 {
        let words = match source.place {
            SourcePlace::Web(_) => "Holds nothing yet.",
            SourcePlace::File(_) | SourcePlace::Folder(_) => "Holds no elements.",
        };
        return (Tone::Caution, words.to_owned());
    }
    let newest = report
        .newest_epoch
        .map_or_else(String::new, |epoch| format!(", newest epoch {}", date_and_age(epoch, now)));
    let word = match source.place {
        SourcePlace::Web(_) => "Sent or confirmed",
        SourcePlace::File(_) | SourcePlace::Folder(_) => "Changed",
    };
    let age = report
        .age_s(now)
        .map_or_else(String::new, |age_s| format!(" {word} {} ago.", format::age(age_s)));
    (Tone::Good, format!("{}{newest}.{age}", objects(report.objects())))
}

/// Times of the last and the next permitted request to the server.
fn asked(report: &SourceReport, now: Timestamp) -> Option<String> {
    let next = report.next_fetch?;
    let last = next.checked_sub(FETCH_PAUSE).ok()?;
    let ago = format::age(seconds_between(last, now));
    let again = if next > now {
        format!(" It may be asked again from {}.", format::time_z(next))
    } else {
        String::new()
    };
    Some(format!("Asked {ago} ago.{again}"))
}

/// The confirmation before a premature request to a server; `None` if a request is
/// permitted now.
pub(super) fn ask_again(
    name: &str,
    report: Option<&SourceReport>,
    now: Timestamp,
) -> Option<String> {
    let next = report?.next_fetch.filter(|next| *next > now)?;
    let last = next.checked_sub(FETCH_PAUSE).ok()?;
    let ago = format::age(seconds_between(last, now));
    Some(format!(
        "The server of {name} was asked {ago} ago. Servers shut out who asks more often than \
         every 2 h. Ask again all the same?"
    ))
}
