//! Request in the form of the solver: every way to take every pass, and its worth.

use std::collections::HashMap;

use jiff::tz::TimeZone;

use super::{
    legs::{LegEnds, Legs},
    outcome::Entry,
    request::{Candidate, Choice, PassKey, Request},
    row::{Class, Row},
    solve::{PassPart, Problem, Solution, Take},
    way::{Lost, Span, Verdict, Way, ms},
};
use crate::station::{AntennaId, ChooseBy, Take as Chosen};

/// Max number of states in the search for the proved best.
const EFFORT: u64 = 12_000_000;

/// Facts about a take that the solver does not need.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fact {
    pub(super) pass: PassKey,
    pub(super) antenna: AntennaId,
    pub(super) class: Class,
    pub(super) worth: i64,
    pub(super) counted_ms: i64,
    pub(super) late_ms: i64,
    pub(super) early_ms: i64,
    pub(super) lost: Option<Lost>,
    pub(super) ends_deg: LegEnds,
    pub(super) is_fixed: bool,
}

pub(super) struct Board<'a> {
    pub(super) request: &'a Request<'a>,
    pub(super) takes: Vec<Take>,
    pub(super) facts: Vec<Fact>,
    pub(super) limits: Vec<u32>,
    pub(super) legs: Legs<'a>,
    passes: usize,
}

/// Whole pass on one antenna.
struct Whole<'a> {
    candidate: &'a Candidate,
    pass: usize,
    antenna: usize,
    way: &'a Way,
    /// Time from AOS to LOS, milliseconds.
    sight_ms: i64,
}

