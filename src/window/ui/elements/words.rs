//! Texts about sources and the catalog.

use egui::Color32;
use jiff::Timestamp;

use super::columns::Next;
use crate::{
    astro::time::{DAY_S, seconds_between},
    contract::sources::{SourceWork, Sources},
    model::{
        DistanceUnit, Model,
        catalog_table::{NEXT_PASSES_H, Question, Subset},
    },
    orbit::{
        Elements, FETCH_PAUSE, FetchProblem, Heights, RefreshHours, Source, SourcePlace,
        SourceReport, tle_lines, write_omm_json,
    },
    station::Priority,
    ui::{
        format,
        icons::Icon,
        replay,
        tokens::Tokens,
        widgets::status_line::Tone,
        words::{OLD_ELEMENTS_S, sentence},
    },
};

/// Formats a number of objects, such as "1 object" or "16 089 objects".
pub(in crate::ui) fn objects(count: usize) -> String {
    format::counted(count, "object")
}

/// Formats a priority, such as "Priority 1, first".
pub(super) fn priority(priority: Priority) -> String {
    let more = match priority.number() {
        1 => ", first",
        5 => ", last",
        _ => "",
    };
    format!("Priority {}{more}", priority.number())
}

pub(super) fn plain(count: usize) -> String {
    format::number(count as f64, 0)
}

/// Reason why favourites may not change while the preferences have unsaved edits.
pub(super) const EDITED: &str = "Save or revert the preferences before you change favourites.";

/// Returns the reason why no source and no set in use may change now.
pub(super) fn sources_lock(model: &Model) -> Option<&'static str> {
    replay::lock(model).or_else(|| match *model.sources {
        Sources { is_locked: true, .. } => Some("The list of sources cannot be read."),
        Sources { work: SourceWork::Nothing, .. } => None,
        Sources { .. } => Some("The sources are being read."),
    })
}

/// Describes the age of the marked objects, of which `old` have old elements, and the `lock`.
pub(super) fn marked(old: usize, lock: Option<&str>) -> String {
    let age = match old {
        0 => String::new(),
        1 => "1 is older than 7 d.".to_owned(),
        old => format!("{} are older than 7 d.", plain(old)),
    };
    [&*age, lock.unwrap_or_default()].join(" ").trim().to_owned()
}

/// Formats a catalog number, in groups from six digits on.
pub(super) fn number(number: u32) -> String {
    if number < 100_000 { number.to_string() } else { format::number(f64::from(number), 0) }
}

/// Formats the heights of apogee and perigee without their unit.
pub(super) fn heights(heights: Heights, unit: DistanceUnit) -> String {
    let Heights { apogee_km, perigee_km } = heights;
    let [apogee, perigee] =
        [apogee_km, perigee_km].map(|distance_km| format::distance_number(distance_km, 0, unit));
    format!("{apogee} × {perigee}")
}

/// Formats an age of elements, whose epoch may be ahead.
pub(super) fn age(seconds: f64) -> String {
    if seconds < 0.0 { "ahead".to_owned() } else { format::age(seconds) }
}

/// Returns the tone of the age of elements. Low orbits get a caution sooner, because drag changes
/// them.
pub(in crate::ui) fn age_tone(elements: &Elements, now: Timestamp) -> Tone {
    let age_s = elements.epoch_distance_s(now);
    let times = if elements.is_geosynchronous() { (30.0, 90.0) } else { (7.0, 30.0) };
    if age_s >= times.1 * DAY_S {
        Tone::Bad
    } else if age_s >= times.0 * DAY_S {
        Tone::Caution
    } else {
        Tone::Plain
    }
}

/// Returns the mark and colour of an age.
pub(in crate::ui) fn age_look(tone: Tone, t: &Tokens) -> (Option<Icon>, Color32) {
    match tone {
        Tone::Bad => (Some(Icon::Cross), t.bad),
        Tone::Caution => (Some(Icon::Warning), t.warn),
        Tone::Plain | Tone::Now | Tone::Good => (None, t.t1),
    }
}

/// Describes when the next pass begins.
pub(super) fn next_pass(next: Next, now: Timestamp) -> String {
    match next {
        Next::Unknown => "…".to_owned(),
        Next::Never => format!("none in {NEXT_PASSES_H} h"),
        Next::At(pass) if pass.is_always_up => "always up".to_owned(),
        Next::At(pass) if pass.aos <= now => {
            format!("up for {}", format::time_left(now, pass.los))
        }
        Next::At(pass) => {
            if seconds_between(now, pass.aos) < 600.0 {
                return format!("in {}", format::time_left(now, pass.aos));
            }
            format::minute(pass.aos, now)
        }
    }
}

