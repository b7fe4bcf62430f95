//! Simulated axis: its drive starts late, coasts and runs for a min time. Readings have noise and
//! whole steps. The axis knows nothing of the watch.

use std::collections::VecDeque;

use crate::driver::dice::Dice;

/// Step of the simulation, seconds.
pub(super) const STEP_S: f64 = 0.02;

/// Properties of an axis and of its unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlantKind {
    pub(super) travel_deg: (f64, f64),
    pub(super) rate_deg_s: f64,
    pub(super) starts_after_s: f64,
    /// Coasting time from the full rate, seconds.
    pub(super) coasts_s: f64,
    /// Min run time of the drive, seconds.
    pub(super) runs_s: f64,
    /// Share of the coasting distance before the target at which the drive switches off.
    pub(super) anticipates: f64,
    /// Max distance from a target at which the drive does not start, degrees.
    pub(super) leaves_deg: f64,
    pub(super) noise_deg: f64,
    pub(super) step_deg: f64,
    pub(super) sway_deg: f64,
    pub(super) wraps: bool,
    pub(super) poll_s: f64,
}

impl PlantKind {
    pub(super) fn any(dice: &mut Dice) -> Self {
        let travels_deg = [
            (0.0, 360.0),
            (0.0, 450.0),
            (0.0, 540.0),
            (-180.0, 180.0),
            (-270.0, 270.0),
            (5.0, 175.0),
        ];
        let travel_deg = travels_deg[dice.below(travels_deg.len())];
        let fast =
            |dice: &mut Dice, min: f64, max: f64| min * (max / min).powf(dice.draw(0.0, 1.0));
        Self {
            travel_deg,
            rate_deg_s: fast(dice, 0.3, 20.0),
            starts_after_s: dice.draw(0.0, 2.0),
            coasts_s: if dice.chance(0.3) { 0.0 } else { dice.draw(0.0, 3.0) },
            runs_s: if dice.chance(0.5) { 0.0 } else { dice.draw(0.0, 0.2) },
            anticipates: dice.draw(0.8, 1.1),
            leaves_deg: [0.1, 0.3, 0.5, 1.5][dice.below(4)],
            noise_deg: if dice.chance(0.3) { 0.0 } else { dice.draw(0.0, 0.3) },
            step_deg: [0.01, 0.1, 1.0][dice.below(3)],
            sway_deg: if dice.chance(0.6) { 0.0 } else { dice.draw(0.1, 1.0) },
            wraps: travel_deg.1 - travel_deg.0 >= 360.0 && dice.chance(0.3),
            poll_s: 1.0 / dice.draw(2.0, 10.0),
        }
    }
}

