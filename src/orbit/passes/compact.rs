//! Compact form of found passes. A week of the whole catalogue has some 700,000 passes, and in
//! calendar time they would take half as much memory again.

use rayon::prelude::*;

use super::{Pass, PassPoint};
use crate::astro::{AzEl, time};

/// Average number of passes in a stretch of time while sorting.
const STRETCH: usize = 1 << 12;

/// A pass and the index of its satellite.
#[derive(Debug, Clone, Copy)]
pub(super) struct CompactPass {
    pub(super) satellite: u32,
    pub(super) starts_before: bool,
    pub(super) ends_after: bool,
    pub(super) aos: CompactPoint,
    pub(super) tca: CompactPoint,
    pub(super) los: CompactPoint,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct CompactPoint {
    /// Nanoseconds since 1970.
    pub(super) at_ns: i64,
    pub(super) direction: AzEl,
}

impl CompactPass {
    fn new(satellite: u32, pass: &Pass) -> Self {
        let Pass { aos, tca, los, starts_before, ends_after } = *pass;
        let [aos, tca, los] = [aos, tca, los].map(|PassPoint { time, direction }| CompactPoint {
            at_ns: time::nanoseconds(time),
            direction,
        });
        Self { satellite, starts_before, ends_after, aos, tca, los }
    }

    fn indexed(&self) -> (usize, Pass) {
        (self.satellite as usize, (*self).into())
    }
}

impl From<CompactPass> for Pass {
    fn from(compact: CompactPass) -> Self {
        let CompactPass { aos, tca, los, starts_before, ends_after, .. } = compact;
        let [aos, tca, los] = [aos, tca, los].map(|CompactPoint { at_ns, direction }| PassPoint {
            time: time::from_nanoseconds(at_ns),
            direction,
        });
        Self { aos, tca, los, starts_before, ends_after }
    }
}

/// Passes of many satellites, each with the index of its satellite.
#[derive(Debug, Clone, Default)]
pub struct FoundPasses {
    /// Batches as found, ordered by satellite, then by time. Copying them into one list would take
    /// a tenth more time and twice the memory.
    batches: Vec<Vec<CompactPass>>,
}

impl FoundPasses {
    pub(super) fn new(batches: Vec<Vec<CompactPass>>) -> Self {
        Self { batches }
    }

    /// Returns the passes in the order of [`Self::batches`].
    pub(super) fn into_passes(self) -> impl Iterator<Item = (usize, Pass)> {
        self.batches.into_iter().flatten().map(|compact| compact.indexed())
    }

    fn len(&self) -> usize {
        self.batches.iter().map(Vec::len).sum()
    }

    /// Replaces each pass by the passes that `parts` returns for it, in their order. The threads of
    /// the caller's rayon pool share the work.
    pub fn divide(&mut self, parts: impl Fn(usize, Pass) -> Vec<Pass> + Sync) {
        let of_one = |compact: &CompactPass| {
            let (satellite, pass) = compact.indexed();
            let parts = parts(satellite, pass);
            parts.into_iter().map(|part| CompactPass::new(compact.satellite, &part)).collect()
        };
        self.batches.par_iter_mut().for_each(|batch| {
            *batch = batch.iter().flat_map::<Vec<_>, _>(of_one).collect();
        });
    }

    /// Keeps the passes for which `is_wanted` returns true.
    pub fn retain(&mut self, is_wanted: impl Fn(&Pass) -> bool + Sync) {
        self.batches.par_iter_mut().for_each(|batch| {
            batch.retain(|compact| is_wanted(&(*compact).into()));
        });
    }

