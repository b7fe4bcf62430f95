//! Fills the antenna card from the model and passes its actions on.

mod asked;
mod axes;
mod live;
mod locks;
mod offsets;

use egui::{Align2, Rect, Ui};

pub(super) use self::locks::Locks;
use self::{asked::CardHandler, offsets::CardOffsets};
use super::{
    antenna_card::{
        self, CardAction, CardModel, CardState, DriveModel, FaultsModel, FollowModel, HeaderModel,
        LinkStatus, LiveNow, LockOutModel, MoreModel, Offer, OtherAntenna, TrackModel, WayOutModel,
    },
    passes,
};
use crate::{
    astro::{Angle, time::seconds_between},
    contract::{
        CatalogState,
        antenna::{Answers, AntennaModel},
        driver::{Intent, LinkState, Snapshot},
    },
    device::{Capabilities, Pointing},
    model::{Model, UiCommand},
    plan::{Barrier, pass_report::Explained},
    station::{AntennaId, Mount},
    ui::{
        antennas, bar,
        confirm::Question,
        dialogs::MaintenanceDialog,
        format, replay,
        state_sentence::{short, state_sentence},
        text, theme,
        widgets::{
            axes_table::{AxesTable, WantedColumn},
            beam_bar::BeamModel,
            go_to::Target,
            jog_pad::JogDirection,
            mode_selector::{self, ModeModel},
            paint,
        },
        words,
    },
};

/// Draws the card of `antenna`; `on_cards` are all antennas with a card, `live` is what the card says
/// of the live station.
// The card, its antenna, and the receivers of requests.
#[allow(clippy::too_many_arguments)]
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    antenna: &AntennaModel,
    on_cards: &[AntennaId],
    live: Option<&LiveNow>,
    state: &mut CardState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let snapshot = &antenna.snapshot;
    let (make, can) = (antenna.variant(), antenna.variant().capabilities);
    let (second_line, recorded) = (second_line(antenna), recorded(model));
    let alarm = bar::alarm(model, antenna);
    let table = axes::table(antenna);
    let (age, wanted) = (age_of_old(model, antenna), wanted(antenna));
    let predicted_decimals = model.appearance.angle_decimals as usize;
    let decimals = format::decimals(can, predicted_decimals);
    let checks = &snapshot.state.checks;
    let checked_at = snapshot.state.checked_at.map(|at| format::moment(at, model.now));
    let checked_at = checked_at.unwrap_or_default();
    let others = others(model, on_cards);
    let in_replay = replay::locked(&antenna.config.name);
    let locks = Locks::of(model, antenna, !checks.is_empty(), &in_replay);
    let blocked = snapshot.state.measured.map(|at| axes::blocked(at, can)).unwrap_or_default();
    let (jog_note, travel) = (axes::unseen(antenna), axes::travel(antenna));
    let modes = modes(can);
    let is_foreign = antenna.tracks_unasked();
    let mode = if is_foreign { Intent::Track } else { snapshot.intent };
    let commanded = [0, 1].map(|index| table.get(index).and_then(|row: &axes::Row| row.wanted_deg));
    let [misses, note] = on_board(model, antenna);
    let nothing_left = passes::nothing_left(model, antenna);
    let asks_unseen = antenna.asks_unseen.as_ref().and_then(|act| make.action(act.action));
    let note = snapshot.sun_lifted.then(|| words::SUN_IS_LIFTED.to_owned()).or(note);
    let asks_standing = words::asks_standing(snapshot, model.now);
    let sun_avoidance = sun_avoidance(model, antenna);
    let (parks_at, way_out) = (words::parks_at(antenna), way_out(antenna));
    let go_on = words::automatic::go_on(model, antenna);
    let automatic = words::automatic::in_full(model, antenna);
    let offsets = CardOffsets::of(model, antenna);
    let held_head = held_head(model, antenna);
    state_sentence(model, antenna).with_sentence(|sentence| {
        let card = CardModel {
            header: HeaderModel {
                second_line: &second_line,
                alarm: alarm.as_deref(),
                recorded: recorded.as_deref(),
                ..header(model, antenna)
            },
            sentence: *sentence,
            offer: offer(antenna, offsets.left()),
            automatic: automatic.as_deref().map(|words| bar::automatic_model(antenna, words)),
            go_on: go_on.as_deref(),

            axes: AxesTable {
                wanted_column: wanted,
                decimals,
                predicted_decimals,
                age: age.as_deref(),
                axes: &table,
            },
            // Kept also without a prediction: the keys below must not jump.
            beam: Some(BeamModel {
                error_deg: antenna.error().map(|error| error.off_beam.degrees()),
                half_beam_deg: antenna.config.beam_width_deg / 2.0,
            }),
            travel: &travel,
            modes: ModeModel {
                offered: &modes,
                current: (!snapshot.pending && snapshot.link != LinkState::Off).then_some(mode),
                is_foreign,
                is_locked: model.replay.is_some() || snapshot.link == LinkState::Off,
                pending: snapshot.pending.then_some(mode),
            },
            track: modes.contains(&Intent::Track).then(|| TrackModel {
                misses: misses.as_deref(),
                nothing_left: nothing_left.as_deref(),
                note: note.as_deref(),
                parks_at: &parks_at,
                ..track(model, antenna, &locks, &held_head, sun_avoidance.as_deref())
            }),
            offsets: offsets.model(antenna, &locks),
            drive: DriveModel {
                commanded_deg: commanded.into(),
                commanded_decimals: wanted.decimals(decimals, predicted_decimals),
                ..drive(antenna, &locks, &blocked, jog_note.as_deref())
            },
            live,
            readings: &snapshot.state.readings,
            faults: faults(model, antenna, &checked_at),
            more: MoreModel {
                actions: make.actions,
                locked: locks.link,
                moves_locked: locks.action,
            },
            lock_out: lock_out(snapshot),
            asks_standing: asks_standing.as_deref(),
            asks_unseen: asks_unseen.map(|action| action.description),
            way_out: way_out.as_ref().map(|(words, hold)| WayOutModel { words, hold: *hold }),
            others: &others,
        };
        let mut handler = CardHandler { model, antenna, question, commands };
        for action in antenna_card::show(ui, rect, &card, state) {
            if action == CardAction::Maintenance {
                state.maintenance = Some(MaintenanceDialog::default());
            } else {
                handler.take(action);
            }
        }
    });
    MaintenanceDialog::show(&mut state.maintenance, ui, model, question, commands);
}

