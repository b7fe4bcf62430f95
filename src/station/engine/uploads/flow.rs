//! State machine of an order, from the operator's request to the unit's report. It has no threads
//! and no clock; the runner carries out the returned steps.

use jiff::Timestamp;

use super::{
    errand::{Errand, Outcome, Report},
    select::{Selection, TICKETS, UnitNow, pick},
};
use crate::{
    contract::{
        transfer::Uploaded,
        uploads::{Cargo, Failure, Order, Proved, SecretWanted, Stage, Uploads, Warning},
    },
    engine::{
        host_keys::{Decision, doubtful},
        uploads::order::account,
    },
    secret::Secret,
    transfer::OfferedKey,
};

/// Reason why an unattended order ends.
const IN_USE: &str = "the antenna is in use or automatic operation is off";

/// Next step of an order.
pub(super) enum Next {
    /// Run of this attempt.
    Run(Box<Errand>),
    /// Operator's decision about a host key, to carry out.
    Decide(Decision),
    /// End of the unit's tracking and auto-track. The gate permits settings that affect the
    /// pointing only at rest.
    Rest,
    /// Use of this file by the unit.
    Select(Selection),
}

/// State of one order.
#[derive(Default)]
pub(super) struct Flow {
    order: Option<Order>,
    secret: Option<Secret>,
    /// `true` to save the secret after a successful log-in.
    keeps: bool,
    /// Reason why the keyring could not be read; Azel asks it once.
    keyring_problem: Option<String>,
    offered: Option<Box<OfferedKey>>,
    /// `true` if the unit's tracking may end.
    is_agreed: bool,
    /// Upload that is on the unit but not in use yet.
    uploaded: Option<Box<Uploaded>>,
    selection: Option<Selection>,
    /// `true` while the selection waits until the unit is at rest.
    awaits_rest: bool,
    selections: u64,
}

impl Flow {
    pub(super) fn order(&self) -> Option<&Order> {
        self.order.as_ref()
    }

    /// Returns `true` if no operator answers questions about the order.
    pub(super) fn is_unattended(&self) -> bool {
        self.order.as_ref().is_some_and(|order| order.is_unattended)
    }

    pub(super) fn begin(
        &mut self,
        order: Order,
        unit: &UnitNow,
        shown: &mut Uploads,
    ) -> Option<Next> {
        if shown.stage.is_open() {
            return None;
        }
        shown.antenna.clone_from(&order.antenna);
        shown.is_roll_back = matches!(order.cargo, Cargo::Kept(_));
        shown.warnings.clear();
        *self = Self { order: Some(order), selections: self.selections, ..Self::default() };
        if let Some(reason) = &unit.locked_out {
            let text =
                format!("nothing was sent, the unit is in maintenance, locked out by {reason}");
            fail(shown, text);
            return None;
        }
        if self.is_unattended() && !unit.is_free() {
            fail(shown, format!("nothing was sent, because {IN_USE}"));
            return None;
        }
        if let Some(busy) = unit.busy {
            shown.stage = Stage::AsksAboutTracking(busy);
            return None;
        }
        self.run(shown)
    }

    fn run(&self, shown: &mut Uploads) -> Option<Next> {
        let order = self.order.clone()?;
        shown.stage = Stage::Working { progress: None, is_cancelled: false };
        Some(Next::Run(Box::new(Errand { order, secret: self.secret.clone() })))
    }

    pub(super) fn agree(&mut self, unit: &UnitNow, shown: &mut Uploads) -> Option<Next> {
        if !matches!(shown.stage, Stage::AsksAboutTracking(_)) {
            return None;
        }
        self.is_agreed = true;
        match self.uploaded.take() {
            Some(uploaded) => self.select(uploaded, unit, shown),
            None => self.run(shown),
        }
    }

    /// Withdraws the operator's agreement after a STOP: tracking may not end or begin without a new
    /// question.
    pub(super) fn stopped(&mut self) {
        self.is_agreed = false;
    }

    pub(super) fn trust(&mut self, shown: &mut Uploads) -> Option<Next> {
        if !matches!(shown.stage, Stage::AsksAboutHostKey(_)) {
            return None;
        }
        let offered = self.offered.take()?;
        shown.stage = Stage::Working { progress: None, is_cancelled: false };
        Some(Next::Decide(Decision::Trust(offered)))
    }

