//! View state of the record: filters, chosen pass, cursor and dialogs.

use jiff::Timestamp;

use super::{days::DaysDialog, report};
use crate::{
    contract::{
        self,
        record::{OpenedPass, PassPage, PassQuery, RecordedPass},
        recorded::{Found, MissedPass, RecordLook},
    },
    model::{
        Model, UiCommand,
        correction::{Correction, correction},
        export::{Export, ReportFormat},
    },
    ui::{
        replay,
        words::{record::no_correction, sentence},
    },
};

/// Number of passes listed initially, and added by each step.
const PAGE: u32 = 200;

/// Query, chosen pass, and the time at the cursor.
#[derive(Debug)]
pub struct RecordState {
    pub(super) query: PassQuery,
    /// Id of the chosen pass; `None` for the newest.
    chosen: Option<i64>,
    /// The last request to the station.
    record_look: Option<RecordLook>,
    /// Time of the cursor in all drawings.
    pub(super) cursor: Option<Timestamp>,
    pub(super) list_is_open: bool,
    /// `true` if the list has to scroll to the chosen pass.
    pub(super) scrolls: bool,
    /// Dialog for the days to export; `None` while it is closed.
    pub(super) days: Option<DaysDialog>,
    /// Correction that the operator accepts, or the reason why there is none.
    pub correction: Option<Result<Correction, String>>,
}

/// A row of the list.
#[derive(Clone, Copy)]
pub(super) enum Listed<'a> {
    Tracked(&'a RecordedPass),
    NotTracked(&'a MissedPass),
}

impl Listed<'_> {
    pub(super) fn aos(self) -> Timestamp {
        match self {
            Self::Tracked(pass) => pass.report.start,
            Self::NotTracked(pass) => pass.flown.pass.1,
        }
    }

    fn over_at(self) -> Timestamp {
        match self {
            Self::Tracked(pass) => pass.report.end,
            Self::NotTracked(pass) => pass.time,
        }
    }
}

impl Default for RecordState {
    fn default() -> Self {
        Self {
            query: PassQuery { count: PAGE, ..PassQuery::default() },
            chosen: None,
            record_look: None,
            cursor: None,
            list_is_open: false,
            scrolls: false,
            days: None,
            correction: None,
        }
    }
}

impl RecordState {
    /// Returns the listed tracked passes, the newest first.
    pub(super) fn passes(model: &Model) -> &[RecordedPass] {
        found(model).map_or(&[], |found| &found.page.passes)
    }

