//! Watch over one axis.

use std::time::Duration;

use super::{
    APART, AxisFigures, AxisReading, SWINGS_BACK,
    lead::{COASTS, Lead, LiveMotion},
    lessons::{DEAD_TIME, FASTEST_DEG_S, RATE_APART, RunsPast, Spread, max_dead_time, note_start},
    range::Range,
};
use crate::{
    clock::Instant,
    contract::driver::{AxisLessons, Evidence, lessons::DeadTime},
    device::{AxisMotion, Drive},
};

/// Min rate of an axis in motion, degrees a second.
const SLOWEST_DEG_S: f64 = 0.25;
/// Max creep of a standing axis, 0.3 degrees a minute, in degrees a second.
const CREEPS_DEG_S: f64 = 0.3 / 60.0;
/// Max number of stored motions. For a further motion, the watch joins the oldest two.
const MAX_MOTIONS: usize = 24;
/// Max delay between a motion of the axis and the reading that shows it.
const LATE: Duration = Duration::from_secs(2);
/// Max time without a reading. After a longer gap, the axis may have turned and stopped.
const UNSEEN: Duration = Duration::from_secs(2);
/// Max distance from the target at which an axis with two possible paths counts as arrived,
/// degrees.
const NEAR_DEG: f64 = 10.0;
/// Max interval between motions that count as steps.
const STEPS: Duration = Duration::from_secs(5);
const TURN_DEG: f64 = 360.0;

/// Possible range of the axis at the time of the last reading inside.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Estimate {
    range: Range,
    time: Instant,
    /// Turns added to a reading that wraps, degrees.
    turns_deg: f64,
}

/// Last observed turn of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Turned {
    /// Reading to compare later readings with, degrees.
    from_deg: f64,
    time: Option<Instant>,
    is_up: bool,
}

/// Readings outside the interval.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Excursion {
    start: Instant,
    /// `true` if the unit has reported a driven axis.
    is_driven: bool,
}

#[derive(Debug)]
pub(super) struct AxisWatch {
    figures: AxisFigures,
    estimate: Option<Estimate>,
    motions: Vec<LiveMotion>,
    /// Send time of the last motion. `starts` is `true` if the axis stood before and has not turned
    /// since.
    sent: Option<Instant>,
    starts: bool,
    /// Signed length of the last motion, degrees.
    last_way_deg: f64,
    /// Last time at which a new target redirected the moving axis.
    redirected: Option<Instant>,
    turned: Option<Turned>,
    /// Reference reading for the rate, degrees.
    rate_from: Option<(f64, Instant)>,
    /// `true` if the unit reported a turning axis at the first reading.
    was_found_turning: bool,
    /// `true` after the report that somebody else moves the axis.
    is_told: bool,
    /// `true` if the axis came to rest after the last motion.
    has_settled: bool,
    outside: Option<Excursion>,
    /// Time of the first report in an unbroken series of reports of foreign motion.
    reported_since: Option<Instant>,
    open_until: Option<Instant>,
    spread: Spread,
    runs_past: RunsPast,
    dead_time: DeadTime,
}

impl AxisWatch {
    pub(super) fn new(figures: AxisFigures, lessons: &AxisLessons) -> Self {
        let AxisLessons { past_ends, dead_time, at_rest } = *lessons;
        Self {
            figures,
            estimate: None,
            motions: Vec::with_capacity(MAX_MOTIONS + 1),
            sent: None,
            starts: false,
            last_way_deg: 0.0,
            redirected: None,
            turned: None,
            rate_from: None,
            was_found_turning: false,
            is_told: false,
            has_settled: false,
            outside: None,
            reported_since: None,
            open_until: None,
            spread: Spread::new(at_rest),
            runs_past: RunsPast::new(past_ends),
            dead_time,
        }
    }

    pub(super) fn lessons(&self) -> AxisLessons {
        let (past_ends, at_rest) = (self.runs_past.past_ends, self.spread.at_rest);
        AxisLessons { past_ends, dead_time: self.dead_time, at_rest }
    }

    pub(super) fn forget_lessons(&mut self) {
        self.runs_past = RunsPast::default();
        (self.dead_time, self.spread) = (DeadTime::default(), Spread::default());
    }

