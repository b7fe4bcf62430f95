//! Content of the sky plot.

use egui::{Rect, Stroke, StrokeKind, Ui};
use jiff::Timestamp;

use super::{OperateState, all_antennas, ghost, sky_time};
use crate::{
    astro::{Angle, AzEl, time::seconds_between},
    contract::{
        antenna::{Answers, AntennaModel},
        passes::{PassListKey, PredictedPass},
    },
    model::{Model, Selected, Sky, UiCommand},
    orbit::{LookAngles, PassPoint},
    plan::Sample,
    ui::{
        format, menus,
        sky_plot::{
            self, Bearing, KeepOutMark, Keyholes, LaterScene, Measured, MenuOf, OtherSatellite,
            SkyScene, Track,
        },
        state_sentence::state_sentence,
        theme,
    },
};

/// Min height of a plot for the full readout, points.
const FULL_READOUT_FROM: f32 = 500.0;
/// Time span of the errors in the beam view, seconds.
const RECENT_S: f64 = 60.0;

/// Shows the plot; returns the time of the path under the pointer.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    state: &mut OperateState,
    commands: &mut Vec<UiCommand>,
) -> Option<Timestamp> {
    state.sky_time.keep(model);
    let time = state.sky_time.time();
    if time.is_some() {
        // A click in the current sky gives no direction in the sky of another time.
        state.ghost.forget_click();
    }
    ghost::keep(ui, model, state, commands);
    let sky = state.sky_time.sky().unwrap_or(&model.sky);
    let antenna = model.antenna();
    let predicted = model.selected_pass();
    let selected = predicted.map(|predicted| predicted.satellite.elements.catalog_number());
    let others = others(sky, selected);
    let look = sky.selected.map(|selected| selected.look);
    let track = predicted.map(|predicted| track(predicted, look));
    let lost = antenna.and_then(|antenna| lost_for(model, antenna));
    let description = description(model, state);
    let planned = time.map(|time| sky_time::planned_antennas(model, time));
    let silences = all_antennas::silences(model);
    let layer = state.sky.layers.antennas;
    let antennas = if layer { all_antennas::others(model, &silences) } else { Vec::new() };
    let scene = SkyScene {
        now: time.unwrap_or(model.now),
        minimum_elevation: Angle::from_degrees(
            antenna.map_or(0.0, |antenna| antenna.config.limits.minimum_elevation_deg),
        ),
        mask: model.station.horizon_mask.as_ref(),
        keep_outs: &antenna.map(|antenna| keep_outs(model, antenna)).unwrap_or_default(),
        keyholes: antenna.and_then(|antenna| Keyholes::new(&antenna.config.mount)),
        track,
        others: &others,
        sun: sky.sun.filter(|sun| sun.elevation_deg() > 0.0),
        moon: sky.moon.filter(|moon| moon.elevation_deg() > 0.0),
        later: planned.as_deref().map(|antennas| LaterScene {
            antennas,
            selected: antenna.map(|antenna| antenna.config.name.as_str()),
        }),
        commanded: antenna.and_then(commanded),
        ghost: antenna.and_then(|antenna| ghost::shown(antenna, state)),
        beam_width: antenna.map_or(Angle::from_degrees(1.0), |antenna| antenna.config.beam_width()),
        measured: antenna
            .and_then(|antenna| antenna.snapshot.state.measured)
            .and_then(|measured| measured.direction())
            .map(|direction| Measured { direction, lost: lost.as_deref() }),
        antennas: &antennas,
        stops: &all_antennas::stops(model, layer),
        bearing: antenna.and_then(|antenna| bearing(antenna, lost.as_deref())).map(|bearing| {
            let target = state.ghost.target();
            let ghost = target.map(|target| Angle::from_degrees(target.azimuth_deg));
            Bearing { ghost, ..bearing }
        }),
        predicted: antenna
            .and_then(|antenna| antenna.prediction)
            .map(|prediction| prediction.direction),
        recent_errors: &antenna.map(recent_errors).unwrap_or_default(),
        marked: state.marked,
        readout: &readout(model, sky.selected, rect.height() >= FULL_READOUT_FROM),
        description: &description,
    };
    let mut looks_at = None;
    let mut menu = |ui: &mut Ui, of_node: egui::Id, menu_of: MenuOf| {
        if time.is_some() {
            let (MenuOf::Satellite(_, direction) | MenuOf::Sky(direction)) = menu_of;
            return menus::direction(ui, of_node, direction);
        }
        let (looks, direction) = match menu_of {
            MenuOf::Satellite(number, direction) => {
                let item = (number, direction);
                (menus::satellite(ui, of_node, model, item, commands), direction)
            }
            MenuOf::Sky(direction) => (menus::sky(ui, of_node, model, direction), direction),
        };
        looks_at = looks_at.or(looks.then_some(direction));
    };
    let answer = sky_plot::show(ui, rect, &scene, &mut state.sky, &mut menu);
    if let Some(time) = time {
        let stroke = Stroke::new(2.0, theme::tokens(ui).warn);
        ui.painter().rect_stroke(rect, 0.0, stroke, StrokeKind::Inside);
        let pass = answer.chosen.and_then(|number| pass_at(model, number, time));
        commands.extend(pass.map(UiCommand::SelectPass));
    } else {
        commands.extend(answer.chosen.map(UiCommand::SelectSatellite));
    }
    commands.extend(answer.antenna.map(UiCommand::SelectAntenna));
    if answer.takes_click_back {
        state.ghost.forget_click();
    }
    if time.is_some() {
        if answer.clicked.is_some() {
            state.sky_time.refuse_click();
        }
    } else if let (Some(direction), Some(antenna)) = (answer.clicked.or(looks_at), antenna) {
        state.ghost.look_at(direction, antenna);
    }
    if let Some(position) = answer.ghost_at {
        ghost::note(ui, rect, position, model, state, commands);
    }
    answer.pointed
}