/// Draws the place of the card while there is no antenna.
pub(super) fn none(ui: &mut Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    if model.demo && !matches!(model.catalog, CatalogState::Failed) {
        let (t, inner) = (theme::tokens(ui), rect.shrink(16.0));
        let words = "The simulated antennas are starting.";
        paint::text(ui, inner.left_top(), Align2::LEFT_TOP, words, text::body(), t.t2);
        return;
    }
    antennas::none(ui, rect, model, commands);
}

/// The line below the sentence: offsets to take back, or a track to take up again or to take over.
fn offer<'a>(antenna: &'a AntennaModel, left: Option<&'a str>) -> Option<Offer<'a>> {
    if let Some(added) = left {
        return Some(Offer::TakeBack(added));
    }
    let again = antenna.track_again.as_ref().map(|again| Offer::TrackAgain(short(&again.name)));
    let name = antenna.tracked_name().filter(|_| antenna.tracks_unasked());
    // Without the elements, Azel has nothing to watch the track by.
    let taken = name.filter(|_| antenna.snapshot.on_board.is_some());
    again.or(taken.map(|name| Offer::TakeOver(short(name))))
}

/// The checks of a unit that has some, with the time of its last report.
fn faults<'a>(
    model: &Model,
    antenna: &'a AntennaModel,
    checked_at: &'a str,
) -> Option<FaultsModel<'a>> {
    let checks = &antenna.snapshot.state.checks;
    let is_known = antenna.answers(model.steady).is_current();
    (!checks.is_empty()).then_some(FaultsModel { is_known, checks, checked_at })
}

fn lock_out(snapshot: &Snapshot) -> Option<LockOutModel<'_>> {
    let lock_out = snapshot.lock_out.as_ref()?;
    Some(LockOutModel { by: &lock_out.operator, locking: snapshot.locking })
}