    pub(super) fn note_command(&mut self, lead: Lead, number: u64, now: Instant) {
        let here = self.reachable(now);
        let turns_deg = self.estimate.map_or(0.0, |estimate| estimate.turns_deg);
        let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
        let (down_to_deg, up_to_deg) = match lead {
            Lead::To(deg) => (deg + turns_deg, deg + turns_deg),
            Lead::EitherWay(deg) => (deg + turns_deg - TURN_DEG, deg + turns_deg + TURN_DEG),
            Lead::By(by_deg) => {
                here.map_or(everywhere, |here| (here.from_deg + by_deg, here.to_deg + by_deg))
            }
            Lead::ToEnd { is_up: true } => (f64::INFINITY, f64::INFINITY),
            Lead::ToEnd { is_up: false } => (f64::NEG_INFINITY, f64::NEG_INFINITY),
            Lead::Anywhere => everywhere,
        };
        let ends = matches!(lead, Lead::To(_) | Lead::EitherWay(_) | Lead::By(_));
        let is_jog = matches!(lead, Lead::ToEnd { .. } | Lead::By(_) | Lead::Anywhere);
        let either_way = matches!(lead, Lead::EitherWay(_));
        let led =
            here.map_or([true; 2], |here| [down_to_deg < here.to_deg, up_to_deg > here.from_deg]);
        self.starts = self.is_settled(now);
        let are_steps = self.sent.is_some_and(|sent| now < sent + STEPS);
        let end = Range { from_deg: down_to_deg, to_deg: up_to_deg };
        let way_deg = self.way_deg(end, here);
        let goes_on = are_steps && way_deg.is_finite() && way_deg * self.last_way_deg >= 0.0;
        if !self.starts && !goes_on {
            self.redirected = Some(now);
        }
        self.last_way_deg = way_deg;
        self.runs_past.note_command(way_deg.abs(), are_steps);
        (self.sent, self.has_settled) = (Some(now), false);
        let expiry = None;
        let passed = [None; 2];
        let mut motion = LiveMotion {
            number,
            down_to_deg,
            up_to_deg,
            ends,
            is_jog,
            either_way,
            led,
            passed,
            expiry,
        };
        motion.look(here, self.figures.arrives_within_deg, now);
        self.motions.push(motion);
        if self.motions.len() > MAX_MOTIONS {
            let oldest = self.motions.remove(0);
            if let Some(next) = self.motions.first_mut() {
                *next = oldest.join(*next);
            }
        }
    }

    /// Returns the length of a motion to `end`, degrees. Measures from the end of the previous
    /// motion, because somebody else may have moved the axis away from there.
    fn way_deg(&self, end: Range, here: Option<Range>) -> f64 {
        let last = self.motions.last().filter(|last| last.ends);
        let start = last.map(|last| Range { from_deg: last.down_to_deg, to_deg: last.up_to_deg });
        let Some(start) = start.or(here) else { return f64::INFINITY };
        let way_deg = end.middle_deg() - start.middle_deg();
        let way_deg = if way_deg.is_nan() { f64::INFINITY } else { way_deg };
        self.turned_deg(way_deg)
    }

    /// Returns the shorter turn, degrees, if the reading wraps.
    fn turned_deg(&self, deg: f64) -> f64 {
        if !self.figures.wraps || !deg.is_finite() {
            return deg;
        }
        (deg + TURN_DEG / 2.0).rem_euclid(TURN_DEG) - TURN_DEG / 2.0
    }

    /// Ends the motions before this number.
    pub(super) fn note_acceptance(&mut self, number: u64, now: Instant) {
        // A motion of the other axis ends no motion of this axis.
        if !self.motions.iter().any(|motion| motion.number == number) {
            return;
        }
        let expiry = now + max_dead_time(self.dead_time);
        for motion in self.motions.iter_mut().filter(|motion| motion.number < number) {
            motion.expiry.get_or_insert(expiry);
        }
    }

    pub(super) fn note_rest(&mut self) {
        self.motions.retain(|motion| motion.ends);
    }

    /// Ends all motions but allows for coasting: at a coarse resolution, equal readings can hide a
    /// slow motion.
    pub(super) fn note_standstill(&mut self, now: Instant) {
        for motion in &mut self.motions {
            motion.expiry = Some(motion.expiry.map_or(now, |expiry| expiry.min(now)));
        }
    }

