//! The passes of near-circular orbits, eight satellites at a time.
//!
//! All satellites take the same steps. The first is an exact state near the middle, the second is
//! the crest from its series. The ellipse of that state gives guesses of AOS and LOS. An exact
//! state at each guess and the crossing from its series give AOS and LOS.
//! [`Track`](crate::passes::track::Track) handles the few satellites that do not converge in this
//! way.

use std::iter;

use super::{
    NearCircular,
    batch::{Batch, SatelliteAt},
    fly_bys,
};
use crate::{
    passes::{
        compact::CompactPass,
        local_series::{Bend, LocalSeries, LocalState},
        sighting::Sighting,
        two_body::TwoBody,
        window::Window,
    },
    simd::{Answers, LANES, Lanes, Number, widest},
};

/// Max distance of AOS and LOS from the crest, in half passes.
const MAX_HALF_PASSES: f64 = 1.1;

/// The AOS of every lane, or the LOS of every lane.
struct Edges {
    /// Side of the crests: -1 before, 1 after.
    side: f64,
    /// Time from the states near the crests to the edges of the ellipses, seconds.
    guess_tau: Lanes,
    /// Places after one step from the exact states at the guesses, and whether they have converged.
    places: LocalState<Lanes>,
    are_settled: Answers,
    sightings: Sighting<Lanes>,
}

/// Returns the passes of near-circular orbits, cut to the window, ordered by satellite, then by
/// time.
pub(in crate::passes) fn passes<'a>(
    window: &Window,
    satellites: impl Iterator<Item = &'a NearCircular<'a>>,
    cancelled: &dyn Fn() -> bool,
) -> Vec<CompactPass> {
    // The code below is compiled once for each register width, and the processor selects the
    // version.
    widest(
        #[inline(always)]
        || passes_of(window, satellites, cancelled),
    )
}

#[inline(always)]
fn passes_of<'a>(
    window: &Window,
    satellites: impl Iterator<Item = &'a NearCircular<'a>>,
    cancelled: &dyn Fn() -> bool,
) -> Vec<CompactPass> {
    let mut batch = Batch::default();
    let mut guesses = fly_bys::guesses(window, satellites, &mut batch, cancelled);
    let mut found = Vec::with_capacity(guesses.len());
    let mut last = None;
    for fly_bys in guesses.chunks_mut(LANES) {
        if cancelled() {
            break;
        }
        let guesses_s = batch.take(fly_bys);
        // The guesses come from the orbit plane alone; refined ones need fewer exact states.
        let at_s = batch.refined(window, guesses_s);
        for (fly_by, at_s) in fly_bys.iter_mut().zip(at_s.as_array()) {
            fly_by.at_s = *at_s;
        }
        passes_at(window, &batch, at_s, fly_bys, last, &mut found);
        last = fly_bys.last().copied();
    }
    found
}

