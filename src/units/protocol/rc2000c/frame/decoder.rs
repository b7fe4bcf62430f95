//! Decoder from a byte stream to frames.

use super::{
    Address, Command, ENVELOPE_BYTES, ETX, Frame, Header, MAX_FRAME_BYTES, OFFLINE, checksum,
};

/// Max number of bytes that wait between two calls; the decoder drops more.
const MAX_PENDING_BYTES: usize = 1024;

/// Reason why bytes that began like a frame are not one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// A checksum that does not match the frame.
    #[error("checksum {received:02X} instead of {computed:02X}")]
    BadChecksum {
        /// Checksum in the frame.
        received: u8,
        /// Checksum of the frame's bytes.
        computed: u8,
    },
    /// A length that no reply to this command has.
    #[error("reply to {code:02X} with {data_bytes} bytes of data")]
    BadLength {
        /// Command code of the frame.
        code: u8,
        /// Number of characters between code and ETX.
        data_bytes: usize,
    },
    /// A byte that belongs to no code and no data: a control byte, or a byte with the eighth bit
    /// set.
    #[error("byte {byte:02X} at place {index}")]
    BadByte {
        byte: u8,
        /// Index of the byte, counted from 0 at the header.
        index: usize,
    },
    /// More than [`MAX_FRAME_BYTES`] bytes without an end.
    #[error("frame longer than {MAX_FRAME_BYTES} bytes")]
    TooLong,
    /// A frame in which the line went quiet.
    #[error("frame ends after {bytes} bytes")]
    Incomplete {
        /// Number of received bytes.
        bytes: usize,
    },
}

/// Decoder of a byte stream into the frames of one unit, for the console or the simulator.
///
/// Push the bytes that were read, then take frames until `None`. Call [`Self::line_is_quiet`] after
/// a silence longer than the gap between two characters of a frame. The stream may be cut and
/// merged anywhere. The decoder buffers at most 1 KiB.
///
/// Only a header followed by the unit's address begins a frame, and a reply has one of the lengths
/// of its command. The place of the checksum is therefore known, and it may equal any control byte.
/// The XOR detects every single wrong bit. A broken frame loses only its header; the decoder reads
/// the rest again.
///
/// A reply inside another reply is the limit of this protocol without parity. A status whose
/// satellite name begins with `FC` or `F#` may read as an offline reply. This happens if one bit of
/// the second letter is wrong, and the third letter is the checksum of the offline reply.
#[derive(Debug)]
pub struct Decoder {
    address: Address,
    pending: Vec<u8>,
    skipped_bytes: u64,
}

/// Judgement on the beginning of the pending bytes.
enum FrameVerdict {
    /// Undecided: more bytes have to come.
    Open,
    /// Bytes that begin no frame of this unit.
    Foreign,
    Broken(FrameError),
    Whole(Frame),
}

impl Decoder {
    /// Returns a decoder for the frames of the unit at `address`.
    pub const fn new(address: Address) -> Self {
        Self { address, pending: Vec::new(), skipped_bytes: 0 }
    }

    /// Takes received bytes. Drops bytes that do not fit while the caller takes no frames.
    pub fn push(&mut self, bytes: &[u8]) {
        let room = MAX_PENDING_BYTES.saturating_sub(self.pending.len());
        let (fitting, lost) = bytes.split_at_checked(room).unwrap_or((bytes, &[]));
        self.pending.extend_from_slice(fitting);
        self.skipped_bytes += lost.len() as u64;
    }

    /// Gives up an incomplete frame, and reads the bytes after its header.
    pub fn line_is_quiet(&mut self) -> Vec<Result<Frame, FrameError>> {
        let mut results = Vec::new();
        loop {
            results.extend(self.by_ref());
            let bytes = self.pending.len();
            if bytes == 0 {
                return results;
            }
            // A lone header is noise; a header with the address after it was a frame.
            if bytes > 1 {
                results.push(Err(FrameError::Incomplete { bytes }));
            }
            self.skip(1);
        }
    }