    /// Allows the unit's own program to turn the axis until now, and the axis to coast afterwards.
    pub(super) fn open(&mut self, now: Instant) {
        self.open_until = self.open_until.max(Some(now + DEAD_TIME + COASTS));
    }

    pub(super) fn restart(&mut self) {
        self.estimate = None;
        self.outside = None;
        self.turned = None;
        self.rate_from = None;
        self.has_settled = false;
        self.spread.note_turn();
    }

    /// Returns `true` if commands explain the reading: the axis turns inside the interval, or
    /// stands at the end of a motion or at its last reading. An axis at rest between these places
    /// was stopped by somebody else. The axis may coast by `coasts_deg`. Returns `false` without an
    /// earlier reading.
    pub(super) fn explains(&self, reading: AxisReading, coasts_deg: f64) -> bool {
        let AxisReading { angle_deg, motion, requested, received, .. } = reading;
        if self.open_until.is_some_and(|end| requested <= end) {
            return true;
        }
        let (Some(estimate), Some(reachable)) = (self.estimate, self.reachable(received)) else {
            return false;
        };
        let deg = angle_deg + self.turns_deg(angle_deg, estimate, reachable);
        let here = Range::with_error(deg, self.error_deg());
        if motion != AxisMotion::Still {
            return here.overlap(reachable).is_some();
        }
        let live = self.motions.iter().filter_map(|motion| motion.state_at(estimate.time));
        let ends_deg = live.flat_map(|motion| [motion.down_to_deg, motion.up_to_deg]);
        let ends =
            ends_deg.map(|end_deg| Range::with_error(end_deg, self.figures.arrives_within_deg));
        let rests = ends.chain([estimate.range]);
        let mut rests = rests.map(|rest| rest.widen(coasts_deg));
        here.overlap(reachable).is_some() && rests.any(|rest| here.overlap(rest).is_some())
    }

    /// Returns `true` while a reading is outside the interval. The suspicion expires, because an
    /// axis may report no further angle.
    pub(super) fn is_suspect(&self, now: Instant) -> bool {
        self.outside.is_some_and(|outside| now < outside.start + SWINGS_BACK + UNSEEN)
    }

    pub(super) fn measured_sway_deg(&self) -> Option<f64> {
        self.spread.expected_deg()
    }

    /// Takes a reading. Returns the evidence that somebody else moves the axis.
    pub(super) fn take(&mut self, reading: AxisReading) -> Option<Evidence> {
        let reported = self.take_drive(reading);
        self.take_angle(reading).or(reported)
    }

    /// Returns the unit's own evidence once its reports have lasted [`APART`].
    fn take_drive(&mut self, reading: AxisReading) -> Option<Evidence> {
        let AxisReading { drive, requested, .. } = reading;
        let evidence = match drive {
            Drive::Off | Drive::On => None,
            Drive::Jogged => (!self.may_be_jogged(requested)).then_some(Evidence::Jogged),
            Drive::Runaway => Some(Evidence::Runaway),
        };
        let Some(evidence) = evidence else {
            self.reported_since = None;
            return None;
        };
        let start = *self.reported_since.get_or_insert(requested);
        (requested.saturating_duration_since(start) >= APART).then(|| self.report_once(evidence))?
    }

    /// Returns `true` while a jog or step from Azel may still turn the axis.
    fn may_be_jogged(&self, time: Instant) -> bool {
        let mut live = self.motions.iter().filter_map(|motion| motion.state_at(time));
        live.any(|motion| motion.is_jog)
    }

    /// Returns evidence only once for each foreign motion.
    fn report_once(&mut self, evidence: Evidence) -> Option<Evidence> {
        (!std::mem::replace(&mut self.is_told, true)).then_some(evidence)
    }