/// Returns the reason why the table is empty.
pub(super) fn nothing_found(question: &Question, all: usize) -> String {
    let search = question.search.trim();
    match (&question.scope, search.is_empty()) {
        (Subset::Favourites, true) => {
            "No favourites yet: click the star of a satellite, or press F.".to_owned()
        }
        (Subset::Old, true) => "No elements are older than 7 d.".to_owned(),
        (_, true) => "There are no objects.".to_owned(),
        (Subset::All, false) => format!("No object matches \"{search}\"."),
        (_, false) => {
            let all = objects(all);
            format!("No object matches \"{search}\" here. Choose All to search {all}.")
        }
    }
}

/// Returns the location of a source.
pub(super) fn place(source: &Source) -> String {
    match &source.place {
        SourcePlace::File(path) | SourcePlace::Folder(path) => path.display().to_string(),
        SourcePlace::Web(url) => url.strip_prefix("https://").unwrap_or(url).to_owned(),
        SourcePlace::SpaceTrack(user) => format!("{user} at space-track.org"),
    }
}

/// Returns the state of a source in its row.
pub(super) fn state(
    source: &Source,
    report: Option<&SourceReport>,
    now: Timestamp,
) -> (Tone, String) {
    let sentences = sentences(source, report, now);
    let grave = [Tone::Bad, Tone::Caution]
        .into_iter()
        .find_map(|tone| sentences.iter().find(|(one_tone, _)| *one_tone == tone));
    let when = report.and_then(|report| report.as_of);
    let when = when.map_or_else(String::new, |time| format::moment(time, now));
    match (grave, report) {
        (Some((tone, words)), _) => (*tone, words.trim_end_matches('.').to_owned()),
        (None, Some(report)) if report.refused() > 0 => {
            let all = report.objects() + report.refused();
            (Tone::Caution, format!("{when}, {} of {all} refused", report.refused()))
        }
        (None, Some(report)) if report.newer_elsewhere > 0 => {
            let older = format!("{} newer elsewhere", older_of(report));
            let when = if when.is_empty() { String::new() } else { format!(", {when}") };
            (Tone::Plain, older + &when)
        }
        (None, _) if when.is_empty() => (Tone::Good, "read".to_owned()),
        (None, _) if source.place.is_server() => (Tone::Good, when),
        (None, _) => (Tone::Good, format!("changed {when}")),
    }
}

/// Returns sentences about the outcome of a source, most important first.
pub(in crate::ui) fn sentences(
    source: &Source,
    report: Option<&SourceReport>,
    now: Timestamp,
) -> Vec<(Tone, String)> {
    let Some(report) = report else {
        return vec![(Tone::Caution, "Not read.".to_owned())];
    };
    if report.is_set_aside {
        let words = "Set aside: Azel ended while reading this source. It is read again only when \
                     you ask.";
        return vec![(Tone::Bad, words.to_owned())];
    }
    let mut lines: Vec<(Tone, String)> = (report.files.iter())
        .filter_map(|file| {
            let (problem, place) = (file.problem.as_ref()?, file.path.display());
            Some((Tone::Bad, format!("Cannot be read: {problem}: {place}.")))
        })
        .collect();
    lines.extend(report.files.iter().filter_map(|file| {
        let (nothing, place) = (file.merge.nothing?, file.path.display());
        Some((Tone::Caution, format!("No elements: {nothing}: {place}.")))
    }));
    if report.objects() > 0 || lines.is_empty() {
        lines.insert(0, holdings(source, report, now));
    }
    if report.refused() > 0 {
        let refused = format::number(report.refused() as f64, 0);
        lines.push((Tone::Plain, format!("{refused} refused: unreadable.")));
    }
    if report.newer_elsewhere > 0 {
        let words = format!("Other sources have newer elements for {}.", older_of(report));
        lines.push((Tone::Plain, words));
    }
    if let Some(problem) = &report.fetch_problem {
        let stays = if report.objects() > 0 { " The previous elements stay in use." } else { "" };
        lines.push((Tone::Bad, format!("{}{stays}", sentence(&problem.to_string()))));
        lines.extend(advice(problem).map(|words| (Tone::Plain, words.to_owned())));
    }
    lines.extend(requested(report, now).map(|words| (Tone::Plain, words)));
    lines
}

/// Returns how many satellites of a source have newer elements elsewhere, such as "12 of 30".
fn older_of(report: &SourceReport) -> String {
    let [older, all] =
        [report.newer_elsewhere, report.objects()].map(|count| format::number(count as f64, 0));
    format!("{older} of {all}")
}

