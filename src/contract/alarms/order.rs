//! Order of the alarms on screen: each cause above its effects.

use std::cmp::Reverse;

use crate::{
    alarms::{Alarm, AlarmKind, Alarms},
    driver::{OffTargetCause, Safety},
    plan::on_board::Cause,
};

/// An alarm with its cause in the list.
#[derive(Debug, Clone, Copy)]
pub struct Placed<'a> {
    pub alarm: &'a Alarm,
    /// Id of the alarm that caused this alarm and precedes it in the list.
    pub follows: Option<u64>,
}

impl Alarms {
    /// Returns the alarms in display order. Persisting red alarms come first, then higher
    /// priorities, then persisting alarms, then newer alarms. Alarms that are both over and
    /// acknowledged come last.
    ///
    /// An effect follows directly behind its cause, in order of occurrence, and lifts the cause to
    /// its own priority. An alarm is an effect if the cause persisted when the alarm came and its
    /// kind explains the alarm's kind. With several causes or a chain of causes, the first cause
    /// counts. An alarm that is over is no cause of a persisting alarm.
    pub fn in_order(&self) -> Vec<Placed<'_>> {
        let cause_of = |effect: &Alarm| {
            let causes = self.list.iter().filter(|cause| is_cause(cause, effect));
            causes.min_by_key(|cause| (cause.last, cause.id))
        };
        // A cause always precedes its effect, so the chain of causes is finite.
        let first_cause =
            |effect| std::iter::successors(cause_of(effect), |cause| cause_of(cause)).last();
        let place = |alarm| Placed { alarm, follows: first_cause(alarm).map(|cause| cause.id) };
        let all: Vec<Placed<'_>> = self.list.iter().map(place).collect();
        let mut groups: Vec<Vec<Placed<'_>>> = Vec::new();
        for first in all.iter().filter(|placed| placed.follows.is_none()) {
            let mut group = vec![*first];
            let id = first.alarm.id;
            group.extend(all.iter().filter(|placed| placed.follows == Some(id)));
            groups.push(group);
        }
        groups.sort_by_key(|group| {
            let open = || group.iter().filter(|placed| !placed.alarm.is_done());
            let rank = open().map(|placed| placed.alarm.priority()).max();
            let standing = open().filter(|placed| !placed.alarm.is_over());
            let standing = standing.map(|placed| placed.alarm.priority()).max();
            let red = standing.filter(|priority| priority.is_red());
            Reverse((red, rank, standing.is_some(), group.first().map(|placed| placed.alarm.id)))
        });
        groups.concat()
    }
}

/// Returns `true` if `cause` explains `effect` and persisted when `effect` came.
fn is_cause(cause: &Alarm, effect: &Alarm) -> bool {
    let is_before = (cause.last, cause.id) < (effect.last, effect.id);
    let stood = cause.over_since.is_none_or(|over_since| over_since >= effect.last);
    let is_there = cause.antenna.is_none() || cause.antenna == effect.antenna;
    // A cause that is over or acknowledged must not stand above an effect that still needs
    // attention.
    let is_open = (!cause.is_done() || effect.is_done()) && (!cause.is_over() || effect.is_over());
    is_before
        && stood
        && is_there
        && is_open
        && cause.shelved_until.is_none()
        && effect.shelved_until.is_none()
        && entails(&cause.kind, &effect.kind)
}

/// Returns `true` if an alarm of the kind `cause` can lead to an alarm of the kind `effect`.
fn entails(cause: &AlarmKind, effect: &AlarmKind) -> bool {
    use crate::alarms::AlarmKind as K;
    match cause {
        // The driver neither sends nor reads anything.
        K::DriverStands(_) => {
            is_of_silence(effect) || matches!(effect, K::LinkLost(_) | K::NotTaken)
        }
        K::LinkLost(_) | K::Unreadable(_) | K::Safety(Safety::SilentInMotion) => {
            is_of_silence(effect)
        }
        K::Check(_) => matches!(
            effect,
            K::Refused(..)
                | K::Unanswered(_)
                | K::EndedShort
                | K::TrackingEnded
                | K::OffTarget { cause: None, .. }
        ),
        K::ClockOff(_) | K::ClockNotSet => match effect {
            K::OffTarget { cause: Some(OffTargetCause::Reported(ranked)), .. } => {
                matches!(ranked.cause, Cause::Clock { .. })
            }
            K::OffTarget { cause: None, .. } | K::UnitDiffers(_) => true,
            _ => false,
        },
        _ => false,
    }
}

/// Returns `true` for alarms that can follow from an antenna that does not answer.
fn is_of_silence(effect: &AlarmKind) -> bool {
    use crate::alarms::AlarmKind as K;
    matches!(
        effect,
        K::StopNotConfirmed
            | K::JogLeaseOver
            | K::JogPositionOld
            | K::LockOutUnproved
            | K::Unanswered(_)
            | K::CannotProgramTrack(..)
            | K::TrackingEnded
            | K::EndedShort
            | K::NotCompared { .. }
            | K::Safety(Safety::DeadManFired | Safety::AsksToResume { .. })
    )
}