/// Returns the text that a screen reader reads for the whole plot.
fn description(model: &Model, state: &OperateState) -> String {
    let sentence = model.antenna().map(|antenna| state_sentence(model, antenna).text());
    let sentence = sentence.unwrap_or_else(|| "Sky plot".to_owned());
    match state.sky_time.words(model) {
        Some(words) => format!("{words}. {sentence}"),
        None => sentence,
    }
}

/// Returns the satellites of `sky` that are not selected.
fn others(sky: &Sky, selected: Option<u32>) -> Vec<OtherSatellite<'_>> {
    let satellites = sky.satellites.iter();
    let others = satellites
        .filter(|satellite| Some(satellite.satellite.elements.catalog_number()) != selected);
    let others = others.map(|satellite| OtherSatellite {
        catalog_number: satellite.satellite.elements.catalog_number(),
        name: satellite.satellite.short_name(),
        direction: satellite.direction,
        ahead: &satellite.ahead,
        geostationary: satellite.satellite.elements.is_geosynchronous(),
    });
    others.collect()
}

/// Returns the pass of a satellite that is under way at `time`.
fn pass_at(model: &Model, number: u32, time: Timestamp) -> Option<PassListKey> {
    let ahead = model.pass_lists.favourites.upcoming(model.now);
    let mut own = ahead.iter().filter(|predicted| predicted.number() == number);
    own.find(|pass| pass.pass.aos.time <= time && time <= pass.pass.los.time)
        .map(PredictedPass::key)
}

/// Returns the path of a pass, with the current look angles of its satellite.
pub(in crate::ui) fn track(predicted: &PredictedPass, look: Option<LookAngles>) -> Track<'_> {
    let sample = |point: &PassPoint| Sample { time: point.time, direction: point.direction };
    Track {
        catalog_number: predicted.satellite.elements.catalog_number(),
        name: predicted.satellite.short_name(),
        samples: predicted.track(),
        aos: sample(&predicted.pass.aos),
        tca: sample(&predicted.pass.tca),
        los: sample(&predicted.pass.los),
        show_aos: !predicted.pass.starts_before,
        show_los: !predicted.pass.ends_after,
        position: look
            .map(|look| look.direction)
            .filter(|direction| direction.elevation_deg() > 0.0),
    }
}

