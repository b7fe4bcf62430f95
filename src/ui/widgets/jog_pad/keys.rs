//! What the jog keys are called.

use egui::Key;

/// Where a key moves the antenna. On an az/el mount X is the azimuth and Y the
/// elevation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum JogDirection {
    /// Up the first axis.
    XPlus,
    /// Down the first axis.
    XMinus,
    /// Up the second axis.
    YPlus,
    /// Down the second axis.
    YMinus,
}

impl JogDirection {
    /// All directions in the order of Tab.
    pub const ALL: [Self; 4] = [Self::YPlus, Self::XMinus, Self::XPlus, Self::YMinus];

    /// Signs of the two axes.
    pub fn signs(self) -> (i8, i8) {
        match self {
            Self::XPlus => (1, 0),
            Self::XMinus => (-1, 0),
            Self::YPlus => (0, 1),
            Self::YMinus => (0, -1),
        }
    }

    /// The direction that an arrow key stands for.
    pub fn of_arrow(key: Key) -> Option<Self> {
        Self::ALL.into_iter().find(|direction| direction.arrow() == key)
    }

    fn arrow(self) -> Key {
        match self {
            Self::XPlus => Key::ArrowRight,
            Self::XMinus => Key::ArrowLeft,
            Self::YPlus => Key::ArrowUp,
            Self::YMinus => Key::ArrowDown,
        }
    }
}

/// What the keys are called, by what they turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum JogKeys {
    /// The axes of an X/Y mount.
    #[default]
    Xy,
    /// Azimuth and elevation.
    AzEl,
    /// The azimuth, and another rotator that turns something else.
    AzOther,
}

/// What stands on a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeyLabel {
    /// An arrow or a sign above the word; empty for a word alone.
    pub mark: &'static str,
    /// In the words of the front panels.
    pub word: &'static str,
    /// What it turns, for those who do not see where it stands.
    pub name: &'static str,
}

impl JogKeys {
    /// What stands on the key of a direction.
    pub fn label(self, direction: JogDirection) -> KeyLabel {
        use JogDirection::{XMinus, XPlus, YMinus, YPlus};
        let (mark, word, name) = match (self, direction) {
            (Self::Xy, XPlus) => ("", "X+", "X+"),
            (Self::Xy, XMinus) => ("", "X−", "X−"),
            (Self::Xy, YPlus) => ("", "Y+", "Y+"),
            (Self::Xy, YMinus) => ("", "Y−", "Y−"),
            (Self::AzEl | Self::AzOther, XPlus) => ("→", "CW", "clockwise"),
            (Self::AzEl | Self::AzOther, XMinus) => ("←", "CCW", "counterclockwise"),
            (Self::AzEl, YPlus) => ("↑", "Up", "up"),
            (Self::AzEl, YMinus) => ("↓", "Down", "down"),
            (Self::AzOther, YPlus) => ("+", "Other", "Other +"),
            (Self::AzOther, YMinus) => ("−", "Other", "Other −"),
        };
        KeyLabel { mark, word, name }
    }
}
