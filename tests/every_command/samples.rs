//! One sample of every command to an antenna and to a station.

use std::{net::SocketAddr, path::PathBuf};

use azel::{
    astro::{Angle, AzEl, Offset, Site, TrackOffsets},
    contract::{
        self, Attention,
        alarms::ShelveTime,
        closing::CloseHow,
        control::ClientCommand,
        driver::{Command, OffsetChange},
        older_sets::SetChoice,
        passes::{PassListKey, Scope},
        record::{Peak, PeakBody, PeakChange},
        source_tests::TestAsk,
        sources::Copied,
        uploads::Ask,
    },
    device::{Pointing, panel::Act, settings::Change},
    orbit::{Source, SourcePlace},
    plan::{OnBoardPass, ProgramTrack, Target},
    secret::Secret,
    station::{
        AntennaId, Hook, HookAction, HookEvent, LockOut, OffsetsSubject, PassLimits, Priority,
        Station,
    },
};
use jiff::Timestamp;

/// Sample values that depend on the make.
pub(super) struct Values {
    pub(super) pass: OnBoardPass,
    pub(super) site: Site,
    pub(super) act: &'static str,
    pub(super) change: Change,
    /// Settings group that a session reads only on request.
    pub(super) group: &'static str,
    pub(super) question: &'static str,
}

/// List of samples by their patterns. A new variant does not compile until it has a sample.
macro_rules! samples {
    ($($pattern:pat => $sample:expr,)*) => {{
        let samples = vec![$({
            let sample = $sample;
            assert!(matches!(sample, $pattern), "{sample:?} is no sample of its pattern");
            sample
        }),*];
        for sample in &samples {
            match sample {
                $($pattern => {})*
            }
        }
        samples
    }};
}

/// Returns the name of a command's variant; `AutoTrack` keeps its value.
pub(super) fn name(command: &Command) -> String {
    let text = format!("{command:?}");
    let end = text.find(['(', ' ']).filter(|_| !text.starts_with("AutoTrack"));
    text[..end.unwrap_or(text.len())].to_owned()
}

/// Returns a lock-out by the person who works on the unit.
pub(super) fn lock_out() -> LockOut {
    LockOut {
        operator: "Ada".to_owned(),
        start: "2026-08-12T10:00:00Z".parse().unwrap(),
        reason: "gear box open".to_owned(),
    }
}

/// Returns a hook of a program that does nothing.
fn hook() -> Hook {
    Hook::new("hook", HookEvent::Aos, HookAction::Command(vec!["true".to_owned()]))
}

/// Returns a direction that every simulated unit reaches, away from its start.
pub(super) fn elsewhere() -> Pointing {
    Pointing {
        azimuth: Some(Angle::from_degrees(100.0)),
        elevation: Some(Angle::from_degrees(30.0)),
    }
}

/// Returns a command to go to [`elsewhere`], which takes some time.
pub(super) fn go_elsewhere() -> Command {
    let Pointing { azimuth, elevation } = elsewhere();
    Command::Position { azimuth, elevation }
}

/// Returns one of each command, in the order of [`Command`].
pub(super) fn commands(values: &Values) -> Vec<Command> {
    use azel::contract::driver::Command as C;
    let target = Target::Fixed(AzEl::from_degrees(110.0, 40.0));
    let track = || {
        let passes = vec![(Timestamp::MIN, Timestamp::MAX)];
        Box::new(ProgramTrack::new(target.clone(), values.site, passes))
    };
    let act = || Act { action: values.act, values: [].into() };
    let tenth = Angle::from_degrees(0.1);
    samples! {
        C::Standby => C::Standby,
        C::Manual => C::Manual,
        C::Hold => C::Hold,
        C::Jog { .. } => C::Jog { rates_deg_s: [1.0, 0.0] },
        C::EndJog => C::EndJog,
        C::AllowUnguarded => C::AllowUnguarded,
        C::AllowWayOut => C::AllowWayOut,
        C::ForgetDrives => C::ForgetDrives,
        C::MoveAway => C::MoveAway,
        C::Step { .. } => C::Step { steps_deg: [1.0, 0.0] },
        C::Position { .. } => go_elsewhere(),
        C::Track(_) => C::Track(Box::new(values.pass.clone())),
        C::TakeOver => C::TakeOver,
        C::ProgramTrack(_) => C::ProgramTrack(track()),
        C::ProgramTrackIntoSun(_) => C::ProgramTrackIntoSun(track()),
        C::Offset(_) => C::Offset(OffsetChange::Step(Offset::Azimuth(tenth))),
        C::FirstOffsets(_) => {
            C::FirstOffsets(TrackOffsets::NONE.plus(Offset::Azimuth(tenth)).unwrap())
        },
        C::EndAtTarget => C::EndAtTarget,
        C::Resume => C::Resume,
        C::SeenStanding => C::SeenStanding,
        C::Park => C::Park,
        C::Preview(_) => C::Preview(Some(elsewhere())),
        C::Connect => C::Connect,
        C::Disconnect => C::Disconnect,
        C::Act(_) => C::Act(act()),
        C::ActUnseen(_) => C::ActUnseen(act()),
        C::AutoTrack(true) => C::AutoTrack(true),
        C::AutoTrack(false) => C::AutoTrack(false),
        C::ReadGroup(_) => C::ReadGroup(values.group),
        C::WriteSettings(_) => C::WriteSettings(values.change.clone()),
        C::LockOut(_) => C::LockOut(lock_out()),
        C::Unlock => C::Unlock,
        C::Ask(_) => C::Ask(values.question.into()),
    }
}

