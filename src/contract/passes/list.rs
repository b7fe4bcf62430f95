//! A pass list.

use std::{iter, ops::Range, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::time::add_seconds,
    orbit::Pass,
    passes::{ListedSatellite, PassListKey, PredictedPass},
};

/// Largest difference in AOS of one pass between two lists.
const SAME_AOS_S: f64 = 60.0;

/// Passes of some satellites. Clones share them.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PassList {
    /// The satellites, in the order of the station or by catalog number.
    #[serde(skip)]
    pub satellites: Arc<Vec<Arc<ListedSatellite>>>,
    /// Passes by AOS, then by catalog number; those that are always up come last, by number. Some
    /// passes may be over.
    #[serde(skip)]
    pub passes: Arc<Vec<PredictedPass>>,
    /// Changes with every new list.
    pub revision: u64,
    /// Start of the search for this list; `None` before the first list.
    pub made_at: Option<Timestamp>,
    pub work: Work,
}

impl Default for PassList {
    fn default() -> Self {
        Self {
            satellites: Arc::default(),
            passes: Arc::default(),
            revision: 0,
            made_at: None,
            work: Work::Nothing,
        }
    }
}

/// State of the search for the next list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Work {
    /// No search: the list is up to date.
    Nothing,
    /// A search is under way.
    UnderWay {
        /// Satellites that are done.
        done: usize,
        /// All satellites; 0 while they are prepared.
        #[serde(rename = "of")]
        total: usize,
    },
    /// The operator has cancelled the search.
    Cancelled,
}

impl PassList {
    /// The passes at these places, each with its catalog number.
    pub fn range(&self, places: Range<usize>) -> impl Iterator<Item = (u32, Pass)> {
        let passes = self.passes.iter().take(places.end).skip(places.start);
        passes.map(|predicted| (predicted.number(), predicted.pass))
    }

    /// The passes that are not over at `now`.
    pub fn upcoming(&self, now: Timestamp) -> UpcomingPasses<'_> {
        UpcomingPasses::new(self, now, None)
    }

    /// The passes that are not over and begin within `span_h` hours, for a list by AOS.
    pub fn upcoming_within(&self, now: Timestamp, span_h: u32) -> UpcomingPasses<'_> {
        let end = add_seconds(now, f64::from(span_h) * 3600.0);
        UpcomingPasses::new(self, now, Some(end))
    }

    /// Place of the pass of `key` in the list. Its AOS may differ a little in a new list.
    fn place(&self, (number, aos): PassListKey) -> Option<usize> {
        let (dated, always_up) = self.parts();
        // Passes cut at the start of a list all have that for AOS, and so are by number.
        let start = dated.first().map(|predicted| predicted.pass.aos.time);
        let cut = dated.partition_point(|predicted| Some(predicted.pass.aos.time) <= start);
        let early = [(0, dated.get(..cut).unwrap_or_default()), (dated.len(), always_up)];
        for (first, passes) in early {
            let Ok(index) = passes.binary_search_by_key(&number, PredictedPass::number) else {
                continue;
            };
            let is_it = |predicted: &PredictedPass| {
                predicted.pass.starts_before && aos < predicted.pass.los.time
            };
            if passes.get(index).is_some_and(is_it) {
                return Some(first + index);
            }
        }
        let (start, end) = (add_seconds(aos, -SAME_AOS_S), add_seconds(aos, SAME_AOS_S));
        let first = dated.partition_point(|predicted| predicted.pass.aos.time <= start);
        let near = dated.iter().enumerate().skip(first);
        near.take_while(|(_, predicted)| predicted.pass.aos.time < end)
            .find_map(|(place, predicted)| (predicted.number() == number).then_some(place))
    }

    /// The passes by AOS, and the always-up passes behind them.
    fn parts(&self) -> (&[PredictedPass], &[PredictedPass]) {
        let dated = self.passes.partition_point(|predicted| !predicted.is_always_up());
        self.passes.split_at(dated)
    }

    pub fn find(&self, key: PassListKey) -> Option<&PredictedPass> {
        self.passes.get(self.place(key)?)
    }
}

/// The passes of a list that are not over.
#[derive(Debug, Clone)]
pub struct UpcomingPasses<'a> {
    list: &'a PassList,
    /// Places of the passes that are over, and of those that begin too late, in order.
    left_out: Vec<Range<usize>>,
    /// Place of the first pass that begins too late.
    late: usize,
}

impl<'a> UpcomingPasses<'a> {
    fn new(list: &'a PassList, now: Timestamp, end: Option<Timestamp>) -> Self {
        let (dated, standing) = list.parts();
        let ended = |passes: &[PredictedPass], first: usize| {
            let passes = passes.iter().enumerate();
            let ended = passes.filter(|(_, predicted)| predicted.pass.los.time <= now);
            ended.map(|(place, _)| first + place..first + place + 1).collect::<Vec<_>>()
        };
        // A pass that is over has begun: the rest of a long list need not be searched.
        let begun = dated.partition_point(|predicted| predicted.pass.aos.time <= now);
        let late = end.map_or(dated.len(), |end| {
            dated.partition_point(|predicted| predicted.pass.aos.time < end).max(begun)
        });
        let mut left_out = ended(dated.get(..begun).unwrap_or_default(), 0);
        left_out.push(late..dated.len());
        left_out.extend(ended(standing, dated.len()));
        Self { list, left_out, late }
    }

    pub fn len(&self) -> usize {
        self.list.passes.len() - self.left_out.iter().map(ExactSizeIterator::len).sum::<usize>()
    }

    /// Changes whenever the rows change within one revision of the list.
    pub fn version(&self) -> (usize, usize) {
        (self.late, self.left_out.len())
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of rows whose passes have begun at `now`, without those that are always up.
    pub fn begun(&self, now: Timestamp) -> usize {
        let begun = self.list.parts().0.partition_point(|dated| dated.pass.aos.time <= now);
        let ended = self.left_out.iter().filter(|range| range.start < begun);
        begun - ended.map(|range| range.end.min(begun) - range.start).sum::<usize>()
    }

    /// The pass in this row.
    pub fn get(&self, row: usize) -> Option<&'a PredictedPass> {
        let mut place = row;
        for left_out in &self.left_out {
            if left_out.start > place {
                break;
            }
            place += left_out.len();
        }
        self.list.passes.get(place)
    }

    pub fn iter(&self) -> impl Iterator<Item = &'a PredictedPass> {
        let passes = &self.list.passes;
        let starts = iter::once(0).chain(self.left_out.iter().map(|range| range.end));
        let ends = self.left_out.iter().map(|range| range.start).chain(iter::once(passes.len()));
        starts.zip(ends).flat_map(|(start, end)| passes.get(start..end).unwrap_or_default())
    }

    /// The passes with AOS before `end`, by AOS, without those that are always up.
    pub fn starting_before(&self, end: Timestamp) -> impl Iterator<Item = &'a PredictedPass> {
        let passes = self.iter().take_while(move |predicted| predicted.pass.aos.time < end);
        passes.filter(|predicted| !predicted.is_always_up())
    }

    /// Row of the pass of `key`. Its AOS may differ a little in a new list.
    pub fn row(&self, key: PassListKey) -> Option<usize> {
        let place = self.list.place(key)?;
        let before = self.left_out.iter().take_while(|left_out| left_out.start <= place);
        let mut row = place;
        for left_out in before {
            if left_out.contains(&place) {
                return None;
            }
            row -= left_out.len();
        }
        Some(row)
    }
}
