//! Station without a window: it runs until the operating system ends it, and reports its
//! events on standard output.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
    process::ExitCode,
    sync::{Arc, mpsc},
    time::{Duration, Instant},
};

use anyhow::{Context as _, bail};
use clap::{Args, ValueEnum};
use jiff::Timestamp;
use serde::Serialize;

use super::log::Lines;
use crate::{
    app::notifier::Notifier,
    clock::Clock,
    contract::{
        Command, CommandOrigin, Event, Snapshot,
        antenna::{AntennaModel, Stake},
        claim::HolderKind,
        closing::CloseHow,
    },
    controller::SPECS,
    desktop::Desktop,
    engine::{
        Handle, Settings,
        claim::LockFolders,
        records_folder, signals,
        status::{AntennaStatus, LinkStatus},
    },
    station,
    ui::words,
};

/// Time limit for the end; anything unproved by then is reported.
const ENDS_WITHIN: Duration = Duration::from_secs(8);
/// Exit code when an antenna is not known to stand at the end.
const NOT_PROVED: u8 = 4;

#[derive(Debug, Args)]
pub(super) struct Options {
    /// Form of the lines on standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Let the members of this group stop antennas and read their status: puts the socket into the
    /// folder that systemd makes for the service, or into /run/azel
    #[cfg(unix)]
    #[arg(long, value_name = "NAME")]
    group: Option<String>,
}

/// How a line is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people
    Text,
    /// One JSON object a line
    Json,
}

/// Report of an event at a station.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Announcement {
    pub time: Timestamp,
    /// Name of the antenna, if the event has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antenna: Option<String>,
    #[serde(rename = "about")]
    pub subject: AnnouncedSubject,
    /// Event in words.
    pub text: String,
}

/// Subject of a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AnnouncedSubject {
    /// The station as a whole.
    Station,
    /// A link came or went.
    Link,
    /// The intent of an antenna changed.
    Intent,
    /// An antenna moves, or stands.
    Motion,
    /// The tracked target changed.
    Track,
    Stop,
    LockOut,
    /// An alarm was raised.
    Alarm,
    AlarmOver,
}

impl Announcement {
    fn line(&self, format: Format) -> String {
        match format {
            Format::Json => serde_json::to_string(self).unwrap_or_default(),
            Format::Text => {
                let time = self.time.strftime("%FT%TZ");
                let antenna = self.antenna.as_ref().map(|name| format!(" {name}:"));
                format!("{time}{} {}", antenna.unwrap_or_default(), self.text)
            }
        }
    }
}

pub(super) fn run(
    station: Option<PathBuf>,
    options: &Options,
    dead_man: Option<PathBuf>,
    marks: Option<PathBuf>,
    folders: Option<LockFolders>,
) -> anyhow::Result<ExitCode> {
    #[cfg(unix)]
    let folders = match &options.group {
        Some(name) => {
            let group = group_to_open(name)?;
            folders.map(|folders| folders.open_to(group))
        }
        None => folders,
    };
    let claims = folders.map(|folders| (folders, HolderKind::Serve));
    let records = records_folder();
    let settings =
        Settings { path: station, dead_man, marks, records, claims, ..Settings::default() };
    let path = settings.station_path().context("this user has no folder for settings")?;
    if !path.exists() {
        bail!(
            "There is no station file at {}. Set the station up in the window first, or name its \
             file with --station.",
            path.display()
        );
    }
    if let Err(error) = station::load(&path, SPECS) {
        bail!("{error}");
    }
    let format = options.format;
    let lines = Lines::to_standard_output(match format {
        Format::Text => |dropped| format!("{dropped} lines were dropped: nobody read them"),
        Format::Json => |dropped| format!("{{\"dropped\":{dropped}}}"),
    })?;
    // One pending wake is as good as many.
    let (wake, woken) = mpsc::sync_channel(1);
    let end = wake.clone();
    let woken_by = wake.clone();
    let station = Handle::start(
        settings,
        Clock::system(),
        Arc::new(move || {
            let _ = woken_by.try_send(Wake::Station);
        }),
    )?;
    drop(wake);
    Notifier::start(station.client().clone(), Desktop::default(), Arc::new(|| {}))?;
    let client = station.client().clone().acting_for(CommandOrigin::Signal);
    signals::watch(
        move || client.stop_all(),
        move || {
            let _ = end.send(Wake::End);
        },
    )?;
    let ended = until_the_end(station, &woken, &mut |announcement: &Announcement| {
        lines.say(&announcement.line(format));
    });
    lines.finish();
    if ended.broke_down {
        bail!("the station broke down");
    }
    if ended.not_proved.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    let antennas = ended.not_proved.join(", ");
    tracing::error!("not known to stand at the end: {antennas}");
    Ok(ExitCode::from(NOT_PROVED))
}