/// Adds the passes whose middles are near these fly-bys, one per lane. `last` is the fly-by before
/// them.
#[inline(always)]
fn passes_at(
    window: &Window,
    batch: &Batch,
    at_s: Lanes,
    fly_bys: &[SatelliteAt<'_>],
    last: Option<SatelliteAt<'_>>,
    found: &mut Vec<CompactPass>,
) {
    let series = batch.series(window, at_s);
    let crests = series.turning();
    let ellipse = TwoBody::new(window, &series, &crests);
    let rising = edges(window, batch, &series, &ellipse, &crests, -1.0);
    let setting = edges(window, batch, &series, &ellipse, &crests, 1.0);
    let tops = Sighting::new(&crests);
    let is_crest =
        crests.turns(Bend::Crest) & batch.exactness.is_crest(crests.at_s - series.at_s, &crests);
    let is_low = is_crest & crests.height.sine.is_less(Lanes::splat(window.sin_floor));
    let is_settled = is_crest
        & rising.are_settled
        & setting.are_settled
        & Lanes::splat(0.0).is_less(rising.places.at_s)
        & setting.places.at_s.is_less(Lanes::splat(window.length_s));
    // The last fly-by of the previous batch may be the first one of this batch again.
    let before = iter::once(last).chain(fly_bys.iter().copied().map(Some));
    for (lane, (fly_by, before)) in fly_bys.iter().zip(before).enumerate() {
        // Two guesses may lead to the same fly-by, whose pass must be found only once.
        if before.is_some_and(|before| fly_by.is_same(&before)) {
            continue;
        }
        let satellite = fly_by.satellite;
        let track = satellite.track;
        track.count(1);
        // Most fly-bys stay below the floor, and need no AOS and LOS.
        if is_low.holds_in(lane) {
            continue;
        }
        let pass = if is_settled.holds_in(lane) {
            track.count(2);
            let points = [&rising.sightings, &tops, &setting.sightings];
            let points = points.map(|sightings| sightings.lane(lane));
            Some(track.pass(points.each_ref(), [false, false]))
        } else {
            let crest = is_crest.holds_in(lane).then(|| crests.lane(lane));
            // A pass that is cut at the window or has not converged is rare enough for a single
            // computation.
            alone(satellite, &series, crest, [&rising, &setting], lane)
        };
        found.extend(pass);
    }
}

#[inline(always)]
fn edges(
    window: &Window,
    batch: &Batch,
    series: &LocalSeries<Lanes>,
    ellipse: &TwoBody<Lanes>,
    crests: &LocalState<Lanes>,
    side: f64,
) -> Edges {
    let guess_tau = ellipse.crossing_tau(side);
    let from_s = series.at_s + guess_tau;
    let sine = window.sin_aos_elevation;
    let places = batch.series(window, from_s).crossing(sine, Lanes::ZERO);
    let are_settled = is_beside(batch.half_pass_s, crests, &places, side)
        & batch.exactness.is_crossing(sine, places.at_s - from_s, &places);
    let sightings = Sighting::at_elevation(&places, window.aos_elevation);
    Edges { side, guess_tau, places, are_settled, sightings }
}

#[inline(always)]
fn is_beside<N: Number>(
    half_pass_s: N,
    crest: &LocalState<N>,
    place: &LocalState<N>,
    side: f64,
) -> N::Answer {
    let from_crest_s = (place.at_s - crest.at_s) * side;
    N::splat(0.0).is_less(from_crest_s) & from_crest_s.is_less(half_pass_s * MAX_HALF_PASSES)
}

/// Returns the pass of one lane, computed alone. Its crest and edges may have converged already.
fn alone(
    satellite: &NearCircular<'_>,
    series: &LocalSeries<Lanes>,
    crest: Option<LocalState>,
    [rising, setting]: [&Edges; 2],
    lane: usize,
) -> Option<CompactPass> {
    let NearCircular { track, half_pass_s, .. } = *satellite;
    let series = series.lane(lane);
    let (series, crest) = match crest {
        Some(crest) => (series, crest),
        None => track.extreme_from(series, half_pass_s, Bend::Crest)?,
    };
    if crest.height.sine < track.window.sin_floor {
        return None;
    }
    let [aos, los] = [rising, setting].map(|edges| {
        let place = edges.places.lane(lane);
        if edges.are_settled.holds_in(lane) {
            track.count(1);
            return Some(place);
        }
        edge_alone(satellite, &series, &crest, edges, lane)
    });
    track.cut(&aos?, &crest, &los?)
}

fn edge_alone(
    satellite: &NearCircular<'_>,
    series: &LocalSeries,
    crest: &LocalState,
    edges: &Edges,
    lane: usize,
) -> Option<LocalState> {
    let NearCircular { track, half_pass_s, .. } = *satellite;
    let Edges { side, guess_tau, places, .. } = edges;
    let near = places.lane(lane);
    let is_near = is_beside(half_pass_s, crest, &near, *side);
    track.count(usize::from(is_near));
    // A step that led away from the pass may have found the edge of another one.
    let guess_s = if is_near { near.at_s } else { series.at_s + guess_tau.lane(lane) };
    let outside_s = crest.at_s + side * MAX_HALF_PASSES * half_pass_s;
    track.crossing(outside_s, guess_s, crest.at_s)
}