    /// Returns the passes in order of AOS, then of satellite.
    ///
    /// The iterator sorts one stretch of time after the other, which takes hardly any memory.
    pub fn in_order(&self) -> impl Iterator<Item = (usize, Pass)> {
        let mut rest: Vec<Rest<'_>> = self.by_satellite().map(Rest::new).collect();
        let first_ns = rest.iter().map(|of_one| of_one.next_ns).min().unwrap_or(0);
        let last_ns = self.by_satellite().filter_map(|of_one| of_one.last()).map(aos_ns).max();
        let last_ns = last_ns.unwrap_or(first_ns);
        let stretches = i64::from((self.len() / STRETCH) as u32) + 1;
        let length_ns = (last_ns - first_ns) / stretches + 1;
        (1..=stretches).flat_map(move |stretch| {
            let end_ns = first_ns + stretch * length_ns;
            let mut passes: Vec<&CompactPass> = Vec::with_capacity(2 * STRETCH);
            for of_one in rest.iter_mut().filter(|of_one| of_one.next_ns < end_ns) {
                passes.extend(of_one.take_before(end_ns));
            }
            passes.sort_by_key(|compact| aos_ns(compact));
            passes.into_iter().map(CompactPass::indexed)
        })
    }

    /// Returns the passes of each satellite with passes, in order of time.
    fn by_satellite(&self) -> impl Iterator<Item = &[CompactPass]> {
        let is_same = |a: &CompactPass, b: &CompactPass| a.satellite == b.satellite;
        self.batches.iter().flat_map(move |batch| batch.chunk_by(is_same))
    }
}

fn aos_ns(compact: &CompactPass) -> i64 {
    compact.aos.at_ns
}

/// Passes of one satellite that are not yet sorted.
struct Rest<'a> {
    /// AOS of the first pass, nanoseconds since 1970. The copy avoids a wait for memory when only
    /// this time is needed.
    next_ns: i64,
    passes: &'a [CompactPass],
}

impl<'a> Rest<'a> {
    fn new(passes: &'a [CompactPass]) -> Self {
        Self { next_ns: passes.first().map_or(i64::MAX, aos_ns), passes }
    }

    /// Removes and returns the passes with AOS before `end_ns`.
    fn take_before(&mut self, end_ns: i64) -> &'a [CompactPass] {
        let count = self.passes.iter().take_while(|compact| aos_ns(compact) < end_ns).count();
        let (head, rest) = self.passes.split_at(count);
        *self = Self::new(rest);
        head
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::Angle;

    /// Returns passes of a few satellites at fixed times, some at the same instant, in two batches.
    fn found(count: i64) -> FoundPasses {
        let pass = |satellite: u32, index: i64| {
            // Every hundred passes, a whole day lies between two passes.
            let aos_ns = index * 600 * time::SECOND_NS + index / 100 * 86_400 * time::SECOND_NS;
            let point = |after_s: i64| PassPoint {
                time: time::from_nanoseconds(aos_ns + after_s * time::SECOND_NS),
                direction: AzEl::from_degrees(10.0, f64::from(satellite)),
            };
            let (aos, tca, los) = (point(0), point(60), point(120));
            let pass = Pass { aos, tca, los, starts_before: index == 0, ends_after: false };
            CompactPass::new(satellite, &pass)
        };
        let passes_of = |satellite| (0..count).map(move |index| pass(satellite, index));
        FoundPasses::new(vec![
            passes_of(0).chain(passes_of(3)).collect(),
            Vec::new(),
            passes_of(7).collect(),
        ])
    }

    #[test]
    fn passes_are_in_order_whatever_lies_between_them() {
        for count in [0, 1, 12_000] {
            let found = found(count);
            let mut sorted: Vec<_> = found.clone().into_passes().collect();
            sorted.sort_by_key(|(satellite, pass)| (pass.aos.time, *satellite));
            assert_eq!(sorted.len(), 3 * count as usize);
            assert!(count < 2 || sorted.len() > 3 * STRETCH);
            assert!(found.in_order().eq(sorted));
        }
    }

    #[test]
    fn passes_come_back_as_they_were_divided() {
        let mut found = found(10);
        found.divide(|satellite, pass| match satellite {
            0 => Vec::new(),
            3 => vec![pass],
            _ => vec![pass, Pass { starts_before: true, ..pass }],
        });
        found.retain(|pass| pass.max_elevation() > Angle::from_degrees(5.0));
        let passes: Vec<_> = found.in_order().collect();
        assert_eq!(passes.len(), 20);
        assert!(passes.iter().all(|(satellite, _)| *satellite == 7));
        assert!(passes.chunks(2).all(|two| two[0].1.aos == two[1].1.aos && two[1].1.starts_before));
    }
}
