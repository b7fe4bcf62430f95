//! Track mode: setup, search, then peaking of the signal at intervals. Times are the simulator's
//! own choices.

use crate::protocol::rc2000c::{Band, Polarity, Submode};

const SETUP_S: f64 = 1.0;
const SEARCH_UNTIL_S: f64 = 5.0;
/// Time between two peak-ups, seconds.
const CYCLE_S: f64 = 30.0;
const PEAK_UP_S: f64 = 6.0;
/// Reach of a peak-up to each side, counts.
const PEAK_COUNTS: u16 = 4;

/// State of the track mode while it is on.
#[derive(Debug, Clone)]
pub(super) struct Tracking {
    az_counts: u16,
    el_counts: u16,
    running_s: f64,
    error: Option<Submode>,
    pub(super) band: Band,
    pub(super) is_dual_band: bool,
    /// Polarization requested during a peak-up, which waits for its end.
    pub(super) waiting: Option<Polarity>,
}

impl Tracking {
    pub(super) fn new(az_counts: u16, el_counts: u16, is_dual_band: bool) -> Self {
        Self {
            az_counts,
            el_counts,
            running_s: 0.0,
            error: None,
            band: Band::K,
            is_dual_band,
            waiting: None,
        }
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        if self.error.is_none() {
            self.running_s += step_s;
        }
    }

    pub(super) fn fail(&mut self, error: Submode) {
        self.error = Some(error);
    }

    /// Clears the error and restarts.
    pub(super) fn restart(&mut self) {
        self.error = None;
        self.running_s = 0.0;
    }

    pub(super) fn submode(&self) -> Submode {
        match self.error {
            Some(error) => error,
            None if self.running_s < SETUP_S => Submode::Setup,
            None if self.running_s < SEARCH_UNTIL_S => Submode::Search,
            None => Submode::Step,
        }
    }

    fn peak_up_s(&self) -> Option<f64> {
        let since_search_s = self.running_s - SEARCH_UNTIL_S;
        let in_cycle_s = since_search_s.rem_euclid(CYCLE_S);
        (self.error.is_none() && since_search_s >= 0.0 && in_cycle_s < PEAK_UP_S)
            .then_some(in_cycle_s)
    }

    pub(super) fn is_peaking(&self) -> bool {
        self.peak_up_s().is_some()
    }

    /// Returns the demanded position of both axes, counts; `None` while they rest.
    pub(super) fn target(&self) -> Option<[u16; 2]> {
        let (az, el) = (self.az_counts, self.el_counts);
        if self.submode() == Submode::Search {
            return Some([az, el]);
        }
        // The axes move in a cross: one second to each side, then back.
        Some(match self.peak_up_s()? {
            ..1.0 => [az.saturating_sub(PEAK_COUNTS), el],
            ..2.0 => [az.saturating_add(PEAK_COUNTS), el],
            ..3.0 => [az, el.saturating_sub(PEAK_COUNTS)],
            ..4.0 => [az, el.saturating_add(PEAK_COUNTS)],
            _ => [az, el],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tracking_goes_through_its_submodes_and_peaks_every_while() {
        let mut tracking = Tracking::new(1830, 860, true);
        assert_eq!((tracking.submode(), tracking.target()), (Submode::Setup, None));
        tracking.advance(1.0);
        assert_eq!(tracking.submode(), Submode::Search);
        tracking.advance(4.0);
        assert_eq!(tracking.submode(), Submode::Step);
        assert_eq!(tracking.target(), Some([1826, 860]));
        tracking.advance(6.0);
        assert!(!tracking.is_peaking() && tracking.target().is_none());
        tracking.advance(24.0);
        assert!(tracking.is_peaking());
        tracking.fail(Submode::PeakLimitError);
        assert_eq!((tracking.submode(), tracking.target()), (Submode::PeakLimitError, None));
        tracking.restart();
        assert_eq!(tracking.submode(), Submode::Setup);
    }
}