/// Returns the address of a program that is not connected.
fn program() -> SocketAddr {
    "127.0.0.1:40000".parse().unwrap()
}

/// Returns one of each command to a station, in the order of [`engine::Command`], without antenna
/// commands. None of these commands reaches a network.
pub(super) fn commands_of_stations(
    antenna: AntennaId,
    pass: PassListKey,
    station: Station,
) -> Vec<contract::Command> {
    use azel::contract::Command as C;
    let (number, aos) = pass;
    let numbers = || vec![number];
    let unit = station.antennas.first().unwrap().clone();
    let nowhere = || PathBuf::from("nowhere");
    let source =
        Source { name: "own".to_owned(), place: SourcePlace::File(nowhere()), refresh: None };
    let peak = Peak { body: PeakBody::Sun, time: aos, azimuth_deg: 100.0, elevation_deg: 20.0 };
    samples! {
        C::Antenna(..) => C::Antenna(antenna, Command::Standby),
        C::Track { .. } => C::Track { antenna, pass, is_agreed: true },
        C::ProgramTrackPass { .. } => C::ProgramTrackPass { antenna, pass },
        C::SetAutomatic { is_on: true, .. } => C::SetAutomatic { antenna, is_on: true },
        C::SetAutomatic { is_on: false, .. } => C::SetAutomatic { antenna, is_on: false },
        C::GoOn(_) => C::GoOn(antenna),
        C::ChoosePass { .. } => C::ChoosePass { satellite: number, tca: aos, take: None },
        C::PriceSwap(_) => C::PriceSwap(pass),
        C::Client(..) => C::Client(antenna, ClientCommand::Park),
        C::TakeControl(_) => C::TakeControl(antenna),
        C::ReleaseControl(_) => C::ReleaseControl(antenna),
        C::HandOver { .. } => C::HandOver { antenna, client: program(), always: false },
        C::SetPassLimits { .. } => {
            C::SetPassLimits { numbers: numbers(), limits: PassLimits::default() }
        },
        C::SetScheduling(_) => C::SetScheduling(station.scheduling),
        C::SetElevationFloor(_) => C::SetElevationFloor(station.elevation_floor_deg),
        C::CancelSearch(_) => C::CancelSearch(Scope::All),
        C::ResumeSearch(_) => C::ResumeSearch(Scope::Favourites),
        C::SetFavourites { .. } => C::SetFavourites { numbers: numbers(), is_favourite: true },
        C::SetPriority { .. } => {
            C::SetPriority { numbers: numbers(), priority: Priority::default() }
        },
        C::SetSourceOrder { .. } => {
            C::SetSourceOrder { satellite: number, sources: vec!["own".to_owned()] }
        },
        C::SetFrequencies { .. } => {
            C::SetFrequencies { satellite: number, frequencies: Vec::new() }
        },
        C::KeepOffsets { .. } => {
            C::KeepOffsets { subject: OffsetsSubject::Antenna(antenna), offsets: TrackOffsets::NONE }
        },
        C::AddSource(_) => C::AddSource(source),
        C::RemoveSource(_) => C::RemoveSource("own".to_owned()),
        C::SetRefresh { .. } => C::SetRefresh { name: "own".to_owned(), hours: None },
        C::CopyElements { .. } => {
            C::CopyElements { name: "copy".to_owned(), origin: Copied::File(nowhere()) }
        },
        C::ListOlderSets(_) => C::ListOlderSets(number),
        C::LookAtRecord(_) => C::LookAtRecord(None),
        C::FitPointing(..) => C::FitPointing(antenna, Vec::new()),
        C::ChangePeaks(..) => C::ChangePeaks(antenna, PeakChange::Added(peak)),
        C::UseSet(_) => C::UseSet(SetChoice::Newest { catalog_number: number }),
        C::RefreshSources { .. } => C::RefreshSources { names: Vec::new(), forced: false },
        C::SetSourcePassword { .. } => C::SetSourcePassword {
            name: "own".to_owned(),
            secret: Secret::new("hunter2"),
            keep: false,
        },
        C::OpenedAlarms => C::OpenedAlarms,
        C::AcknowledgeAlarm(_) => C::AcknowledgeAlarm(1),
        C::AcknowledgeAlarms { .. } => C::AcknowledgeAlarms { newest: 1 },
        C::ShelveAlarm { .. } => C::ShelveAlarm { id: 1, time: ShelveTime::OneHour },
        C::UnshelveAlarm(_) => C::UnshelveAlarm(1),
        C::SaveSettings(_) => C::SaveSettings(antenna),
        C::CompareSettings(_) => C::CompareSettings(antenna),
        C::ReadCopy { .. } => C::ReadCopy { antenna, path: nowhere() },
        C::CloseCopy => C::CloseCopy,
        C::SaveStation(_) => C::SaveStation(Box::new(station)),
        C::Upload(Ask::AgreeToTracking) => C::Upload(Ask::AgreeToTracking),
        C::Upload(_) => C::Upload(Ask::Cancel),
        C::TestSource(_) => C::TestSource(TestAsk::Cancel),
        C::TestLink(_) => C::TestLink(Box::new(unit)),
        C::TryHook(_) => C::TryHook(Box::new(hook())),
        C::CloseAfter(CloseHow::Park) => C::CloseAfter(CloseHow::Park),
        C::CloseAfter(CloseHow::Hold) => C::CloseAfter(CloseHow::Hold),
        C::CloseAfter(CloseHow::Leave) => C::CloseAfter(CloseHow::Leave),
        C::StayOpen => C::StayOpen,
        C::Look(_) => C::Look(Attention::default()),
    }
}