/// The age of measured values that are old.
fn age_of_old(model: &Model, antenna: &AntennaModel) -> Option<String> {
    let measured = antenna.snapshot.state.measured.filter(|_| !antenna.is_live())?;
    let age = model.steady.saturating_duration_since(measured.requested);
    Some(format::age(age.as_secs_f64()))
}

/// Values beside the measured ones.
fn wanted(antenna: &AntennaModel) -> WantedColumn {
    if antenna.snapshot.aim.is_none() && antenna.prediction.is_some() {
        WantedColumn::Predicted
    } else {
        WantedColumn::Command
    }
}

/// Sentence about the Sun avoidance that following the Sun lifts.
fn sun_avoidance(model: &Model, antenna: &AntennaModel) -> Option<String> {
    let sun = model.station.sun_avoidance?;
    Some(words::sun_lifted(&antenna.config.name, sun.radius_deg))
}

fn second_line(antenna: &AntennaModel) -> String {
    let kind = match antenna.config.mount {
        Mount::AzEl { .. } => antenna.spec().name,
        Mount::Xy { .. } => "X/Y mount",
    };
    match (&antenna.snapshot.state.unit_name, antenna.config.mount) {
        (Some(name), _) => format!("{kind}, {name}"),
        (None, Mount::AzEl { .. }) => kind.to_owned(),
        (None, Mount::Xy { .. }) => format!("{kind} at {}", antenna.config.connection.address),
    }
}

/// The head of the card without words that are made for it.
fn header<'a>(model: &Model, antenna: &'a AntennaModel) -> HeaderModel<'a> {
    HeaderModel {
        name: &antenna.config.name,
        second_line: "",
        link: bar::glyph(model, antenna),
        status: link_status(model, antenna),
        takes_panel: antenna.variant().capabilities.waits_for_word,
        in_maintenance: antenna.snapshot.lock_out.is_some(),
        alarm: None,
        recorded: None,
    }
}

/// In a replay: of what time the card is.
fn recorded(model: &Model) -> Option<String> {
    let replay = model.replay.as_ref()?;
    Some(format!("as recorded at {}", format::moment(replay.time, replay.time)))
}

fn link_status(model: &Model, antenna: &AntennaModel) -> LinkStatus {
    let snapshot = &antenna.snapshot;
    match antenna.answers(model.steady) {
        _ if antenna.held_by.is_some() => LinkStatus::Elsewhere,
        Answers::Off => LinkStatus::NotConnected,
        _ if snapshot.lock_out.is_some() => LinkStatus::InMaintenance,
        Answers::InTime => LinkStatus::Connected,
        Answers::Connecting => LinkStatus::Connecting,
        Answers::Late(_) => LinkStatus::Late,
        Answers::Silent(_) | Answers::Lost(_) => LinkStatus::NoReply,
    }
}

/// The controls for moving by hand and to a direction.
fn drive<'a>(
    antenna: &'a AntennaModel,
    locks: &Locks<'a>,
    blocked: &'a [JogDirection],
    jog_note: Option<&'a str>,
) -> DriveModel<'a> {
    let can = antenna.variant().capabilities;
    let is_unguarded = antenna.snapshot.unguarded && antenna.asks_unguarded;
    DriveModel {
        keys: axes::keys(antenna),
        is_tracking: locks.is_tracking,
        jog_locked: locks.jog,
        unguarded: is_unguarded.then_some(words::UNGUARDED),
        jog_note,
        blocked,
        real_deg_s: axes::rate_of_jog(antenna),
        speeds: can.jog,
        max_deg_s: antenna.config.limits.maximum_rate_deg_s,
        max_step_deg: can.steps.then_some(antenna.config.limits.maximum_step_deg),
        go_to_locked: locks.go_to,
        azimuth_range_deg: azimuth_range_deg(antenna.config.mount),
        elevation_range_deg: can.has_elevation().then(|| elevation_range_deg(antenna)),
        commanded_deg: (None, None),
        commanded_decimals: 0,
        stop_note: can.stop_note,
    }
}