/// Number of the group called `name`, to which this process can open its socket.
#[cfg(unix)]
fn group_to_open(name: &str) -> anyhow::Result<u32> {
    use nix::unistd::{Group, getegid, geteuid, getgroups};
    let group = Group::from_name(name)?.with_context(|| format!("there is no group {name}"))?.gid;
    let is_member = geteuid().is_root() || group == getegid() || getgroups()?.contains(&group);
    if !is_member {
        bail!("The user of this service is no member of the group {name}.");
    }
    Ok(group.as_raw())
}

/// Reason why the main loop goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wake {
    /// The station has something new.
    Station,
    /// The program must end.
    End,
}

/// End of a station.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ended {
    /// Names of the antennas that are not known to stand although the station file demands it.
    pub not_proved: Vec<String>,
    /// The part of the program that ran the station is gone.
    pub broke_down: bool,
}

/// Reports the events of a station until it must end. Then stops or leaves its antennas,
/// as the station file says, and proves it.
pub fn until_the_end(
    mut station: Handle,
    woken: &mpsc::Receiver<Wake>,
    tell: &mut dyn FnMut(&Announcement),
) -> Ended {
    let mut reporter = Reporter::default();
    loop {
        // A second, for displays that only ages change.
        let wake = woken.recv_timeout(Duration::from_secs(1));
        while station.next_event().is_some() {}
        station.take();
        reporter.tell(station.snapshot(), tell);
        if wake == Ok(Wake::End) || !station.runs() {
            break;
        }
    }
    let choice = match CloseHow::from_station(&station.snapshot().station) {
        // Parking takes longer than the operating system waits.
        None | Some(CloseHow::Hold | CloseHow::Park) => CloseHow::Hold,
        Some(CloseHow::Leave) => CloseHow::Leave,
    };
    say(tell, None, AnnouncedSubject::Station, "Ends.".to_owned());
    // A station that does not take it has stopped, or has broken down: see below.
    let serve = station.client().clone().acting_for(CommandOrigin::Serve);
    let _ = serve.send(Command::CloseAfter(choice));
    let end = Instant::now() + ENDS_WITHIN;
    let is_left = |stake: &Stake| choice == CloseHow::Leave && matches!(stake, Stake::OnBoard(_));
    let open = |antenna: &AntennaModel| antenna.stake().is_some_and(|stake| !is_left(&stake));
    let (mut may_end, mut is_passed) = (false, false);
    loop {
        let left = end.saturating_duration_since(Instant::now());
        // Further signals change nothing.
        let _ = woken.recv_timeout(left.min(Duration::from_millis(100)));
        station.take();
        let snapshot = Arc::clone(station.snapshot());
        reporter.tell(&snapshot, tell);
        may_end |= std::iter::from_fn(|| station.next_event()).any(|event| event == Event::MayEnd);
        if station.stood_for().is_some() && !std::mem::replace(&mut is_passed, true) {
            // The station does not carry the command out: STOP goes past it.
            station.client().stop_all();
        }
        let stand = !snapshot.antennas.iter().any(open);
        let broke_down = !station.runs();
        if (may_end && stand) || left.is_zero() || broke_down {
            // A snapshot of a station that does not respond proves nothing.
            let names = snapshot.antennas.iter().filter(|antenna| is_passed || open(antenna));
            let not_proved = names.map(|model_antenna| model_antenna.config.name.clone()).collect();
            return Ended { not_proved, broke_down };
        }
    }
}

/// Reports the changes from one snapshot to the next.
#[derive(Default)]
struct Reporter {
    antennas: BTreeMap<String, AntennaStatus>,
    /// Standing alarms by their numbers.
    alarms: BTreeMap<u64, (Option<String>, String)>,
    begun: bool,
}

impl Reporter {
    fn tell(&mut self, station: &Snapshot, tell: &mut dyn FnMut(&Announcement)) {
        if !std::mem::replace(&mut self.begun, true) {
            let count = station.antennas.len();
            let plural = if count == 1 { "" } else { "s" };
            let text = format!("{}, {count} antenna{plural}.", station.station.name);
            say(tell, None, AnnouncedSubject::Station, text);
        }
        let now = AntennaStatus::of_all(station);
        for status in &now {
            let before = self.antennas.get(&status.antenna);
            for (subject, text) in changes(before, status) {
                say(tell, Some(&status.antenna), subject, text);
            }
        }
        self.antennas = now.into_iter().map(|status| (status.antenna.clone(), status)).collect();
        self.tell_alarms(station, tell);
    }

