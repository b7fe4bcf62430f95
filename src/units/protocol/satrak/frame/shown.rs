//! Bytes of a line for screens and files, without secrets. The answer to `SATELLITE_FTP?` contains
//! a password in clear, and the line may be cut or damaged anywhere. The filter only passes bytes
//! that cannot be a piece of the password.

use super::{Frame, MAX_LINE_BYTES, ReceivedLine};
use crate::protocol::satrak::Word;

/// Placeholder for hidden bytes.
pub const HIDDEN: &str = "(hidden)";

/// Bytes of a line that Azel may show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// At most [`MAX_LINE_BYTES`] of the line, with [`HIDDEN`] in place of omitted bytes.
    pub bytes: Vec<u8>,
    /// `true` if no byte was omitted.
    pub is_whole: bool,
}

impl ReceivedLine {
    /// Returns the line without any bytes that may be the FTP password or a piece of it.
    ///
    /// A good frame with a word of the document other than `SATELLITE_FTP` stays whole. Any other
    /// line shows only the words of the document and the numbers right after them. `is_greeting` is
    /// `true` until the first `$` has come over the link: plain text is then no piece of a frame.
    pub fn without_secrets(&self, is_greeting: bool) -> Shown {
        let bytes = self.bytes.get(..MAX_LINE_BYTES).unwrap_or(&self.bytes);
        let mut filter = SecretFilter { shown: Vec::with_capacity(bytes.len()), is_whole: true };
        let (content, end) = split_end(bytes);
        match &self.frame {
            Ok(frame) => {
                let header = header_of(frame, content);
                let (noise, good) = content.split_at_checked(header).unwrap_or((content, b""));
                filter.take_spoiled(noise);
                filter.take_frame(frame, good, !noise.is_empty());
            }
            Err(_) if is_greeting && is_plain_text(content) => filter.show(content),
            Err(_) => filter.take_spoiled(content),
        }
        filter.show(end);
        let is_whole = filter.is_whole && bytes.len() == self.bytes.len();
        Shown { bytes: filter.shown, is_whole }
    }
}

/// Returns the index of the header of a good frame in its line.
fn header_of(frame: &Frame, content: &[u8]) -> usize {
    // The index counts back from the last star: values may contain stars, and noise may contain a
    // `$`.
    let star = content.iter().rposition(|byte| *byte == b'*').unwrap_or(0);
    star.saturating_sub(frame.line().len() + 1)
}

/// Splits a line into content and the CR and LF at its end.
fn split_end(bytes: &[u8]) -> (&[u8], &[u8]) {
    let length = bytes.iter().rposition(|byte| !b"\r\n".contains(byte)).map_or(0, |last| last + 1);
    bytes.split_at(length)
}

fn is_plain_text(content: &[u8]) -> bool {
    !content.iter().any(|byte| b"$,*".contains(byte))
}

/// Filter that collects the bytes that Azel may show.
struct SecretFilter {
    shown: Vec<u8>,
    is_whole: bool,
}

impl SecretFilter {
    fn show(&mut self, bytes: &[u8]) {
        self.shown.extend_from_slice(bytes);
    }

    /// Adds the placeholder once for any number of hidden bytes.
    fn hide(&mut self) {
        self.is_whole = false;
        if !self.shown.ends_with(HIDDEN.as_bytes()) {
            self.show(HIDDEN.as_bytes());
        }
    }

    /// Takes a frame with the right checksum. One in 256 pieces of another frame also has the right
    /// checksum, so the filter hides an unknown word after noise.
    fn take_frame(&mut self, frame: &Frame, bytes: &[u8], is_behind_noise: bool) {
        match frame.command() {
            // A frame without values has nothing to hide.
            Some((Word::SatelliteFtp, _)) if !is_bare(frame) => {
                self.show(b"$");
                self.show(frame.word().as_bytes());
                self.hide();
            }
            Some(_) => self.show(bytes),
            None if is_behind_noise || names_ftp(bytes) => self.hide(),
            None => {
                let (word, values) = split_word(bytes);
                self.show(word);
                self.take_numbers(values);
            }
        }
    }

    /// Takes bytes that form no good frame.
    fn take_spoiled(&mut self, bytes: &[u8]) {
        let first = bytes.iter().position(|byte| *byte == b'$').unwrap_or(bytes.len());
        // These bytes may be the tail of a cut frame.
        if first > 0 {
            self.hide();
        }
        let pieces = bytes.get(first..).unwrap_or_default();
        for piece in pieces.split(|byte| *byte == b'$').skip(1) {
            let (word, values) = split_word(piece);
            let is_known = std::str::from_utf8(word).is_ok_and(is_plain_word);
            // The values of a damaged word may come from the FTP answer.
            if !is_known || names_ftp(piece) {
                return self.hide();
            }
            self.show(b"$");
            self.show(word);
            // A byte of a password may have changed to a `$`, so the filter shows no more.
            if !self.take_numbers(values) {
                return;
            }
        }
    }

