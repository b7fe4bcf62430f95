//! Judgements of the paths of units that track on their own. A judgement takes up to a second, so a
//! worker computes it. The gate refuses a path without a judgement.

use std::sync::Arc;

use super::Gate;
use crate::{
    contract::driver::Refusal,
    device::OnBoard,
    plan::{
        Bounds,
        on_board::{Judge, NotClear},
    },
};

/// Max change of the unit's clock that keeps a judgement valid, seconds. Such a change barely
/// affects the distance to the Sun.
const SAME_CLOCK_S: f64 = 10.0;
/// Max number of stored judgements: for a pass, and for its next offsets by the axes and on the
/// sky.
const MAX_KEPT: usize = 6;

/// Request to judge the path of a unit with the report `unit` on a pass, within these bounds.
#[derive(Debug, Clone)]
pub(in crate::driver) struct PathQuestion {
    judge: Arc<Judge>,
    unit: OnBoard,
    bounds: Bounds,
}

impl PathQuestion {
    /// Checks the whole path; takes up to a second.
    pub(in crate::driver) fn judge(&self) -> Result<(), NotClear> {
        self.judge.is_clear(&self.unit, &self.bounds)
    }

    /// Returns `true` if a judgement of this path applies to `other`, which may begin later on the
    /// path.
    fn covers(&self, other: &Self) -> bool {
        let (mine, others) = (self.judge.pass(), other.judge.pass());
        let is_part = Arc::ptr_eq(&self.judge, &other.judge)
            || (mine.elements == others.elements
                && mine.site == others.site
                && mine.target.end == others.target.end
                && mine.target.start <= others.target.start
                && self.judge.ability() == other.judge.ability());
        let is_same_clock = match (self.unit.clock, other.unit.clock) {
            (Some(mine), Some(other)) => (mine.ahead_s - other.ahead_s).abs() < SAME_CLOCK_S,
            (mine, other) => mine.is_none() && other.is_none(),
        };
        is_part
            && is_same_clock
            && self.unit.place == other.unit.place
            && self.unit.offsets == other.unit.offsets
            && self.bounds == other.bounds
    }
}

/// Newest judgements.
#[derive(Debug, Default)]
pub(super) struct Judged(Vec<(PathQuestion, Result<(), NotClear>)>);

impl Gate {
    fn question(&self, judge: &Arc<Judge>, unit: &OnBoard) -> PathQuestion {
        let (judge, unit, bounds) = (Arc::clone(judge), unit.clone(), self.bounds.clone());
        PathQuestion { judge, unit, bounds }
    }

    /// Returns the questions for the paths of `judge` with these reports that have no judgement
    /// yet.
    pub(in crate::driver) fn open_questions(
        &self,
        judge: &Arc<Judge>,
        units: &[OnBoard],
    ) -> Vec<PathQuestion> {
        let questions = units.iter().map(|unit| self.question(judge, unit));
        questions.filter(|question| self.verdict(question).is_none()).collect()
    }

    pub(in crate::driver) fn take_judgements(
        &mut self,
        judgements: Vec<(PathQuestion, Result<(), NotClear>)>,
    ) {
        let Judged(verdicts) = &mut self.judged;
        verdicts.extend(judgements);
        // A unit whose reports keep changing must not fill the memory.
        verdicts.drain(..verdicts.len().saturating_sub(MAX_KEPT));
    }

    fn verdict(&self, question: &PathQuestion) -> Option<&Result<(), NotClear>> {
        let Judged(verdicts) = &self.judged;
        let fitting = verdicts.iter().rev().find(|(judged, _)| judged.covers(question));
        fitting.map(|(_, verdict)| verdict)
    }

    /// Returns the judgement of a whole path of the unit; an error if it is missing.
    pub(super) fn whole_path_is_clear(
        &self,
        judge: &Arc<Judge>,
        unit: &OnBoard,
    ) -> Result<(), Refusal> {
        // The unit's report may have changed since then: a path without a verdict is not clear.
        let verdict = self.verdict(&self.question(judge, unit)).ok_or(Refusal::BeingJudged)?;
        Ok(verdict.clone()?)
    }
}