    fn tell_alarms(&mut self, station: &Snapshot, tell: &mut dyn FnMut(&Announcement)) {
        let mut standing = BTreeSet::new();
        for alarm in station.alarms.list().iter().filter(|alarm| !alarm.is_over()) {
            standing.insert(alarm.id);
            if self.alarms.contains_key(&alarm.id) {
                continue;
            }
            let antenna = alarm.antenna.and_then(|id| {
                station.antennas.iter().find(|model_antenna| model_antenna.id() == id)
            });
            let name = antenna.map(|antenna| antenna.config.name.clone());
            let text =
                words::alarm(&alarm.kind, name.as_deref().unwrap_or("Azel"), Timestamp::now());
            say(tell, name.as_deref(), AnnouncedSubject::Alarm, text.clone());
            self.alarms.insert(alarm.id, (name, text));
        }
        let ended: Vec<u64> =
            self.alarms.keys().filter(|id| !standing.contains(id)).copied().collect();
        for id in ended {
            if let Some((name, text)) = self.alarms.remove(&id) {
                say(tell, name.as_deref(), AnnouncedSubject::AlarmOver, format!("Over: {text}"));
            }
        }
    }
}

fn say(
    tell: &mut dyn FnMut(&Announcement),
    antenna: Option<&str>,
    subject: AnnouncedSubject,
    text: String,
) {
    let antenna = antenna.map(str::to_owned);
    tell(&Announcement { time: Timestamp::now(), antenna, subject, text });
}

/// Differences between two states of an antenna, in words.
fn changes(before: Option<&AntennaStatus>, now: &AntennaStatus) -> Vec<(AnnouncedSubject, String)> {
    let mut announcements = Vec::new();
    if before.map(|before| before.link) != Some(now.link) {
        announcements.push((AnnouncedSubject::Link, link(now.link).to_owned()));
    }
    let is_known = before.is_some();
    let was = |differs: fn(&AntennaStatus, &AntennaStatus) -> bool| {
        before.is_some_and(|before| differs(before, now))
    };
    if was(|before, now| before.owes_stop != now.owes_stop) {
        let text = if now.owes_stop { "STOP, not confirmed yet." } else { "STOP is confirmed." };
        announcements.push((AnnouncedSubject::Stop, text.to_owned()));
    }
    if !is_known || was(|before, now| before.locked_out != now.locked_out) {
        match &now.locked_out {
            Some(author) => {
                announcements.push((AnnouncedSubject::LockOut, format!("Locked out by {author}")));
            }
            None if is_known => announcements
                .push((AnnouncedSubject::LockOut, "Not locked out any more.".to_owned())),
            None => {}
        }
    }
    if was(|before, now| before.intent != now.intent) {
        announcements.push((AnnouncedSubject::Intent, format!("Intent: {}.", now.intent)));
    }
    if before.and_then(|before| before.tracks.as_ref()) != now.tracks.as_ref() {
        announcements.push((
            AnnouncedSubject::Track,
            now.tracks.as_ref().map_or_else(
                || "Tracks nothing any more.".to_owned(),
                |name| format!("Tracks {name}."),
            ),
        ));
    }
    if before.and_then(|before| before.moves) != now.moves
        && let Some(moves) = now.moves
    {
        let place = match (now.azimuth_deg, now.elevation_deg) {
            (Some(azimuth), Some(elevation)) => format!(" at {azimuth:.1}, {elevation:.1}"),
            (Some(azimuth), None) => format!(" at {azimuth:.1}"),
            _ => String::new(),
        };
        let verb = if moves { "Moves" } else { "Stands" };
        announcements.push((AnnouncedSubject::Motion, format!("{verb}{place}.")));
    }
    announcements
}

fn link(link: LinkStatus) -> &'static str {
    match link {
        LinkStatus::Off => "No link is wanted.",
        LinkStatus::Connecting => "Connects.",
        LinkStatus::Up => "The link is up.",
        LinkStatus::Stale => "The last answer is old.",
        LinkStatus::Lost => "The link is lost.",
        LinkStatus::Elsewhere => "Driven by another Azel of this machine.",
    }
}
