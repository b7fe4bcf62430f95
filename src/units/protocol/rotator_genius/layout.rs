//! Places of the fields in a status.

use super::RotatorKind;
use super::reply::ReplyStart;

/// Form of a status: there are two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Layout {
    /// 72 bytes, according to the list of fields in section 1.0. Units send this form.
    Wide,
    /// 64 bytes, according to the example in section 1.0, with offsets of 2 and names of 10
    /// characters.
    Narrow,
}

impl Layout {
    /// Returns the length of the field "Offset", bytes.
    pub(super) const fn offset_length(self) -> usize {
        match self {
            Self::Wide => 4,
            Self::Narrow => 2,
        }
    }

    /// Returns the length of the field "Name", the last of a rotator, bytes.
    pub(super) const fn name_length(self) -> usize {
        match self {
            Self::Wide => 12,
            Self::Narrow => 10,
        }
    }

    /// Returns the length of all fields of one rotator, bytes.
    pub(super) const fn rotator_length(self) -> usize {
        18 + self.offset_length() + self.name_length()
    }
}

/// Length of `|h` and the bytes "Active" and "Panic", bytes.
const HEADER_LENGTH: usize = 4;
/// Index of "Configuration" among the fields of a rotator; "Moving" follows.
const KIND_AT: usize = 9;

/// Form of a status and length of its header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LayoutShape {
    pub(super) layout: Layout,
    pub(super) has_panic_byte: bool,
}

impl LayoutShape {
    /// Returns the number of bytes before the first rotator.
    pub(super) const fn header_length(self) -> usize {
        if self.has_panic_byte { HEADER_LENGTH } else { HEADER_LENGTH - 1 }
    }

    /// Returns the length of the whole status, bytes.
    pub(super) const fn length(self) -> usize {
        self.header_length() + 2 * self.layout.rotator_length()
    }

    /// Returns the shape of the status at the beginning of `bytes`, which begin with `|h`.
    ///
    /// A status carries neither length nor version. The letters for the kind of the rotators
    /// decide: in the other form, these places contain digits and blanks, but never names. A text
    /// layer on the way may have removed the zero byte of "Panic", which moves all places down by
    /// one.
    pub(super) fn decide(bytes: &[u8]) -> ReplyStart<Self> {
        for has_panic_byte in [true, false] {
            let start = |layout| Self { layout, has_panic_byte }.header_length();
            // The forms differ only after the first motion, so one test of the first rotator serves
            // both.
            match has_rotator(bytes, start(Layout::Wide)) {
                None => return ReplyStart::Unfinished,
                Some(false) => continue,
                Some(true) => {}
            }
            // The narrow form needs fewer bytes for a decision, because its second rotator begins
            // earlier.
            for layout in [Layout::Narrow, Layout::Wide] {
                match has_rotator(bytes, start(layout) + layout.rotator_length()) {
                    None => return ReplyStart::Unfinished,
                    Some(false) => {}
                    Some(true) => {
                        let shape = Self { layout, has_panic_byte };
                        return ReplyStart::Whole(shape, shape.length());
                    }
                }
            }
        }
        ReplyStart::Unknown
    }
}

/// Returns `true` if the bytes for kind and motion are valid for a rotator whose fields begin at
/// `index`; `None` if too few bytes have come.
fn has_rotator(bytes: &[u8], index: usize) -> Option<bool> {
    let kind = bytes.get(index + KIND_AT)?;
    let moving = bytes.get(index + KIND_AT + 1)?;
    Some(RotatorKind::from_letter(*kind).is_some() && matches!(moving, b'0'..=b'2'))
}
