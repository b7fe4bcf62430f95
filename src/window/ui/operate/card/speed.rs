//! Choice of the jog speed: any rate on a slider, one of the named speeds, or no choice.

use egui::{Rect, Ui};

use crate::{
    device::{JogSpeed, JogSpeeds},
    ui::{
        format,
        widgets::{
            rate_slider,
            segmented::{self, Segment},
        },
    },
};

/// Returns the rate to send, degrees per second. With named speeds, returns the rate of the nearest
/// one.
pub(super) fn rate_deg_s(chosen_deg_s: f64, speeds: JogSpeeds, max_deg_s: f64) -> f64 {
    let named = speeds.nearest(chosen_deg_s, max_deg_s);
    named.map_or(chosen_deg_s.min(max_deg_s), |speed| speed.share * max_deg_s)
}

/// Returns the rate or the name of the speed; empty without a choice.
pub(super) fn in_words(chosen_deg_s: f64, speeds: JogSpeeds, max_deg_s: f64) -> String {
    match speeds {
        JogSpeeds::AnyRate => format::number(chosen_deg_s, 2),
        JogSpeeds::Named([_, _, ..]) => {
            let speed = speeds.nearest(chosen_deg_s, max_deg_s);
            speed.map_or_else(String::new, |speed| speed.name.to_owned())
        }
        JogSpeeds::Named(_) => String::new(),
    }
}

/// Returns the rate `steps` steps up, degrees per second.
pub(super) fn stepped(chosen_deg_s: f64, steps: i32, speeds: JogSpeeds, max_deg_s: f64) -> f64 {
    let JogSpeeds::Named(named) = speeds else {
        return rate_slider::stepped(chosen_deg_s, steps, max_deg_s);
    };
    let current = speeds.nearest(chosen_deg_s, max_deg_s);
    let index = named.iter().position(|speed| Some(*speed) == current).unwrap_or_default();
    let last = named.len().saturating_sub(1);
    let target = index.saturating_add_signed(steps as isize).min(last);
    named.get(target).map_or(chosen_deg_s, |speed| speed.share * max_deg_s)
}

/// Shows the choice of the speed in `rect` and changes `chosen_deg_s`. `is_locked` locks the
/// slider.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    speeds: JogSpeeds,
    max_deg_s: f64,
    is_locked: bool,
    chosen_deg_s: &mut f64,
) {
    match speeds {
        JogSpeeds::AnyRate => {
            rate_slider::show(ui, rect, max_deg_s, is_locked, chosen_deg_s);
        }
        JogSpeeds::Named(named @ [_, _, ..]) => {
            let current = speeds.nearest(*chosen_deg_s, max_deg_s);
            let segment = |speed: &JogSpeed| {
                let is_chosen = Some(*speed) == current;
                (speed.name, if is_chosen { Segment::Chosen } else { Segment::Free })
            };
            let segments: Vec<_> = named.iter().map(segment).collect();
            let clicked = segmented::show(ui, "speed", rect, "Jog speed", &segments);
            if let Some(speed) = clicked.and_then(|index| named.get(index)) {
                *chosen_deg_s = speed.share * max_deg_s;
            }
        }
        JogSpeeds::Named(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: JogSpeeds = JogSpeeds::Named(&[
        JogSpeed { name: "Slow", share: 0.25 },
        JogSpeed { name: "Fast", share: 1.0 },
    ]);
    const ONE: JogSpeeds = JogSpeeds::Named(&[JogSpeed { name: "Turn", share: 1.0 }]);

    #[test]
    fn what_is_sent_is_one_of_the_speeds_that_there_are() {
        let assert_close =
            |rate: f64, expected: f64| assert!((rate - expected).abs() < 1e-9, "{rate}");
        assert_close(rate_deg_s(0.7, TWO, 2.0), 0.5);
        assert_close(rate_deg_s(9.0, TWO, 2.0), 2.0);
        assert_close(rate_deg_s(0.5, ONE, 6.0), 6.0);
        assert_close(rate_deg_s(0.5, JogSpeeds::AnyRate, 3.0), 0.5);
        assert_close(rate_deg_s(9.0, JogSpeeds::AnyRate, 3.0), 3.0);
    }

    #[test]
    fn a_step_up_takes_the_next_name_and_ends_at_the_last() {
        let assert_close =
            |rate: f64, expected: f64| assert!((rate - expected).abs() < 1e-9, "{rate}");
        assert_close(stepped(0.5, 1, TWO, 2.0), 2.0);
        assert_close(stepped(2.0, 1, TWO, 2.0), 2.0);
        assert_close(stepped(2.0, -3, TWO, 2.0), 0.5);
        assert_close(stepped(6.0, -1, ONE, 6.0), 6.0);
    }

    #[test]
    fn only_a_choice_is_named() {
        assert_eq!(in_words(0.5, JogSpeeds::AnyRate, 3.0), "0.50");
        assert_eq!(in_words(2.0, TWO, 2.0), "Fast");
        assert_eq!(in_words(6.0, ONE, 6.0), "");
    }
}
