//! Passes that are handed from one antenna to another, one after the other: for where there are too
//! many states to try them all together.

use super::{Line, Part, Problem, Row};

impl Problem<'_> {
    /// Takes a pass in two parts where that is worth more than how it is taken now, beside all
    /// others as they are.
    pub(super) fn handed_over(
        &self,
        lines: &[Line],
        (mut takes, mut row): (Vec<Vec<u32>>, Row),
    ) -> (Vec<Vec<u32>>, Row) {
        let before = row;
        let mut parts: Vec<(Vec<u32>, Vec<u32>)> = vec![Default::default(); self.passes];
        for (index, take) in (0..).zip(self.takes) {
            let Some((first, second)) = parts.get_mut(take.pass as usize) else { continue };
            match take.part {
                Part::Alone => {}
                Part::First => first.push(index),
                Part::Second => second.push(index),
            }
        }
        for (pass, (first, second)) in (0..).zip(&parts) {
            let mut now = takes.iter().flatten().filter_map(|take| self.take(*take));
            if first.is_empty() || now.any(|it| it.pass == pass && it.is_whole) {
                continue;
            }
            let mut without = takes.clone();
            for takes in &mut without {
                takes.retain(|take| self.take(*take).is_some_and(|it| it.pass != pass));
            }
            for (first, second) in first.iter().flat_map(|a| second.iter().map(move |b| (a, b))) {
                let Some(found) = self.with_parts(&without, *first, *second) else { continue };
                let new_row = self.row(&found);
                if new_row > row && self.keeps_limits(&found) && self.is_in_time(&found) {
                    (takes, row) = (found, new_row);
                }
            }
        }
        if row > before { self.improved(lines, takes) } else { (takes, row) }
    }

    fn with_parts(&self, takes: &[Vec<u32>], first: u32, second: u32) -> Option<Vec<Vec<u32>>> {
        let (a, b) = (self.take(first)?, self.take(second)?);
        if a.antenna == b.antenna || a.to_ms > b.from_ms {
            return None;
        }
        let mut takes = takes.to_vec();
        for (take, it) in [(first, a), (second, b)] {
            let own = takes.get_mut(it.antenna as usize)?;
            let place = own.partition_point(|other| {
                self.take(*other).is_some_and(|other| other.from_ms <= it.from_ms)
            });
            own.insert(place, take);
        }
        Some(takes)
    }
}
