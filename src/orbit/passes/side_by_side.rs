//! The passes of a nearly round orbit, several at a time.
//!
//! All go the same way: an exact state near the middle, the crest from its
//! series, AOS and LOS guessed from the ellipse of that state, an exact state at
//! each and the crossing from its series. The few that do not settle this way
//! are taken up one by one by [`Track`].

use super::{
    Pass,
    local_series::{Bend, LocalSeries, Place},
    track::Track,
    two_body::TwoBody,
    window::Sighting,
};
use crate::orbit::{
    lanes::{Lanes, Number, holds_in, lane_of, lanes_of},
    propagator::Secular,
};

/// AOS and LOS are looked for within this many half passes of the crest.
const MOST_OF_HALF: f64 = 1.1;

/// The track of a satellite of which several passes are worked at once.
pub(super) struct SideBySide<'a> {
    track: &'a Track<'a>,
    secular: &'a Secular,
    half_pass_s: f64,
}

/// The AOS of every lane, or the LOS.
struct Edges {
    /// Before the crests for -1, after them for 1.
    side: f64,
    /// From the states near the crests to where the ellipses have them.
    guess_tau: Lanes,
    /// Where one step from the exact states there led, and whether that is it.
    places: Place<Lanes>,
    are_settled: Lanes,
    sightings: Sighting<Lanes>,
}

impl<'a> SideBySide<'a> {
    /// `half_pass_s` is more than the time between the middle of a pass and its
    /// ends.
    pub(super) fn new(track: &'a Track<'a>, secular: &'a Secular, half_pass_s: f64) -> Self {
        Self { track, secular, half_pass_s }
    }

    /// Adds the passes with their middles near `guesses`, up to one a lane, cut
    /// to the window.
    pub(super) fn passes(&self, guesses: &[f64], found: &mut Vec<Pass>) {
        let Self { track, .. } = *self;
        let window = track.window;
        let series = track.round_series(self.secular, lanes_of(guesses));
        let crests = series.turning();
        let ellipse = TwoBody::new(window, &series, &crests);
        let rising = self.edges(&series, &ellipse, &crests, -1.0);
        let setting = self.edges(&series, &ellipse, &crests, 1.0);
        let tops = Sighting::new(&crests);
        let is_crest =
            crests.turns(Bend::Crest) & track.is_exact_crest(crests.at_s - series.at_s, &crests);
        let is_low = is_crest & crests.height.sine.is_less(Lanes::of(window.sin_floor));
        let is_settled = is_crest
            & rising.are_settled
            & setting.are_settled
            & Lanes::of(0.0).is_less(rising.places.at_s)
            & setting.places.at_s.is_less(Lanes::of(window.length_s));
        track.count(guesses.len());
        for lane in 0..guesses.len() {
            if holds_in(is_low, lane) {
                continue;
            }
            if holds_in(is_settled, lane) {
                track.count(2);
                let points = [&rising.sightings, &tops, &setting.sightings];
                let points = points.map(|sightings| sightings.lane(lane));
                found.push(track.pass(points.each_ref(), [false, false]));
            } else {
                let crest = holds_in(is_crest, lane).then(|| crests.lane(lane));
                found.extend(self.alone(&series, crest, [&rising, &setting], lane));
            }
        }
    }

    fn edges(
        &self,
        series: &LocalSeries<Lanes>,
        ellipse: &TwoBody<Lanes>,
        crests: &Place<Lanes>,
        side: f64,
    ) -> Edges {
        let window = self.track.window;
        let guess_tau = ellipse.crossing_tau(side);
        let from_s = series.at_s + guess_tau;
        let at_edge = self.track.round_series(self.secular, from_s);
        let places = at_edge.crossing(window.sin_horizon, Lanes::ZERO);
        let are_settled = self.is_beside(crests, &places, side)
            & self.track.is_timed(places.at_s - from_s, &places);
        let sightings = Sighting::at_elevation(&places, window.horizon);
        Edges { side, guess_tau, places, are_settled, sightings }
    }

    fn is_beside<N: Number>(&self, crest: &Place<N>, place: &Place<N>, side: f64) -> N::Answer {
        let from_crest_s = (place.at_s - crest.at_s) * side;
        N::of(0.0).is_less(from_crest_s)
            & from_crest_s.is_less(N::of(MOST_OF_HALF * self.half_pass_s))
    }

    /// The pass of one lane by itself, of which the crest and the edges may have
    /// settled.
    fn alone(
        &self,
        series: &LocalSeries<Lanes>,
        crest: Option<Place>,
        [rising, setting]: [&Edges; 2],
        lane: usize,
    ) -> Option<Pass> {
        let track = self.track;
        let series = series.lane(lane);
        let (series, crest) = match crest {
            Some(crest) => (series, crest),
            None => track.extreme_from(series, self.half_pass_s, Bend::Crest)?,
        };
        if crest.height.sine < track.window.sin_floor {
            return None;
        }
        let [aos, los] = [rising, setting].map(|edges| {
            let place = edges.places.lane(lane);
            if holds_in(edges.are_settled, lane) {
                track.count(1);
                return Some(place);
            }
            self.edge_alone(&series, &crest, edges, lane)
        });
        track.cut(&aos?, &crest, &los?)
    }

    fn edge_alone(
        &self,
        series: &LocalSeries,
        crest: &Place,
        edges: &Edges,
        lane: usize,
    ) -> Option<Place> {
        let Edges { side, guess_tau, places, .. } = edges;
        let near = places.lane(lane);
        let is_near = self.is_beside(crest, &near, *side);
        self.track.count(usize::from(is_near));
        let guess_s = if is_near { near.at_s } else { series.at_s + lane_of(guess_tau, lane) };
        let outside_s = crest.at_s + side * MOST_OF_HALF * self.half_pass_s;
        self.track.crossing(outside_s, guess_s, crest.at_s)
    }
}
