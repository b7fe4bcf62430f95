//! Directions and labels of the jog keys.

use egui::Key;

/// Direction of a jog key. On an az/el mount X is azimuth and Y is elevation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum JogDirection {
    XPlus,
    XMinus,
    YPlus,
    YMinus,
}

impl JogDirection {
    /// All directions in Tab order.
    pub const ALL: [Self; 4] = [Self::YPlus, Self::XMinus, Self::XPlus, Self::YMinus];

    /// Returns the signs of the two axes.
    pub fn signs(self) -> (i8, i8) {
        match self {
            Self::XPlus => (1, 0),
            Self::XMinus => (-1, 0),
            Self::YPlus => (0, 1),
            Self::YMinus => (0, -1),
        }
    }

    /// Returns the direction of an arrow key.
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

/// The axes that the keys move; they determine the labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum JogKeys {
    /// The axes of an X/Y mount, with the direction in the sky of each key.
    Xy { x_plus: &'static str, x_minus: &'static str, y_plus: &'static str, y_minus: &'static str },
    /// Azimuth and elevation.
    #[default]
    AzEl,
    /// The azimuth, and a second axis of this name.
    AzOther(&'static str),
    /// Only the azimuth.
    Az,
}

/// Label of a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyLabel {
    /// An arrow, a sign or the axis, above the word.
    pub mark: &'static str,
    /// Word of the front panels, or direction in the sky.
    pub word: &'static str,
    /// Axis and direction, for screen readers.
    pub name: String,
    /// Further description of the key; may be empty.
    pub description: String,
}

impl JogKeys {
    /// Returns the label of the key of a direction; `None` if there is no such key.
    pub fn label(self, direction: JogDirection) -> Option<KeyLabel> {
        use JogDirection::{XMinus, XPlus, YMinus, YPlus};
        let (mark, word, name) = match (self, direction) {
            (Self::Xy { x_plus, .. }, XPlus) => ("X+", x_plus, "X+"),
            (Self::Xy { x_minus, .. }, XMinus) => ("X−", x_minus, "X−"),
            (Self::Xy { y_plus, .. }, YPlus) => ("Y+", y_plus, "Y+"),
            (Self::Xy { y_minus, .. }, YMinus) => ("Y−", y_minus, "Y−"),
            (_, XPlus) => ("→", "CW", "clockwise"),
            (_, XMinus) => ("←", "CCW", "counterclockwise"),
            (Self::AzEl, YPlus) => ("↑", "Up", "up"),
            (Self::AzEl, YMinus) => ("↓", "Down", "down"),
            (Self::AzOther(word), YPlus) => ("+", word, ""),
            (Self::AzOther(word), YMinus) => ("−", word, ""),
            (Self::Az, YPlus | YMinus) => return None,
        };
        let name = if name.is_empty() { format!("{word} {mark}") } else { name.to_owned() };
        let description = match self {
            Self::Xy { .. } => format!("{mark}: towards {word}"),
            Self::AzEl | Self::AzOther(_) | Self::Az => String::new(),
        };
        Some(KeyLabel { mark, word, name, description })
    }
}
