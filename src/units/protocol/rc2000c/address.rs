//! Address of a unit on its bus.

use std::fmt;

const MIN: u8 = 49;
const MAX: u8 = 111;

/// Address of a unit, 49 to 111 (appendix D), sent as one printable character.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Address(u8);

/// A number that is not an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("address {number} is not between {MIN} and {MAX}")]
pub struct AddressError {
    pub number: u8,
}

impl Address {
    // The source of 50 is a third-party driver for this model, not the manual.
    /// Factory setting of the address.
    pub const FACTORY: Self = Self(50);

    /// Returns address `number`, 49 to 111.
    pub const fn new(number: u8) -> Result<Self, AddressError> {
        if MIN <= number && number <= MAX { Ok(Self(number)) } else { Err(AddressError { number }) }
    }

    /// Returns the number of the address, which is also the byte on the line.
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
