//! State of the live station while the record is shown.

use crate::{
    contract::antenna::AntennaModel,
    model::Model,
    ui::{
        antenna_card::{LiveAntenna, LiveNow},
        bar, format,
        widgets::link_chip,
        words,
    },
};

impl LiveNow {
    /// Returns the state of `live` while `model` is a replay.
    pub fn of(live: &Model, model: &Model) -> Option<Self> {
        model.replay.as_ref()?;
        let antennas = live.antennas.iter().map(|antenna| live_antenna(live, antenna)).collect();
        Some(Self { antennas, next: next(live) })
    }
}

fn live_antenna(live: &Model, antenna: &AntennaModel) -> LiveAntenna {
    let link = bar::glyph(live, antenna);
    let can = antenna.variant().capabilities;
    let measured = antenna.snapshot.state.measured;
    let at = measured.map(|measured| format!(" at {}", format::pointing(measured.pointing, can)));
    let activity = format!("{}{}", bar::activity(live, antenna), at.unwrap_or_default());
    LiveAntenna {
        name: antenna.config.name.clone(),
        link,
        does: link_chip::with_age(&activity, &bar::age(live, antenna), link),
    }
}

fn next(live: &Model) -> String {
    let entries = live.schedule.schedule.entries.iter();
    let next = entries.filter(|entry| entry.start > live.now).min_by_key(|entry| entry.start);
    let Some(next) = next else { return "no pass is planned".to_owned() };
    let name = words::schedule::satellite_name(live, next.pass.satellite);
    let at = format::moment(next.start, live.now);
    format!("{name} at {at}, in {}", format::time_left(live.now, next.start))
}
