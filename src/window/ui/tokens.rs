//! The colours of the three themes. View code uses only these tokens; no other module contains a
//! literal colour.

// The design writes colours in this form.
#![allow(clippy::unreadable_literal)]

use egui::Color32;

use crate::model::ThemeName;

impl ThemeName {
    pub fn tokens(self) -> &'static Tokens {
        match self {
            Self::Dark => &DARK,
            Self::Light => &LIGHT,
            Self::Night => &NIGHT,
        }
    }
}

/// The colours of a theme, one for each role.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tokens {
    /// Background of the window and of plot surroundings.
    pub bg0: Color32,
    /// Background of inputs and of table rows. In the light theme, the background of the window
    /// would make them look disabled.
    pub field: Color32,
    /// Background of panels, bars and the day part of the plan.
    pub bg1: Color32,
    /// Background of cards, table heads and the state sentence.
    pub bg2: Color32,
    /// Background of buttons and the gauge track.
    pub bg3: Color32,
    /// Background of the selected row and the active view.
    pub bgsel: Color32,
    /// Background of the disc of the sky plot.
    pub sky: Color32,
    /// Colour of dividers and the quiet grid.
    pub line: Color32,
    /// Colour of control borders, the rim and the day lines of the plan.
    pub edge: Color32,
    /// Colour of rings and spokes.
    pub grid: Color32,
    /// Colour of main text and the now-line.
    pub t1: Color32,
    /// Colour of secondary text.
    pub t2: Color32,
    /// Colour of captions and axis numbers.
    pub t3: Color32,
    /// Colour of the selected satellite, predictions, the selection and primary actions.
    pub sat: Color32,
    /// Colour of commands: ring, command column, slew and held jog key.
    pub cmd: Color32,
    /// Colour of measured antenna positions.
    pub ant: Color32,
    /// Colour of good, verified and live states.
    pub ok: Color32,
    /// Colour of cautions: time lost, late, or confirmation needed.
    pub warn: Color32,
    /// Colour of faults, limits, rejections and lost links.
    pub bad: Color32,
    /// Fill of STOP only.
    pub stop: Color32,
    /// Text on STOP.
    pub onstop: Color32,
    /// Text on a sat or cmd fill.
    pub onsat: Color32,
    /// Background of a row or note with a caution.
    pub warnbg: Color32,
    /// Background of a row with a fault.
    pub badbg: Color32,
    /// Background of a note or field row with a confirmed value.
    pub okbg: Color32,
    /// Fill of keep-outs and of the ends of travel.
    pub keep: Color32,
    /// Fill of the mask under its hatch.
    pub mask: Color32,
    /// Colour of the hatch lines of the mask.
    pub hatch: Color32,
    /// Colour of the Sun.
    pub sun: Color32,
    /// Colour of the Moon.
    pub moon: Color32,
    /// Colour of unselected satellites and of passes left out.
    pub other: Color32,
}

/// Veil above parts that are unusable while a question is open, in every theme. Positions, links
/// and states stay readable through the veil.
pub const VEIL: Color32 = Color32::from_black_alpha(26);

const fn rgb(hex: u32) -> Color32 {
    let [_, r, g, b] = hex.to_be_bytes();
    // Only this function turns a literal into a colour.
    #[allow(clippy::disallowed_methods)]
    Color32::from_rgb(r, g, b)
}

const DARK: Tokens = Tokens {
    bg0: rgb(0x0A0E13),
    field: rgb(0x0A0E13),
    bg1: rgb(0x10161D),
    bg2: rgb(0x171F28),
    bg3: rgb(0x222D39),
    bgsel: rgb(0x123048),
    sky: rgb(0x0D131A),
    line: rgb(0x26313D),
    edge: rgb(0x5F7186),
    grid: rgb(0x33414F),
    t1: rgb(0xEDF2F7),
    t2: rgb(0xB4C0CD),
    t3: rgb(0x8B9AAB),
    sat: rgb(0x58C7FF),
    cmd: rgb(0xEE93F5),
    ant: rgb(0xFFFFFF),
    ok: rgb(0x4FD08B),
    warn: rgb(0xFFBC4B),
    bad: rgb(0xFF7A70),
    stop: rgb(0xD42B1E),
    onstop: rgb(0xFFFFFF),
    onsat: rgb(0x04141F),
    warnbg: rgb(0x33270F),
    badbg: rgb(0x3A1614),
    okbg: rgb(0x0F2C1E),
    keep: rgb(0x5A1B18),
    mask: rgb(0x1D262F),
    hatch: rgb(0x4E5D6D),
    sun: rgb(0xFFE08A),
    moon: rgb(0xC9D3DE),
    other: rgb(0x93A6BA),
};

const LIGHT: Tokens = Tokens {
    bg0: rgb(0xDFE4EA),
    field: rgb(0xFFFFFF),
    bg1: rgb(0xF3F5F8),
    bg2: rgb(0xFFFFFF),
    bg3: rgb(0xE4E9EF),
    bgsel: rgb(0xD6E8F8),
    sky: rgb(0xFBFCFE),
    line: rgb(0xCDD4DC),
    edge: rgb(0x76859A),
    grid: rgb(0xBCC6D1),
    t1: rgb(0x0E151C),
    t2: rgb(0x3A4653),
    t3: rgb(0x556272),
    sat: rgb(0x00629E),
    cmd: rgb(0x98149F),
    ant: rgb(0x000000),
    ok: rgb(0x0A7038),
    warn: rgb(0x8A5000),
    bad: rgb(0xB3150D),
    stop: rgb(0xC5160B),
    onstop: rgb(0xFFFFFF),
    onsat: rgb(0xFFFFFF),
    warnbg: rgb(0xFBEBCB),
    badbg: rgb(0xFADCD9),
    okbg: rgb(0xD5EEDF),
    keep: rgb(0xF3B6B0),
    mask: rgb(0xD9DFE6),
    hatch: rgb(0x9AA7B5),
    sun: rgb(0x7A5B00),
    moon: rgb(0x4A5663),
    other: rgb(0x4A5A6B),
};