impl PlantKind {
    /// Reduces the coasting, which makes a drive hunt for a moving target.
    pub(super) fn follows_well(&mut self) {
        (self.coasts_s, self.runs_s, self.anticipates) = (self.coasts_s.min(0.3), 0.0, 1.0);
        self.wraps = false;
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PlantOrder {
    To(f64),
    /// Motion at a signed share of the rate, until a stop or the end of the travel.
    Run(f64),
    Stop,
}

#[derive(Debug, Clone)]
pub(super) struct Plant {
    pub(super) kind: PlantKind,
    pub(super) now_s: f64,
    pub(super) deg: f64,
    rate_deg_s: f64,
    waiting: VecDeque<(f64, PlantOrder)>,
    order: PlantOrder,
    /// Direction of the running drive, and its start time.
    drive: Option<(f64, f64)>,
    /// Number of drive starts for this order.
    starts: u8,
    /// Force of somebody who turns the axis, degrees from its position at the start.
    pub(super) held_deg: Option<f64>,
    gust_deg: f64,
}

impl Plant {
    pub(super) fn new(kind: PlantKind, deg: f64) -> Self {
        Self {
            kind,
            now_s: 0.0,
            deg,
            rate_deg_s: 0.0,
            waiting: VecDeque::new(),
            order: PlantOrder::Stop,
            drive: None,
            starts: 0,
            held_deg: None,
            gust_deg: 0.0,
        }
    }

    pub(super) fn send(&mut self, order: PlantOrder) {
        self.waiting.push_back((self.now_s + self.kind.starts_after_s, order));
    }

    pub(super) fn is_still(&self) -> bool {
        self.rate_deg_s == 0.0 && self.drive.is_none() && self.waiting.is_empty()
    }

    pub(super) fn is_driven(&self) -> bool {
        self.drive.is_some()
    }

    /// Returns the positions that the drive approaches, now or soon.
    pub(super) fn targets_deg(&self) -> Vec<f64> {
        let orders =
            std::iter::once(self.order).chain(self.waiting.iter().map(|(_, order)| *order));
        orders
            .filter_map(|order| if let PlantOrder::To(deg) = order { Some(deg) } else { None })
            .collect()
    }

    pub(super) fn step(&mut self, dice: &mut Dice) {
        self.now_s += STEP_S;
        while self.waiting.front().is_some_and(|(at_s, _)| *at_s <= self.now_s) {
            if let Some((_, order)) = self.waiting.pop_front() {
                (self.order, self.starts) = (order, 0);
            }
        }
        let slows_deg_s2 = if self.kind.coasts_s > 0.0 {
            self.kind.rate_deg_s / self.kind.coasts_s
        } else {
            f64::INFINITY
        };
        let coasts_deg = if slows_deg_s2.is_finite() {
            self.rate_deg_s.powi(2) / 2.0 / slows_deg_s2
        } else {
            0.0
        };
        let demand = match self.order {
            PlantOrder::Stop => None,
            PlantOrder::Run(share) => Some(share),
            PlantOrder::To(to_deg) => {
                let left_deg = to_deg - self.deg;
                let goes_there = self.rate_deg_s * left_deg > 0.0;
                let stops_deg = if goes_there { coasts_deg * self.kind.anticipates } else { 0.0 };
                let is_far = left_deg.abs()
                    > stops_deg.max(self.kind.leaves_deg * 0.5)
                        + if self.drive.is_some() { 0.0 } else { self.kind.leaves_deg * 0.5 };
                // The drive does not reverse before it has come to rest.
                let may = self.rate_deg_s == 0.0 || goes_there;
                (is_far && may).then(|| left_deg.signum())
            }
        };
        let runs_on = self.drive.filter(|(_, since_s)| {
            self.now_s - since_s < self.kind.runs_s && self.order != PlantOrder::Stop
        });
        // The unit gives up after three attempts.
        let demand = demand.filter(|_| self.drive.is_some() || self.starts < 3);
        let before = self.drive;
        self.drive = match (demand, runs_on, self.drive) {
            (_, Some(runs_on), _) => Some(runs_on),
            (Some(way), _, Some((before, since_s))) if way * before > 0.0 => Some((way, since_s)),
            (Some(way), ..) => Some((way, self.now_s)),
            (None, ..) => None,
        };
        self.starts += u8::from(before.is_none() && self.drive.is_some());
        if let Some((way, _)) = self.drive {
            let gains = self.kind.rate_deg_s / 0.3 * STEP_S;
            let wanted_deg_s = way * self.kind.rate_deg_s;
            self.rate_deg_s += (wanted_deg_s - self.rate_deg_s).clamp(-gains, gains);
        } else {
            let loses = (slows_deg_s2 * STEP_S).min(self.rate_deg_s.abs());
            self.rate_deg_s -= loses.copysign(self.rate_deg_s);
        }
        let (from_deg, to_deg) = self.kind.travel_deg;
        let next_deg = self.deg + self.rate_deg_s * STEP_S;
        if !(from_deg..=to_deg).contains(&next_deg) {
            self.rate_deg_s = 0.0;
            if matches!(self.order, PlantOrder::Run(_)) {
                self.order = PlantOrder::Stop;
            }
        }
        self.deg = next_deg.clamp(from_deg, to_deg);
        if let Some(held_deg) = self.held_deg {
            self.deg = held_deg;
            self.rate_deg_s = 0.0;
        }
        if self.kind.sway_deg > 0.0 && dice.chance(0.02) {
            self.gust_deg = dice.draw(-0.5, 0.5) * self.kind.sway_deg;
        }
    }

    /// Returns the currently reported angle, degrees.
    pub(super) fn read(&self, dice: &mut Dice) -> f64 {
        let noise_deg = dice.draw(-1.0, 1.0) * self.kind.noise_deg;
        let deg = self.deg + self.gust_deg + noise_deg;
        let deg = (deg / self.kind.step_deg).round() * self.kind.step_deg;
        if self.kind.wraps { deg.rem_euclid(360.0) } else { deg }
    }
}
