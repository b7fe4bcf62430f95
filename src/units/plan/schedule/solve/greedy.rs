//! Schedules that take one pass after the other, in a fixed order.

use super::{PassPart, Problem, Take};

impl Problem<'_> {
    /// Returns the schedules of greedy planners: the passes with the highest worth first, or the
    /// highest passes of each class.
    pub(super) fn greedy(&self) -> [Vec<Vec<u32>>; 2] {
        let sorted = |compare: &dyn Fn(&Take, &Take) -> std::cmp::Ordering| {
            let mut order: Vec<u32> = (0..self.takes.len() as u32).collect();
            // Equal takes keep the order of their indices, so that two runs give the same schedule.
            order.sort_by(|a, b| match (self.take(*a), self.take(*b)) {
                (Some(one), Some(other)) => compare(one, other).then(a.cmp(b)),
                _ => a.cmp(b),
            });
            self.filled(vec![Vec::new(); self.antennas], order)
        };
        let highest = |a: &Take, b: &Take| {
            let first = a.row.first_class().cmp(&b.row.first_class());
            let higher = b.height_mdeg.cmp(&a.height_mdeg);
            first.then(higher).then(b.is_whole.cmp(&a.is_whole)).then(b.row.cmp(&a.row))
        };
        [sorted(&|a, b| b.row.cmp(&a.row)), sorted(&highest)]
    }

    /// Adds takes in their order if they fit beside the previous ones. Hands no pass over.
    pub(super) fn filled(
        &self,
        mut takes: Vec<Vec<u32>>,
        order: impl IntoIterator<Item = u32>,
    ) -> Vec<Vec<u32>> {
        let mut is_taken = vec![false; self.passes];
        let mut left = self.limits.to_vec();
        // Existing takes already use up their passes and limits.
        for take in takes.iter().flatten().filter_map(|take| self.take(*take)) {
            if let Some(flag) = is_taken.get_mut(take.pass as usize) {
                *flag = true;
            }
            if let Some(left) = take.limit.and_then(|limit| left.get_mut(limit as usize)) {
                *left = left.saturating_sub(1);
            }
        }
        for index in order {
            // A part of a pass is worth nothing without its second part, so add only whole passes.
            let Some(take) = self.take(index).filter(|take| take.part == PassPart::Alone) else {
                continue;
            };
            let limit = take.limit.and_then(|limit| left.get_mut(limit as usize));
            if limit.as_deref() == Some(&0) || is_taken.get(take.pass as usize) != Some(&false) {
                continue;
            }
            let Some(own) = takes.get_mut(take.antenna as usize) else { continue };
            let starts_before =
                |other: &u32| self.take(*other).is_some_and(|other| other.from_ms <= take.from_ms);
            let place = own.partition_point(starts_before);
            let fits_after = match place.checked_sub(1).and_then(|before| own.get(before)) {
                Some(before) => self.fits(*before, index),
                // The antenna may stand too far away to reach its first take in time.
                None => self.slews.first_ms(index as usize).is_some(),
            };
            if !fits_after || own.get(place).is_some_and(|after| !self.fits(index, *after)) {
                continue;
            }
            own.insert(place, index);
            if let Some(is_first) = is_taken.get_mut(take.pass as usize) {
                *is_first = true;
            }
            if let Some(left) = limit {
                *left -= 1;
            }
        }
        takes
    }
}
