//! Replies of the unit.

use super::{Status, WholeDegrees};

/// Any reply of the unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reply {
    /// Reply to `|h`.
    Status(Status),
    /// Reply to a command.
    Acknowledgement {
        request: Acknowledgement,
        /// `true` for `K`, `false` for `F`. An `F` gives no reason.
        is_accepted: bool,
    },
}

/// Command that the unit acknowledges. The reply does not name the rotator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acknowledgement {
    /// `|A`: a turn to an angle.
    GoTo {
        /// Target, if the reply has the longer form of the document's list and repeats a valid
        /// target.
        target: Option<WholeDegrees>,
    },
    /// `|P`: a clockwise turn.
    RotateClockwise,
    /// `|M`: a counter-clockwise turn.
    RotateCounterClockwise,
    /// `|S`: a stop.
    Stop,
    /// `|c`: a configuration.
    Configure,
}

/// Result of reading the beginning of a stream.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum ReplyStart<T> {
    /// An item, and its number of bytes.
    Whole(T, usize),
    Unknown,
    /// Undecided: more bytes have to come.
    Unfinished,
}

/// Reads the acknowledgement at the beginning of `bytes`.
pub(super) fn acknowledgement(bytes: &[u8]) -> ReplyStart<Reply> {
    let short = match bytes {
        [] | [b'|'] => return ReplyStart::Unfinished,
        [b'|', b'A', ..] => return go_to(bytes),
        [b'|', b'P', ..] => Acknowledgement::RotateClockwise,
        [b'|', b'M', ..] => Acknowledgement::RotateCounterClockwise,
        [b'|', b'S', ..] => Acknowledgement::Stop,
        [b'|', b'c', ..] => Acknowledgement::Configure,
        _ => return ReplyStart::Unknown,
    };
    ended_by(bytes.get(2), short, 3)
}

/// Reads both forms: 6 bytes in the document's list, 3 in its example.
fn go_to(bytes: &[u8]) -> ReplyStart<Reply> {
    let is_filler = |byte: &u8| byte.is_ascii_digit() || *byte == b' ';
    let field = bytes.get(2..5.min(bytes.len())).unwrap_or_default();
    match field {
        [] => ReplyStart::Unfinished,
        // No length distinguishes the forms, but no number begins with `K` or `F`.
        [first, ..] if !is_filler(first) => {
            ended_by(Some(first), Acknowledgement::GoTo { target: None }, 3)
        }
        // The decoder gives up before six bytes have come, so a cut reply does not swallow the next
        // reply.
        _ if !field.iter().all(is_filler) => ReplyStart::Unknown,
        _ => {
            let target = WholeDegrees::parse(field);
            ended_by(bytes.get(5), Acknowledgement::GoTo { target }, 6)
        }
    }
}

fn ended_by(
    last: Option<&u8>,
    acknowledgement: Acknowledgement,
    length: usize,
) -> ReplyStart<Reply> {
    let is_accepted = match last {
        None => return ReplyStart::Unfinished,
        Some(b'K') => true,
        Some(b'F') => false,
        Some(_) => return ReplyStart::Unknown,
    };
    ReplyStart::Whole(Reply::Acknowledgement { request: acknowledgement, is_accepted }, length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_acknowledgement_ends_with_its_verdict() {
        let accepted = |request, length| {
            ReplyStart::Whole(Reply::Acknowledgement { request, is_accepted: true }, length)
        };
        let target = |degrees| WholeDegrees::new(degrees).ok();
        let go_to = |target| Acknowledgement::GoTo { target };
        for (bytes, expected) in [
            (&b"|SK|h"[..], accepted(Acknowledgement::Stop, 3)),
            (b"|AK15", accepted(go_to(None), 3)),
            (b"|A158K", accepted(go_to(target(158)), 6)),
            (b"|A   K", accepted(go_to(None), 6)),
            (b"|A999K", accepted(go_to(None), 6)),
            (b"|A15", ReplyStart::Unfinished),
            (b"|A", ReplyStart::Unfinished),
            (b"|", ReplyStart::Unfinished),
            (b"|M", ReplyStart::Unfinished),
            (b"|A1K", ReplyStart::Unknown),
            (b"|A158X", ReplyStart::Unknown),
            (b"|M1", ReplyStart::Unknown),
            (b"|XK", ReplyStart::Unknown),
        ] {
            assert_eq!(acknowledgement(bytes), expected, "{bytes:?}");
        }
    }
}