    /// Shows values up to the first that is not a number. Returns `false` if there is such a value.
    fn take_numbers(&mut self, values: &[u8]) -> bool {
        let signs = values.iter().take_while(|byte| b"?=".contains(byte)).count();
        let (sign, values) = values.split_at(signs);
        let (values, sum) = split_sum(values);
        self.show(sign);
        for (place, value) in values.split(|byte| *byte == b',').enumerate() {
            if place > 0 {
                self.show(b",");
            }
            if !is_number(value) {
                self.hide();
                return false;
            }
            self.show(value);
        }
        self.show(sum);
        true
    }
}

/// Splits off the word before the sign or the values.
fn split_word(bytes: &[u8]) -> (&[u8], &[u8]) {
    let end = bytes.iter().position(|byte| b",?=*".contains(byte)).unwrap_or(bytes.len());
    bytes.split_at(end)
}

/// Returns `true` if the frame has no values, or only the outcome of a request.
fn is_bare(frame: &Frame) -> bool {
    let fields: Vec<&str> = frame.fields().iter().map(String::as_str).collect();
    // Only one code is allowed: with more values, ERR may be the address of the server.
    matches!(fields.as_slice(), [] | ["OK" | "ERR"] | ["ERR", _])
}

/// Returns `true` for a word of the document whose values are not secret.
fn is_plain_word(word: &str) -> bool {
    Word::from_name(word).is_some_and(|word| word != Word::SatelliteFtp)
}

/// Returns `true` if the bytes contain the letters FTP, in upper or lower case.
fn names_ftp(bytes: &[u8]) -> bool {
    // Three letters suffice, because the rest of the word may be damaged.
    bytes.windows(3).any(|three| three.eq_ignore_ascii_case(b"FTP"))
}

/// Splits off the star and digits of a checksum at the end, if there are any.
fn split_sum(values: &[u8]) -> (&[u8], &[u8]) {
    let star = values.iter().rposition(|byte| *byte == b'*');
    let star_index = star.filter(|index| {
        let digits = values.get(index + 1..).unwrap_or_default();
        digits.len() <= 2 && digits.iter().all(u8::is_ascii_hexdigit)
    });
    values.split_at(star_index.unwrap_or(values.len()))
}

