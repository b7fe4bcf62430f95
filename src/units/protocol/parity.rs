//! Even parity in software, for ports and servers that carry eight data bits without
//! parity.

/// Place where the parity of the line (seven data bits, even parity) is generated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Parity {
    /// Parity of the port, or no parity: bytes pass unchanged.
    #[default]
    Port,
    /// Parity from this module, in the eighth bit.
    Software,
}

/// Byte that replaces a character with wrong parity; never part of a frame.
const BROKEN: u8 = 0xff;

impl Parity {
    /// Prepares `bytes` of seven bits for the port.
    pub fn prepare(self, bytes: &mut [u8]) {
        if self == Self::Software {
            for byte in bytes {
                let parity = (*byte & 0x7f).count_ones() as u8 & 1;
                *byte = *byte & 0x7f | parity << 7;
            }
        }
    }

    /// Removes the parity from `bytes` of the port. A character with wrong parity becomes a byte
    /// that no frame contains.
    pub fn check(self, bytes: &mut [u8]) {
        if self == Self::Software {
            for byte in bytes {
                let is_even = byte.count_ones().is_multiple_of(2);
                *byte = if is_even { *byte & 0x7f } else { BROKEN };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_comes_back_and_every_flipped_bit_is_seen() {
        for byte in 0..0x80_u8 {
            let mut sent = [byte];
            Parity::Software.prepare(&mut sent);
            assert_eq!(sent[0] & 0x7f, byte);
            for bit in 0..8 {
                let mut hit = [sent[0] ^ 1 << bit];
                Parity::Software.check(&mut hit);
                assert_eq!(hit, [BROKEN], "{byte:02x} {bit}");
            }
            Parity::Software.check(&mut sent);
            assert_eq!(sent, [byte]);
        }
    }

    #[test]
    fn the_parity_is_that_of_a_7e1_line() {
        let mut bytes = *b"\x02\x32\x31\x03\x02";
        Parity::Software.prepare(&mut bytes);
        assert_eq!(bytes, *b"\x82\xb2\xb1\x03\x82");
        let mut same = *b"\x02\xff";
        Parity::Port.prepare(&mut same);
        Parity::Port.check(&mut same);
        assert_eq!(same, *b"\x02\xff");
    }
}
