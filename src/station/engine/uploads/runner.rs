//! Runner of an order's steps on threads of their own, with the order's progress.

use std::{sync::Arc, time::Duration};

use super::{
    Places,
    errand::{self, Report},
    flow::{Flow, Next},
    select::{Selection, UnitNow},
};
use crate::{
    clock::{Clock, Instant},
    contract::uploads::{Ask, KeptEntry, KeptFiles, Order, Stage, Uploads, Warning},
    engine::{host_keys, uploads::order::account},
    job::{Job, Wake},
    transfer::Transfer,
};

/// Timeout for the unit's answer. A session answers long before, also after a link loss; without an
/// answer, the operator gets a message.
const SELECTING: Duration = Duration::from_secs(90);

/// Request to the session of an antenna.
pub(in crate::engine) enum SessionRequest {
    /// End of tracking and auto-track.
    Rest,
    /// Use of a file.
    Use(Selection),
}

/// Runner of one order at a time.
pub(in crate::engine) struct Runner {
    places: Option<Places>,
    clock: Clock,
    wake: Wake,
    flow: Flow,
    transfer: Option<Transfer<Report>>,
    deciding: Option<Job<Result<(), String>>>,
    keeping: Option<Job<Result<(), String>>>,
    listing: Option<Job<KeptFiles>>,
    selecting_since: Option<Instant>,
}

impl Runner {
    pub(in crate::engine) fn new(places: Option<Places>, clock: Clock, wake: Wake) -> Self {
        Self {
            places,
            clock,
            wake,
            flow: Flow::default(),
            transfer: None,
            deciding: None,
            keeping: None,
            listing: None,
            selecting_since: None,
        }
    }

    /// Carries out a client's request. `unit_of` returns the state of an antenna's unit. Returns a
    /// request to the session of the shown antenna.
    pub(in crate::engine) fn ask(
        &mut self,
        ask: Ask,
        unit_of: impl Fn(&str) -> UnitNow,
        shown: &mut Uploads,
    ) -> Option<SessionRequest> {
        let next = match ask {
            Ask::Begin(order) => {
                let unit = unit_of(&order.antenna);
                self.flow.begin(*order, &unit, shown)
            }
            Ask::AgreeToTracking => self.flow.agree(&unit_of(&shown.antenna), shown),
            Ask::TrustHostKey => self.flow.trust(shown),
            Ask::ForgetHostKey => self.flow.forget_host(shown),
            Ask::Secret { secret, keep } => self.flow.type_secret(secret, keep, shown),
            Ask::Cancel => {
                if self.flow.cancel(shown)
                    && let Some(transfer) = &self.transfer
                {
                    transfer.cancel();
                }
                None
            }
            Ask::Dismiss => {
                if !shown.stage.is_open() {
                    shown.stage = Stage::Idle;
                }
                None
            }
            Ask::ListKept { unit, file } => {
                self.list(unit, file, shown);
                None
            }
        };
        self.carry_out(next, shown)
    }

    /// Returns the last order.
    pub(in crate::engine) fn order(&self) -> Option<&Order> {
        self.flow.order()
    }

    /// Ends the current order with the reason `text`. Leaves behind a thread that does not end.
    pub(in crate::engine) fn give_up(&mut self, text: String, shown: &mut Uploads) {
        self.transfer = None;
        self.flow.give_up(text, shown);
    }

    /// Notes that the operator has stopped the antennas.
    pub(in crate::engine) fn stopped(&mut self) {
        self.flow.stopped();
    }

    /// Collects results of finished jobs. Returns a request to the session of the shown antenna.
    pub(in crate::engine) fn poll(
        &mut self,
        unit: &UnitNow,
        steady: Instant,
        shown: &mut Uploads,
    ) -> Option<SessionRequest> {
        match Job::take(&mut self.listing) {
            Some(Ok(kept_files)) => shown.kept_files = kept_files,
            Some(Err(broke_off)) => shown.kept_files.list = Some(Err(broke_off.to_string())),
            None => {}
        }
        if let Some(Err(problem)) = take(&mut self.keeping) {
            shown.warnings.push(Warning::NotKept(problem));
        }
        self.watch_selection(unit, steady, shown);
        let decided = take(&mut self.deciding).and_then(|result| self.flow.decided(result, shown));
        let reported = self.poll_transfer(unit, shown);
        let next = decided.or(reported).or_else(|| self.flow.rested(unit));
        self.carry_out(next, shown)
    }

