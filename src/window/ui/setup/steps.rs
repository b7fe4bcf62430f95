//! The steps of the set-up, and the progress of the operator.

/// A step of the set-up of a station.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Step {
    #[default]
    Site,
    Antennas,
    Satellites,
    Elements,
    /// Summary of the file to write, with the button that writes it.
    End,
}

impl Step {
    /// Steps that the operator can skip.
    pub(super) const NUMBERED: [Self; 4] =
        [Self::Site, Self::Antennas, Self::Satellites, Self::Elements];
    const ALL: [Self; 5] =
        [Self::Site, Self::Antennas, Self::Satellites, Self::Elements, Self::End];

    pub(super) fn number(self) -> usize {
        self as usize + 1
    }

    pub(super) fn next(self) -> Option<Self> {
        Self::ALL.get(self as usize + 1).copied()
    }

    pub(super) fn before(self) -> Option<Self> {
        (self as usize).checked_sub(1).and_then(|index| Self::ALL.get(index)).copied()
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Site => "Site",
            Self::Antennas => "Antennas",
            Self::Satellites => "Satellites",
            Self::Elements => "Elements",
            Self::End => "Check and finish",
        }
    }

    /// Returns the title and the purpose of the step.
    pub(super) fn title(self) -> (&'static str, &'static str) {
        let description = match self {
            Self::Site => {
                "Where are the antennas? Passes and directions are computed for this location."
            }
            Self::Antennas => {
                "Which units move your antennas, and where do they answer? A test only asks; it \
                 moves nothing."
            }
            Self::Satellites => "Which satellites should the list of passes show?",
            Self::Elements => {
                "Orbits change: predictions are only as good as the elements are fresh. A source \
                 is saved as soon as you add it."
            }
            Self::End => "This is what Finish saves. Sources that you added are saved already.",
        };
        (self.name(), description)
    }
}

/// Outcome of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Passed {
    #[default]
    NotYet,
    Done,
    Skipped,
}

/// Outcome of each step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Progress([Passed; Step::NUMBERED.len()]);

impl Progress {
    pub(super) fn outcome(self, step: Step) -> Passed {
        self.0.get(step as usize).copied().unwrap_or_default()
    }

    pub(super) fn done(&mut self, step: Step) {
        self.set(step, Passed::Done);
    }

    pub(super) fn skipped(&mut self, step: Step) {
        self.set(step, Passed::Skipped);
    }

    fn set(&mut self, step: Step, passed: Passed) {
        if let Some(state) = self.0.get_mut(step as usize) {
            *state = passed;
        }
    }
}