const NIGHT: Tokens = Tokens {
    bg0: rgb(0x000000),
    field: rgb(0x000000),
    bg1: rgb(0x0B0000),
    bg2: rgb(0x150202),
    bg3: rgb(0x240505),
    bgsel: rgb(0x340505),
    sky: rgb(0x050000),
    line: rgb(0x3A0909),
    edge: rgb(0xB23022),
    grid: rgb(0x571008),
    t1: rgb(0xFF5743),
    t2: rgb(0xFF4A38),
    t3: rgb(0xF8402F),
    sat: rgb(0xFF624C),
    cmd: rgb(0xFF5D4A),
    ant: rgb(0xFF7C6A),
    ok: rgb(0xFF5D4A),
    warn: rgb(0xFF6C58),
    bad: rgb(0xFF7C6A),
    stop: rgb(0xEC2A1D),
    onstop: rgb(0x000000),
    onsat: rgb(0x150000),
    warnbg: rgb(0x2E0504),
    badbg: rgb(0x3E0706),
    okbg: rgb(0x240404),
    keep: rgb(0x4A0806),
    mask: rgb(0x1A0303),
    hatch: rgb(0x7A160D),
    sun: rgb(0xFF6C58),
    moon: rgb(0xF8402F),
    other: rgb(0xF8402F),
};

/// Returns the contrast of two opaque colours by the Web Content Accessibility Guidelines, from 1
/// to 21.
pub fn contrast(a: Color32, b: Color32) -> f64 {
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

fn luminance(colour: Color32) -> f64 {
    let linear = |channel: u8| {
        let value = f64::from(channel) / 255.0;
        if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_control_borders_can_be_read_in_every_theme() {
        for theme in [ThemeName::Dark, ThemeName::Light, ThemeName::Night] {
            let t = theme.tokens();
            for (name, front, back, needed) in [
                ("t1 on bg1", t.t1, t.bg1, 4.5),
                ("t2 on bg1", t.t2, t.bg1, 4.5),
                ("t3 on bg1", t.t3, t.bg1, 4.5),
                ("t3 on bg2", t.t3, t.bg2, 4.5),
                ("t3 on bgsel", t.t3, t.bgsel, 4.5),
                ("sat on sky", t.sat, t.sky, 4.5),
                ("cmd on sky", t.cmd, t.sky, 4.5),
                ("other on sky", t.other, t.sky, 4.5),
                ("t2 on sky", t.t2, t.sky, 4.5),
                ("t3 on sky", t.t3, t.sky, 4.5),
                ("t3 on bg0", t.t3, t.bg0, 4.5),
                ("ok on bg0", t.ok, t.bg0, 4.5),
                ("sat on bg0", t.sat, t.bg0, 4.5),
                ("warn on bg0", t.warn, t.bg0, 4.5),
                ("bad on bg0", t.bad, t.bg0, 4.5),
                ("bad on bg1", t.bad, t.bg1, 4.5),
                ("t2 on bgsel", t.t2, t.bgsel, 4.5),
                ("warn on bgsel", t.warn, t.bgsel, 4.5),
                ("bad on bgsel", t.bad, t.bgsel, 4.5),
                ("sun on bg0", t.sun, t.bg0, 4.5),
                ("sat on bgsel", t.sat, t.bgsel, 4.5),
                ("ok on bgsel", t.ok, t.bgsel, 4.5),
                ("sun on bgsel", t.sun, t.bgsel, 4.5),
                ("ok on bg1", t.ok, t.bg1, 4.5),
                ("warn on warnbg", t.warn, t.warnbg, 4.5),
                ("bad on badbg", t.bad, t.badbg, 4.5),
                ("t1 on keep", t.t1, t.keep, 4.5),
                ("onstop on stop", t.onstop, t.stop, 4.5),
                ("onsat on sat", t.onsat, t.sat, 4.5),
                ("edge on bg1", t.edge, t.bg1, 3.0),
                ("edge on bg2", t.edge, t.bg2, 3.0),
                ("t1 on field", t.t1, t.field, 4.5),
                ("t3 on field", t.t3, t.field, 4.5),
                ("edge on field", t.edge, t.field, 3.0),
                ("sat on field", t.sat, t.field, 3.0),
                ("bad on field", t.bad, t.field, 3.0),
                ("ok on okbg", t.ok, t.okbg, 4.5),
                ("t3 on warnbg", t.t3, t.warnbg, 4.5),
                ("t3 on badbg", t.t3, t.badbg, 4.5),
                ("onsat on warn", t.onsat, t.warn, 4.5),
                ("onsat on t3", t.onsat, t.t3, 4.5),
                ("onsat on cmd", t.onsat, t.cmd, 4.5),
            ] {
                let ratio = contrast(front, back);
                assert!(ratio >= needed, "{theme:?} {name}: {ratio:.2}");
            }
        }
    }

    #[test]
    fn night_keeps_green_and_blue_small() {
        let t = ThemeName::Night.tokens();
        for body in [t.t1, t.t2, t.t3] {
            assert!(body.g() <= 87 && body.b() <= 87, "{body:?}");
        }
        for mark in [t.sat, t.cmd, t.ant, t.ok, t.warn, t.bad, t.sun, t.moon, t.other] {
            assert!(mark.g() <= 124 && mark.b() <= 124, "{mark:?}");
        }
    }
}
