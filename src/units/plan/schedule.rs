//! Schedule: the assignment of passes to antennas, and the reasons why the other passes are left
//! out.
//!
//! [`Reach`] judges the part of one pass that one antenna can take: its axis positions, and the
//! seconds that count. `solve` chooses among these takes, and knows only spans, rows and slews. It
//! maximises a row of numbers, one per class: passes that are always taken, then priority 1 to 5. A
//! class never loses for the sake of later classes. Among equal rows, the previous schedule comes
//! first, then fewer seconds of slew, then earlier passes.

mod between_passes;
mod board;
mod changes;
mod joining;
mod left_out;
mod legs;
mod of_station;
mod outcome;
mod reach;
mod request;
mod row;
mod sight;
mod solve;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
#[cfg(test)]
mod tests;
mod under_way;
mod way;

pub use between_passes::{LEAD_S, between_passes, parks_within_s, sets_out};
use board::{Board, Fact};
pub use changes::{Change, ChangeCause, Changed, changes};
pub use joining::Joining;
pub use of_station::{deciding_rule, sun_is};
pub use outcome::{ClassWorth, Conflict, Entry, LeftOut, LeftOutReason, Proof, Schedule};
pub use reach::Reach;
pub use request::{
    AntennaOff, Candidate, Choice, Common, Partial, PassKey, PassPolicy, PlannedAntenna, Refusal,
    Request, Rule, Steadiness,
};
pub use row::Class;
pub use sight::Sight;
use solve::{Slews as _, Solution, Take};
use way::at_ms;
pub use way::{Impossible, Lost, Verdict, Way};

/// Returns the best schedule that the solver finds for the request.
pub fn plan(request: &Request<'_>) -> Schedule {
    let board = Board::new(request);
    board.schedule(&board.solve())
}

impl Board<'_> {
    fn schedule(&self, solution: &Solution) -> Schedule {
        let mut entries = Vec::new();
        let mut slew_s = 0.0;
        for takes in &solution.takes {
            let mut before = None;
            for take in takes {
                let entry = self.entry(before, *take, &solution.takes);
                slew_s += entry.as_ref().map_or(0.0, |entry| entry.slew_s);
                entries.extend(entry);
                before = Some(*take);
            }
        }
        entries.sort_by_key(|entry| (entry.start, entry.antenna));
        let left_out = self.left_out(solution);
        let worth = self.worth(&entries, solution);
        Schedule { entries, left_out, worth, slew_s }
    }

    fn with_fact(&self, take: u32) -> Option<(&Take, &Fact)> {
        self.takes.get(take as usize).zip(self.facts.get(take as usize))
    }

    fn entry(&self, before: Option<u32>, take: u32, all: &[Vec<u32>]) -> Option<Entry> {
        let (of_take, fact) = self.with_fact(take)?;
        let antenna = self.request.antennas.get(of_take.antenna as usize)?;
        let set_up_ms = legs::set_up_ms(antenna);
        let earlier = before.and_then(|before| self.with_fact(before));
        let (slew_ms, spare_ms) = if let Some((before, (earlier, _))) = before.zip(earlier) {
            let slew_ms = self.legs.turning_ms(before as usize, take as usize);
            (slew_ms, Some(of_take.from_ms - earlier.to_ms - slew_ms - set_up_ms))
        } else {
            let slew_ms = self.legs.first_ms(take as usize).unwrap_or_default();
            let spare_ms = of_take.from_ms - way::ms(antenna.free_from) - slew_ms - set_up_ms;
            (slew_ms, antenna.stands_deg.map(|_| spare_ms))
        };
        let parts = all.iter().flatten().filter(|other| **other != take);
        let mut parts = parts.filter_map(|other| self.with_fact(*other));
        let shared_with = parts.find(|(_, other)| other.pass == fact.pass);
        let seconds = |ms: i64| ms as f64 / 1000.0;
        Some(Entry {
            pass: fact.pass,
            antenna: fact.antenna,
            class: fact.class,
            start: at_ms(of_take.from_ms),
            end: at_ms(of_take.to_ms),
            late_s: seconds(fact.late_ms),
            early_s: seconds(fact.early_ms),
            counted_s: seconds(fact.counted_ms),
            worth: fact.worth,
            lost: fact.lost,
            axes_deg: fact.ends_deg,
            after: earlier.map(|(_, fact)| fact.pass),
            slew_s: seconds(slew_ms),
            set_up_s: seconds(set_up_ms),
            spare_s: spare_ms.map(seconds),
            shared_with: shared_with.map(|(_, fact)| fact.antenna),
            is_fixed: fact.is_fixed,
        })
    }

    /// Returns the worth of each class, and whether it is proved. Steadiness may have kept a class
    /// below its proved best.
    fn worth(&self, entries: &[Entry], solution: &Solution) -> Vec<ClassWorth> {
        let mut is_open = false;
        let with_worth = |class: Class| {
            let own = entries.iter().filter(|entry| entry.class == class);
            let worth = own.map(|entry| entry.worth).sum();
            let bound = solution.bound.number(class.index());
            // If this class could be better, the later ones would change with it and are not
            // proved.
            is_open |= bound != worth;
            let proof = if is_open { Proof::AtMost(bound) } else { Proof::Best };
            ClassWorth { class, worth, proof }
        };
        Class::shown(self.request.choose_by).into_iter().map(with_worth).collect()
    }
}
