//! Sentences about recent events, shown for a short time.

use super::{Spoken, short};
use crate::{
    astro::time::seconds_between,
    contract::{
        antenna::AntennaModel,
        driver::{Event, Found},
    },
    model::Model,
    plan::TrackStats,
    ui::{format, widgets::sentence::SentenceKind, words},
};

/// Time for which such a sentence is shown, seconds.
const SHOWN_S: f64 = 12.0;

pub(super) fn sentence(model: &Model, antenna: &AntennaModel) -> Option<Spoken> {
    let (event, moment) = antenna.news.as_ref()?;
    if seconds_between(*moment, model.now) > SHOWN_S {
        return None;
    }
    let (now, name) = (model.now, &antenna.config.name);
    let can = antenna.variant().capabilities;
    let caution = Spoken::new(SentenceKind::Caution);
    let reason = |barrier| words::reason(barrier, &model.station);
    Some(match event {
        Event::Back { after, found, .. } => {
            let silent = format::age(after.as_secs_f64());
            if antenna.follows() {
                return Some(
                    Spoken::new(SentenceKind::Tracking)
                        .plain(format!("{name} answers again after {silent}. It is still \
                                        following.")),
                );
            }
            let held_satellite = antenna.snapshot.state.on_board.satellite.as_ref();
            let spoken = Spoken::new(match found {
                Found::Tracking => SentenceKind::Tracking,
                Found::Moving => SentenceKind::Caution,
                Found::Still => SentenceKind::Holding,
            })
            .plain(format!("{name} answers again after {silent}. "));
            match found {
                Found::Tracking => spoken
                    .plain("It is still tracking ")
                    .bold(held_satellite.map_or("a satellite", |held_satellite| short(&held_satellite.name)))
                    .plain("."),
                Found::Moving => spoken.plain("It is moving, but not by its tracking program."),
                Found::Still => spoken.plain("It is at rest and tracks nothing."),
            }
        }
        Event::NotSent(refusal) | Event::OffsetRefused(refusal) => {
            let reason = refusal.barrier().map(reason);
            caution.plain(words::refusal(refusal, now) + &reason.unwrap_or_default())
        }
        Event::Refused(motion, answer) => {
            caution.plain(format!("{}: the unit answered {answer}.", words::motion_name(*motion)))
        }
        Event::Unanswered(motion) => caution.plain(format!(
            "{}: the unit did not answer and does not move. It is not sent again.",
            words::motion_name(*motion)
        )),
        Event::OffsetNotTaken(error) => caution.plain(words::offset_not_taken(error)),
        Event::CannotTrack(target, reason) => caution
            .plain("Not tracking ")
            .bold(short(&target.name))
            .plain(format!(": {}.", words::prepare_error(reason))),
        Event::WouldMiss { name, found } => caution.plain(format!(
            "Not tracking. {} Hold Track anyway, or follow from here.",
            words::would_miss(short(name), found, now, model.appearance.distances)
        )),
        Event::ProgramTrackOver { name, stats } => follow_over(name, *stats),
        Event::CannotProgramTrack(target, problem) => caution
            .plain("Not following ")
            .bold(short(target))
            .plain(format!(": {}", words::track_problem(problem, now)))
            .plain(problem.barrier().map(reason).unwrap_or_default()),
        Event::TrackingEnded { completed: false } => {
            caution.plain("The unit ended tracking before LOS.")
        }
        Event::EndedShort { aim, position: pointing } => caution.plain(format!(
            "Stopped at {} instead of {}.",
            format::pointing(*pointing, can),
            format::pointing(*aim, can)
        )),
        Event::Safety(matter) => caution
            .plain(words::safety(matter, name, now))
            .plain(matter.barrier().map(reason).unwrap_or_default()),
        Event::JogLeaseOver => {
            caution.plain("The jog was stopped: the window did not renew it in time.")
        }
        Event::JogPositionOld => caution.plain("The jog was stopped: the position came too late."),
        Event::StopRefused(answer) => Spoken::new(SentenceKind::Fault)
            .plain(format!("The unit answered {answer} to STOP. Use the local panel.")),
        Event::AutoTrackStillOn => {
            caution.plain("Stopped. Auto-track is on: the unit may start by itself.")
        }
        Event::AutoStaysOn => caution.plain("The unit did not switch auto-track off."),
        Event::AutoTrackNotKnown => caution.plain(
            "The unit was told to switch auto-track off but does not report auto-track: it may start \
             tracking by itself. Check auto-track at the unit.",
        ),
        Event::LockOutUnproved => caution.plain(
            "Locked out, but auto-track could not be confirmed off. Switch it off at the unit.",
        ),
        Event::StartedByItself => caution.plain("The unit has begun to track by itself."),
        Event::LinkLost(_)
        | Event::Connected(_)
        | Event::Tracking(_)
        | Event::Awaits { .. }
        | Event::ProgramTracks(_)
        | Event::TrackingEnded { completed: true }
        | Event::Arrived(_)
        | Event::Stopped
        | Event::StopNotConfirmed => return None,
    })
}

fn follow_over(name: &str, stats: TrackStats) -> Spoken {
    let spoken = Spoken::new(SentenceKind::Holding)
        .plain("The pass of ")
        .bold(short(name))
        .plain(" is over.");
    let Some((rms, worst)) = stats.rms().zip(stats.worst()) else { return spoken };
    spoken.plain(format!(
        " It was followed with an error of {} rms, {} at worst, using {} commands.",
        format::degrees(rms.degrees(), 2),
        format::degrees(worst.degrees(), 2),
        stats.commands
    ))
}