/// For an antenna that points, or may point, where it must not: the allowed motions in words, and
/// the label of the button that allows them, `None` once the operator has.
fn way_out(antenna: &AntennaModel) -> Option<(String, Option<&'static str>)> {
    let snapshot = &antenna.snapshot;
    let can_be_asked =
        snapshot.link.is_open() && snapshot.lock_out.is_none() && snapshot.intent != Intent::Track;
    let inside = snapshot.breach.as_ref().filter(|_| can_be_asked)?;
    let hold = if inside.unknown_axis.is_some() || matches!(inside.barrier, Barrier::Unread(_)) {
        words::HOLD_UNCHECKED
    } else {
        words::HOLD_WAY_OUT
    };
    let words = words::way_out(&antenna.config.name, inside);
    Some((words, (!inside.may_leave).then_some(hold)))
}

/// The caption of the satellite on the left: whose it is, and how long ago it was read, if that is not
/// what the unit answers now.
fn held_head(model: &Model, antenna: &AntennaModel) -> String {
    let snapshot = &antenna.snapshot;
    if snapshot.program_track.is_some() || !antenna.variant().capabilities.has_program {
        return "Azel follows".to_owned();
    }
    let state = &snapshot.state;
    let is_read = state.on_board.satellite.is_some();
    let last = state.last_satellite.as_ref().filter(|_| state.unreadable.is_none());
    match last {
        Some(last) if !(is_read && antenna.answers(model.steady).is_current()) => {
            let age_s = seconds_between(last.read_at, model.now).max(0.0);
            format!("On the unit {} ago", format::age(age_s))
        }
        Some(_) | None => "On the unit".to_owned(),
    }
}

/// The tracked and the selected satellite.
fn track<'a>(
    model: &'a Model,
    antenna: &'a AntennaModel,
    locks: &Locks<'a>,
    head: &'a str,
    sun_avoidance: Option<&'a str>,
) -> TrackModel<'a> {
    let state = &antenna.snapshot.state;
    let selected = model.selected_pass();
    let number = selected.map(|predicted| predicted.satellite.elements.catalog_number());
    let followed = antenna.snapshot.program_track.as_ref();
    let is_here = followed.is_some() || !antenna.variant().capabilities.has_program;
    let (held, tracks_selected) = if is_here {
        let name = followed.map(|followed| followed.name.as_str());
        let of_it = followed.and_then(|followed| followed.catalog_number);
        (name.map_or("nothing", short), of_it.is_some() && of_it == number)
    } else {
        // An unreadable reply may pass for a name.
        let held = state.on_board.satellite.as_ref().filter(|_| state.unreadable.is_none());
        let of_it = held.map(|held| held.catalog_number);
        let is_tracked = of_it.is_some() && of_it == number && antenna.tracked_number() == number;
        let last = state.last_satellite.as_ref().filter(|_| state.unreadable.is_none());
        let read = held.map(|held| &held.name).or(last.map(|last| &last.name));
        let name = match read.map(String::as_str) {
            None => "not read yet",
            Some("") => "no satellite",
            Some(name) => short(name),
        };
        (name, is_tracked)
    };
    TrackModel {
        head,
        held,
        selected: selected.map(|predicted| predicted.satellite.short_name()),
        tracks_selected,
        parks_at: "",
        ends: antenna.tracked_name().map(short),
        refusal: locks.track,
        misses: None,
        nothing_left: None,
        note: None,
        auto_track: state
            .program
            .filter(|_| antenna.snapshot.link.is_open())
            .and_then(|program| program.auto),
        follow: antenna.variant().capabilities.takes_positions.then(|| FollowModel {
            by_positions: selected
                .filter(|_| antenna.variant().capabilities.has_program)
                .map(|predicted| predicted.satellite.short_name()),
            here: state.measured.and_then(|measured| target(measured.pointing)),
            here_decimals: format::decimals(antenna.variant().capabilities, 1),
            sun_avoidance,
        }),
    }
}