    /// Returns the number of bytes so far that belonged to no frame: noise, other units' frames and
    /// broken frames.
    pub const fn skipped_bytes(&self) -> u64 {
        self.skipped_bytes
    }

    fn skip(&mut self, count: usize) {
        self.pending.drain(..count);
        self.skipped_bytes += count as u64;
    }

    fn judge(&self) -> FrameVerdict {
        let Some(header) = self.pending.first().copied().and_then(Header::from_byte) else {
            return if self.pending.is_empty() {
                FrameVerdict::Open
            } else {
                FrameVerdict::Foreign
            };
        };
        match self.pending.get(1) {
            None => return FrameVerdict::Open,
            // Other units may share the line.
            Some(byte) if *byte != self.address.number() => return FrameVerdict::Foreign,
            Some(_) => {}
        }
        // Code and data are printable (appendix D), so the first ETX after them ends the frame.
        for (index, byte) in self.pending.iter().copied().enumerate().skip(2) {
            match byte {
                ETX if index > 2 => return self.judge_whole(header, index),
                // Two more bytes have to follow: ETX and checksum.
                0x20..0x80 if index + 2 < MAX_FRAME_BYTES => {}
                0x20..0x80 => return FrameVerdict::Broken(FrameError::TooLong),
                _ => return FrameVerdict::Broken(FrameError::BadByte { byte, index }),
            }
        }
        FrameVerdict::Open
    }

    /// Judges a frame with its ETX at `etx_at`.
    fn judge_whole(&self, header: Header, etx_at: usize) -> FrameVerdict {
        let (Some(body), Some(code), Some(data)) = (
            self.pending.get(..=etx_at),
            self.pending.get(2).copied(),
            self.pending.get(3..etx_at),
        ) else {
            return FrameVerdict::Open;
        };
        // The decoder judges the length first. A false frame then does not wait for a checksum that
        // never comes.
        if !is_known_form(header, code, data) {
            return FrameVerdict::Broken(FrameError::BadLength { code, data_bytes: data.len() });
        }
        let Some(received) = self.pending.get(etx_at + 1).copied() else {
            return FrameVerdict::Open;
        };
        let computed = checksum(body);
        if received == computed {
            FrameVerdict::Whole(Frame::new(header, self.address, code, data.to_vec()))
        } else {
            FrameVerdict::Broken(FrameError::BadChecksum { received, computed })
        }
    }
}

impl Iterator for Decoder {
    type Item = Result<Frame, FrameError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.judge() {
                FrameVerdict::Open => return None,
                FrameVerdict::Foreign => self.skip(1),
                // The decoder drops only the header, because a whole frame may begin right after
                // it.
                FrameVerdict::Broken(error) => {
                    self.skip(1);
                    return Some(Err(error));
                }
                FrameVerdict::Whole(frame) => {
                    self.pending.drain(..ENVELOPE_BYTES + frame.data().len());
                    return Some(Ok(frame));
                }
            }
        }
    }
}

/// Returns `true` if a frame may contain `data`. A command may have any length, because a unit also
/// answers wrong commands.
fn is_known_form(header: Header, code: u8, data: &[u8]) -> bool {
    match header {
        Header::Command => true,
        // A NAK gives no reason (appendix E), so it has no data.
        Header::Nak => data.is_empty(),
        Header::Ack => {
            let expected = Command::from_code(code).map(Command::reply_bytes);
            // A unit with its remote mode disabled gives the offline reply to any command.
            data == OFFLINE || expected == Some(data.len() + ENVELOPE_BYTES) || is_device_type(data)
        }
    }
}

/// Returns `true` if `data` is a device type. Firmware of the RC2000A before 2.6 repeats a wrong
/// code in this reply, and the RC2000C shares its code base.
pub(in super::super) fn is_device_type(data: &[u8]) -> bool {
    data.len() + ENVELOPE_BYTES == Command::DeviceType.reply_bytes()
        && (data.starts_with(b"2KC") || data.starts_with(b"RC2K"))
}

#[cfg(test)]
mod tests;
