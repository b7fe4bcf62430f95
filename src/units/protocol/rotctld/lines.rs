//! Conversion of a stream of bytes to lines.

/// Max length of a line, bytes. Hamlib takes arguments of up to 127 characters.
pub const MAX_LINE_BYTES: usize = 512;

/// One line, without its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Line {
    /// A line of printable ASCII.
    Text(String),
    /// A line longer than [`MAX_LINE_BYTES`], which is dropped as a whole.
    TooLong,
}

/// Collector of bytes until a line feed. It drops carriage returns, zero bytes and all other bytes
/// except printable ASCII, so a telnet client can talk to a server.
#[derive(Debug, Default)]
pub struct Lines {
    pending: String,
    is_too_long: bool,
}

impl Lines {
    /// Takes bytes and returns the lines that they complete, in order.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<Line> {
        bytes.iter().filter_map(|byte| self.take(*byte)).collect()
    }

    fn take(&mut self, byte: u8) -> Option<Line> {
        match byte {
            b'\n' => return Some(self.end()),
            b'\t' | b' '..=b'~' if self.pending.len() == MAX_LINE_BYTES => self.is_too_long = true,
            b'\t' => self.pending.push(' '),
            b' '..=b'~' => self.pending.push(char::from(byte)),
            _ => {}
        }
        None
    }

    fn end(&mut self) -> Line {
        let text = std::mem::take(&mut self.pending);
        if std::mem::take(&mut self.is_too_long) { Line::TooLong } else { Line::Text(text) }
    }

    /// Ends the line that still waits for its line feed; `None` without such a line.
    pub fn flush(&mut self) -> Option<Line> {
        (!self.pending.is_empty()).then(|| self.end())
    }

    /// Returns `true` if a line waits for its line feed.
    pub fn has_pending(&self) -> bool {
        !self.pending.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Line {
        Line::Text(text.to_owned())
    }

    #[test]
    fn lines_end_at_a_line_feed_wherever_the_bytes_are_cut() {
        let bytes = b"p\r\nP 10\t20\n\np";
        for cut in 0..=bytes.len() {
            let mut lines = Lines::default();
            let mut found = lines.push(&bytes[..cut]);
            found.extend(lines.push(&bytes[cut..]));
            assert_eq!(found, [text("p"), text("P 10 20"), text("")]);
            assert!(lines.has_pending());
            assert_eq!(lines.flush(), Some(text("p")));
            assert_eq!(lines.flush(), None);
        }
    }

    #[test]
    fn a_line_without_an_end_takes_no_memory() {
        let mut lines = Lines::default();
        assert_eq!(lines.push(&vec![b'x'; 100_000]), []);
        assert!(lines.pending.capacity() <= 2 * MAX_LINE_BYTES);
        assert_eq!(lines.push(b"\np\n"), [Line::TooLong, text("p")]);
        let longest = "y".repeat(MAX_LINE_BYTES);
        assert_eq!(lines.push(format!("{longest}\n").as_bytes()), [text(&longest)]);
    }

    #[test]
    fn bytes_that_are_no_text_are_dropped() {
        let mut lines = Lines::default();
        assert_eq!(lines.push(b"\xff\xfb\x01\0p\x07\n"), [text("p")]);
    }
}
