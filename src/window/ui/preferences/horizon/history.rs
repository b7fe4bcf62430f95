//! Undo and redo of edits in the horizon page.

use super::draft::Skies;

/// Max number of undo steps.
const MAX: usize = 100;

/// Earlier states, and undone states.
#[derive(Default)]
pub(super) struct History {
    settled: Option<Skies>,
    before: Vec<Skies>,
    undone: Vec<Skies>,
}

impl History {
    /// Records a state unless the operator is dragging or typing.
    pub(super) fn settle(&mut self, now: &Skies) {
        if self.settled.as_ref() == Some(now) {
            return;
        }
        if let Some(old) = self.settled.replace(now.clone()) {
            self.before.push(old);
            self.undone.clear();
            if self.before.len() > MAX {
                self.before.remove(0);
            }
        }
    }

    pub(super) fn can_undo(&self) -> bool {
        !self.before.is_empty()
    }

    pub(super) fn undo(&mut self, now: &mut Skies) {
        self.settle(now);
        if let Some(old) = self.before.pop() {
            self.undone.push(std::mem::replace(now, old));
            self.settled = Some(now.clone());
        }
    }

    /// Redoes one undone step.
    pub(super) fn redo(&mut self, now: &mut Skies) {
        if let Some(next) = self.undone.pop() {
            self.before.push(std::mem::replace(now, next));
            self.settled = Some(now.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::station::Station;

    #[test]
    fn steps_are_undone_and_done_again() {
        let mut now = Skies::new(&Station::default());
        let mut history = History::default();
        history.settle(&now);
        assert!(!history.can_undo());
        for mask in ["0 1", "0 2"] {
            mask.clone_into(&mut now.mask);
            history.settle(&now);
        }
        // The last change counts as a step although it is not settled.
        "0 3".clone_into(&mut now.mask);
        for expected in ["0 2", "0 1", "", ""] {
            history.undo(&mut now);
            assert_eq!(now.mask, expected);
        }
        for expected in ["0 1", "0 2", "0 3", "0 3"] {
            history.redo(&mut now);
            assert_eq!(now.mask, expected);
        }
        history.undo(&mut now);
        "0 9".clone_into(&mut now.mask);
        history.settle(&now);
        history.redo(&mut now);
        assert_eq!(now.mask, "0 9", "another step ends what was undone");
    }
}
