//! The jog key that the operator holds down.

use std::time::Duration;

use crate::{clock::Instant, device::Motion};

/// A jog starts at a position younger than this, or at one that was asked for after the key went
/// down: the command and the next position may each be late by 300 ms before this one is too old.
const YOUNG: Duration = Duration::from_millis(300);
/// Longest time that a jog waits for its position. One reply may be lost, and Azel asks some units
/// nothing for a second after that.
const PATIENCE: Duration = Duration::from_secs(3);

/// A held jog key.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Jog {
    /// Signed rates of the two axes, degrees a second.
    rates_deg_s: [f64; 2],
    pressed_at: Instant,
    /// A younger position has been asked for.
    has_asked: bool,
    /// When the jog ends unless renewed.
    end: Instant,
    /// The motion went through the gate.
    is_started: bool,
    /// The gate refused it, and the operator knows.
    is_refused: bool,
}

impl Jog {
    pub(super) fn motion(&self) -> Motion {
        let [x_deg_s, y_deg_s] = self.rates_deg_s;
        Motion::Jog { x_deg_s, y_deg_s }
    }

    /// Signed rates of the two axes, degrees a second.
    pub(super) fn rates_deg_s(&self) -> [f64; 2] {
        self.rates_deg_s
    }

    /// When the jog ends unless renewed.
    pub(super) fn end(&self) -> Instant {
        self.end
    }

    /// Returns `true` once the motion went through the gate.
    pub(super) fn is_started(&self) -> bool {
        self.is_started
    }
}

/// The operator's jog keys.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct JogKey(State);

#[derive(Debug, Clone, PartialEq, Default)]
enum State {
    #[default]
    Up,
    Down(Jog),
    /// A jog with these rates ended before its key came up. It needs a new press, or the same
    /// key could move the antenna again after the window has frozen.
    Spent([f64; 2]),
}

/// Wait of a jog for a position that lasts until the next one comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PositionWait {
    Over,
    /// Such a position must be requested.
    Ask,
    Wait,
}

impl JogKey {
    pub(super) fn pressed(&self) -> Option<&Jog> {
        match &self.0 {
            State::Down(jog) => Some(jog),
            State::Up | State::Spent(_) => None,
        }
    }

    fn pressed_mut(&mut self) -> Option<&mut Jog> {
        match &mut self.0 {
            State::Down(jog) => Some(jog),
            State::Up | State::Spent(_) => None,
        }
    }

    /// The jog that went through the gate.
    pub(super) fn started(&self) -> Option<&Jog> {
        self.pressed().filter(|jog| jog.is_started)
    }

    /// Returns `true` if the key of a jog that has ended is still down in this direction.
    pub(super) fn is_spent(&self, rates_deg_s: [f64; 2]) -> bool {
        matches!(self.0, State::Spent(rates) if is_same_way(rates, rates_deg_s))
    }

    /// Lengthens a jog with exactly these rates. Returns `false` if there is none.
    pub(super) fn renew(&mut self, rates_deg_s: [f64; 2], end: Instant) -> bool {
        let jog = self.pressed_mut().filter(|jog| is_same_rate(jog.rates_deg_s, rates_deg_s));
        let is_renewed = jog.is_some();
        if let Some(jog) = jog {
            jog.end = end;
        }
        is_renewed
    }

    pub(super) fn press(&mut self, rates_deg_s: [f64; 2], end: Instant, now: Instant) {
        self.0 = State::Down(Jog {
            rates_deg_s,
            pressed_at: now,
            has_asked: false,
            end,
            is_started: false,
            is_refused: false,
        });
    }

    /// The motion of the held key went through the gate.
    pub(super) fn start(&mut self) {
        if let Some(jog) = self.pressed_mut() {
            jog.is_started = true;
        }
    }

    /// The gate has refused the motion of the held key. Returns `true` the first time.
    pub(super) fn is_first_refusal(&mut self) -> bool {
        self.pressed_mut().is_some_and(|jog| !std::mem::replace(&mut jog.is_refused, true))
    }

    /// The key is up.
    pub(super) fn release(&mut self) {
        self.0 = State::Up;
    }

    /// Ends a jog whose key is still down.
    pub(super) fn spend(&mut self) {
        if let State::Down(jog) = &self.0 {
            self.0 = State::Spent(jog.rates_deg_s);
        }
    }

    /// The key of a jog with these rates is still down, and must come up before the next one.
    pub(super) fn spend_rates(&mut self, rates_deg_s: [f64; 2]) {
        self.0 = State::Spent(rates_deg_s);
    }

    /// Ends a jog; the same key may begin another.
    pub(super) fn end(&mut self) {
        if let State::Down(_) = self.0 {
            self.0 = State::Up;
        }
    }

    /// Judges the last position, which was asked for at `asked`. The gate judges the age of a
    /// position that does not come.
    pub(super) fn wait_for_position(&mut self, asked: Instant, now: Instant) -> PositionWait {
        let Some(jog) = self.pressed_mut() else { return PositionWait::Over };
        let age = now.saturating_duration_since(asked);
        let waited = now.saturating_duration_since(jog.pressed_at);
        if age < YOUNG || asked >= jog.pressed_at || waited >= PATIENCE {
            PositionWait::Over
        } else if std::mem::replace(&mut jog.has_asked, true) {
            PositionWait::Wait
        } else {
            PositionWait::Ask
        }
    }
}

/// Returns `true` if two jogs turn the same axes the same way, at whatever rates.
fn is_same_way(a: [f64; 2], b: [f64; 2]) -> bool {
    let way = |rate: f64| rate.partial_cmp(&0.0);
    a.map(way) == b.map(way)
}

/// A held key repeats exactly the same numbers.
fn is_same_rate(a: [f64; 2], b: [f64; 2]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGHT: [f64; 2] = [1.0, 0.0];

    #[test]
    fn a_spent_key_moves_nothing_in_its_direction_until_it_comes_up() {
        let now = Instant::now();
        let mut key = JogKey::default();
        key.press(RIGHT, now, now);
        key.start();
        key.spend();
        assert!(key.pressed().is_none() && key.is_spent([2.0, 0.0]));
        assert!(!key.is_spent([-1.0, 0.0]), "another direction is another press");
        key.release();
        assert!(!key.is_spent(RIGHT));
    }

    #[test]
    fn a_jog_asks_once_for_a_younger_position_and_waits_no_longer_than_its_patience() {
        let start = Instant::now();
        let pressed = start + YOUNG;
        let mut key = JogKey::default();
        key.press(RIGHT, pressed, pressed);
        assert_eq!(key.wait_for_position(start, pressed), PositionWait::Ask);
        assert_eq!(key.wait_for_position(start, pressed), PositionWait::Wait);
        assert_eq!(key.wait_for_position(pressed, pressed), PositionWait::Over);
        assert_eq!(key.wait_for_position(start, pressed + PATIENCE), PositionWait::Over);
    }
}