impl<'a> Board<'a> {
    pub(super) fn new(request: &'a Request<'a>) -> Self {
        let fixed_as = |entry: &Entry| {
            // Compare by overlap, because newer elements shift AOS.
            let is_it = |candidate: &Candidate| {
                candidate.key.satellite == entry.pass.satellite
                    && candidate.key.aos < entry.end
                    && entry.start < candidate.los
            };
            request.candidates.iter().position(is_it)
        };
        let fixed: Vec<Option<usize>> = request.fixed.iter().map(fixed_as).collect();
        let limits = DayLimits::new(request);
        let mut board = Self {
            request,
            takes: Vec::new(),
            facts: Vec::new(),
            limits: limits.maxima.clone(),
            legs: Legs::new(request.antennas, std::iter::empty()),
            passes: request.candidates.len() + request.fixed.len(),
        };
        for ((entry, pass), extra) in request.fixed.iter().zip(&fixed).zip(0..) {
            // If one part of a pass is handed over, the other part may also be taken.
            let own = request.candidates.len() + extra;
            let pass = pass.filter(|_| entry.shared_with.is_none()).unwrap_or(own);
            board.add_fixed(entry, pass, limits.of_pass.get(pass).copied().flatten());
        }
        let wholes: Vec<Whole<'_>> =
            (0..request.antennas.len()).flat_map(|antenna| wholes(request, antenna)).collect();
        let fixed_beside = |whole: &Whole<'_>| {
            let pairs = request.fixed.iter().zip(&fixed);
            let own = pairs.filter(|(_, pass)| **pass == Some(whole.pass));
            own.map(|(entry, _)| entry).collect::<Vec<_>>()
        };
        let previous = PreviousPlan::new(request);
        let crowd = Crowd::new(request, &wholes);
        for whole in &wholes {
            let limit = limits.of_pass.get(whole.pass).copied().flatten();
            let fixed_entries = fixed_beside(whole);
            let id = request.antennas.get(whole.antenna).map(|antenna| antenna.id);
            let is_free = |span: Span| {
                fixed_entries.iter().all(|entry| {
                    let is_apart = span.from_ms >= ms(entry.end) || span.to_ms <= ms(entry.start);
                    entry.shared_with.is_some() && id != Some(entry.antenna) && is_apart
                })
            };
            for (span, part) in board.parts(whole, &crowd) {
                if fixed_entries.is_empty() {
                    board.add(whole, (span, part), limit, &previous);
                } else if part != PassPart::Alone && is_free(span) {
                    board.add(whole, (span, PassPart::Alone), limit, &previous);
                }
            }
        }
        let mut order: Vec<usize> = (0..board.takes.len()).collect();
        order.sort_by_key(|index| board.takes.get(*index).map(|take| (take.antenna, take.from_ms)));
        board.takes =
            order.iter().filter_map(|position| board.takes.get(*position).copied()).collect();
        board.facts = order.iter().filter_map(|index| board.facts.get(*index).copied()).collect();
        let stops = board.takes.iter().zip(&board.facts);
        let stops = stops.map(|(take, fact)| (*take, fact.ends_deg, fact.is_fixed));
        board.legs = Legs::new(request.antennas, stops);
        board
    }

    pub(super) fn solve(&self) -> Solution {
        self.problem().solve()
    }

    fn problem(&self) -> Problem<'_> {
        Problem {
            antennas: self.request.antennas.len(),
            passes: self.passes,
            takes: &self.takes,
            limits: &self.limits,
            slews: &self.legs,
            effort: EFFORT,
        }
    }

    fn add_fixed(&mut self, entry: &Entry, pass: usize, limit: Option<u32>) {
        let ids = self.request.antennas.iter().map(|antenna| antenna.id);
        let Some(antenna) = ids.clone().position(|id| id == entry.antenna) else { return };
        self.takes.push(Take {
            pass: pass as u32,
            antenna: antenna as u32,
            limit,
            part: PassPart::Alone,
            from_ms: ms(entry.start),
            to_ms: ms(entry.end),
            share: 1000,
            is_whole: true,
            height_mdeg: 0,
            // This is the first class of all, so that no plan gives up a pass under way.
            row: Row::new(Class::Fixed, 1) + Row::new(entry.class, entry.worth),
        });
        self.facts.push(Fact {
            pass: entry.pass,
            antenna: entry.antenna,
            class: entry.class,
            worth: entry.worth,
            counted_ms: (entry.counted_s * 1000.0) as i64,
            late_ms: (entry.late_s * 1000.0) as i64,
            early_ms: (entry.early_s * 1000.0) as i64,
            lost: entry.lost,
            ends_deg: entry.axes_deg,
            is_fixed: true,
        });
    }

    /// Returns the whole pass, and its remainders with a later start or an earlier end.
    fn parts(&self, whole: &Whole<'_>, crowd: &Crowd) -> Vec<(Span, PassPart)> {
        let (way, span) = (whole.way, whole.way.span());
        let mut parts = vec![(span, PassPart::Alone)];
        let Some(partial) = self.request.partial else { return parts };
        let counted_ms = way.counted_ms(span);
        let min_ms = (counted_ms as f64 * partial.min_share).max(partial.min_s * 1000.0) as i64;
        // Require at least one, because limits of zero must not let an empty part pass.
        let is_enough = |part: Span| way.counted_ms(part) >= min_ms.max(1);
        // A division counts the cuts, so the step must not be zero.
        let step_ms = ((partial.step_s * 1000.0) as i64).max(1_000);
        let cuts = |room_ms: i64| (0..=room_ms / step_ms).map(move |step| step * step_ms);
        let room_ms = (span.length_ms() - min_ms).max(0);
        let (is_late, is_early) = crowd.overlaps(whole, span, room_ms);
        let (late, early) = (if is_late { room_ms } else { 0 }, if is_early { room_ms } else { 0 });
        for late_ms in cuts(late) {
            let part =
                |early_ms| Span { from_ms: span.from_ms + late_ms, to_ms: span.to_ms - early_ms };
            let cut = cuts(early).map(part).take_while(|part| is_enough(*part));
            parts.extend(cut.filter(|part| *part != span).map(|part| (part, PassPart::Alone)));
        }
        if partial.hand_over && self.request.antennas.len() > 1 {
            // The first cut would leave a first part without length.
            for cut_ms in cuts(span.length_ms() - 1).skip(1) {
                let middle_ms = span.from_ms + cut_ms;
                let first = (Span { to_ms: middle_ms, ..span }, PassPart::First);
                let second = (Span { from_ms: middle_ms, ..span }, PassPart::Second);
                parts.extend([first, second].into_iter().filter(|(part, _)| is_enough(*part)));
            }
        }
        parts
    }

    fn add(
        &mut self,
        whole: &Whole<'_>,
        (span, part): (Span, PassPart),
        limit: Option<u32>,
        previous: &PreviousPlan,
    ) {
        let Some(antenna) = self.request.antennas.get(whole.antenna) else { return };
        let (candidate, way, all) = (whole.candidate, whole.way, whole.way.span());
        let choose_by = self.request.choose_by;
        let counted_ms = way.counted_ms(span);
        let worth = candidate.worth(choose_by, counted_ms, part);
        let class = candidate.class(choose_by);
        let mut row = Row::new(class, worth)
            .counting(counted_ms)
            .risen(ms(candidate.key.aos) - previous.epoch_ms);
        if previous.holds(whole.pass, antenna.id) {
            let steadiness = self.request.steadiness;
            let seconds = match choose_by {
                // Worth counts passes here, and seconds must not be added to passes.
                ChooseBy::MostPasses => 0,
                _ => i64::from(steadiness.seconds) * 1000,
            };
            let bonus = worth * i64::from(steadiness.percent) / 100 + seconds;
            row = row + Row::new(class, bonus) + Row::new(Class::Kept, 1);
        }
        self.takes.push(Take {
            pass: whole.pass as u32,
            antenna: whole.antenna as u32,
            // Both parts are one pass, which counts towards its limit once.
            limit: limit.filter(|_| part != PassPart::Second),
            part,
            from_ms: span.from_ms,
            to_ms: span.to_ms,
            share: match part {
                PassPart::Alone => 1000,
                PassPart::First | PassPart::Second => span.length_ms() * 1000 / whole.sight_ms,
            },
            is_whole: span == all,
            height_mdeg: (candidate.max_elevation.degrees() * 1000.0) as i64,
            row,
        });
        self.facts.push(Fact {
            pass: candidate.key,
            antenna: antenna.id,
            class,
            worth,
            counted_ms,
            late_ms: span.from_ms - all.from_ms,
            early_ms: all.to_ms - span.to_ms,
            lost: way.lost,
            ends_deg: [way.axes_deg(span.from_ms), way.axes_deg(span.to_ms)],
            is_fixed: false,
        });
    }
}

