//! The number of hours in the strip.

/// Selectable values.
const HOURS: [u32; 6] = [1, 2, 4, 8, 12, 24];

/// Number of hours in the strip: the default of its form, until the operator chooses more
/// or fewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Zoom {
    wanted: Option<u32>,
    shown: u32,
}

impl Default for Zoom {
    fn default() -> Self {
        Self { wanted: None, shown: 12 }
    }
}

impl Zoom {
    /// A zoom with an earlier choice, in hours.
    pub fn of(wanted: Option<u32>) -> Self {
        Self { wanted: wanted.filter(|hours| HOURS.contains(hours)), ..Self::default() }
    }

    /// The operator's choice, in hours; `None` for the default.
    pub fn wanted(&self) -> Option<u32> {
        self.wanted
    }

    /// The hours to show in a form with the default `usual`.
    pub fn hours(&mut self, usual: u32) -> u32 {
        self.shown = self.wanted.unwrap_or(usual);
        self.shown
    }

    /// Shows fewer hours (`closer` positive) or more.
    pub fn change(&mut self, closer: isize) {
        let now = HOURS.iter().position(|hours| *hours >= self.shown).unwrap_or_default();
        let wanted = now.saturating_add_signed(-closer).min(HOURS.len() - 1);
        self.wanted = HOURS.get(wanted).copied();
        self.shown = self.wanted.unwrap_or(self.shown);
    }

    /// Returns to the default.
    pub fn reset(&mut self) {
        self.wanted = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_lead_from_what_is_shown_and_end_at_the_ends() {
        for (usual, closer, farther) in [(12, 8, 24), (4, 2, 8)] {
            let mut zoom = Zoom::default();
            assert_eq!(zoom.hours(usual), usual);
            zoom.change(1);
            assert_eq!(zoom.hours(usual), closer);
            zoom.reset();
            assert_eq!(zoom.hours(usual), usual);
            zoom.change(-1);
            assert_eq!(zoom.hours(usual), farther);
        }
        let mut zoom = Zoom::default();
        for (by, end) in [(1, 1), (-1, 24)] {
            (0..20).for_each(|_| zoom.change(by));
            assert_eq!(zoom.hours(12), end);
        }
    }

    #[test]
    fn what_cannot_be_chosen_is_not_taken_over() {
        for wrong in [0, 5, 48] {
            assert_eq!(Zoom::of(Some(wrong)), Zoom::default());
        }
        assert_eq!(Zoom::of(Some(24)).hours(12), 24);
    }
}
