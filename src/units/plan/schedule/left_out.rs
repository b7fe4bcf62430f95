//! Reasons why a pass is left out.

use super::{
    board::{Board, Fact},
    outcome::{Conflict, LeftOut, LeftOutReason},
    request::{Candidate, Choice, PlannedAntenna},
    solve::{PassPart, Slews as _, Solution, Take},
    way::{Impossible, Verdict, ms},
};

impl Board<'_> {
    pub(super) fn left_out(&self, solution: &Solution) -> Vec<LeftOut> {
        let mut is_taken = vec![false; self.request.candidates.len()];
        for take in
            solution.takes.iter().flatten().filter_map(|take| self.takes.get(*take as usize))
        {
            if let Some(is_taken) = is_taken.get_mut(take.pass as usize) {
                *is_taken = true;
            }
        }
        let wholes = self.wholes();
        let left = self.request.candidates.iter().zip(&is_taken).zip(&wholes);
        let left = left.filter(|((_, is_taken), _)| !**is_taken);
        let mut left: Vec<LeftOut> = left
            .map(|((candidate, _), own)| self.left_out_pass(candidate, own, solution))
            .collect();
        left.sort_by_key(|left| left.pass);
        // This sort is stable: passes with equal AOS stay in the order of their satellites.
        left.sort_by_key(|left| left.pass.aos);
        left
    }

    /// Returns the whole takes of each candidate.
    fn wholes(&self) -> Vec<Vec<u32>> {
        let mut wholes = vec![Vec::new(); self.request.candidates.len()];
        for ((take, fact), index) in self.takes.iter().zip(&self.facts).zip(0..) {
            let is_whole = take.part == PassPart::Alone && fact.late_ms == 0 && fact.early_ms == 0;
            if let Some(own) = wholes.get_mut(take.pass as usize).filter(|_| is_whole) {
                own.push(index);
            }
        }
        wholes
    }

    fn left_out_pass(&self, candidate: &Candidate, wholes: &[u32], solution: &Solution) -> LeftOut {
        let on = |(index, antenna): (usize, &PlannedAntenna)| {
            (antenna.id, self.why_not_on(index, antenna, candidate, wholes, solution))
        };
        // A pass that is refused from the start was not judged for any antenna.
        let by_antenna: Vec<_> = if candidate.options.is_empty() {
            Vec::new()
        } else {
            self.request.antennas.iter().enumerate().map(on).collect()
        };
        let all_impossible =
            by_antenna.iter().all(|(_, reason)| matches!(reason, LeftOutReason::Impossible(_)));
        let nearest =
            by_antenna.iter().map(|(_, reason)| reason).min_by_key(|reason| distance(reason));
        let chosen = match (candidate.refusal, nearest) {
            // The limits of the mounts come before the age of the elements and the rules.
            (Some(_), Some(nearest)) if all_impossible => nearest.clone(),
            (Some(refusal), _) => LeftOutReason::Refused(refusal),
            (None, Some(nearest)) => nearest.clone(),
            (None, None) => LeftOutReason::NotFound,
        };
        LeftOut { pass: candidate.key, reason: chosen, by_antenna }
    }

    fn why_not_on(
        &self,
        index: usize,
        antenna: &PlannedAntenna,
        candidate: &Candidate,
        wholes: &[u32],
        solution: &Solution,
    ) -> LeftOutReason {
        let option = candidate.options.iter().find(|(id, _)| *id == antenna.id);
        match option {
            Some((_, Choice::Judged(Verdict::Impossible(impossible)))) => {
                return LeftOutReason::Impossible(impossible.clone());
            }
            Some((_, Choice::AgainstRule)) | None => {
                let allowed = candidate.options.iter().filter(|(_, choice)| match choice {
                    Choice::Judged(_) => true,
                    Choice::AgainstRule => false,
                });
                return LeftOutReason::OtherAntennas(allowed.map(|(id, _)| *id).collect());
            }
            Some((_, Choice::Judged(Verdict::Possible(_)))) => {}
        }
        if let Some(off_reason) = antenna.off_reason {
            return LeftOutReason::Off(off_reason);
        }
        if let Some(refusal) = candidate.refusal {
            return LeftOutReason::Refused(refusal);
        }
        let own = wholes.iter().filter(|take| self.is_on(**take, index));
        let entries = solution.takes.get(index).map(Vec::as_slice).unwrap_or_default();
        let whys = own.map(|take| self.in_the_way(*take, entries));
        let in_the_way = whys.min_by_key(|reason| reason.as_ref().map_or((0, 0), distance));
        if let Some(Some(in_the_way)) = in_the_way {
            return in_the_way;
        }
        let limit = wholes.iter().find_map(|take| self.takes.get(*take as usize)?.limit);
        let day_limit = limit.and_then(|limit| self.limits.get(limit as usize));
        day_limit.map_or(LeftOutReason::NotFound, |max| LeftOutReason::MaxPerDay(*max))
    }

    fn is_on(&self, take: u32, antenna: usize) -> bool {
        self.takes.get(take as usize).is_some_and(|take| take.antenna as usize == antenna)
    }

    /// Returns the reason that prevents one more take among `entries`.
    fn in_the_way(&self, take: u32, entries: &[u32]) -> Option<LeftOutReason> {
        let (taken_entry, _) = self.with_fact(take)?;
        let mut overlaps: Vec<(i64, Fact)> = Vec::new();
        let mut too_short: Vec<(i64, Fact)> = Vec::new();
        for entry in entries {
            let Some((other, fact)) = self.with_fact(*entry) else { continue };
            let common_ms =
                other.to_ms.min(taken_entry.to_ms) - other.from_ms.max(taken_entry.from_ms);
            if common_ms > 0 {
                overlaps.push((common_ms, *fact));
                continue;
            }
            // At this distance, any leg fits.
            if common_ms <= -self.legs.longest_ms(taken_entry.antenna as usize) {
                continue;
            }
            let Some(missing_ms) = self.missing_ms((*entry, other), (take, taken_entry)) else {
                return Some(LeftOutReason::Impossible(Impossible::NoWay));
            };
            if missing_ms > 0 {
                too_short.push((missing_ms, *fact));
            }
        }
        if let Some(conflict) = conflict(overlaps, &too_short) {
            return Some(LeftOutReason::Overlaps(conflict));
        }
        if let Some(conflict) = conflict(too_short, &[]) {
            return Some(LeftOutReason::SlewTooShort(conflict));
        }
        let is_first = entries.iter().filter_map(|entry| self.takes.get(*entry as usize));
        let is_first = is_first.into_iter().all(|other| other.from_ms >= taken_entry.to_ms);
        if !is_first || self.legs.first_ms(take as usize).is_some() {
            return None;
        }
        if !self.legs.is_in_reach(take as usize) {
            return Some(LeftOutReason::Impossible(Impossible::NoWay));
        }
        let antenna = self.request.antennas.get(taken_entry.antenna as usize);
        let has_begun = antenna.is_some_and(|antenna| taken_entry.from_ms < ms(antenna.free_from));
        Some(if has_begun { LeftOutReason::UnderWay } else { LeftOutReason::TooFar })
    }

    /// Returns the missing time between two takes, milliseconds; `None` if no path leads from one
    /// to the other.
    fn missing_ms(&self, a: (u32, &Take), b: (u32, &Take)) -> Option<i64> {
        let (before, after) = if a.1.to_ms <= b.1.from_ms { (a, b) } else { (b, a) };
        let needs_ms = self.legs.needs_ms(before.0 as usize, after.0 as usize)?;
        Some(before.1.to_ms + needs_ms - after.1.from_ms)
    }
}