/// Returns the operator's next step after a problem.
fn advice(problem: &FetchProblem) -> Option<&'static str> {
    match problem {
        FetchProblem::NoPassword => Some("Choose Password in Elements to enter it."),
        FetchProblem::Keyring(_) => {
            Some("Unlock the keyring, or choose Password in Elements to enter it.")
        }
        FetchProblem::LogIn => Some(
            "Azel does not try again by itself, because the server locks accounts. Choose Password \
             in Elements to enter it again, or Fetch to try again.",
        ),
        FetchProblem::Unrecorded(_) | FetchProblem::QueryUnrecorded(_) => Some(
            "Make room on the disk, or give Azel access to its data folder. Azel asks a server with \
             limits only if it can record the time.",
        ),
        FetchProblem::UnknownAuthority => Some(
            "Add the authority of the server to those of this computer, or name its file in \
             SSL_CERT_FILE and start Azel again. If you know of no such authority, somebody may \
             answer in place of the server.",
        ),
        FetchProblem::Certificate(_) => {
            Some("Check the address and the clock of this computer, then ask who runs the server.")
        }
        FetchProblem::NoFavourites => Some("Mark the satellites that you want as favourites."),
        FetchProblem::Address
        | FetchProblem::Proxy(_)
        | FetchProblem::Answer(_)
        | FetchProblem::Unreachable(_)
        | FetchProblem::TooLarge(_)
        | FetchProblem::NoElements
        | FetchProblem::Nothing(_)
        | FetchProblem::Older
        | FetchProblem::NoSession
        | FetchProblem::Refused(_)
        | FetchProblem::Disk(_) => None,
    }
}

fn holdings(source: &Source, report: &SourceReport, now: Timestamp) -> (Tone, String) {
    if report.objects() == 0 {
        let words = match source.place {
            SourcePlace::Web(_) | SourcePlace::SpaceTrack(_) => "Holds nothing yet.",
            SourcePlace::File(_) | SourcePlace::Folder(_) => "Holds no elements.",
        };
        return (Tone::Caution, words.to_owned());
    }
    let newest = report.newest_epoch.map_or_else(String::new, |epoch| {
        let age_s = seconds_between(epoch, now);
        let word = if age_s < 0.0 { "ahead" } else { "old" };
        let age = format::age(age_s.abs());
        format!(", newest epoch {}, {age} {word}", format::iso_date(epoch))
    });
    let word = match source.place {
        SourcePlace::Web(_) | SourcePlace::SpaceTrack(_) => "Sent or confirmed",
        SourcePlace::File(_) | SourcePlace::Folder(_) => "Changed",
    };
    let age = report
        .age_s(now)
        .map_or_else(String::new, |age_s| format!(" {word} {} ago.", format::age(age_s)));
    (Tone::Good, format!("{}{newest}.{age}", objects(report.objects())))
}

/// Describes the times of the last and the next permitted request to the server.
fn requested(report: &SourceReport, now: Timestamp) -> Option<String> {
    let next = report.next_request(now)?;
    let last = next.checked_sub(FETCH_PAUSE).ok()?;
    let ago = format::age(seconds_between(last, now));
    let again = if next > now {
        format!(" It may be asked again from {}.", format::moment(next, now))
    } else {
        String::new()
    };
    Some(format!("Asked {ago} ago.{again}"))
}

/// Returns the confirmation before a premature request to a server; `None` if Azel may ask the
/// server now.
pub(super) fn ask_again(
    name: &str,
    report: Option<&SourceReport>,
    now: Timestamp,
) -> Option<String> {
    let next = report?.next_request(now).filter(|next| *next > now)?;
    let last = next.checked_sub(FETCH_PAUSE).ok()?;
    let ago = format::age(seconds_between(last, now));
    Some(format!(
        "The server of {name} was asked {ago} ago. Servers block clients that ask more often than \
         once every 2 h. Ask again anyway?"
    ))
}

/// Returns the reason why even the operator may not ask a server now.
pub(super) fn pause(report: Option<&SourceReport>, now: Timestamp) -> Option<String> {
    let end = report?.not_before(now).filter(|end| *end > now)?;
    let end = format::moment(end, now);
    Some(format!("The server limits requests. It may be asked again from {end}."))
}

/// Returns `true` if Azel may ask a source now.
pub(super) fn is_due(source: &Source, report: Option<&SourceReport>, now: Timestamp) -> bool {
    let awaits_operator = report.is_some_and(SourceReport::awaits_operator);
    let is_asked = source.place.is_server() && !awaits_operator;
    is_asked && report.and_then(|report| report.next_request(now)).is_none_or(|next| next <= now)
}

