//! Checks of values at their construction.

/// Reason why a value cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ValueError {
    #[error("{name} {value} is not between {min} and {max}")]
    Range {
        /// Meaning of the number, with its unit.
        name: &'static str,
        value: u64,
        min: u64,
        max: u64,
    },
    /// A name of ten digits, which a unit would read as a position.
    #[error("a name of ten digits means a position")]
    NameIsPosition,
    /// A blank name, which no satellite has.
    #[error("the name is empty")]
    NoName,
}

/// Returns `value` if it is between `min` and `max`.
pub(super) fn checked(
    name: &'static str,
    value: u64,
    min: u64,
    max: u64,
) -> Result<u64, ValueError> {
    if (min..=max).contains(&value) {
        Ok(value)
    } else {
        Err(ValueError::Range { name, value, min, max })
    }
}
