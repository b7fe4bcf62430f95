//! Decides whether a jog key is held. Everything doubtful counts as released.

use egui::{Event, InputState, Key};

use super::JogDirection;

/// What keeps a key held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Pointer,
    Keyboard(Key),
}

/// Which key is held, kept from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct JogState {
    held: Option<(JogDirection, Source)>,
    focus: bool,
}

/// What one frame says about the pad.
#[derive(Debug, Clone, Default)]
pub(super) struct Frame {
    /// The pad is refused.
    locked: bool,
    /// Directions without a usable key, in the order of [`JogDirection::ALL`].
    pub(super) blocked: [bool; 4],
    /// The pointer holds this key down.
    pub(super) pointer_on: Option<JogDirection>,
    /// This key has the focus of the keyboard.
    pub(super) focus: Option<JogDirection>,
    pointer_lost: bool,
    pointer_pressed: bool,
    window_lost: bool,
    escape: bool,
    pressed: Vec<Key>,
    down: Vec<Key>,
}

const USED: [Key; 6] =
    [Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown, Key::Space, Key::Enter];

impl Frame {
    pub(super) fn new(locked: bool) -> Self {
        Self { locked, ..Self::default() }
    }

    /// Takes in the window, the pointer and the keys.
    pub(super) fn read(&mut self, input: &InputState) {
        self.window_lost = !input.focused;
        self.pointer_lost = !input.pointer.has_pointer() || !input.pointer.primary_down();
        self.pointer_pressed = input.pointer.primary_pressed();
        self.escape = input.key_pressed(Key::Escape);
        self.down = USED.into_iter().filter(|key| input.key_down(*key)).collect();
        self.pressed = input
            .events
            .iter()
            .filter_map(|event| match event {
                // A repeated press may be left over from before the focus came back.
                Event::Key { key, pressed: true, repeat: false, modifiers, .. }
                    if !modifiers.any() =>
                {
                    Some(*key)
                }
                _ => None,
            })
            .collect();
    }

    fn is_blocked(&self, direction: JogDirection) -> bool {
        JogDirection::ALL.iter().zip(self.blocked).any(|(at, blocked)| *at == direction && blocked)
    }

    fn keeps(&self, direction: JogDirection, source: Source) -> bool {
        match source {
            Source::Pointer => !self.pointer_lost && self.pointer_on == Some(direction),
            Source::Keyboard(key) => self.focus.is_some() && self.down.contains(&key),
        }
    }

    /// A key that went down in this very frame.
    fn new_press(&self) -> Option<(JogDirection, Source)> {
        if self.pointer_pressed
            && !self.pointer_lost
            && let Some(direction) = self.pointer_on
        {
            return Some((direction, Source::Pointer));
        }
        let focus = self.focus?;
        self.pressed.iter().find_map(|key| {
            let direction = match key {
                Key::Space | Key::Enter => Some(focus),
                arrow => JogDirection::of_arrow(*arrow),
            };
            Some((direction?, Source::Keyboard(*key)))
        })
    }
}

impl JogState {
    /// The direction that is held in this frame.
    pub(super) fn step(&mut self, frame: &Frame) -> Option<JogDirection> {
        self.focus = frame.focus.is_some() && !frame.window_lost;
        if frame.locked || frame.window_lost || frame.escape {
            self.held = None;
            return None;
        }
        self.held = self
            .held
            .filter(|(direction, source)| frame.keeps(*direction, *source))
            .or_else(|| frame.new_press())
            .filter(|(direction, source)| {
                !frame.is_blocked(*direction) && frame.keeps(*direction, *source)
            });
        self.held.map(|(direction, _)| direction)
    }

    /// One of the keys has the focus of the keyboard.
    pub fn has_focus(self) -> bool {
        self.focus
    }

    /// One of the keys is held.
    pub fn is_held(self) -> bool {
        self.held.is_some()
    }
}
