//! The number of hours in the strip.

/// Selectable numbers of hours.
const HOURS: [u32; 6] = [1, 2, 4, 8, 12, 24];

/// Number of hours in the strip: the default of its form until the operator chooses another number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Zoom {
    requested: Option<u32>,
    shown: u32,
}

impl Default for Zoom {
    fn default() -> Self {
        Self { requested: None, shown: 12 }
    }
}

impl Zoom {
    /// Creates a zoom with an earlier choice, hours.
    pub fn new(requested: Option<u32>) -> Self {
        Self { requested: requested.filter(|hours| HOURS.contains(hours)), ..Self::default() }
    }

    /// Returns the operator's choice, hours; `None` for the default.
    pub fn requested(&self) -> Option<u32> {
        self.requested
    }

    /// Returns the number of hours to show in a form with the default `default`.
    pub fn hours(&mut self, default: u32) -> u32 {
        self.shown = self.requested.unwrap_or(default);
        self.shown
    }

    /// Shows fewer hours if `closer` is positive, otherwise more.
    pub fn change(&mut self, closer: isize) {
        let now = HOURS.iter().position(|hours| *hours >= self.shown).unwrap_or_default();
        let requested = now.saturating_add_signed(-closer).min(HOURS.len() - 1);
        self.requested = HOURS.get(requested).copied();
        self.shown = self.requested.unwrap_or(self.shown);
    }

    /// Resets the number of hours to the default.
    pub fn reset(&mut self) {
        self.requested = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_lead_from_what_is_shown_and_end_at_the_ends() {
        for (default, closer, farther) in [(12, 8, 24), (4, 2, 8)] {
            let mut zoom = Zoom::default();
            assert_eq!(zoom.hours(default), default);
            zoom.change(1);
            assert_eq!(zoom.hours(default), closer);
            zoom.reset();
            assert_eq!(zoom.hours(default), default);
            zoom.change(-1);
            assert_eq!(zoom.hours(default), farther);
        }
        let mut zoom = Zoom::default();
        for (step, end) in [(1, 1), (-1, 24)] {
            (0..20).for_each(|_| zoom.change(step));
            assert_eq!(zoom.hours(12), end);
        }
    }

    #[test]
    fn what_cannot_be_chosen_is_not_taken_over() {
        for wrong in [0, 5, 48] {
            assert_eq!(Zoom::new(Some(wrong)), Zoom::default());
        }
        assert_eq!(Zoom::new(Some(24)).hours(12), 24);
    }
}