/// Returns the conflict with the entry of the highest class. Among entries of one class, takes the
/// one with the most missing time.
fn conflict(mut found: Vec<(i64, Fact)>, more: &[(i64, Fact)]) -> Option<Conflict> {
    found.sort_by_key(|(missing_ms, fact)| (fact.class, -missing_ms));
    let (missing_ms, rival) = found.first()?;
    let others = found.iter().skip(1).chain(more).map(|(_, fact)| fact.pass);
    Some(Conflict {
        pass: rival.pass,
        class: rival.class,
        missing_s: *missing_ms as f64 / 1000.0,
        others: others.collect(),
    })
}

/// Returns how far a pass was from being taken.
fn distance(reason: &LeftOutReason) -> (u8, i64) {
    let ms = |conflict: &Conflict| (conflict.missing_s * 1000.0) as i64;
    match reason {
        LeftOutReason::NotFound => (0, 0),
        LeftOutReason::MaxPerDay(_) => (1, 0),
        LeftOutReason::SlewTooShort(conflict) => (2, ms(conflict)),
        LeftOutReason::Overlaps(conflict) => (3, ms(conflict)),
        LeftOutReason::TooFar | LeftOutReason::UnderWay => (4, 0),
        LeftOutReason::Refused(_) => (5, 0),
        LeftOutReason::Off(_) => (6, 0),
        // An excluded antenna may be able to take the pass, but the operator excluded it.
        LeftOutReason::Impossible(_) => (7, 0),
        LeftOutReason::OtherAntennas(_) => (8, 0),
    }
}