/// The reason why the unit would miss the selected satellite, and a further note on its
/// on-board track.
fn on_board(model: &Model, antenna: &AntennaModel) -> [Option<String>; 2] {
    let half_beam_deg = antenna.config.beam_width_deg / 2.0;
    let off_deg = antenna.error().map(|error| error.off_beam.degrees());
    // The search for a cause looks at minutes, and would tell of an error that is over.
    let is_over = |explained: &&Explained| {
        explained.error_deg > half_beam_deg && off_deg.is_some_and(|off| off <= half_beam_deg)
    };
    let explained = antenna.explained.as_ref().filter(|explained| !is_over(explained));
    let explained = explained.and_then(|explained| words::record::explained(explained, model.now));
    let Some(found) = antenna.supervision() else { return [None, explained] };
    let name = model.selected_pass().map(|predicted| predicted.satellite.short_name());
    let is_missed = !found.is_within_beam;
    let misses = name.filter(|_| is_missed).map(|name| {
        let why = words::would_miss(name, found, model.now, model.appearance.distances);
        format!("{why} Follow it from here instead.")
    });
    let lowest_deg = antenna.config.limits.minimum_elevation_deg;
    let lower = found.lower_minimum_deg.map(|deg| words::lower_minimum(deg, lowest_deg));
    // Beside a larger error, the small one that is known would look like its cause.
    let is_off = off_deg.is_some_and(|off| off > half_beam_deg);
    let off = words::within_beam(found, model.appearance.distances);
    let off = off.filter(|_| !is_missed && !is_off);
    let said = explained.into_iter().chain(off).chain(lower).chain(words::not_known(found));
    let said: Vec<String> = said.collect();
    [misses, (!said.is_empty()).then(|| said.join(" "))]
}

/// All antennas but those whose cards are shown.
fn others(model: &Model, on_cards: &[AntennaId]) -> Vec<OtherAntenna> {
    let antennas = model.antennas.iter().enumerate();
    let others = antennas.filter(|(_, antenna)| !on_cards.contains(&antenna.id()));
    let in_short = |(index, antenna): (usize, &AntennaModel)| {
        let measured = antenna.snapshot.state.measured;
        let at = measured
            .map(|measured| format::pointing(measured.pointing, antenna.variant().capabilities))
            .unwrap_or_default();
        let in_maintenance = antenna.snapshot.lock_out.is_some();
        let is_old = !at.is_empty() && !antenna.snapshot.link.is_open();
        OtherAntenna {
            index,
            name: antenna.config.name.clone(),
            link: bar::glyph(model, antenna),
            pointing: match (in_maintenance, is_old) {
                (true, _) => "in maintenance".to_owned(),
                (false, true) => format!("last {at}"),
                (false, false) => at,
            },
            sentence: state_sentence(model, antenna).text(),
            alarm: bar::alarm(model, antenna),
        }
    };
    others.map(in_short).collect()
}

/// The direction of the antenna, as a go-to target.
fn target(pointing: Pointing) -> Option<Target> {
    Some(Target {
        azimuth_deg: pointing.azimuth?.wrapped_360().degrees(),
        elevation_deg: pointing.elevation.map(Angle::degrees),
    })
}

/// The modes that a controller with these capabilities offers.
fn modes(can: Capabilities) -> Vec<Intent> {
    let offers = |mode: &Intent| match mode {
        Intent::Standby | Intent::Manual => true,
        Intent::Position | Intent::Park => can.takes_positions,
        Intent::Track => can.has_program || can.takes_positions,
    };
    mode_selector::ALL.into_iter().filter(offers).collect()
}

/// The accepted azimuths, degrees: all of the sky, and those beyond that are in the travel
/// of the axis.
fn azimuth_range_deg(mount: Mount) -> (f64, f64) {
    match mount {
        Mount::Xy { .. } => (0.0, 360.0),
        Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } => {
            (azimuth_from_deg.min(0.0), azimuth_to_deg.max(360.0))
        }
    }
}

/// The accepted elevations, degrees.
fn elevation_range_deg(antenna: &AntennaModel) -> (f64, f64) {
    let lowest = antenna.config.limits.minimum_elevation_deg;
    match antenna.config.mount {
        Mount::Xy { .. } => (lowest, 90.0),
        Mount::AzEl { elevation_from_deg, elevation_to_deg, .. } => {
            (lowest.max(elevation_from_deg), elevation_to_deg.min(90.0))
        }
    }
}