    fn take_angle(&mut self, reading: AxisReading) -> Option<Evidence> {
        let AxisReading { angle_deg, motion, drive, requested, received } = reading;
        let error_deg = self.error_deg();
        let time = self.estimate.map_or(requested, |estimate| estimate.time);
        self.motions.retain(|motion| motion.state_at(time).is_some());
        self.was_found_turning &= motion != AxisMotion::Still;
        if self.estimate.is_none() {
            self.was_found_turning = motion != AxisMotion::Still;
        }
        if self.was_found_turning {
            self.open(received);
        }
        let is_open = self.open_until.is_some_and(|end| requested <= end);
        let reachable = self.reachable(received).filter(|_| !is_open);
        let (Some(estimate), Some(reachable)) = (self.estimate, reachable) else {
            self.begin(angle_deg, 0.0, requested);
            return None;
        };
        let turns_deg = self.turns_deg(angle_deg, estimate, reachable);
        let deg = angle_deg + turns_deg;
        if self.figures.wraps && reachable.to_deg - reachable.from_deg > TURN_DEG - error_deg * 2.0
        {
            self.lose_turns();
        }
        let here = Range::with_error(deg, error_deg);
        let Some(range) = here.overlap(reachable) else {
            let is_driven = drive != Drive::Off || !self.is_settled(requested);
            let outside = self.outside.get_or_insert(Excursion { start: requested, is_driven });
            outside.is_driven |= is_driven;
            let lasted = requested.saturating_duration_since(outside.start);
            let may_swing_back = !outside.is_driven && lasted < SWINGS_BACK;
            if lasted < APART || may_swing_back {
                return None;
            }
            self.begin(angle_deg, turns_deg, requested);
            return self.report_once(Evidence::Outside { off_deg: reachable.off_deg(deg) });
        };
        self.outside = None;
        self.know(angle_deg, turns_deg, range, [requested, received]);
        self.learn(deg, drive, requested);
        None
    }

    /// Restarts the watch at a reading and discards the previous interval.
    fn begin(&mut self, angle_deg: f64, turns_deg: f64, time: Instant) {
        let deg = angle_deg + turns_deg;
        self.estimate =
            Some(Estimate { range: Range::with_error(deg, self.error_deg()), time, turns_deg });
        self.turned = Some(Turned { from_deg: deg, time: Some(time), is_up: false });
        (self.outside, self.has_settled, self.starts) = (None, false, false);
        self.rate_from = Some((deg, time));
        self.spread.note_turn();
        self.runs_past.forget();
        self.may_have_passed(time);
    }

    /// Records that the unseen axis may have passed the end of any motion.
    fn may_have_passed(&mut self, time: Instant) {
        for motion in &mut self.motions {
            (motion.led, motion.passed) = ([true; 2], [Some(time); 2]);
        }
    }

    fn know(
        &mut self,
        angle_deg: f64,
        turns_deg: f64,
        range: Range,
        [time, received]: [Instant; 2],
    ) {
        let before = self.estimate.replace(Estimate { range, time, turns_deg });
        let gap = before.map(|before| time.saturating_duration_since(before.time));
        let deg = angle_deg + turns_deg;
        // Between two readings, the axis may have been further.
        let longest = before.map(|before| received.saturating_duration_since(before.time));
        let went_s = longest.unwrap_or_default().as_secs_f64() / 2.0;
        let went_deg = self.runs_past.max_deg_s() * went_s;
        for motion in &mut self.motions {
            motion.look(Some(range.widen(went_deg)), self.figures.arrives_within_deg, time);
        }
        // The motion of the axis during the gap is unknown.
        if let Some(turned) = self.turned.as_mut().filter(|_| gap.is_some_and(|gap| gap > UNSEEN)) {
            (turned.from_deg, turned.time) = (deg, Some(time));
            self.rate_from = Some((deg, time));
            self.has_settled = false;
            self.may_have_passed(time);
        }
        let first = Turned { from_deg: deg, time: Some(time), is_up: false };
        let Turned { from_deg, .. } = *self.turned.get_or_insert(first);
        self.measure_rate(deg, time, received);
        if (deg - from_deg).abs() > self.error_deg_of_two() {
            let is_up = deg > from_deg;
            if self.is_led(is_up, deg, time) {
                // A drive may start late.
                self.has_settled = false;
            }
            if std::mem::take(&mut self.starts)
                && let Some(sent) = self.sent
            {
                note_start(&mut self.dead_time, time.saturating_duration_since(sent));
            }
            self.turned = Some(Turned { from_deg: deg, time: Some(time), is_up });
            // The axis hunts around its target.
            for motion in self
                .motions
                .iter_mut()
                .filter(|motion| motion.expiry.is_none_or(|expiry| time <= expiry + LATE))
            {
                let [down, up] = &mut motion.led;
                *if is_up { up } else { down } = true;
            }
        }
    }

