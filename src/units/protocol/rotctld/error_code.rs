//! Codes of `RPRT`: 0 for success, negative for an error.

use std::fmt;

/// An error that a server answers or a client reads; the number in `RPRT -1` without its sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ErrorCode(i32);

impl ErrorCode {
    /// A parameter that is not a number, or is outside the range of the antenna.
    // Hamlib uses -21 for a limit since 4.6, but SDRangel 7 looks up the text in a list of 18.
    pub const INVALID: Self = Self(1);
    /// A command that the server does not know.
    pub const NOT_IMPLEMENTED: Self = Self(4);
    /// A missing current position.
    pub const TIMED_OUT: Self = Self(5);
    /// A rotator that does not answer the server.
    pub const IO: Self = Self(6);
    /// A motion that this client may not start now.
    pub const REJECTED: Self = Self(9);
    /// A function that the antenna does not have.
    pub const NOT_AVAILABLE: Self = Self(11);

    /// Returns the code of the number after `RPRT`; `None` for success.
    pub const fn from_report(number: i32) -> Option<Self> {
        match number.checked_abs() {
            Some(0) => None,
            Some(code) => Some(Self(code)),
            None => Some(Self(i32::MAX)),
        }
    }

    /// Returns the number after `RPRT`, negative.
    pub const fn report(self) -> i32 {
        -self.0
    }

    /// Returns the meaning according to Hamlib's list.
    const fn meaning(self) -> Option<&'static str> {
        Some(match self.0 {
            1 => "invalid parameter",
            2 => "invalid configuration",
            3 => "out of memory",
            4 => "not implemented",
            5 => "timed out",
            6 => "I/O error",
            7 => "internal error",
            8 => "protocol error",
            9 => "rejected",
            10 => "truncated",
            11 => "not available",
            12 => "VFO not targetable",
            13 => "bus error",
            14 => "bus busy",
            15 => "invalid argument",
            16 => "invalid VFO",
            17 => "out of domain",
            18 => "deprecated",
            19 => "security error",
            20 => "power off",
            21 => "limit exceeded",
            22 => "access denied",
            _ => return None,
        })
    }
}

impl fmt::Display for ErrorCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.meaning() {
            Some(meaning) => write!(f, "{meaning} ({})", self.report()),
            None => write!(f, "error {}", self.report()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_of_zero_is_no_error() {
        assert_eq!(ErrorCode::from_report(0), None);
        assert_eq!(ErrorCode::from_report(-9), Some(ErrorCode::REJECTED));
        // Some releases of Hamlib omitted the sign.
        assert_eq!(ErrorCode::from_report(9), Some(ErrorCode::REJECTED));
        assert_eq!(ErrorCode::from_report(i32::MIN).unwrap().report(), -i32::MAX);
    }

    #[test]
    fn an_error_has_words_and_number() {
        assert_eq!(ErrorCode::REJECTED.to_string(), "rejected (-9)");
        assert_eq!(ErrorCode::from_report(-77).unwrap().to_string(), "error -77");
    }
}
