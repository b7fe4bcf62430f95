//! Fills the antenna card from the model and hands on what was asked there.

use egui::{Align2, Rect, Ui};

use super::antenna_card::{
    self, CardAction, CardModel, CardState, CheckRow, CheckState, Control, DriveModel, FaultsModel,
    HeaderModel, TrackModel,
};
use crate::{
    app::{Model, UiCommand, View, antenna::AntennaModel, model::CatalogState},
    astro::Angle,
    controller::{AxisMotion, Measured, Pointing},
    driver::{Command, Intent},
    protocol::satrak::{FaultKind, Satellite},
    ui::{
        bar, format,
        state_sentence::{short, state_sentence},
        text, theme,
        widgets::{
            axes_table::{AxisRow, WantedColumn},
            beam_bar::BeamModel,
            button::Button,
            go_to::Target,
            jog_pad::{JogDirection, JogKeys},
            mode_selector::{Mode, ModeModel},
            paint,
            travel_gauge::TravelModel,
        },
        words,
    },
};

/// Draws the card of `antenna`.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    antenna: &AntennaModel,
    state: &mut CardState,
    commands: &mut Vec<UiCommand>,
) {
    let snapshot = &antenna.snapshot;
    let unit = &snapshot.state.satrak;
    let measured = snapshot.state.measured;
    let second_line = second_line(antenna);
    let axes = axes(antenna);
    let wanted = if snapshot.aim.is_none() && antenna.prediction.is_some() {
        WantedColumn::Predicted
    } else {
        WantedColumn::Command
    };
    let checks = checks(antenna);
    let checked_at = unit.faults.as_ref().map(|(_, at)| format::time_z(*at)).unwrap_or_default();
    let selected = model.selected_pass();
    let selected_name = selected.map(|forecast| forecast.satellite.short_name());
    // A fresh unit names no satellite at all, and decimal commas read as a name.
    let names_one = |held: &&Satellite| !held.name.is_empty() && !unit.decimal_commas;
    let held = unit.satellite.as_ref().filter(names_one);
    let tracks_selected = held.is_some_and(|held| {
        antenna.tracked_number() == Some(held.catalog_number)
            && selected.is_some_and(|forecast| {
                forecast.satellite.elements.catalog_number() == held.catalog_number
            })
    });
    let locks = Locks::of(antenna);
    let blocked = measured.map(blocked).unwrap_or_default();
    let travel = travel(antenna, measured);
    let mode = mode(snapshot.intent);
    let [azimuth, elevation] = axes.map(|row| row.wanted_deg);
    state_sentence(model, antenna).with(|sentence| {
        let card = CardModel {
            header: HeaderModel {
                name: &antenna.config.name,
                second_line: &second_line,
                link: bar::glyph(antenna),
                control: if snapshot.link.is_open() { Control::You } else { Control::Unknown },
            },
            sentence: *sentence,
            wanted,
            axes: &axes,
            // Kept without a prediction too: the keys below must not jump.
            beam: Some(BeamModel {
                error_deg: antenna.error().map(|error| error.off_beam.degrees()),
                half_beam_deg: antenna.config.beam_width_deg / 2.0,
            }),
            travel: &travel,
            modes: ModeModel {
                offered: &Mode::ALL,
                current: (!snapshot.pending).then_some(mode),
                pending: snapshot.pending.then_some(mode),
            },
            track: Some(TrackModel {
                held: held.map(|held| short(&held.name)),
                selected: selected_name,
                tracks_selected,
                refusal: locks.track,
                auto_track: snapshot.state.program.and_then(|program| program.auto),
            }),
            drive: DriveModel {
                keys: JogKeys::Xy,
                jog_locked: locks.jog,
                blocked: &blocked,
                real_deg_s: snapshot.jog.and(fastest(antenna)),
                most_deg_s: antenna.config.limits.maximum_rate_deg_s,
                most_step_deg: antenna.config.limits.maximum_step_deg,
                go_to_locked: locks.go_to,
                azimuth_range_deg: (0.0, 360.0),
                elevation_range_deg: Some((antenna.config.limits.minimum_elevation_deg, 90.0)),
                commanded_deg: (azimuth, elevation),
                go_to_refusal: None,
                go_to_note: None,
            },
            faults: FaultsModel { checks: &checks, checked_at: &checked_at },
        };
        for action in antenna_card::show(ui, rect, &card, state) {
            commands.extend(command(action, model));
        }
    });
}

