//! One simulated unit of any make.

use azel::{
    clock::Instant,
    driver::Stream,
    protocol::satrak::encode,
    sim::{rc2000c, rotator_genius, satrak},
    station::CountLine,
};
use tokio::io::{AsyncReadExt, AsyncWriteExt};

use crate::common::network;

/// A simulated unit of one make.
#[derive(Clone)]
pub(super) enum Unit {
    Satrak(satrak::Control),
    Genius(rotator_genius::Control),
    Rc2000c(rc2000c::Control, [CountLine; 2]),
}

/// What a unit tells wrongly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lie {
    FrozenAngles,
    FalseRest,
}

impl Unit {
    /// Where both axes truly stand, degrees as the mount counts.
    pub(super) fn axes_deg(&self) -> [f64; 2] {
        match self {
            Self::Satrak(control) => control.state().metal_deg,
            Self::Genius(control) => control.state().rotators.map(|rotator| rotator.angle_deg),
            Self::Rc2000c(control, lines) => {
                let state = control.state();
                [lines[0].degrees(state.az_counts), lines[1].degrees(state.el_counts)]
            }
        }
    }

    pub(super) fn is_turning(&self) -> bool {
        match self {
            Self::Satrak(control) => control.state().is_moving,
            Self::Genius(control) => control.state().rotators.iter().any(|it| it.is_turning),
            Self::Rc2000c(control, _) => control.state().is_turning,
        }
    }

    pub(super) fn tell(&self, lie: Lie) {
        match (self, lie) {
            (Self::Satrak(it), Lie::FrozenAngles) => {
                it.set_fault(satrak::Fault::FrozenAngles, true);
            }
            (Self::Satrak(it), Lie::FalseRest) => it.set_fault(satrak::Fault::FalseRest, true),
            (Self::Genius(it), Lie::FrozenAngles) => {
                it.set_fault(rotator_genius::Fault::FrozenAngles, true);
            }
            (Self::Genius(it), Lie::FalseRest) => {
                it.set_fault(rotator_genius::Fault::FalseRest, true);
            }
            (Self::Rc2000c(it, _), Lie::FrozenAngles) => {
                it.set_fault(rc2000c::Fault::FrozenAngles, true);
            }
            (Self::Rc2000c(it, _), Lie::FalseRest) => it.set_fault(rc2000c::Fault::FalseRest, true),
        }
    }

    /// A link that it serves.
    pub(super) fn link(&self) -> Box<dyn Stream> {
        match self {
            Self::Satrak(control) => network::link(control),
            Self::Genius(control) => network::link(control),
            Self::Rc2000c(control, _) => network::link(control),
        }
    }

    /// Closes every link.
    pub(super) fn drop_clients(&self) {
        match self {
            Self::Satrak(control) => control.drop_clients(),
            Self::Genius(control) => control.drop_clients(),
            Self::Rc2000c(control, _) => control.drop_clients(),
        }
    }

    /// What it has received since `from`, in order: a STOP, a question or anything
    /// else.
    pub(super) fn words_since(&self, from: Instant) -> Vec<(Instant, Word)> {
        let text: Vec<(Instant, String)> = match self {
            Self::Satrak(control) => control.received(),
            Self::Genius(control) => control.received(),
            Self::Rc2000c(control, _) => {
                let frames = control.received().into_iter();
                let text = |frame: &azel::protocol::rc2000c::Frame| {
                    let data = String::from_utf8_lossy(frame.data());
                    format!("{}{data}", char::from(frame.code()))
                };
                frames.map(|(at, frame)| (at, text(&frame))).collect()
            }
        };
        let word = |text: &str| match self {
            Self::Satrak(_) if text.starts_with("STOP=") || text.starts_with("TRACK=,0") => {
                Word::Stop
            }
            Self::Satrak(_) if !text.contains('=') => Word::Question,
            Self::Satrak(_)
                if ["GOTO=", "MOVE=", "STEP=", "TRACK="]
                    .iter()
                    .any(|word| text.starts_with(word)) =>
            {
                Word::Motion
            }
            Self::Genius(_) if text == "|S" => Word::Stop,
            Self::Genius(_) if text == "|h" => Word::Question,
            Self::Genius(_) if ["|A", "|P", "|M"].iter().any(|word| text.starts_with(word)) => {
                Word::Motion
            }
            Self::Rc2000c(..) if text.starts_with("3X") => Word::Stop,
            Self::Rc2000c(..) if text.starts_with(['0', '1', '5']) => Word::Question,
            Self::Rc2000c(..) if text.starts_with(['2', '3']) => Word::Motion,
            _ => Word::Other,
        };
        text.into_iter().filter(|(at, _)| *at >= from).map(|(at, it)| (at, word(&it))).collect()
    }

    /// Whether a jog goes on until the unit is told otherwise.
    pub(super) fn jogs_run_on(&self) -> bool {
        !matches!(self, Self::Rc2000c(..))
    }

    /// Another client turns one axis; `false` where none can.
    pub(super) async fn other_client_turns(&self, axis: usize, rate_deg_s: f64) -> bool {
        let bytes = match self {
            Self::Satrak(_) => {
                let rate = format!("{rate_deg_s:.2}");
                let rates = if axis == 0 { [rate.as_str(), "0"] } else { ["0", rate.as_str()] };
                encode(&format!("MOVE=,{},{}", rates[0], rates[1]))
            }
            Self::Genius(_) => {
                let way = if rate_deg_s > 0.0 { 'P' } else { 'M' };
                format!("|{way}{}", axis + 1).into_bytes()
            }
            Self::Rc2000c(..) => return false,
        };
        let mut near = self.link();
        near.write_all(&bytes).await.unwrap();
        let mut answer = [0; 64];
        drop(near.read(&mut answer).await);
        true
    }
}

/// What a unit received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    Stop,
    Question,
    /// Metal is to move.
    Motion,
    Other,
}
