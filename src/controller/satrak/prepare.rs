//! Puts a target on the unit, step by step, each one read back.

use crate::{
    device::{PrepareError, TrackTarget},
    protocol::satrak::{
        FaultKind, Query, Reply, Request, Satellite, SatelliteChoice, Setting, TextValue,
        TrackWindow,
    },
};

/// A target on its way to the unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Preparation {
    pub(super) target: TrackTarget,
    step: Step,
    /// The satellite that the unit named last in answer to this.
    held: Option<Satellite>,
}

/// What is to be sent next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// Which file and satellite does the unit use now?
    AskSatellite,
    SetSatellite,
    ReadSatellite,
    /// Why did it not take the satellite?
    AskFaults,
    SetWindow,
    ReadWindow,
}

/// How a step ended.
pub(super) enum Outcome {
    /// The next step is to be sent.
    Onward,
    /// The unit holds the target.
    Done,
}

impl Preparation {
    pub(super) fn new(target: TrackTarget) -> Self {
        Self { target, step: Step::AskSatellite, held: None }
    }

    /// The request of the present step. Satellites are chosen from
    /// `element_file`; empty for the file that the unit uses already.
    pub(super) fn request(&self, element_file: &str) -> Result<Request, PrepareError> {
        Ok(match self.step {
            Step::AskSatellite | Step::ReadSatellite => Request::Query(Query::Satellite),
            Step::AskFaults => Request::Query(Query::Faults),
            Step::ReadWindow => Request::Query(Query::StartStopTime),
            Step::SetWindow => Request::Setting(Setting::StartStopTime(self.window()?)),
            Step::SetSatellite => {
                let held = self.held.as_ref().ok_or(PrepareError::Unanswered)?;
                let file = if element_file.is_empty() { &held.file } else { element_file };
                if file.is_empty() {
                    return Err(PrepareError::NoElementFile);
                }
                let text = |what, text: &str| {
                    TextValue::new(what, text)
                        .map_err(|error| PrepareError::CannotBeSent(error.to_string()))
                };
                Request::Setting(Setting::Satellite(SatelliteChoice {
                    file: text("element file", file)?,
                    name: text("satellite name", &self.target.name)?,
                    period: u16::try_from(held.period).unwrap_or(1),
                    // The unit must not swing over to another satellite before
                    // the gate has said so.
                    continue_tracking: false,
                }))
            }
        })
    }

    fn window(&self) -> Result<TrackWindow, PrepareError> {
        TrackWindow::new(self.target.from, self.target.until)
            .map_err(|error| PrepareError::CannotBeSent(error.to_string()))
    }

    /// Whether the unit said on this very way that it holds the target.
    fn holds_target(&self) -> bool {
        self.held.as_ref().is_some_and(|held| {
            held.catalog_number == self.target.catalog_number && held.name == self.target.name
        })
    }

    /// The present step was answered. Only what is said in answer counts: what
    /// was read before may be about another satellite.
    pub(super) fn answered(&mut self, reply: &Reply) -> Result<Outcome, PrepareError> {
        self.step = match (self.step, reply) {
            (Step::AskSatellite, Reply::Satellite(held)) => {
                self.held = Some(held.clone());
                if self.holds_target() { Step::SetWindow } else { Step::SetSatellite }
            }
            (Step::SetSatellite, Reply::Done) => Step::ReadSatellite,
            (Step::ReadSatellite, Reply::Satellite(held)) => {
                self.held = Some(held.clone());
                // The name may be right and the elements missing all the same.
                Step::AskFaults
            }
            (Step::AskFaults, Reply::Faults(faults)) => {
                let missing = [FaultKind::TleMissing, FaultKind::SatelliteMissing];
                let held = self.held.clone();
                if faults.active().any(|kind| missing.contains(&kind)) {
                    let file = held.map(|held| held.file).unwrap_or_default();
                    return Err(PrepareError::NotOnDevice { file });
                }
                if !self.holds_target() {
                    let held = held.map(|held| held.name).unwrap_or_default();
                    return Err(PrepareError::Differs { held });
                }
                Step::SetWindow
            }
            (Step::SetWindow, Reply::Done) => Step::ReadWindow,
            (Step::ReadWindow, Reply::StartStopTime(read)) => {
                let sent = self.window()?;
                if read.start != sent.start() || read.stop != sent.stop() {
                    return Err(PrepareError::Differs {
                        held: format!("the window {} to {}", read.start, read.stop),
                    });
                }
                return Ok(Outcome::Done);
            }
            // Matched by its word, so the answer to something else cannot come.
            _ => return Err(PrepareError::Unanswered),
        };
        Ok(Outcome::Onward)
    }
}
