//! One pass over the whole sky in a small plot, with the selected antenna.

use egui::{Rect, Ui};

use super::{
    format,
    operate::sky,
    sky_plot::{self, Keyholes, Measured, SkyScene},
    theme,
    widgets::paint,
};
use crate::{astro::Angle, contract::passes::PredictedPass, model::Model, orbit::LookAngles};

/// Draws the plot in `rect`. `look` is the current direction of the satellite; `None` before the
/// pass.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    predicted: &PredictedPass,
    look: Option<LookAngles>,
) {
    let t = theme::tokens(ui);
    let antenna = model.antenna();
    let lost = antenna.and_then(|antenna| sky::lost_for(model, antenna));
    let measured = antenna
        .and_then(|antenna| antenna.snapshot.state.measured)
        .and_then(|measured| measured.direction());
    let scene = SkyScene {
        now: model.now,
        minimum_elevation: Angle::from_degrees(
            antenna.map_or(0.0, |antenna| antenna.config.limits.minimum_elevation_deg),
        ),
        mask: model.station.horizon_mask.as_ref(),
        keep_outs: &[],
        keyholes: antenna.and_then(|antenna| Keyholes::new(&antenna.config.mount)),
        track: Some(sky::track(predicted, look)),
        others: &[],
        sun: None,
        moon: None,
        later: None,
        commanded: antenna.and_then(sky::commanded),
        ghost: None,
        beam_width: Angle::ZERO,
        measured: measured.map(|direction| Measured { direction, lost: lost.as_deref() }),
        antennas: &[],
        stops: &[],
        bearing: None,
        predicted: None,
        recent_errors: &[],
        marked: None,
        readout: &[],
        description: "",
    };
    sky_plot::paint_small(ui.painter(), rect, &scene, t);
    let name = predicted.satellite.short_name();
    let words = match look {
        Some(look) => format!("Pass of {name}, now at {}", format::pointing_at(look.direction)),
        None => format!("Path of {name} over the sky"),
    };
    paint::name_text(ui, "small sky plot", rect, &words);
}