    /// Returns `true` if a motion drives the axis in this direction at `deg`. Beyond the end of the
    /// motion, the axis may only coast.
    fn is_led(&self, is_up: bool, deg: f64, time: Instant) -> bool {
        let mut live = self.motions.iter().filter_map(|motion| motion.state_at(time));
        live.any(|motion| if is_up { motion.up_to_deg > deg } else { motion.down_to_deg < deg })
    }

    /// Learns the rate from readings that are far enough apart, at any polling rate.
    fn measure_rate(&mut self, deg: f64, time: Instant, received: Instant) {
        let (from_deg, start) = *self.rate_from.get_or_insert((deg, time));
        let lasted = time.saturating_duration_since(start);
        let turned_deg = (deg - from_deg).abs();
        if lasted < RATE_APART || turned_deg <= self.error_deg_of_two() {
            return;
        }
        if self.is_led(deg > from_deg, deg, time) {
            let longest = received.saturating_duration_since(start);
            self.runs_past.note_rate(turned_deg / longest.as_secs_f64());
        }
        self.rate_from = Some((deg, time));
    }

    /// Learns from a reading inside the interval.
    fn learn(&mut self, deg: f64, drive: Drive, time: Instant) {
        if self.is_settled(time) {
            self.has_settled = true;
            // A continuing report is no new foreign motion.
            self.is_told &= self.reported_since.is_some();
            if let Some(turned) = &mut self.turned {
                turned.from_deg = deg;
            }
            self.rate_from = Some((deg, time));
            self.has_arrived(deg);
            // With power on, changing readings may be slow motion instead of noise.
            if drive == Drive::Off {
                self.spread.note_rest(deg);
            }
            return;
        }
        self.spread.note_turn();
        if !self.motions.last().is_some_and(|newest| newest.ends) {
            return;
        }
        // A drive that obeys late is still turning to an earlier target.
        let live = || self.motions.iter().filter_map(|motion| motion.state_at(time));
        let up_to_deg = live().map(|motion| motion.up_to_deg).fold(f64::NEG_INFINITY, f64::max);
        let down_to_deg = live().map(|motion| motion.down_to_deg).fold(f64::INFINITY, f64::min);
        let ends = live().flat_map(|motion| [motion.up_to_deg, motion.down_to_deg]);
        let distances_deg = ends.map(|end_deg| self.turned_deg(deg - end_deg).abs());
        let is_between =
            (down_to_deg..=up_to_deg).contains(&deg) && up_to_deg - down_to_deg < TURN_DEG / 2.0;
        let off_deg = if is_between { 0.0 } else { distances_deg.fold(f64::INFINITY, f64::min) };
        let turns = self
            .turned
            .and_then(|turned| turned.time)
            .is_some_and(|turned| time <= turned + UNSEEN);
        let is_there = turns && off_deg <= self.figures.arrives_within_deg + self.error_deg();
        self.runs_past.look(is_there, time);
        let Some(Turned { time: Some(turned_at), is_up, .. }) = self.turned else { return };
        let past_deg = if is_up { deg - up_to_deg } else { down_to_deg - deg };
        if turned_at == time && past_deg > 0.0 && past_deg.is_finite() {
            self.runs_past.note_overshoot(past_deg);
        }
    }

    /// Allows for a full turn of the axis since the last reading.
    fn lose_turns(&mut self) {
        for motion in &mut self.motions {
            motion.down_to_deg -= TURN_DEG;
            motion.up_to_deg += TURN_DEG;
            motion.either_way = motion.ends;
        }
    }

    /// Removes the older motions once the axis stands at the end of the newest motion, and settles
    /// on one of two possible paths.
    fn has_arrived(&mut self, deg: f64) {
        let Some(newest) = self.motions.last_mut().filter(|newest| newest.ends) else { return };
        let turns = ((deg - newest.up_to_deg) / TURN_DEG).round();
        let end_deg = newest.up_to_deg + turns * TURN_DEG;
        if newest.either_way && (deg - end_deg).abs() <= NEAR_DEG {
            (newest.down_to_deg, newest.up_to_deg, newest.either_way) = (end_deg, end_deg, false);
        }
        let (number, end) =
            (newest.number, Range { from_deg: newest.down_to_deg, to_deg: newest.up_to_deg });
        let near_deg = self.figures.arrives_within_deg + self.error_deg();
        if end.off_deg(deg).abs() <= near_deg {
            self.motions.retain(|motion| motion.number == number);
        }
    }