    /// Returns all listed passes, tracked or missed, the newest first.
    pub(super) fn listed(model: &Model) -> Vec<Listed<'_>> {
        let missed = found(model).map_or(&[][..], |found| &found.missed);
        let tracked = Self::passes(model).iter().map(Listed::Tracked);
        let mut all: Vec<_> = tracked.chain(missed.iter().map(Listed::NotTracked)).collect();
        all.sort_by_key(|listed| std::cmp::Reverse(listed.over_at()));
        all
    }

    pub(super) fn page(model: &Model) -> Option<&PassPage> {
        found(model).map(|found| &found.page)
    }

    /// Returns the id of the pass whose report is shown.
    pub(super) fn shown(&self, model: &Model) -> Option<i64> {
        self.chosen.or_else(|| Self::passes(model).first().map(|pass| pass.id))
    }

    pub(super) fn opened<'a>(&self, model: &'a Model) -> Option<&'a OpenedPass> {
        let opened = found(model)?.opened.as_ref()?;
        Some(opened).filter(|opened| Some(opened.pass.id) == self.shown(model))
    }

    pub(super) fn choose(&mut self, id: i64) {
        self.chosen = Some(id);
        self.cursor = None;
        self.list_is_open = false;
    }

    /// Chooses the pass `down` rows further down.
    pub fn step(&mut self, model: &Model, down: isize) {
        let passes = Self::passes(model);
        let shown = self.shown(model);
        let Some(place) = passes.iter().position(|pass| Some(pass.id) == shown) else { return };
        let next = place.saturating_add_signed(down).min(passes.len().saturating_sub(1));
        if let Some(pass) = passes.get(next) {
            let list_is_open = self.list_is_open;
            self.choose(pass.id);
            (self.list_is_open, self.scrolls) = (list_is_open, true);
        }
    }

    /// Returns the command that replays the pass of the report, if a replay is possible.
    pub fn replay(&self, model: &Model) -> Option<UiCommand> {
        let opened = self.opened(model).filter(|_| lock(model).is_none())?;
        Some(report::replay_of(&opened.pass, None))
    }

    /// Returns the command that saves the page of the report, if a report is open.
    pub fn export(&self, model: &Model) -> Option<UiCommand> {
        let format = ReportFormat::Html;
        self.opened(model).map(|_| UiCommand::Save(Export::Report { format }))
    }

    /// Accepts the correction for the best explanation of the report.
    pub fn correct(&mut self, model: &Model) {
        if model.replay.is_some() {
            self.correction = Some(Err(replay::REFUSED.to_owned()));
            return;
        }
        let opened = self.opened(model);
        let best = opened.and_then(|opened| opened.pass.report.causes.first());
        let found = opened.zip(best);
        let found = found.and_then(|(opened, best)| correction(model, &opened.pass, best));
        self.correction = Some(found.ok_or_else(|| no_correction(best)));
    }

    pub(super) fn list_more(&mut self) {
        self.query.count += PAGE;
    }

    /// Returns `true` if a dialog of this view is open.
    pub fn is_asking(&self) -> bool {
        self.days.is_some()
    }

    /// Returns `true` if the query excludes passes.
    pub(super) fn filters(&self) -> bool {
        let all = PassQuery { count: self.query.count, ..PassQuery::default() };
        self.query != all
    }

    /// Requests the data to show from the station, if the request has changed.
    pub(super) fn ask(&mut self, model: &Model, commands: &mut Vec<UiCommand>) {
        let look = RecordLook { query: self.query.clone(), opened: self.shown(model) };
        if self.record_look.as_ref() != Some(&look) {
            self.record_look = Some(look.clone());
            commands.push(UiCommand::Station(contract::Command::LookAtRecord(Some(look))));
        }
    }

    /// Ends the request to the station when another view opens.
    pub fn leave(&mut self, commands: &mut Vec<UiCommand>) {
        if self.record_look.take().is_some() {
            commands.push(UiCommand::Station(contract::Command::LookAtRecord(None)));
        }
    }

    /// Returns a title and a sentence about why there is no report.
    pub(super) fn why_nothing(model: &Model) -> (&'static str, String) {
        let Some(recorded) = &model.recorded else {
            return ("Record", "The record is being read.".to_owned());
        };
        match &recorded.found {
            Err(reason) => ("The record cannot be read", sentence(reason)),
            Ok(found) if found.page.passes.is_empty() && !found.missed.is_empty() => {
                ("No report", "A pass that was not tracked has no report.".to_owned())
            }
            Ok(found) if found.page.all == 0 => (
                "No pass is recorded yet",
                "The report of a pass appears here when an antenna has tracked it to its end."
                    .to_owned(),
            ),
            Ok(found) if found.page.passes.is_empty() => {
                ("No pass found", "Try another antenna, verdict or text.".to_owned())
            }
            Ok(_) => ("Record", "The pass is being read.".to_owned()),
        }
    }
}

/// Returns the reason why controls are locked that replay or change the record.
pub fn lock(model: &Model) -> Option<&'static str> {
    replay::lock(model).or(model.record.is_none().then_some("Nothing is recorded."))
}

pub(super) fn found(model: &Model) -> Option<&Found> {
    model.recorded.as_deref()?.found.as_ref().ok()
}
