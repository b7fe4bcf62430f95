//! Shapes and texts of one page, in points, as SVG.

use std::fmt::Write as _;

use quick_xml::escape::escape;

/// A4, upright.
pub(in crate::ui) const WIDTH: f64 = 595.0;
pub(in crate::ui) const HEIGHT: f64 = 842.0;

/// Letters at the end of a name that may be its number.
const NUMBER: usize = 5;

/// Light enough to read black text on.
pub(in crate::ui) const SHADE: &str = "#dcdcdc";
const INK: &str = "#000000";
/// For captions and rings.
const QUIET: &str = "#555555";

/// Where a text stands beside its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(in crate::ui) struct Face {
    pub(in crate::ui) size: f64,
    pub(in crate::ui) is_bold: bool,
    pub(in crate::ui) is_quiet: bool,
    pub(in crate::ui) anchor: Anchor,
}

impl Face {
    pub(in crate::ui) const fn of(size: f64) -> Self {
        Self { size, is_bold: false, is_quiet: false, anchor: Anchor::Start }
    }

    pub(in crate::ui) const fn bold(self) -> Self {
        Self { is_bold: true, ..self }
    }

    pub(in crate::ui) const fn quiet(self) -> Self {
        Self { is_quiet: true, ..self }
    }

    pub(in crate::ui) const fn anchored(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    /// Width of a text in the widest of the usual fonts.
    fn width(self, text: &str) -> f64 {
        let wider = if self.is_bold { 1.12 } else { 1.0 };
        text.chars().map(em).sum::<f64>() * self.size * wider
    }
}

/// Width of a letter, in sizes of the font.
fn em(letter: char) -> f64 {
    match letter {
        'i' | 'j' | 'l' | 'I' | '\'' => 0.3,
        ' ' | '.' | ',' | ':' | ';' | '|' | '!' | '/' | '\u{2009}' => 0.34,
        'f' | 'r' | 't' | '(' | ')' | '[' | ']' | '-' => 0.42,
        '°' | '–' | '"' | '*' => 0.5,
        'm' | 'w' | 'M' | 'W' | '@' | '%' | '…' | '—' => 1.0,
        'A'..='Z' | '−' | '+' | '=' | '<' | '>' | '&' | '#' | '~' | '^' => 0.8,
        '\0'..='\u{24f}' => 0.66,
        '\u{250}'..='\u{10ff}' => 0.9,
        '\u{1100}'..='\u{ffff}' => 1.05,
        _ => 1.4,
    }
}

/// A page that is being drawn.
pub(in crate::ui) struct Svg(String);

impl Svg {
    pub(in crate::ui) fn new(title: &str) -> Self {
        let mut page = String::new();
        let _ = write!(
            page,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"210mm\" height=\"297mm\" \
             viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" \
             style=\"font-variant-numeric:tabular-nums\">\n<title>{}</title>\n\
             <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>\n",
            escape(shown(title))
        );
        Self(page)
    }

    pub(in crate::ui) fn finish(mut self) -> String {
        self.0 += "</svg>\n";
        self.0
    }

    /// A text on the base line `y` that is cut to `room`.
    pub(in crate::ui) fn text(&mut self, at: [f64; 2], room: f64, face: Face, text: &str) {
        self.put(at, face, &cut(&shown(text), room, face, 0));
    }

    /// A name of a satellite that keeps its number where it is cut.
    pub(in crate::ui) fn name(&mut self, at: [f64; 2], room: f64, face: Face, name: &str) {
        let name = shown(name);
        let end = if name.ends_with(|letter: char| letter.is_ascii_digit()) { NUMBER } else { 0 };
        self.put(at, face, &cut(&name, room, face, end));
    }

    fn put(&mut self, [x, y]: [f64; 2], face: Face, text: &str) {
        if text.is_empty() {
            return;
        }
        let [x, y] = [x, y].map(number);
        let anchor = match face.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let weight = if face.is_bold { " font-weight=\"bold\"" } else { "" };
        let fill = if face.is_quiet { QUIET } else { INK };
        let size = number(face.size);
        let text = escape(text);
        let _ = writeln!(
            self.0,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{anchor}{weight} fill=\"{fill}\">{text}</text>"
        );
    }

    pub(in crate::ui) fn line(&mut self, from: [f64; 2], to: [f64; 2], stroke: f64) {
        let ([x1, y1], [x2, y2]) = (from.map(number), to.map(number));
        let stroke = number(stroke);
        let _ = writeln!(
            self.0,
            "<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"{INK}\" stroke-width=\"{stroke}\"/>"
        );
    }

    /// A box of one colour without an edge.
    pub(in crate::ui) fn filled(
        &mut self,
        [x, y]: [f64; 2],
        [width, height]: [f64; 2],
        fill: &str,
    ) {
        let [x, y, width, height] = [x, y, width, height].map(number);
        let _ = writeln!(
            self.0,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{fill}\"/>"
        );
    }