/// The place of the card while there is no antenna.
pub(super) fn none(ui: &mut Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let inner = rect.shrink(16.0);
    if model.demo && !matches!(model.catalog, CatalogState::Failed) {
        let words = "The simulated antenna is starting.";
        paint::text(ui, inner.left_top(), Align2::LEFT_TOP, words, text::body(), t.t2);
        return;
    }
    let words = "No antenna yet. Set one up.";
    let line = paint::text(ui, inner.left_top(), Align2::LEFT_TOP, words, text::body(), t.t2);
    let button = Button::primary("Set up an antenna");
    let size = egui::vec2(button.width(ui), 32.0);
    let place = Rect::from_min_size(line.left_bottom() + egui::vec2(0.0, 12.0), size);
    if button.show(ui, "set up antenna", place).clicked() {
        commands.push(UiCommand::Show(View::Preferences));
    }
}

fn second_line(antenna: &AntennaModel) -> String {
    let version = antenna.snapshot.state.satrak.version.as_ref();
    version.map_or_else(
        || format!("X/Y mount at {}", antenna.config.connection.address()),
        |version| format!("X/Y mount, {}", version.control_unit),
    )
}

fn axes(antenna: &AntennaModel) -> [AxisRow<'static>; 2] {
    let snapshot = &antenna.snapshot;
    let actual = snapshot.state.measured.map(|measured| measured.pointing);
    let wanted = snapshot.aim.or(antenna.prediction.map(|prediction| prediction.direction.into()));
    let rates = antenna.rates_deg_s;
    let error = wanted.zip(actual).map(|(wanted, actual)| {
        let off = |actual: Option<Angle>, wanted: Option<Angle>| {
            Some((actual? - wanted?).wrapped_180().degrees())
        };
        (off(actual.azimuth, wanted.azimuth), off(actual.elevation, wanted.elevation))
    });
    let azimuth_deg = |at: Pointing| at.azimuth.map(|azimuth| azimuth.wrapped_360().degrees());
    let elevation_deg = |at: Pointing| at.elevation.map(Angle::degrees);
    [
        AxisRow {
            name: "Az",
            wanted_deg: wanted.and_then(azimuth_deg),
            actual_deg: actual.and_then(azimuth_deg),
            error_deg: error.and_then(|(azimuth, _)| azimuth),
            rate_deg_s: rates.map(|(azimuth, _)| azimuth),
        },
        AxisRow {
            name: "El",
            wanted_deg: wanted.and_then(elevation_deg),
            actual_deg: actual.and_then(elevation_deg),
            error_deg: error.and_then(|(_, elevation)| elevation),
            rate_deg_s: rates.map(|(_, elevation)| elevation),
        },
    ]
}

fn travel(antenna: &AntennaModel, measured: Option<Measured>) -> [TravelModel<'static>; 2] {
    let axis = |index: usize, name, travel_deg| {
        let axis = measured.and_then(|measured| measured.axes.get(index).copied());
        TravelModel {
            name,
            scale_deg: (0.0, 180.0),
            travel_deg,
            position_deg: axis.and_then(|axis| axis.angle_deg),
            lower_limit: axis.is_some_and(|axis| axis.minus_limit),
            upper_limit: axis.is_some_and(|axis| axis.plus_limit),
            turns: false,
        }
    };
    let [x, y] = antenna.make().capabilities.axes;
    let [of_x, of_y] = antenna.config.mount.travel_deg();
    [axis(0, x, of_x), axis(1, y, of_y)]
}

fn blocked(measured: Measured) -> Vec<JogDirection> {
    let [x, y] = measured.axes;
    [
        (x.plus_limit, JogDirection::XPlus),
        (x.minus_limit, JogDirection::XMinus),
        (y.plus_limit, JogDirection::YPlus),
        (y.minus_limit, JogDirection::YMinus),
    ]
    .into_iter()
    .filter_map(|(set, direction)| set.then_some(direction))
    .collect()
}