    /// Forgets the host's keys; the order then restarts and asks about the new key.
    pub(super) fn forget_host(&mut self, shown: &mut Uploads) -> Option<Next> {
        let Stage::Failed(Failure { changed_key: Some(_), .. }) = &shown.stage else { return None };
        let peer = self.order.as_ref()?.unit.clone();
        shown.stage = Stage::Working { progress: None, is_cancelled: false };
        Some(Next::Decide(Decision::Forget(peer)))
    }

    pub(super) fn decided(
        &mut self,
        result: Result<(), String>,
        shown: &mut Uploads,
    ) -> Option<Next> {
        let is_cancelled = matches!(shown.stage, Stage::Working { is_cancelled: true, .. });
        match result {
            Err(text) => fail(shown, text),
            Ok(()) if is_cancelled => cancelled(shown, "nothing was changed on the unit"),
            Ok(()) => return self.run(shown),
        }
        None
    }

    pub(super) fn type_secret(
        &mut self,
        secret: Secret,
        keep: bool,
        shown: &mut Uploads,
    ) -> Option<Next> {
        if !matches!(shown.stage, Stage::AsksForSecret(_)) {
            return None;
        }
        (self.secret, self.keeps) = (Some(secret), keep);
        self.run(shown)
    }

    /// Returns the secret to store in the keyring, once.
    pub(super) fn secret_to_keep(&mut self) -> Option<Secret> {
        std::mem::take(&mut self.keeps).then(|| self.secret.clone()).flatten()
    }

    /// Ends an order that takes too long.
    pub(super) fn give_up(&mut self, text: String, shown: &mut Uploads) {
        *self = Self { selections: self.selections, ..Self::default() };
        fail(shown, text);
    }

    /// Cancels the order. Returns `true` if the current work must be cancelled too.
    pub(super) fn cancel(&mut self, shown: &mut Uploads) -> bool {
        let can_cancel = shown.stage.can_cancel();
        match &mut shown.stage {
            Stage::Working { is_cancelled, .. } if can_cancel => {
                *is_cancelled = true;
                return true;
            }
            Stage::AsksAboutTracking(_) => {
                let uploaded = self.uploaded.take();
                let state = if uploaded.is_some() {
                    "the file is on the unit, which was not told to use it"
                } else {
                    "nothing was changed on the unit"
                };
                cancelled(shown, state);
                if let Stage::Failed(failure) = &mut shown.stage {
                    failure.uploaded = uploaded;
                }
            }
            Stage::AsksAboutHostKey(_) | Stage::AsksForSecret(_) => {
                cancelled(shown, "nothing was changed on the unit");
            }
            _ => {}
        }
        false
    }

    pub(super) fn reported(
        &mut self,
        report: Report,
        unit: &UnitNow,
        shown: &mut Uploads,
    ) -> Option<Next> {
        self.keyring_problem = report.keyring_problem.or(self.keyring_problem.take());
        if report.is_factory && !shown.warnings.contains(&Warning::FactoryPassword) {
            shown.warnings.push(Warning::FactoryPassword);
        }
        if !report.old_algorithms.is_empty() {
            // An order makes two connections: the host check before a password, and the upload.
            shown.warnings.retain(|warning| !matches!(warning, Warning::OldAlgorithms(_)));
            shown.warnings.push(Warning::OldAlgorithms(report.old_algorithms));
        }
        match report.outcome {
            Outcome::Uploaded(uploaded) => return self.use_file(uploaded, unit, shown),
            Outcome::HostKey(error) => {
                let text = error.to_string();
                match doubtful(error) {
                    Ok((_, key)) if key.is_changed() => {
                        let changed_key = Some(key);
                        let failure = Failure { text, changed_key, ..Failure::default() };
                        shown.stage = Stage::Failed(failure);
                    }
                    Ok(_) if self.is_unattended() => fail(shown, text),
                    Ok((offered, key)) => {
                        self.offered = Some(offered);
                        shown.stage = Stage::AsksAboutHostKey(key);
                    }
                    Err(error) => fail(shown, error.to_string()),
                }
            }
            Outcome::Secret { refused } => {
                self.secret = None;
                let order = self.order.as_ref()?;
                if order.is_unattended {
                    let missing = || match self.keyring_problem.take() {
                        Some(problem) => format!("the keyring gave no password: {problem}"),
                        None => "no password or passphrase is in the keyring".to_owned(),
                    };
                    let text = refused.map(|reason| format!("the log-in failed: {reason}"));
                    fail(shown, text.unwrap_or_else(missing));
                    return None;
                }
                let account = account(order);
                shown.stage = Stage::AsksForSecret(SecretWanted {
                    user: account.user,
                    address: account.address,
                    is_passphrase: order.key_file.is_some(),
                    refused,
                    keyring_problem: self.keyring_problem.clone(),
                });
            }
            Outcome::Cancelled(state) => cancelled(shown, &state),
            Outcome::Failed(text) => fail(shown, text),
        }
        None
    }

