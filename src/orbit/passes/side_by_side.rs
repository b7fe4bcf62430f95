//! The passes of a nearly round orbit, four at a time.
//!
//! All four go the same way: an exact state near the middle, the crest from its
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
    lanes::{Lanes, lane_of, lanes_of},
    propagator::Secular,
};

/// AOS and LOS are looked for within this many half passes of the crest.
const MOST_OF_HALF: f64 = 1.1;

/// The track of a satellite of which up to four passes are worked at once.
pub(super) struct SideBySide<'a> {
    track: &'a Track<'a>,
    secular: &'a Secular,
    half_pass_s: f64,
}

/// Four times AOS, or four times LOS.
struct Edges {
    /// Before the crests for -1, after them for 1.
    side: f64,
    /// From the states near the crests to where the ellipses have them.
    guess_tau: Lanes,
    /// From the exact states there to the places.
    tau: Lanes,
    places: Place<Lanes>,
    sightings: Sighting<Lanes>,
}

impl<'a> SideBySide<'a> {
    /// `half_pass_s` is more than the time between the middle of a pass and its
    /// ends.
    pub(super) fn new(track: &'a Track<'a>, secular: &'a Secular, half_pass_s: f64) -> Self {
        Self { track, secular, half_pass_s }
    }

    /// Adds the passes with their middles near up to four `guesses`, cut to the
    /// window.
    pub(super) fn passes(&self, guesses: &[f64], found: &mut Vec<Pass>) {
        let middles = lanes_of(guesses);
        let window = self.track.window;
        let series = self.track.four_series(self.secular, middles);
        let crests = series.turning();
        let ellipse = TwoBody::new(window, &series, &crests);
        let rising = self.edges(&series, &ellipse, -1.0);
        let setting = self.edges(&series, &ellipse, 1.0);
        let sightings = Sighting::new(&crests);
        self.track.count(guesses.len());
        for lane in 0..guesses.len() {
            let (Some(crest), Some(from_s)) = (crests.lane(lane), lane_of(&middles, lane)) else {
                return;
            };
            let is_crest =
                crest.turns(Bend::Crest) && self.track.is_exact_crest(crest.at_s - from_s, &crest);
            if is_crest && crest.height.sine < window.sin_floor {
                continue;
            }
            let [aos, los] = [&rising, &setting].map(|edges| self.edge(edges, &crest, lane));
            if is_crest
                && let (Some((_, aos)), Some((_, los))) = (&aos, &los)
                && let Some(tca) = sightings.lane(lane)
                && aos.at_s >= 0.0
                && los.at_s <= window.length_s
            {
                self.track.count(2);
                found.push(self.track.pass([aos, &tca, los], [false, false]));
                continue;
            }
            let edges = [(&rising, aos), (&setting, los)]
                .map(|(edges, settled)| edges.lane(lane, settled.map(|(place, _)| place)));
            if let (Some(series), [Some(rising), Some(setting)]) = (series.lane(lane), edges) {
                let crest = is_crest.then_some(crest);
                found.extend(self.alone(&series, crest, &rising, &setting));
            }
        }
    }

    fn edges(&self, series: &LocalSeries<Lanes>, ellipse: &TwoBody<'_, Lanes>, side: f64) -> Edges {
        let guess_tau = ellipse.crossing_tau(side);
        let from_s = series.at_s + guess_tau;
        let at_edge = self.track.four_series(self.secular, from_s);
        let places = at_edge.crossing(self.track.window.sin_horizon, Lanes::ZERO);
        let sightings = Sighting::new(&places);
        Edges { side, guess_tau, tau: places.at_s - from_s, places, sightings }
    }

    /// AOS or LOS of one lane, where it has settled.
    fn edge(&self, edges: &Edges, crest: &Place, lane: usize) -> Option<(Place, Sighting)> {
        let place = edges.places.lane(lane)?;
        let tau = lane_of(&edges.tau, lane)?;
        let is_settled =
            self.is_beside(crest, &place, edges.side) && self.track.is_timed(tau, &place);
        is_settled.then_some((place, edges.sightings.lane(lane)?))
    }

    fn is_beside(&self, crest: &Place, place: &Place, side: f64) -> bool {
        let from_crest_s = (place.at_s - crest.at_s) * side;
        0.0 < from_crest_s && from_crest_s < MOST_OF_HALF * self.half_pass_s
    }

    /// The pass of one lane by itself, of which the crest and the edges may have
    /// settled.
    fn alone(
        &self,
        series: &LocalSeries,
        crest: Option<Place>,
        rising: &Edge,
        setting: &Edge,
    ) -> Option<Pass> {
        let track = self.track;
        let (series, crest) = match crest {
            Some(crest) => (*series, crest),
            None => track.extreme_from(*series, self.half_pass_s, Bend::Crest)?,
        };
        if crest.height.sine < track.window.sin_floor {
            return None;
        }
        let aos = self.edge_alone(&series, &crest, rising)?;
        let los = self.edge_alone(&series, &crest, setting)?;
        track.cut(&aos, &crest, &los)
    }

    fn edge_alone(&self, series: &LocalSeries, crest: &Place, edge: &Edge) -> Option<Place> {
        let Edge { side, guess_tau, near, settled } = edge;
        if settled.is_some() {
            self.track.count(1);
            return *settled;
        }
        let near = Some(near).filter(|place| self.is_beside(crest, place, *side));
        self.track.count(usize::from(near.is_some()));
        let guess_s = near.map_or(series.at_s + guess_tau, |place| place.at_s);
        let outside_s = crest.at_s + side * MOST_OF_HALF * self.half_pass_s;
        self.track.crossing(outside_s, guess_s, crest.at_s)
    }
}

/// AOS or LOS of one lane.
struct Edge {
    side: f64,
    guess_tau: f64,
    /// Where one step from the exact state led.
    near: Place,
    /// Where it is, when that was close enough.
    settled: Option<Place>,
}

impl Edges {
    fn lane(&self, lane: usize, settled: Option<Place>) -> Option<Edge> {
        let guess_tau = lane_of(&self.guess_tau, lane)?;
        Some(Edge { side: self.side, guess_tau, near: self.places.lane(lane)?, settled })
    }
}
