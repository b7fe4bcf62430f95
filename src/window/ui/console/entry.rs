//! Text in the question line, and the questions sent before.

use std::collections::VecDeque;

/// Max number of kept questions.
const MAX_KEPT: usize = 50;

/// Text of the question field. A recalled question replaces the typed text, which comes back after
/// it.
#[derive(Debug, Default)]
pub(super) struct Entry {
    pub(super) text: String,
    /// Sent questions, oldest first.
    sent: VecDeque<String>,
    /// Position of the recalled question, counted from the newest, and the text typed before the
    /// recall.
    shown: Option<(usize, String)>,
}

impl Entry {
    /// Keeps the text as the newest question.
    pub(super) fn sent(&mut self) {
        self.shown = None;
        if self.sent.back() != Some(&self.text) {
            self.sent.push_back(self.text.clone());
        }
        while self.sent.len() > MAX_KEPT {
            self.sent.pop_front();
        }
    }

    /// Shows the previous question.
    pub(super) fn older(&mut self) {
        let place = self.shown.as_ref().map_or(0, |(place, _)| place + 1);
        let Some(question) = self.sent.iter().rev().nth(place) else { return };
        let now = std::mem::replace(&mut self.text, question.clone());
        let typed = self.shown.take().map_or(now, |(_, typed)| typed);
        self.shown = Some((place, typed));
    }

    /// Shows the next question, or the typed text after the newest question.
    pub(super) fn newer(&mut self) {
        let Some((place, typed)) = self.shown.take() else { return };
        let Some(place) = place.checked_sub(1) else {
            self.text = typed;
            return;
        };
        if let Some(question) = self.sent.iter().rev().nth(place) {
            self.text.clone_from(question);
        }
        self.shown = Some((place, typed));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earlier_questions_come_back_and_what_was_typed_too() {
        let mut entry = Entry::default();
        entry.older();
        assert_eq!(entry.text, "");
        for question in ["STATUS?", "TPOS?", "TPOS?"] {
            entry.text = question.to_owned();
            entry.sent();
        }
        entry.text = "REDU".to_owned();
        let shown: Vec<String> = (0..3)
            .map(|_| {
                entry.older();
                entry.text.clone()
            })
            .collect();
        assert_eq!(shown, ["TPOS?", "STATUS?", "STATUS?"], "a repeated question counts once");
        let shown: Vec<String> = (0..3)
            .map(|_| {
                entry.newer();
                entry.text.clone()
            })
            .collect();
        assert_eq!(shown, ["TPOS?", "REDU", "REDU"]);
    }

    #[test]
    fn only_the_newest_are_kept() {
        let mut entry = Entry::default();
        for number in 0..200 {
            entry.text = number.to_string();
            entry.sent();
        }
        (0..200).for_each(|_| entry.older());
        assert_eq!(entry.text, "150");
    }
}
