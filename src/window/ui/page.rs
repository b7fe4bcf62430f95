//! A4 pages to print, in black on white, as self-contained HTML. The style sheet sets the height of
//! every row, so that a page knows how many rows fit and counts the rest. A browser cuts words that
//! are too long.

pub(super) mod plot;
#[cfg(test)]
pub(super) mod testing;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::format;
use crate::astro::Site;

/// Height of the page within its margins, millimetres; the style sheet has the same value.
pub(super) const HEIGHT_MM: f64 = 276.0;
/// Space between two sections, millimetres; the style sheet has the same value.
pub(super) const GAP_MM: f64 = 2.5;
/// Height of the head of a section, millimetres; the style sheet has the same value.
pub(super) const SECTION_HEAD_MM: f64 = 5.0;

/// Returns the page with this title and content.
pub(super) fn whole(title: &str, content: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                title { (printable(title)) }
                style { (PreEscaped(include_str!("page/page.css"))) }
            }
            body { (content) }
        }
    };
    page.into_string()
}

/// Returns the head of a page: a name, the kind of page, and pairs of lines at the left and at the
/// right.
pub(super) fn head(name: &str, kind: &str, lines: [[&str; 2]; 2]) -> Markup {
    html! {
        header.page {
            div { h1 { (printable(name)) } span { (kind) } }
            @for [left, right] in lines {
                div { p { (printable(left)) } p { (right) } }
            }
        }
    }
}

/// Returns a section: its name, a remark, and its content.
pub(super) fn section(class: &str, name: &str, remark: &str, content: &Markup) -> Markup {
    html! {
        section class=(class) {
            header { h2 { (name) } p { (remark) } }
            (content)
        }
    }
}

/// Formats latitude, longitude and altitude of a site.
pub(super) fn place(site: Site) -> String {
    format!(
        "{}, {}, {} m",
        format::latitude(site.latitude().degrees(), 3),
        format::longitude(site.longitude().degrees(), 3),
        format::number(site.altitude_m(), 0)
    )
}

/// Returns a text without characters that no printer shows or that reverse the direction of text.
pub(super) fn printable(text: &str) -> String {
    let is_unseen = |letter: char| {
        letter.is_control()
            || matches!(letter, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}')
            || matches!(letter, '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff0}'..='\u{ffff}')
    };
    let words = text.split(|letter: char| letter.is_whitespace() || is_unseen(letter));
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_printer_shows_is_left_out() {
        assert_eq!(printable("A\u{0}B\u{202e}C\n\u{feff}D\u{ffff}"), "A B C D");
    }

    #[test]
    fn the_style_sheet_and_the_page_agree_on_heights() {
        let css = include_str!("page/page.css");
        for rule in [
            format!("height: {HEIGHT_MM}mm"),
            format!("gap: {GAP_MM}mm"),
            format!("flex: 0 0 {SECTION_HEAD_MM}mm"),
        ] {
            assert!(css.contains(&rule), "{rule}");
        }
    }
}