    /// Makes the unit use the file. Checks the unit's state only now, because tracking may have
    /// begun during the upload.
    fn use_file(
        &mut self,
        uploaded: Box<Uploaded>,
        unit: &UnitNow,
        shown: &mut Uploads,
    ) -> Option<Next> {
        if self.is_unattended() && !unit.is_free() {
            let text = format!("the file is on the unit but not in use yet, because {IN_USE}");
            fail_after(shown, text, uploaded);
            return None;
        }
        if let Some(busy) = unit.busy.filter(|_| !self.is_agreed) {
            self.uploaded = Some(uploaded);
            shown.stage = Stage::AsksAboutTracking(busy);
            return None;
        }
        self.select(uploaded, unit, shown)
    }

    fn select(
        &mut self,
        uploaded: Box<Uploaded>,
        unit: &UnitNow,
        shown: &mut Uploads,
    ) -> Option<Next> {
        let order = self.order.as_ref()?;
        let (requested, takes) = (order.satellite, order.takes);
        let Some(satellite) = pick(&uploaded, requested, unit.current).cloned() else {
            fail_after(shown, "the file holds no elements that Azel can read".to_owned(), uploaded);
            return None;
        };
        self.selections += 1;
        let ticket = TICKETS + self.selections;
        let file = uploaded.file.as_str().to_owned();
        let selection = Selection { ticket, takes, start: unit.time, file, satellite };
        self.selection = Some(selection.clone());
        shown.stage = Stage::Selecting(uploaded);
        self.awaits_rest = unit.busy.is_some();
        Some(if self.awaits_rest { Next::Rest } else { Next::Select(selection) })
    }

    /// Continues once the unit is at rest.
    pub(super) fn rested(&mut self, unit: &UnitNow) -> Option<Next> {
        self.awaits_rest &= self.selection.is_some();
        if !self.awaits_rest || unit.hindrance.is_some() {
            return None;
        }
        self.awaits_rest = false;
        self.selection.clone().map(Next::Select)
    }

    /// Handles the unit's answer, if it has arrived.
    pub(super) fn answered(&mut self, unit: &UnitNow, shown: &mut Uploads) {
        let selection = self.selection.as_ref();
        let end = selection.zip(unit.answer.as_ref()).and_then(|(one, answer)| one.end(answer));
        if let Some((time, result)) = end {
            self.selected(result, time, shown);
        }
    }

    /// Handles the result of the selection.
    pub(super) fn selected(
        &mut self,
        result: Result<(), String>,
        time: Timestamp,
        shown: &mut Uploads,
    ) {
        let Some(selection) = self.selection.take() else { return };
        let Stage::Selecting(uploaded) = std::mem::take(&mut shown.stage) else { return };
        match result {
            Ok(()) => {
                let satellite = selection.satellite;
                shown.stage =
                    Stage::Proved(Box::new(Proved { uploaded: *uploaded, satellite, time }));
            }
            Err(text) => fail_after(shown, text, uploaded),
        }
    }
}

fn fail(shown: &mut Uploads, text: String) {
    shown.stage = Stage::Failed(Failure { text, ..Failure::default() });
}

fn fail_after(shown: &mut Uploads, text: String, uploaded: Box<Uploaded>) {
    let uploaded = Some(uploaded);
    shown.stage = Stage::Failed(Failure { text, uploaded, ..Failure::default() });
}

fn cancelled(shown: &mut Uploads, state: &str) {
    let text = format!("cancelled; {state}");
    shown.stage = Stage::Failed(Failure { text, is_cancel: true, ..Failure::default() });
}

#[cfg(test)]
mod tests;