    fn poll_transfer(&mut self, unit: &UnitNow, shown: &mut Uploads) -> Option<Next> {
        let transfer = self.transfer.as_ref()?;
        if let Stage::Working { progress, .. } = &mut shown.stage {
            *progress = transfer.progress();
        }
        let report = match transfer.poll()? {
            Ok(report) => report,
            Err(broken) => Report::failed(broken.to_string()),
        };
        self.transfer = None;
        if report.is_logged_in
            && let Some(secret) = self.flow.secret_to_keep()
            && let Some((places, order)) = self.places.as_ref().zip(self.flow.order())
        {
            let wake = Arc::clone(&self.wake);
            self.keeping = Some(errand::keep_secret(places, account(order), secret, wake));
        }
        let next = self.flow.reported(report, unit, shown);
        let origin = shown.kept_files.origin.clone();
        if !origin.1.is_empty() {
            self.list(origin.0, origin.1, shown);
        }
        next
    }

    fn watch_selection(&mut self, unit: &UnitNow, steady: Instant, shown: &mut Uploads) {
        if !matches!(shown.stage, Stage::Selecting(_)) {
            self.selecting_since = None;
            return;
        }
        let start = *self.selecting_since.get_or_insert(steady);
        self.flow.answered(unit, shown);
        let is_open = matches!(shown.stage, Stage::Selecting(_));
        if is_open && steady.saturating_duration_since(start) > SELECTING {
            self.not_selected("the unit did not say whether it uses the file".to_owned(), shown);
        }
    }

    /// Ends the order with the reason `text`, because the unit cannot use the file.
    pub(in crate::engine) fn not_selected(&mut self, text: String, shown: &mut Uploads) {
        self.flow.selected(Err(text), self.clock.utc(), shown);
    }

    fn carry_out(&mut self, next: Option<Next>, shown: &mut Uploads) -> Option<SessionRequest> {
        let next = next?;
        let Some(places) = &self.places else {
            let text = "this user has no folder for data".to_owned();
            return self.end_early(text, shown);
        };
        let wake = Arc::clone(&self.wake);
        match next {
            Next::Rest => return Some(SessionRequest::Rest),
            Next::Select(selection) => return Some(SessionRequest::Use(selection)),
            Next::Run(errand) => match errand::start(*errand, places, &self.clock, wake) {
                Ok(transfer) => self.transfer = Some(transfer),
                Err(error) => {
                    return self.end_early(format!("no thread for the upload: {error}"), shown);
                }
            },
            Next::Decide(decision) => {
                self.deciding = Some(host_keys::decide(&places.known_hosts, decision, wake));
            }
        }
        None
    }

    fn end_early(&mut self, text: String, shown: &mut Uploads) -> Option<SessionRequest> {
        let unit = UnitNow::default();
        // A failure has no next step.
        let _ = self.flow.reported(Report::failed(text), &unit, shown);
        None
    }

    fn list(&mut self, unit: String, file: String, shown: &mut Uploads) {
        let origin = (unit, file);
        if shown.kept_files.origin != origin {
            shown.kept_files = KeptFiles { origin: origin.clone(), list: None };
        }
        let Some(places) = &self.places else { return };
        let kept_files = places.kept_files.clone();
        self.listing = Some(Job::start("azel-kept-uploads", Arc::clone(&self.wake), move |_| {
            let (unit, file) = &origin;
            let list = kept_files.list(unit, file).map_err(|error| error.to_string());
            let entry = |file| {
                let objects = kept_files.read(&file).map(|content| content.objects().to_vec());
                KeptEntry { file, objects: objects.map_err(|error| error.to_string()) }
            };
            let list = list.map(|files| files.into_iter().map(entry).collect());
            KeptFiles { origin, list: Some(list) }
        }));
    }
}

/// Returns the result of a finished `job`.
fn take(job: &mut Option<Job<Result<(), String>>>) -> Option<Result<(), String>> {
    Job::take(job).map(|end| end.unwrap_or_else(|broke_off| Err(broke_off.to_string())))
}
