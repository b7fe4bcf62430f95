//! Jog key that the operator holds down.

use std::time::Duration;

use crate::{clock::Instant, device::Motion};

/// Max age of a position that starts a jog, unless Azel requested the position after the key press.
/// The command and the next position may then each be 300 ms late.
const YOUNG: Duration = Duration::from_millis(300);
/// Max time that a jog waits for its position. One reply may get lost, and Azel then queries some
/// units only after a second.
const PATIENCE: Duration = Duration::from_secs(3);

/// Held jog key.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Jog {
    /// Signed rates of the two axes, degrees a second.
    rates_deg_s: [f64; 2],
    pressed_at: Instant,
    /// `true` after a request for a fresh position.
    has_asked: bool,
    /// End of the jog unless renewed.
    end: Instant,
    /// `true` once the motion has passed the gate.
    is_started: bool,
    /// `true` once the gate has refused the motion and the operator knows.
    is_refused: bool,
}

impl Jog {
    pub(super) fn motion(&self) -> Motion {
        let [x_deg_s, y_deg_s] = self.rates_deg_s;
        Motion::Jog { x_deg_s, y_deg_s }
    }

    /// Returns the signed rates of the two axes, degrees a second.
    pub(super) fn rates_deg_s(&self) -> [f64; 2] {
        self.rates_deg_s
    }

    /// Returns the end of the jog unless renewed.
    pub(super) fn end(&self) -> Instant {
        self.end
    }

    /// Returns `true` once the motion has passed the gate.
    pub(super) fn is_started(&self) -> bool {
        self.is_started
    }
}

/// State of the operator's jog keys.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct JogKey(KeyState);

#[derive(Debug, Clone, PartialEq, Default)]
enum KeyState {
    #[default]
    Up,
    Down(Jog),
    /// Ended jog with these rates and a key that is still down. A new jog needs a new press.
    /// Otherwise the same key could move the antenna again after the window froze.
    Spent([f64; 2]),
}

/// Wait of a jog for a position that stays valid until the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PositionWait {
    Over,
    /// Missing request: the session must request such a position.
    Ask,
    Wait,
}

impl JogKey {
    pub(super) fn pressed(&self) -> Option<&Jog> {
        match &self.0 {
            KeyState::Down(jog) => Some(jog),
            KeyState::Up | KeyState::Spent(_) => None,
        }
    }

    fn pressed_mut(&mut self) -> Option<&mut Jog> {
        match &mut self.0 {
            KeyState::Down(jog) => Some(jog),
            KeyState::Up | KeyState::Spent(_) => None,
        }
    }

    /// Returns the jog that has passed the gate.
    pub(super) fn started(&self) -> Option<&Jog> {
        self.pressed().filter(|jog| jog.is_started)
    }

    /// Returns `true` if an ended jog's key is still down in this direction.
    pub(super) fn is_spent(&self, rates_deg_s: [f64; 2]) -> bool {
        matches!(self.0, KeyState::Spent(rates) if is_same_way(rates, rates_deg_s))
    }

    /// Extends a jog with exactly these rates. Returns `false` if no such jog runs.
    pub(super) fn renew(&mut self, rates_deg_s: [f64; 2], end: Instant) -> bool {
        let jog = self.pressed_mut().filter(|jog| is_same_rate(jog.rates_deg_s, rates_deg_s));
        let is_renewed = jog.is_some();
        if let Some(jog) = jog {
            jog.end = end;
        }
        is_renewed
    }

    pub(super) fn press(&mut self, rates_deg_s: [f64; 2], end: Instant, now: Instant) {
        self.0 = KeyState::Down(Jog {
            rates_deg_s,
            pressed_at: now,
            has_asked: false,
            end,
            is_started: false,
            is_refused: false,
        });
    }

    /// Records that the motion of the held key has passed the gate.
    pub(super) fn start(&mut self) {
        if let Some(jog) = self.pressed_mut() {
            jog.is_started = true;
        }
    }

    /// Records that the gate refused the motion of the held key. Returns `true` the first time.
    pub(super) fn is_first_refusal(&mut self) -> bool {
        self.pressed_mut().is_some_and(|jog| !std::mem::replace(&mut jog.is_refused, true))
    }

    /// Records the release of the key.
    pub(super) fn release(&mut self) {
        self.0 = KeyState::Up;
    }

    /// Ends a jog whose key is still down.
    pub(super) fn spend(&mut self) {
        if let KeyState::Down(jog) = &self.0 {
            self.0 = KeyState::Spent(jog.rates_deg_s);
        }
    }

    /// Records a held key with these rates that must be released before the next jog.
    pub(super) fn spend_rates(&mut self, rates_deg_s: [f64; 2]) {
        self.0 = KeyState::Spent(rates_deg_s);
    }

    /// Ends a jog; the same key may start another.
    pub(super) fn end(&mut self) {
        if let KeyState::Down(_) = self.0 {
            self.0 = KeyState::Up;
        }
    }

    /// Judges the last position; `requested` is its request time. The gate judges the age of a
    /// missing position.
    pub(super) fn wait_for_position(&mut self, requested: Instant, now: Instant) -> PositionWait {
        let Some(jog) = self.pressed_mut() else { return PositionWait::Over };
        let age = now.saturating_duration_since(requested);
        let waited = now.saturating_duration_since(jog.pressed_at);
        if age < YOUNG || requested >= jog.pressed_at || waited >= PATIENCE {
            PositionWait::Over
        } else if std::mem::replace(&mut jog.has_asked, true) {
            PositionWait::Wait
        } else {
            PositionWait::Ask
        }
    }
}

/// Returns `true` if two jogs turn the same axes in the same directions, at any rates.
fn is_same_way(a: [f64; 2], b: [f64; 2]) -> bool {
    let way = |rate: f64| rate.partial_cmp(&0.0);
    a.map(way) == b.map(way)
}

/// Compares the rates exactly, because a held key repeats the same numbers.
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