/// Returns the readout; a low plot has room for the direction only.
fn readout(model: &Model, selected: Option<Selected>, full: bool) -> Vec<(&'static str, String)> {
    let Some(selected) = selected else { return Vec::new() };
    let look = selected.look;
    let decimals = model.appearance.angle_decimals as usize;
    let direction = [
        ("Az", format::degrees(look.direction.azimuth_deg(), decimals)),
        ("El", format::degrees(look.direction.elevation_deg(), decimals)),
    ];
    let unit = model.appearance.distances;
    let range = format::distance(look.range_km, 0, unit);
    let rate = format::range_rate(look.range_rate_km_s, unit);
    let range = ("Range", format!("{range}\n{rate}"));
    let number = model.selected_pass().map(PredictedPass::number);
    let carriers =
        model.station.frequencies.iter().filter(|frequency| Some(frequency.satellite) == number);
    let doppler = carriers.map(|frequency| {
        let shift_khz = look.doppler_hz(frequency.mhz * 1e6) / 1e3;
        let carrier = format!("{} {} MHz", frequency.name, frequency.mhz);
        ("Doppler", format!("{} kHz\n{}", format::signed(shift_khz, 2), carrier.trim()))
    });
    let further = std::iter::once(range).chain(doppler).filter(|_| full);
    direction.into_iter().chain(further).collect()
}

/// Returns the direction commanded by the operator or by the program track.
pub(in crate::ui) fn commanded(antenna: &AntennaModel) -> Option<AzEl> {
    let snapshot = &antenna.snapshot;
    let follows = snapshot.program_track.as_ref().filter(|_| antenna.follows());
    snapshot.aim.or_else(|| follows?.commanded)?.direction()
}

/// Returns the time since the last report of an antenna whose unit does not answer.
pub(in crate::ui) fn lost_for(model: &Model, antenna: &AntennaModel) -> Option<String> {
    let age = match antenna.answers(model.steady) {
        Answers::Silent(age) | Answers::Lost(age) => age,
        // Azel is not connected, so others may have turned the antenna since.
        Answers::Off => {
            let received = antenna.snapshot.state.measured?.received;
            model.steady.saturating_duration_since(received)
        }
        Answers::Connecting | Answers::InTime | Answers::Late(_) => return None,
    };
    Some(format::age(age.as_secs_f64()))
}

/// Returns the keep-outs that apply to the antenna.
fn keep_outs<'a>(model: &'a Model, antenna: &AntennaModel) -> Vec<KeepOutMark<'a>> {
    let config = &antenna.config;
    let hold = model.station.keep_outs.iter().filter(|keep_out| keep_out.holds_for(&config.name));
    hold.map(|keep_out| KeepOutMark {
        name: &keep_out.name,
        zone: &keep_out.zone,
        margin: keep_out.margin() + config.beam_width() * 0.5,
    })
    .collect()
}

/// Returns the bearing of an antenna with known azimuth and unknown elevation, or at a limit of its
/// azimuth.
pub(super) fn bearing<'a>(antenna: &'a AntennaModel, lost: Option<&'a str>) -> Option<Bearing<'a>> {
    let measured = antenna.snapshot.state.measured?;
    let pointing = measured.pointing;
    let (azimuth, limit) = match (pointing.azimuth, pointing.elevation) {
        (Some(_), Some(_)) => return None,
        (Some(azimuth), None) => (azimuth, None),
        (None, _) => {
            let [azimuth, elevation] = measured.axes;
            let [start, last] = all_antennas::ends(antenna)?;
            let (end, limit) = match (azimuth.minus_limit, azimuth.plus_limit) {
                (true, false) => (start, "CCW limit"),
                (false, true) => (last, "CW limit"),
                (true, true) | (false, false) => return None,
            };
            let is_flipped = antenna.config.mount.is_flipped(elevation.angle_deg);
            let turn = Angle::from_degrees(if is_flipped { 180.0 } else { 0.0 });
            ((end + turn).wrapped_360(), Some(limit))
        }
    };
    Some(Bearing {
        name: &antenna.config.name,
        measured: Some(azimuth),
        limit,
        commanded: antenna.snapshot.aim.and_then(|aim| aim.azimuth),
        ghost: None,
        lost,
    })
}

/// Returns the errors across and upwards on the sky, degrees. The azimuth error is scaled by the
/// cosine of the elevation.
fn recent_errors(antenna: &AntennaModel) -> Vec<(f32, f32)> {
    let Some(newest) = antenna.errors.back() else { return Vec::new() };
    let elevation =
        antenna.prediction.map_or(0.0, |prediction| prediction.direction.elevation.radians());
    antenna
        .errors
        .iter()
        .rev()
        .take_while(|error| seconds_between(error.time, newest.time) <= RECENT_S)
        .map(|error| {
            let across = error.azimuth.degrees() * elevation.cos();
            (across as f32, error.elevation.degrees() as f32)
        })
        .collect()
}