/// The jog rate with the sign of the axis that turns.
fn fastest(antenna: &AntennaModel) -> Option<f64> {
    let measured = antenna.snapshot.state.measured?;
    let jog = antenna.snapshot.jog?;
    jog.into_iter()
        .zip(measured.axes)
        .find(|(rate, axis)| *rate != 0.0 && axis.motion != AxisMotion::Still)
        .map(|(rate, _)| rate)
}

fn checks(antenna: &AntennaModel) -> Vec<CheckRow<'static>> {
    let faults = antenna.snapshot.state.satrak.faults.as_ref().map(|(faults, _)| faults);
    FaultKind::ALL
        .into_iter()
        .map(|kind| CheckRow {
            name: words::fault_name(kind),
            state: match faults.and_then(|faults| faults.state(kind)) {
                None => CheckState::Unknown,
                Some(state) if !state.is_set() => CheckState::Good,
                Some(_) if kind.is_warning() => CheckState::Caution,
                Some(_) => CheckState::Fault,
            },
            advice: words::fault_advice(kind),
        })
        .collect()
}

/// Why something cannot be asked for now, in a sentence.
struct Locks {
    jog: Option<&'static str>,
    go_to: Option<&'static str>,
    track: Option<&'static str>,
}

impl Locks {
    fn of(antenna: &AntennaModel) -> Self {
        let snapshot = &antenna.snapshot;
        let intent = snapshot.intent;
        let program = snapshot.state.program.is_some_and(|program| program.enabled);
        let common = if !snapshot.link.is_open() {
            Some("Locked: the unit does not answer.")
        } else if snapshot.state.motion_lock == Some(true) {
            Some("Locked by a fault. Look at Faults.")
        } else {
            None
        };
        let jog = match intent {
            _ if program => Some("Locked while tracking. Choose Manual or Position."),
            Intent::Manual => None,
            _ => Some("Jog is locked. Choose Manual."),
        };
        let go_to = match intent {
            _ if program => Some("Locked while tracking. Choose Manual or Position."),
            Intent::Position | Intent::Park | Intent::Manual => None,
            _ => Some("Go to is locked. Choose Position."),
        };
        Self { jog: common.or(jog), go_to: common.or(go_to), track: common }
    }
}

fn mode(intent: Intent) -> Mode {
    match intent {
        Intent::Standby => Mode::Standby,
        Intent::Manual => Mode::Manual,
        Intent::Position => Mode::Position,
        Intent::Track => Mode::Track,
        Intent::Park => Mode::Park,
    }
}

fn command(action: CardAction, model: &Model) -> Option<UiCommand> {
    let command = match action {
        CardAction::SetMode(Mode::Standby) => Command::Standby,
        CardAction::SetMode(Mode::Manual) => Command::Manual,
        CardAction::SetMode(Mode::Position) => Command::Hold,
        CardAction::SetMode(Mode::Park) => Command::Park,
        CardAction::SetMode(Mode::Track) | CardAction::TrackSelected => {
            return UiCommand::track_selected(model);
        }
        CardAction::Jog { x, y, rate_deg_s } => {
            Command::Jog { rates_deg_s: [f64::from(x) * rate_deg_s, f64::from(y) * rate_deg_s] }
        }
        CardAction::JogReleased => Command::EndJog,
        CardAction::Step { x, y, step_deg } => {
            Command::Step { steps_deg: [f64::from(x) * step_deg, f64::from(y) * step_deg] }
        }
        CardAction::GoTo(Target { azimuth_deg, elevation_deg }) => Command::Position {
            azimuth: Some(Angle::from_degrees(azimuth_deg)),
            elevation: elevation_deg.map(Angle::from_degrees),
        },
        CardAction::SetAutoTrack(on) => Command::AutoTrack(on),
        // The plot reads the ghost from the fields themselves.
        CardAction::PreviewGoTo(_) => return None,
    };
    Some(UiCommand::Antenna(model.selected_antenna, command))
}