impl Candidate {
    pub(super) fn class(&self, choose_by: ChooseBy) -> Class {
        match self.take {
            Some(Chosen::Always) => Class::Always,
            None | Some(Chosen::Never) => Class::by_plan(choose_by, self.priority),
        }
    }

    /// Returns the worth of a take with this counted time, milliseconds, in its class.
    pub(super) fn worth(&self, choose_by: ChooseBy, counted_ms: i64, part: PassPart) -> i64 {
        match choose_by {
            ChooseBy::Elevation => {
                (counted_ms as f64 * self.max_elevation.radians().sin()).round() as i64
            }
            ChooseBy::Duration | ChooseBy::MostMinutes => counted_ms,
            ChooseBy::MostPasses => i64::from(part != PassPart::Second),
        }
    }
}

/// Returns all whole passes that an antenna can take.
fn wholes<'a>(request: &'a Request<'a>, antenna: usize) -> Vec<Whole<'a>> {
    let Some(planned) = request
        .antennas
        .get(antenna)
        .filter(|planned_antenna| planned_antenna.off_reason.is_none())
    else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let candidates = request.candidates.iter().enumerate();
    for (pass, candidate) in candidates.filter(|(_, other)| other.refusal.is_none()) {
        let option = candidate.options.iter().find(|(id, _)| *id == planned.id);
        let Some((_, Choice::Judged(Verdict::Possible(ways)))) = option else { continue };
        // Shares are divided by this value.
        let sight_ms = (ms(candidate.los) - ms(candidate.key.aos)).max(1);
        found.extend(ways.iter().map(|way| Whole { candidate, pass, antenna, way, sight_ms }));
    }
    found
}

/// Neighbouring passes that may justify a late start or an early end of a pass.
struct Crowd {
    /// Pass, start and end for each antenna, by start.
    spans: Vec<Vec<(usize, Span)>>,
    longest_pass_ms: Vec<i64>,
    /// Max slew time of each antenna, milliseconds.
    reach_ms: Vec<i64>,
    free_ms: Vec<i64>,
}

