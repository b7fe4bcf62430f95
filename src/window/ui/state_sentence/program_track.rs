//! Sentences of an antenna in program track.

use super::{Spoken, missing_angle, place, short};
use crate::{
    contract::{antenna::AntennaModel, driver::TrackView},
    model::Model,
    plan::{TrackPhase, program_track::OnPath},
    ui::{format, widgets::sentence::SentenceKind},
};

pub(super) fn sentence(model: &Model, antenna: &AntennaModel) -> Option<Spoken> {
    let view = antenna.snapshot.program_track.as_ref()?;
    let name = short(&view.name);
    Some(match view.phase {
        TrackPhase::Waiting { aos } => {
            let spoken = Spoken::new(SentenceKind::Commanded);
            let moving = antenna.snapshot.state.measured.is_some_and(|measured| measured.moving());
            let spoken = if moving {
                spoken.plain("Moving to meet ")
            } else {
                spoken.plain(format!("Waiting{} for ", place(antenna)))
            };
            spoken.bold(name).plain(format!(
                ", which rises at {}, in {}.",
                format::moment(aos, model.now),
                format::time_left(model.now, aos)
            ))
        }
        TrackPhase::Tracking => following(model, antenna, view, name),
        TrackPhase::Over => Spoken::new(SentenceKind::Holding)
            .plain("The pass of ")
            .bold(name)
            .plain(format!(" is over. Holding{}.", place(antenna))),
    })
}

fn following(model: &Model, antenna: &AntennaModel, view: &TrackView, name: &str) -> Spoken {
    let lead = |kind| Spoken::new(kind).plain("Following ").bold(name);
    if view.predicted.is_none() || antenna.is_out_of_reach() {
        return lead(SentenceKind::Caution)
            .plain(format!(", which is out of reach. Waiting{}.", place(antenna)));
    }
    let Some(error) = antenna.error() else {
        let reason = missing_angle(antenna).unwrap_or("Its position is being read.");
        return lead(SentenceKind::Caution).plain(format!(". {reason}"));
    };
    let beam_deg = antenna.config.beam_width_deg;
    let off_deg = error.off_beam.degrees();
    let (kind, side) = if off_deg <= beam_deg / 2.0 {
        (SentenceKind::Tracking, "inside")
    } else {
        (SentenceKind::Caution, "outside")
    };
    if let (SentenceKind::Caution, Some(OnPath::OnItsWay { arrival: end })) = (kind, view.on_path) {
        let arrival_words = end.map_or_else(String::new, |arrival| {
            let (time_text, left) =
                (format::moment(arrival, model.now), format::time_left(model.now, arrival));
            format!(", expected there at {time_text}, in {left}")
        });
        let deviation_text = format::degrees(off_deg, 2);
        return lead(SentenceKind::Commanded).plain(format!(
            ". The antenna is still turning, {deviation_text} off target{arrival_words}."
        ));
    }
    let addition = if view.offsets.is_none() { "" } else { " with offsets" };
    lead(kind).plain(format!(
        " position by position{addition}. The antenna is {} off, {side} its {} beam.",
        format::degrees(off_deg, 2),
        format::degrees(beam_deg, 2)
    ))
}
