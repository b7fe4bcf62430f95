//! The address of a controller on its bus.

use std::fmt;

const MIN: u8 = 49;
const MAX: u8 = 111;

/// Address of a controller, 49 to 111 (appendix D). It goes over the line as
/// one printable character.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Address(u8);

/// A number that is no address.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("address {number} is not between {MIN} and {MAX}")]
pub struct AddressError {
    pub number: u8,
}

impl Address {
    /// The address of a controller as it leaves the factory.
    pub const FACTORY: Self = Self(50);

    /// The address with this number, 49 to 111.
    pub const fn new(number: u8) -> Result<Self, AddressError> {
        if MIN <= number && number <= MAX { Ok(Self(number)) } else { Err(AddressError { number }) }
    }

    /// The number, which is also the byte on the line.
    pub const fn number(self) -> u8 {
        self.0
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_63_addresses() {
        let good: Vec<u8> = (0..=u8::MAX).filter(|number| Address::new(*number).is_ok()).collect();
        assert_eq!((good.first(), good.last(), good.len()), (Some(&49), Some(&111), 63));
        assert_eq!(Address::new(Address::FACTORY.number()), Ok(Address::FACTORY));
    }
}