/// Returns `true` if the value is a number, a coordinate with its letter, or one of the fixed
/// words.
fn is_number(value: &[u8]) -> bool {
    let value = value.trim_ascii();
    if [b"OK".as_slice(), b"ERR", b"NONE", b"?"].contains(&value) {
        return true;
    }
    let digits = match value.split_last() {
        Some((letter, digits)) if b"NSEW".contains(letter) => digits,
        _ => value,
    };
    let digits = digits.strip_prefix(b"-").or(digits.strip_prefix(b"+")).unwrap_or(digits);
    let mut parts = digits.splitn(3, |byte| *byte == b'.');
    let is_digits = |part: &[u8]| part.iter().all(u8::is_ascii_digit);
    parts.by_ref().take(2).all(is_digits) && parts.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::{Decoder, encode};

    const ANSWER: &str = "SATELLITE_FTP?,10.0.1.2,user,hunter2,22,f.txt,AO-7,1,1";

    fn shown(bytes: &[u8], is_greeting: bool) -> Vec<String> {
        let mut decoder = Decoder::new();
        decoder.push(bytes);
        let mut lines: Vec<_> = std::iter::from_fn(|| decoder.next_line()).collect();
        lines.extend(decoder.take_unfinished());
        let text = |line: &ReceivedLine| {
            let shown = line.without_secrets(is_greeting);
            assert_eq!(shown.is_whole, shown.bytes == line.bytes);
            String::from_utf8_lossy(&shown.bytes).into_owned()
        };
        lines.iter().map(text).collect()
    }

    fn only(bytes: &[u8]) -> String {
        let mut all = shown(bytes, false);
        assert_eq!(all.len(), 1, "{all:?}");
        all.remove(0)
    }

    #[test]
    fn good_frames_are_shown_as_they_came() {
        for payload in ["STATUS?", "SATELLITE?,a.txt,AO-7, OSCAR 7,1,7530,78.4", "STOP=,ERR,7"] {
            let bytes = encode(payload);
            assert_eq!(only(&bytes).as_bytes(), bytes);
        }
        let unknown = encode("DATETIMEG?=,2016,12,22");
        assert_eq!(only(&unknown), "$DATETIMEG?=,2016,12,22*6E\r\n");
    }

    #[test]
    fn answer_and_setting_of_the_ftp_source_are_hidden() {
        let setting = ANSWER.replace('?', "=");
        for payload in [ANSWER, &setting, "SATELLITE_FTP =,a,b,c", "satellite_ftp?,a,b,1"] {
            let text = only(&encode(payload));
            assert!(text.ends_with("(hidden)\r\n") && !text.contains(','), "{text}");
        }
        assert_eq!(only(&encode(ANSWER)), "$SATELLITE_FTP?(hidden)\r\n");
        for payload in ["SATELLITE_FTP?", "SATELLITE_FTP=,OK", "SATELLITE_FTP=,ERR,7"] {
            let bytes = encode(payload);
            assert_eq!(only(&bytes).as_bytes(), bytes);
        }
    }

    #[test]
    fn a_damaged_line_keeps_the_numbers_of_a_known_word() {
        for (bytes, text) in [
            (&b"$STATUS?,0,324.98,-5.02*00\r\n"[..], "$STATUS?,0,324.98,-5.02*00\r\n"),
            (b"$STATUS?,0,2$STOP=,OK*0D\r\n", "$STATUS?,0,2$STOP=,OK*0D\r\n"),
            (b"$STOP=,OK\r\n", "$STOP=,OK\r\n"),
            (b"$STATUS?,0,29user,1,2*00\n", "$STATUS?,0,(hidden)\n"),
            (b"$VERSION?,SATRAK CU*00\r\n", "$VERSION?,(hidden)\r\n"),
            (b"$GPS_DATA?,41.01N*00\r\n", "$GPS_DATA?,41.01N*00\r\n"),
            (b"er2,22,f*00\r\n", "(hidden)\r\n"),
            (b"er2$STOP=,OK*0D\r\n", "(hidden)$STOP=,OK*0D\r\n"),
            (b"$STATU", "(hidden)"),
        ] {
            assert_eq!(only(bytes), text);
        }
    }

    #[test]
    fn a_greeting_is_shown_until_frames_have_come() {
        assert_eq!(shown(b"login:\r\n", true), ["login:\r\n"]);
        assert_eq!(shown(b"login:\r\n", false), ["(hidden)\r\n"]);
        assert_eq!(shown(b"er2,22\r\n", true), ["(hidden)\r\n"]);
    }

    /// Returns `true` if `lines` contain any four successive characters of the password.
    fn leaks(lines: &[String], password: &str) -> bool {
        let pieces: Vec<_> =
            (0..password.len() - 3).map(|index| &password[index..index + 4]).collect();
        lines.iter().any(|line| pieces.iter().any(|piece| line.contains(piece)))
    }

    #[test]
    fn no_single_fault_lets_a_piece_of_the_password_through() {
        for password in ["hunter2", "98431765", "N5.75E31"] {
            let good = encode(&ANSWER.replace("hunter2", password));
            for index in 0..good.len() {
                for byte in [b'\n', b'\r', b'$', b'*', b',', b'?', b'x', b'0', 0, 0xff] {
                    let mut replaced = good.clone();
                    replaced[index] = byte;
                    let mut inserted = good.clone();
                    inserted.insert(index, byte);
                    let mut removed = good.clone();
                    removed.remove(index);
                    let mut overrun = b"$STATUS?,0,2".to_vec();
                    overrun.extend(&good[index..]);
                    let mut before = good[..index].to_vec();
                    before.extend(encode("STOP=,OK"));
                    let cut = good[..index].to_vec();
                    for bytes in [replaced, inserted, removed, before, cut] {
                        let lines = shown(&bytes, false);
                        assert!(!leaks(&lines, password), "{index} {byte}: {lines:?}");
                    }
                    // Digits next to digits cannot be distinguished from a number.
                    let is_glued = password.starts_with(|c: char| c.is_ascii_digit());
                    if !is_glued {
                        let lines = shown(&overrun, false);
                        assert!(!leaks(&lines, password), "{index} {byte}: {lines:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn any_length_is_kept_short() {
        let mut long = b"$STATUS?".to_vec();
        long.extend(b",1".repeat(5000));
        let mut decoder = Decoder::new();
        decoder.push(&long);
        let line = decoder.next_line().unwrap();
        let shown = line.without_secrets(false);
        assert!(shown.bytes.len() <= MAX_LINE_BYTES && !shown.is_whole);
        assert_eq!(line.length(), long.len());
    }
}
