//! Values that are checked when they are built.

/// Why a value cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ValueError {
    /// Outside the range.
    #[error("{what} {value} is not between {least} and {most}")]
    Range {
        /// What the number means, with its unit.
        what: &'static str,
        value: u64,
        least: u64,
        most: u64,
    },
    /// A controller would read the ten digits of the name as a position.
    #[error("a name of ten digits means a position")]
    NameIsPosition,
    /// No satellite has a name of blanks.
    #[error("the name is empty")]
    NoName,
}

/// `value`, when it lies between `least` and `most`.
pub(super) fn checked(
    what: &'static str,
    value: u64,
    least: u64,
    most: u64,
) -> Result<u64, ValueError> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(ValueError::Range { what, value, least, most })
    }
}
