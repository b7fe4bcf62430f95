//! Transfer of a target to the unit step by step, with a read-back of each step.

use crate::{
    device::{PrepareError, TrackTarget},
    protocol::satrak::{
        FaultKind, Query, Reply, Request, Satellite, SatelliteChoice, Setting, TextValue,
        TrackWindow,
    },
};

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Preparation {
    pub(super) target: TrackTarget,
    step: PrepareStep,
    /// The satellite in the unit's last answer.
    stored: Option<Satellite>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PrepareStep {
    /// Question for the file and satellite in use.
    AskSatellite,
    SetSatellite,
    ReadSatellite,
    /// Question for the faults, which explain why the unit did not take the satellite.
    AskFaults,
    SetWindow,
    ReadWindow,
}

/// Outcome of a step.
pub(super) enum Outcome {
    Onward,
    /// End of the preparation: the unit holds the target.
    Done,
}

impl Preparation {
    pub(super) fn new(target: TrackTarget) -> Self {
        Self { target, step: PrepareStep::AskSatellite, stored: None }
    }

    /// Returns the request of the current step. The unit takes satellites from the element file of
    /// the target, else from `element_file`, or from the file in use if that is empty.
    pub(super) fn request(&self, element_file: &str) -> Result<Request, PrepareError> {
        Ok(match self.step {
            PrepareStep::AskSatellite | PrepareStep::ReadSatellite => {
                Request::Query(Query::Satellite)
            }
            PrepareStep::AskFaults => Request::Query(Query::Faults),
            PrepareStep::ReadWindow => Request::Query(Query::StartStopTime),
            PrepareStep::SetWindow => Request::Setting(Setting::StartStopTime(self.window()?)),
            PrepareStep::SetSatellite => {
                let satellite = self.stored.as_ref().ok_or(PrepareError::Unanswered)?;
                let file = self.target.element_file.as_deref().unwrap_or(element_file);
                let file = if file.is_empty() { &satellite.file } else { file };
                if file.is_empty() {
                    return Err(PrepareError::NoElementFile);
                }
                let text = |field, text: &str| {
                    TextValue::new(field, text)
                        .map_err(|error| PrepareError::CannotBeSent(error.to_string()))
                };
                Request::Setting(Setting::Satellite(SatelliteChoice {
                    file: text("element file", file)?,
                    name: text("satellite name", &self.target.name)?,
                    period: u16::try_from(satellite.period).unwrap_or(1),
                    // The unit must not turn to another satellite before the gate allows it.
                    continue_tracking: false,
                }))
            }
        })
    }

    fn window(&self) -> Result<TrackWindow, PrepareError> {
        TrackWindow::new(self.target.start, self.target.end)
            .map_err(|error| PrepareError::CannotBeSent(error.to_string()))
    }

    /// Returns `true` if the unit has confirmed the target in this preparation.
    fn holds_target(&self) -> bool {
        self.stored.as_ref().is_some_and(|satellite| {
            satellite.catalog_number == self.target.catalog_number
                && satellite.name == self.target.name
        })
    }

    /// Takes an answer to the current step. Only answers count: earlier readings may describe
    /// another satellite.
    pub(super) fn answered(&mut self, reply: &Reply) -> Result<Outcome, PrepareError> {
        self.step = match (self.step, reply) {
            (PrepareStep::AskSatellite, Reply::Satellite(satellite)) => {
                self.stored = Some(satellite.clone());
                // The file may have new elements, which the unit reads only when `SATELLITE=` names
                // the file.
                let is_from_file = self.target.element_file.is_some();
                if !is_from_file && self.holds_target() {
                    PrepareStep::SetWindow
                } else {
                    PrepareStep::SetSatellite
                }
            }
            (PrepareStep::SetSatellite, Reply::Done) => PrepareStep::ReadSatellite,
            (PrepareStep::ReadSatellite, Reply::Satellite(current)) => {
                self.stored = Some(current.clone());
                // The name may be right even if the elements are missing.
                PrepareStep::AskFaults
            }
            (PrepareStep::AskFaults, Reply::Faults(faults)) => {
                let missing = [FaultKind::TleMissing, FaultKind::SatelliteMissing];
                let previous = self.stored.clone();
                if faults.active().any(|kind| missing.contains(&kind)) {
                    let file = previous.map(|satellite| satellite.file).unwrap_or_default();
                    return Err(PrepareError::NotOnDevice { file });
                }
                if !self.holds_target() {
                    let previous_name =
                        previous.map(|satellite| satellite.name).unwrap_or_default();
                    return Err(PrepareError::Differs { current: previous_name });
                }
                PrepareStep::SetWindow
            }
            (PrepareStep::SetWindow, Reply::Done) => PrepareStep::ReadWindow,
            (PrepareStep::ReadWindow, Reply::StartStopTime(read)) => {
                let sent = self.window()?;
                if read.start != sent.start() || read.stop != sent.stop() {
                    return Err(PrepareError::Differs {
                        current: format!("the window {} to {}", read.start, read.stop),
                    });
                }
                return Ok(Outcome::Done);
            }
            // Azel matches replies by their word, so no other answer can arrive here.
            _ => return Err(PrepareError::Unanswered),
        };
        Ok(Outcome::Onward)
    }
}
