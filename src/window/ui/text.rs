//! The type scale: every text in the window has one of these fonts.

use egui::{FontData, FontDefinitions, FontFamily, FontId};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// Running text.
    Regular,
    /// Buttons and names.
    Medium,
    /// Values and titles.
    SemiBold,
    /// The cardinal points and the word STOP.
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

/// A font of any size; prefer the named ones below.
pub fn sized(size: f32, weight: Weight) -> FontId {
    FontId::new(size, weight.family())
}

/// UTC clock and the main countdown.
pub fn clock() -> FontId {
    sized(28.0, Weight::SemiBold)
}

/// Name of the selected object.
pub fn title() -> FontId {
    sized(20.0, Weight::SemiBold)
}

/// Countdown in a row, title of a card.
pub fn value() -> FontId {
    sized(15.0, Weight::SemiBold)
}

/// Axes table.
pub fn axis() -> FontId {
    sized(15.0, Weight::Regular)
}

/// Sentences.
pub fn body() -> FontId {
    sized(13.0, Weight::Regular)
}

/// Buttons and names.
pub fn body_medium() -> FontId {
    sized(13.0, Weight::Medium)
}

/// Second lines, tables, chips.
pub fn small() -> FontId {
    sized(12.0, Weight::Regular)
}

/// Values in second lines and small buttons.
pub fn small_strong() -> FontId {
    sized(12.0, Weight::SemiBold)
}

/// Axis numbers, heads of columns.
pub fn caption() -> FontId {
    sized(11.0, Weight::Regular)
}

/// Raw frames and hex.
pub fn raw() -> FontId {
    FontId::new(12.0, FontFamily::Monospace)
}

/// The fonts of the window. All digits have the same width, so that numbers change in place.
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
