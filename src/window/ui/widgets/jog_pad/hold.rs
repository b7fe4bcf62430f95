//! Detection of a held jog key. Every doubtful state counts as released.

use egui::{Event, InputState, Key};

use super::JogDirection;

/// The input that holds a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Pointer,
    Keyboard(Key),
}

/// The part of the pad that has the keyboard focus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Focus {
    /// The pad as a whole, with the arrows as its keys.
    Pad,
    /// One key, which Space and Enter also press.
    Key(JogDirection),
}

/// The held key, kept from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct JogState {
    held_jog: Option<(JogDirection, Source)>,
    focus: bool,
    wish: Wish,
}

/// A request to give the pad the keyboard focus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Wish {
    #[default]
    None,
    /// A request of this frame, possibly by a key among its events.
    New,
    /// A request that waits until the pad is free.
    Waiting,
}

/// The input of one frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Frame {
    /// `true` if Azel refuses jogging.
    locked: bool,
    /// Directions without a usable key, in the order of [`JogDirection::ALL`].
    pub(super) blocked: [bool; 4],
    /// Key that the pointer holds down.
    pub(super) pointer_on: Option<JogDirection>,
    pub(super) focus: Option<Focus>,
    pointer_lost: bool,
    pointer_pressed: bool,
    window_lost: bool,
    escape: bool,
    pressed: Vec<Key>,
    down: Vec<Key>,
    /// `true` if any key or button went down, on the pad or elsewhere.
    anything_pressed: bool,
}

const USED: [Key; 6] =
    [Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown, Key::Space, Key::Enter];

impl Frame {
    pub(super) fn new(locked: bool) -> Self {
        Self { locked, ..Self::default() }
    }

    /// Reads the state of the window, the pointer and the keys.
    pub(super) fn read(&mut self, input: &InputState) {
        self.window_lost = !input.focused;
        self.pointer_lost = !input.pointer.has_pointer() || !input.pointer.primary_down();
        self.pointer_pressed = input.pointer.primary_pressed();
        self.escape = input.key_pressed(Key::Escape);
        self.down = USED.into_iter().filter(|key| input.key_down(*key)).collect();
        // Raw events include the events that another control has consumed.
        self.anything_pressed = input.raw.events.iter().any(|event| {
            matches!(
                event,
                Event::Key { pressed: true, repeat: false, .. }
                    | Event::PointerButton { pressed: true, .. }
            )
        });
        self.pressed = input
            .events
            .iter()
            .filter_map(|event| match event {
                // A repeated press may have started before the window got the focus.
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
        JogDirection::ALL
            .iter()
            .zip(self.blocked)
            .any(|(jog_direction, blocked)| *jog_direction == direction && blocked)
    }

    fn keeps(&self, direction: JogDirection, source: Source) -> bool {
        match source {
            Source::Pointer => !self.pointer_lost && self.pointer_on == Some(direction),
            Source::Keyboard(key) => self.focus.is_some() && self.down.contains(&key),
        }
    }

    /// Returns a jog key that went down in this frame.
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
                Key::Space | Key::Enter => match focus {
                    Focus::Key(direction) => Some(direction),
                    Focus::Pad => None,
                },
                arrow => JogDirection::of_arrow(*arrow),
            };
            Some((direction?, Source::Keyboard(*key)))
        })
    }
}

impl JogState {
    /// Advances by one frame. Returns the held direction.
    pub(super) fn step(&mut self, frame: &Frame) -> Option<JogDirection> {
        self.focus = frame.focus.is_some() && !frame.window_lost;
        if frame.locked || frame.window_lost || frame.escape {
            self.held_jog = None;
            return None;
        }
        self.held_jog = self
            .held_jog
            .filter(|(direction, source)| frame.keeps(*direction, *source))
            .or_else(|| frame.new_press())
            .filter(|(direction, source)| {
                !frame.is_blocked(*direction) && frame.keeps(*direction, *source)
            });
        self.held_jog.map(|(direction, _)| direction)
    }

    /// Gives the pad the keyboard focus as soon as the pad is free. This moves nothing.
    pub fn focus(&mut self) {
        self.wish = Wish::New;
    }

    /// Returns `true` when the pad takes the keyboard focus in this frame. Any other press
    /// before the pad is free cancels the request.
    pub(super) fn takes_focus(&mut self, frame: &Frame) -> bool {
        let wish = std::mem::take(&mut self.wish);
        let is_over = wish == Wish::Waiting && frame.anything_pressed;
        if wish == Wish::None || is_over || frame.window_lost {
            return false;
        }
        if frame.locked {
            self.wish = Wish::Waiting;
            return false;
        }
        frame.focus.is_none()
    }

    /// Returns `true` if the pad or one of its keys has the keyboard focus.
    pub fn has_focus(self) -> bool {
        self.focus
    }

    pub fn is_held(self) -> bool {
        self.held_jog.is_some()
    }
}