/// Describes when Azel next asks or reads a source.
pub(super) fn next(source: &Source, report: Option<&SourceReport>, now: Timestamp) -> String {
    if !source.place.is_server() {
        return "when you read it".to_owned();
    }
    if report.is_some_and(SourceReport::awaits_operator) {
        return "when you log in".to_owned();
    }
    match report.and_then(|report| report.next_request(now)) {
        _ if source.refresh.is_some() => match source.next_by_itself(report, now) {
            Some(next) if next > now => format!("automatically {}", until_minute(next, now)),
            _ => "automatically, now".to_owned(),
        },
        None => "due".to_owned(),
        Some(next) if next <= now => format!("due since {}", until_minute(next, now)),
        Some(next) => format!("from {}", until_minute(next, now)),
    }
}

/// Describes how often Azel asks a server automatically.
pub(super) fn refresh(hours: Option<RefreshHours>) -> String {
    match hours {
        None => "Only when you ask".to_owned(),
        Some(hours) => format!("Every {} h", u32::from(hours)),
    }
}

fn until_minute(time: Timestamp, now: Timestamp) -> String {
    let far = seconds_between(time, now).abs() >= DAY_S;
    if far { format::day(time) } else { format::minute(time, now) }
}

/// Format of copied elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Tle,
    Omm,
}

/// Formats elements as text. Leaves out objects that a TLE cannot carry.
pub(super) fn copied<'a>(elements: impl Iterator<Item = &'a Elements>, form: Form) -> String {
    match form {
        Form::Tle => elements
            .filter_map(|object| {
                let [first, second] = tle_lines(object).ok()?;
                Some(format!("{}\n{first}\n{second}\n", object.name()))
            })
            .collect(),
        Form::Omm => {
            let mut text = Vec::new();
            // A write to memory cannot fail.
            let _ = write_omm_json(elements, &mut text);
            String::from_utf8(text).unwrap_or_default()
        }
    }
}

/// Returns `true` if elements are so old that Azel mentions their age.
pub(super) fn is_old(elements: &Elements, now: Timestamp) -> bool {
    elements.epoch_distance_s(now) > OLD_ELEMENTS_S
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::{Angle, time::add_seconds},
        model::globe::NextPass,
        orbit::bundled,
    };

    fn now() -> Timestamp {
        "2026-11-14T12:15:30Z".parse().unwrap()
    }

    #[test]
    fn ages_and_numbers_fit_into_a_column() {
        for (seconds, words) in [
            (2_520.0, "42 min"),
            (22_260.0, "6 h 11 min"),
            (99_600.0, "1 d 3 h"),
            (95.5 * DAY_S, "95 d"),
            (-5.0, "ahead"),
        ] {
            assert_eq!(age(seconds), words);
        }
        assert_eq!(
            (number(25_544), number(799_501_204)),
            ("25544".into(), "799\u{2009}501\u{2009}204".into())
        );
    }

    #[test]
    fn a_next_pass_counts_down_and_has_the_date_of_another_day() {
        let pass = |from_s: f64| {
            let (aos, los) = (add_seconds(now(), from_s), add_seconds(now(), from_s + 600.0));
            let max_elevation = Angle::from_degrees(20.0);
            Next::At(NextPass { aos, los, max_elevation, is_always_up: false })
        };
        for (next, words) in [
            (Next::Unknown, "…"),
            (Next::Never, "none in 24 h"),
            (pass(-408.0), "up for 3:12"),
            (pass(280.0), "in 4:40"),
            (pass(1200.0), "12:35Z"),
            (pass(43_200.0), "15 Nov 00:15Z"),
        ] {
            assert_eq!(next_pass(next, now()), words);
        }
    }

    #[test]
    fn copied_elements_can_be_read_again() {
        let catalog = bundled().unwrap();
        let iss = catalog.get(25_544).unwrap();
        for form in [Form::Tle, Form::Omm] {
            let read = crate::orbit::read_elements(&copied([iss].into_iter(), form)).elements;
            assert_eq!((read.len(), read[0].name()), (1, "ISS (ZARYA)"), "{form:?}");
            assert_eq!(read[0].epoch(), iss.epoch());
        }
    }

    #[test]
    fn a_certificate_that_is_not_trusted_comes_with_what_to_do() {
        let source = Source::celestrak("active");
        for (problem, words) in [
            (FetchProblem::UnknownAuthority, "SSL_CERT_FILE"),
            (FetchProblem::Certificate("expired".to_owned()), "clock of this computer"),
        ] {
            let report = SourceReport {
                source: source.name.clone(),
                files: Vec::new(),
                as_of: None,
                newest_epoch: None,
                fetch_problem: Some(problem),
                failures: 1,
                next_fetch: None,
                limits: Vec::new(),
                is_set_aside: false,
                newer_elsewhere: 0,
            };
            let lines = sentences(&source, Some(&report), now());
            assert!(lines.iter().any(|(_, line)| line.contains("certificate")), "{lines:?}");
            assert!(lines.iter().any(|(_, line)| line.contains(words)), "{lines:?}");
        }
    }
}