impl Crowd {
    fn new(request: &Request<'_>, wholes: &[Whole<'_>]) -> Self {
        let mut spans = vec![Vec::new(); request.antennas.len()];
        for whole in wholes {
            if let Some(spans) = spans.get_mut(whole.antenna) {
                spans.push((whole.pass, whole.way.span()));
            }
        }
        for spans in &mut spans {
            spans.sort_by_key(|(pass, span): &(usize, Span)| (span.from_ms, *pass));
        }
        let longest = |spans: &Vec<(usize, Span)>| {
            spans.iter().map(|(_, span)| span.length_ms()).max().unwrap_or_default()
        };
        let stops = wholes.iter().map(|whole| {
            let span = whole.way.span();
            let take = Take {
                pass: 0,
                antenna: whole.antenna as u32,
                limit: None,
                part: PassPart::Alone,
                from_ms: span.from_ms,
                to_ms: span.to_ms,
                share: 1000,
                is_whole: true,
                height_mdeg: 0,
                row: Row::ZERO,
            };
            (take, [span.from_ms, span.to_ms].map(|at_ms| whole.way.axes_deg(at_ms)), false)
        });
        let legs = Legs::new(request.antennas, stops);
        let antennas = 0..request.antennas.len();
        Self {
            longest_pass_ms: spans.iter().map(longest).collect(),
            spans,
            reach_ms: antennas
                .map(|antenna| super::solve::Slews::longest_ms(&legs, antenna))
                .collect(),
            free_ms: request.antennas.iter().map(|antenna| ms(antenna.free_from)).collect(),
        }
    }

    /// Returns whether another pass may need the first part of `span`, and whether one may need its
    /// last part. The pass may give up at most `room_ms`.
    fn overlaps(&self, whole: &Whole<'_>, span: Span, room_ms: i64) -> (bool, bool) {
        let own = |list: &[i64]| list.get(whole.antenna).copied().unwrap_or_default();
        let reach_ms = own(&self.reach_ms);
        let Some(spans) = self.spans.get(whole.antenna) else { return (false, false) };
        let earliest_ms = span.from_ms - reach_ms - own(&self.longest_pass_ms);
        let first = spans.partition_point(|(_, other)| other.from_ms < earliest_ms);
        let near = spans.get(first..).unwrap_or_default().iter();
        let near = near.take_while(|(_, other)| other.from_ms < span.to_ms + reach_ms);
        let near = near.filter(|(pass, _)| *pass != whole.pass);
        let mut is_late = own(&self.free_ms) + reach_ms > span.from_ms;
        let mut is_early = false;
        for (_, other) in near {
            is_late |=
                other.from_ms < span.from_ms + room_ms && other.to_ms + reach_ms > span.from_ms;
            is_early |= other.to_ms > span.to_ms - room_ms && other.from_ms < span.to_ms + reach_ms;
        }
        (is_late, is_early)
    }
}

/// Daily pass limits that the request can reach.
struct DayLimits {
    maxima: Vec<u32>,
    of_pass: Vec<Option<u32>>,
}

impl DayLimits {
    fn new(request: &Request<'_>) -> Self {
        let day = |candidate: &Candidate| {
            (candidate.key.satellite, candidate.key.aos.to_zoned(TimeZone::UTC).date())
        };
        let mut counts = HashMap::new();
        let limited =
            |candidate: &&Candidate| candidate.refusal.is_none() && candidate.max_per_day.is_some();
        for candidate in request.candidates.iter().filter(limited) {
            *counts.entry(day(candidate)).or_insert(0_u32) += 1;
        }
        let mut indices = HashMap::new();
        let mut maxima = Vec::new();
        let of_pass = request.candidates.iter().map(|candidate| {
            let max = candidate.max_per_day.filter(|_| candidate.refusal.is_none())?;
            let day = day(candidate);
            // An unreachable limit would only multiply the states of the search.
            if counts.get(&day).is_none_or(|count| *count <= max) {
                return None;
            }
            let index = indices.entry(day).or_insert_with(|| {
                maxima.push(max);
                maxima.len() as u32 - 1
            });
            Some(*index)
        });
        let of_pass = of_pass.collect();
        Self { maxima, of_pass }
    }
}

/// Passes of the previous schedule.
struct PreviousPlan {
    /// Index of the pass, and the antenna.
    takes: Vec<(usize, AntennaId)>,
    /// Reference time of the AOS times, milliseconds.
    epoch_ms: i64,
}

impl PreviousPlan {
    fn new(request: &Request<'_>) -> Self {
        let mut by_satellite: HashMap<u32, Vec<(usize, &Candidate)>> = HashMap::new();
        for (index, candidate) in request.candidates.iter().enumerate() {
            by_satellite.entry(candidate.key.satellite).or_default().push((index, candidate));
        }
        let previous = request.previous.iter().flat_map(|schedule| &schedule.entries);
        let takes = previous.filter_map(|entry| {
            let own = by_satellite.get(&entry.pass.satellite)?;
            let same = own.iter().find(|(_, candidate)| {
                candidate.key.aos < entry.end && entry.start < candidate.los
            })?;
            Some((same.0, entry.antenna))
        });
        let mut previous_takes: Vec<_> = takes.collect();
        previous_takes.sort_unstable();
        let first = request.candidates.iter().map(|candidate| ms(candidate.key.aos)).min();
        Self { takes: previous_takes, epoch_ms: first.unwrap_or_default() }
    }

    fn holds(&self, pass: usize, antenna: AntennaId) -> bool {
        self.takes.binary_search(&(pass, antenna)).is_ok()
    }
}
