//! Digits by their place on the keyboard.
//!
//! Some layouts need Shift for the digits and have other signs on these keys. On a French keyboard,
//! Ctrl+4 would be Ctrl+'. Azel names keys by the digits printed on them.

use egui::{Context, Event, Key, Plugin, RawInput};

/// Plugin that turns each key of the digit row into its digit, whatever sign the layout has there.
pub struct DigitKeys;

impl Plugin for DigitKeys {
    fn debug_name(&self) -> &'static str {
        "digit keys"
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        for event in &mut input.events {
            let Event::Key { key, physical_key: Some(place), modifiers, .. } = event else {
                continue;
            };
            // With Shift or Alt, a layout may have a sign there that Azel uses as a key: Shift+7 is
            // the slash of a German keyboard.
            if is_digit(*place) && is_sign(*key) && !modifiers.shift && !modifiers.alt {
                *key = *place;
            }
        }
    }
}

fn is_digit(key: Key) -> bool {
    matches!(
        key,
        Key::Num0
            | Key::Num1
            | Key::Num2
            | Key::Num3
            | Key::Num4
            | Key::Num5
            | Key::Num6
            | Key::Num7
            | Key::Num8
            | Key::Num9
    )
}

/// Returns `false` for letters, and for the keys of a number pad without Num Lock.
fn is_sign(key: Key) -> bool {
    matches!(
        key,
        Key::Colon
            | Key::Comma
            | Key::Backslash
            | Key::Slash
            | Key::Pipe
            | Key::Questionmark
            | Key::Exclamationmark
            | Key::OpenBracket
            | Key::CloseBracket
            | Key::OpenCurlyBracket
            | Key::CloseCurlyBracket
            | Key::Backtick
            | Key::Minus
            | Key::Period
            | Key::Plus
            | Key::Equals
            | Key::Semicolon
            | Key::Quote
    )
}

#[cfg(test)]
mod tests {
    use egui::Modifiers;

    use super::*;

    #[test]
    fn the_digit_row_gives_digits_on_every_layout() {
        let read = |key, place, modifiers| {
            let event = Event::Key {
                key,
                physical_key: Some(place),
                pressed: true,
                repeat: false,
                modifiers,
            };
            let mut input = RawInput { events: vec![event], ..RawInput::default() };
            DigitKeys.input_hook(&Context::default(), &mut input);
            let [Event::Key { key, .. }] = input.events[..] else { panic!("{:?}", input.events) };
            key
        };
        let (none, ctrl, shift) = (Modifiers::NONE, Modifiers::COMMAND, Modifiers::SHIFT);
        // French: 4 and 6. Czech: 1.
        assert_eq!(read(Key::Quote, Key::Num4, ctrl), Key::Num4);
        assert_eq!(read(Key::Minus, Key::Num6, none), Key::Num6);
        assert_eq!(read(Key::Plus, Key::Num1, ctrl), Key::Num1);
        // German: the slash.
        assert_eq!(read(Key::Slash, Key::Num7, shift), Key::Slash);
        // The number pad without Num Lock, and keys elsewhere.
        assert_eq!(read(Key::ArrowLeft, Key::Num4, none), Key::ArrowLeft);
        assert_eq!(read(Key::Minus, Key::Minus, ctrl), Key::Minus);
    }
}