    pub(in crate::ui) fn bar(&mut self, at: [f64; 2], size: [f64; 2]) {
        self.filled(at, size, INK);
    }

    pub(in crate::ui) fn ring(&mut self, [x, y]: [f64; 2], radius: f64, stroke: f64) {
        let [x, y, radius, stroke] = [x, y, radius, stroke].map(number);
        let _ = writeln!(
            self.0,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"none\" stroke=\"{QUIET}\" stroke-width=\"{stroke}\"/>"
        );
    }

    pub(in crate::ui) fn dot(&mut self, [x, y]: [f64; 2], radius: f64) {
        let [x, y, radius] = [x, y, radius].map(number);
        let _ = writeln!(self.0, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{INK}\"/>");
    }

    pub(in crate::ui) fn path(&mut self, points: &[[f64; 2]], stroke: f64) {
        self.polyline(points, stroke, "");
    }

    /// A path of dashes and gaps of these lengths.
    pub(in crate::ui) fn dashed(&mut self, points: &[[f64; 2]], stroke: f64, dash: [f64; 2]) {
        let [on, off] = dash.map(number);
        self.polyline(points, stroke, &format!(" stroke-dasharray=\"{on} {off}\""));
    }

    fn polyline(&mut self, points: &[[f64; 2]], stroke: f64, dash: &str) {
        let points: Vec<String> =
            points.iter().map(|[x, y]| format!("{},{}", number(*x), number(*y))).collect();
        if points.len() < 2 {
            return;
        }
        let (points, stroke) = (points.join(" "), number(stroke));
        let _ = writeln!(
            self.0,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"{stroke}\"{dash} \
             stroke-linejoin=\"round\" stroke-linecap=\"butt\"/>"
        );
    }
}

/// At most two decimals.
fn number(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    // Adding zero makes a negative zero positive.
    (rounded + 0.0).to_string()
}

/// A text without what no printer shows, XML forbids, or turns the order of what follows.
fn shown(text: &str) -> String {
    let is_unseen = |letter: char| {
        letter.is_control()
            || matches!(letter, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}')
            || matches!(letter, '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff0}'..='\u{ffff}')
    };
    let words = text.split(|letter: char| letter.is_whitespace() || is_unseen(letter));
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// A text that fits, with an ellipsis for what is missing before its last `end` letters.
fn cut(text: &str, room: f64, face: Face, end: usize) -> String {
    if face.width(text) <= room {
        return text.to_owned();
    }
    let begin = text.chars().count().saturating_sub(end);
    let tail: String = text.chars().skip(begin).collect();
    let tail = format!("…{}", tail.trim_start());
    let left = room - face.width(&tail);
    if left < 0.0 && end > 0 {
        return cut(text, room, face, 0);
    }
    let mut kept = String::new();
    for letter in text.chars() {
        kept.push(letter);
        if face.width(&kept) > left {
            kept.pop();
            break;
        }
    }
    format!("{}{tail}", kept.trim_end())
}

/// A text in lines that fit; what is too much ends in the last one.
pub(in crate::ui) fn wrapped(text: &str, room: f64, face: Face, lines: usize) -> Vec<String> {
    let text = shown(text);
    let mut wrapped = vec![String::new()];
    for word in text.split(' ') {
        let full = wrapped.len() >= lines;
        let Some(line) = wrapped.last_mut() else { break };
        let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if full || line.is_empty() || face.width(&longer) <= room {
            *line = longer;
        } else {
            wrapped.push(word.to_owned());
        }
    }
    wrapped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_cut_where_its_room_ends() {
        let face = Face::of(10.0);
        assert_eq!(cut("NOAA 20", 100.0, face, 0), "NOAA 20");
        let long = cut(&"METEOR ".repeat(20), 100.0, face, 0);
        assert!(long.ends_with('…') && face.width(&long) <= 100.0, "{long}");
        assert_eq!(cut("WWWW", 1.0, face, 0), "…");
    }

    #[test]
    fn a_name_that_is_cut_keeps_its_number() {
        let face = Face::of(10.0);
        let name = cut("STARLINK-31472", 80.0, face, NUMBER);
        assert!(name.ends_with("…31472") && face.width(&name) <= 80.0, "{name}");
        assert_eq!(cut("STARLINK-31472", 20.0, face, NUMBER), "S…");
    }

    #[test]
    fn what_no_printer_shows_is_left_out() {
        assert_eq!(shown("A\u{0}B\u{202e}C\n\u{feff}D\u{ffff}"), "A B C D");
    }

    #[test]
    fn lines_break_between_words() {
        let face = Face::of(10.0);
        let lines = wrapped("NOAA 20 overlaps by 8:16 and more words", 70.0, face, 2);
        assert_eq!(lines.len(), 2);
        assert_eq!(lines.join(" "), "NOAA 20 overlaps by 8:16 and more words");
    }

    #[test]
    fn numbers_have_no_noise() {
        assert_eq!([-0.001, 12.345, 3.0].map(number), ["0", "12.35", "3"]);
    }
}
