//! The type scale, the only fonts of the window.

use egui::{FontData, FontDefinitions, FontFamily, FontId};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// Weight of running text.
    Regular,
    /// Weight of buttons and names.
    Medium,
    /// Weight of values and titles.
    SemiBold,
    /// Weight of the cardinal points and the word STOP.
    Bold,
}

impl Weight {
    fn family(self) -> FontFamily {
        match self {
            Self::Regular => FontFamily::Proportional,
            Self::Medium => FontFamily::Name("medium".into()),
            Self::SemiBold => FontFamily::Name("semibold".into()),
            Self::Bold => FontFamily::Name("bold".into()),
        }
    }
}

/// Returns a font of any size; prefer the named fonts below.
pub fn sized(size: f32, weight: Weight) -> FontId {
    FontId::new(size, weight.family())
}

/// Returns the font of the UTC clock and the main countdown.
pub fn clock() -> FontId {
    sized(28.0, Weight::SemiBold)
}

/// Returns the font of the name of the selected object.
pub fn title() -> FontId {
    sized(20.0, Weight::SemiBold)
}

/// Returns the font of a countdown in a row and of the title of a card.
pub fn value() -> FontId {
    sized(15.0, Weight::SemiBold)
}

/// Returns the font of the axes table.
pub fn axis() -> FontId {
    sized(15.0, Weight::Regular)
}

/// Returns the font of sentences.
pub fn body() -> FontId {
    sized(13.0, Weight::Regular)
}

/// Returns the font of buttons and names.
pub fn body_medium() -> FontId {
    sized(13.0, Weight::Medium)
}

/// Returns the font of second lines, tables and chips.
pub fn small() -> FontId {
    sized(12.0, Weight::Regular)
}

/// Returns the font of values in second lines and of small buttons.
pub fn small_strong() -> FontId {
    sized(12.0, Weight::SemiBold)
}

/// Returns the font of axis numbers and column headings.
pub fn caption() -> FontId {
    sized(11.0, Weight::Regular)
}

/// Returns the font of raw frames and hex.
pub fn raw() -> FontId {
    FontId::new(12.0, FontFamily::Monospace)
}

/// Returns the fonts of the window. All digits have the same width, so that numbers change in
/// place.
pub fn definitions() -> FontDefinitions {
    let mut fonts = FontDefinitions::empty();
    let mut add = |family: FontFamily, name: &str, bytes: &'static [u8]| {
        fonts.font_data.insert(name.to_owned(), FontData::from_static(bytes).into());
        fonts.families.entry(family).or_default().push(name.to_owned());
    };
    add(
        Weight::Regular.family(),
        "Inter",
        include_bytes!("../../../assets/fonts/Inter-Regular.otf"),
    );
    add(
        Weight::Medium.family(),
        "Inter Medium",
        include_bytes!("../../../assets/fonts/Inter-Medium.otf"),
    );
    add(
        Weight::SemiBold.family(),
        "Inter SemiBold",
        include_bytes!("../../../assets/fonts/Inter-SemiBold.otf"),
    );
    add(
        Weight::Bold.family(),
        "Inter Bold",
        include_bytes!("../../../assets/fonts/Inter-Bold.otf"),
    );
    add(
        FontFamily::Monospace,
        "JetBrains Mono",
        include_bytes!("../../../assets/fonts/JetBrainsMono-Regular.ttf"),
    );
    fonts
}
