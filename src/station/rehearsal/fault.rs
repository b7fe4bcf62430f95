//! Faults that the operator adds to a rehearsal.

use std::{str::FromStr, time::Duration};

use crate::sim::Trouble;

/// Fault of one unit or of all units, for a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    pub kind: FaultKind,
    /// Name of the antenna; `None` for all antennas.
    pub antenna: Option<String>,
    /// Time from the start of the rehearsal to the fault.
    pub after: Duration,
    /// Duration; `None` for the rest of the rehearsal.
    pub lasts: Option<Duration>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FaultKind {
    /// The link breaks and cannot be opened again.
    LinkLost,
    /// The unit loses power: it stops and does not answer. Once powered again, it stays at rest.
    PowerCut,
    OfUnit(Trouble),
}

/// Reason why a text is not a valid fault.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WrongFault {
    #[error(
        "{0} is no fault; there are link-lost, power-cut, silence, noise, refusal, slow-drives=SHARE, \
         clock-late=MS, track-late=MS, clock-drift=S and late-replies=MS"
    )]
    Kind(String),
    #[error("{0} says nothing of a fault; there are antenna=NAME, after=MIN and for=S")]
    Word(String),
    #[error("{0} is no number that fits")]
    Number(String),
}

/// Parses for example `link-lost,antenna=Dish,after=30,for=90`. The kind comes first; `after` is in
/// minutes, `for` in seconds.
impl FromStr for Fault {
    type Err = WrongFault;

    fn from_str(text: &str) -> Result<Self, WrongFault> {
        let mut words = text.split(',').map(str::trim);
        let kind = kind(words.next().unwrap_or_default())?;
        let mut fault = Self { kind, antenna: None, after: Duration::ZERO, lasts: None };
        for word in words {
            let wrong = || WrongFault::Word(word.to_owned());
            let (key, value) = word.split_once('=').ok_or_else(wrong)?;
            match key {
                "antenna" => fault.antenna = Some(value.to_owned()),
                "after" => fault.after = span(value, 60.0)?,
                "for" => fault.lasts = Some(span(value, 1.0)?),
                _ => return Err(wrong()),
            }
        }
        Ok(fault)
    }
}

fn kind(word: &str) -> Result<FaultKind, WrongFault> {
    let trouble = match word.split_once('=') {
        Some(("slow-drives", share)) => {
            let number = number(share)?;
            if number > 1.0 {
                return Err(WrongFault::Number(share.to_owned()));
            }
            Trouble::SlowDrives([number; 2])
        }
        Some(("clock-late", ms)) => Trouble::ClockLate(span(ms, 0.001)?),
        Some(("track-late", ms)) => Trouble::TrackLate(span(ms, 0.001)?),
        Some(("clock-drift", gains_s_day)) => {
            let number = gains_s_day.parse().ok().filter(|number: &f64| number.is_finite());
            let wrong = || WrongFault::Number(gains_s_day.to_owned());
            Trouble::ClockDrifts(number.ok_or_else(wrong)?)
        }
        Some(("late-replies", ms)) => Trouble::LateReplies(span(ms, 0.001)?),
        None if word == "link-lost" => return Ok(FaultKind::LinkLost),
        None if word == "power-cut" => return Ok(FaultKind::PowerCut),
        None if word == "silence" => Trouble::Silence,
        None if word == "noise" => Trouble::Noise,
        None if word == "refusal" => Trouble::Refusal,
        _ => return Err(WrongFault::Kind(word.to_owned())),
    };
    Ok(FaultKind::OfUnit(trouble))
}

/// Parses a finite number that is not negative.
fn number(text: &str) -> Result<f64, WrongFault> {
    let number = text.parse::<f64>().ok().filter(|number| *number >= 0.0 && number.is_finite());
    number.ok_or_else(|| WrongFault::Number(text.to_owned()))
}

/// Parses a duration in units of `unit_s` seconds.
fn span(text: &str, unit_s: f64) -> Result<Duration, WrongFault> {
    Duration::try_from_secs_f64(number(text)? * unit_s)
        .map_err(|_| WrongFault::Number(text.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_read_with_its_antenna_and_times() {
        let read: Fault = "link-lost,antenna=Dish 2,after=30,for=90".parse().unwrap();
        assert_eq!(
            read,
            Fault {
                kind: FaultKind::LinkLost,
                antenna: Some("Dish 2".to_owned()),
                after: Duration::from_mins(30),
                lasts: Some(Duration::from_secs(90)),
            }
        );
        let kind = |text: &str| text.parse::<Fault>().map(|fault| fault.kind);
        let late = Trouble::ClockLate(Duration::from_millis(250));
        assert_eq!(kind("clock-late=250"), Ok(FaultKind::OfUnit(late)));
        let late = Trouble::TrackLate(Duration::from_millis(250));
        assert_eq!(kind("track-late=250"), Ok(FaultKind::OfUnit(late)));
        let late = Trouble::LateReplies(Duration::from_millis(250));
        assert_eq!(kind("late-replies=250"), Ok(FaultKind::OfUnit(late)));
        assert_eq!(kind("clock-drift=-4.5"), Ok(FaultKind::OfUnit(Trouble::ClockDrifts(-4.5))));
        assert_eq!(kind("power-cut"), Ok(FaultKind::PowerCut));
        assert_eq!(kind("slow-drives=0.5"), Ok(FaultKind::OfUnit(Trouble::SlowDrives([0.5; 2]))));
        for (text, trouble) in [
            ("silence", Trouble::Silence),
            ("noise", Trouble::Noise),
            ("refusal", Trouble::Refusal),
        ] {
            assert_eq!(kind(text), Ok(FaultKind::OfUnit(trouble)));
        }
    }

    #[test]
    fn what_is_no_fault_is_named() {
        let wrong = |text: &str| text.parse::<Fault>().unwrap_err();
        assert_eq!(wrong("fire"), WrongFault::Kind("fire".to_owned()));
        assert_eq!(wrong("noise=3"), WrongFault::Kind("noise=3".to_owned()));
        assert_eq!(wrong("noise,when=3"), WrongFault::Word("when=3".to_owned()));
        assert_eq!(wrong("noise,for"), WrongFault::Word("for".to_owned()));
        for text in [
            "slow-drives=1.5",
            "slow-drives=-1",
            "clock-late=x",
            "clock-drift=nan",
            "noise,for=inf",
        ] {
            assert!(matches!(wrong(text), WrongFault::Number(_)), "{text}");
        }
    }
}