    /// Returns `true` if the axis has come to rest after its last motion.
    fn is_settled(&self, time: Instant) -> bool {
        let last = self.sent.max(self.turned.and_then(|turned| turned.time));
        let shows_s = self.error_deg_of_two() / SLOWEST_DEG_S;
        let shows = Duration::try_from_secs_f64(shows_s).unwrap_or(DEAD_TIME);
        self.has_settled || last.is_none_or(|last| last + DEAD_TIME + COASTS + shows < time)
    }

    /// Returns the max error of a reading, with half of the sway, degrees.
    fn error_deg(&self) -> f64 {
        self.spread.error_deg(self.figures.resolution_deg) + self.figures.sway_deg / 2.0
    }

    fn error_deg_of_two(&self) -> f64 {
        self.error_deg() * 2.0
    }

    /// Returns the turns to add to a reading for the best fit, degrees.
    fn turns_deg(&self, angle_deg: f64, estimate: Estimate, reachable: Range) -> f64 {
        if !self.figures.wraps {
            return estimate.turns_deg;
        }
        if reachable.off_deg(angle_deg + estimate.turns_deg) == 0.0 {
            return estimate.turns_deg;
        }
        let near = ((estimate.range.middle_deg() - angle_deg) / TURN_DEG).round();
        let turns_deg = [near, near - 1.0, near + 1.0].map(|turns| turns * TURN_DEG);
        let off_deg = |turns_deg: f64| reachable.off_deg(angle_deg + turns_deg).abs();
        let best_deg =
            turns_deg.into_iter().min_by(|one, other| off_deg(*one).total_cmp(&off_deg(*other)));
        best_deg.unwrap_or(estimate.turns_deg)
    }

    /// Returns the max overshoot past the end of a motion, degrees: from the full rate after a
    /// redirection.
    fn max_past_deg(&self, time: Instant) -> f64 {
        let is_redirected =
            self.redirected.is_some_and(|start| time <= start + DEAD_TIME + COASTS + LATE);
        let max_deg = self.runs_past.max_deg();
        if is_redirected { max_deg.max(self.runs_past.coasts_deg()) } else { max_deg }
    }

    /// Returns the possible range of the axis at `time`.
    fn reachable(&self, time: Instant) -> Option<Range> {
        let Estimate { range, time: start, .. } = self.estimate?;
        let elapsed_s = time.saturating_duration_since(start).as_secs_f64();
        let reach_deg = FASTEST_DEG_S * elapsed_s;
        let mut reachable = range.widen(CREEPS_DEG_S * elapsed_s);
        let is_unseen = time.saturating_duration_since(start) > UNSEEN;
        let is_settled = self.is_settled(start) && !(is_unseen && self.sent > Some(start));
        for motion in self.motions.iter().filter_map(|motion| motion.state_at(start)) {
            let LiveMotion {
                mut down_to_deg, mut up_to_deg, passed: [from_above, from_below], ..
            } = motion;
            let arrives_deg = self.figures.arrives_within_deg;
            let past_deg = arrives_deg + self.max_past_deg(start) + self.error_deg();
            let may_pass = |passed: Option<Instant>| {
                let passed = passed.is_some_and(|passed| start <= passed + COASTS + LATE);
                !is_settled && (passed || is_unseen)
            };
            if may_pass(from_above) {
                down_to_deg -= past_deg;
            }
            if may_pass(from_below) {
                up_to_deg += past_deg;
            }
            let Range { from_deg, to_deg } = range;
            let from_deg = from_deg.min(down_to_deg.max(from_deg - reach_deg));
            let to_deg = to_deg.max(up_to_deg.min(to_deg + reach_deg));
            reachable.from_deg = reachable.from_deg.min(from_deg);
            reachable.to_deg = reachable.to_deg.max(to_deg);
        }
        Some(reachable)
    }
}
