//! Repeats of a held key, which are nothing new while an antenna is jogged.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use eframe::{EframeWinitApplication, UserEvent};
use winit::{
    application::ApplicationHandler,
    event::{DeviceEvent, DeviceId, StartCause, WindowEvent},
    event_loop::ActiveEventLoop,
    keyboard::{Key, NamedKey},
    window::WindowId,
};

/// A window to which repeats of keys are not passed on while an antenna is jogged. The toolkit draws
/// two frames for each, of 25 a second, and Esc would have to wait for many of them.
pub(super) struct WithoutRepeats<'app> {
    pub(super) window: EframeWinitApplication<'app>,
    pub(super) is_jogging: Arc<AtomicBool>,
}

/// Returns `true` for a key event that the window does not get. It gets every Esc: each asks for STOP.
fn is_left_out(key: &Key, repeats: bool, is_jogging: bool) -> bool {
    repeats && is_jogging && *key != Key::Named(NamedKey::Escape)
}

impl ApplicationHandler<UserEvent> for WithoutRepeats<'_> {
    fn window_event(&mut self, events: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        let is_jogging = self.is_jogging.load(Ordering::Relaxed);
        if let WindowEvent::KeyboardInput { event: key, .. } = &event
            && is_left_out(&key.logical_key, key.repeat, is_jogging)
        {
            return;
        }
        self.window.window_event(events, id, event);
    }

    fn new_events(&mut self, events: &ActiveEventLoop, cause: StartCause) {
        self.window.new_events(events, cause);
    }

    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.window.resumed(events);
    }

    fn user_event(&mut self, events: &ActiveEventLoop, event: UserEvent) {
        self.window.user_event(events, event);
    }

    fn device_event(&mut self, events: &ActiveEventLoop, id: DeviceId, event: DeviceEvent) {
        self.window.device_event(events, id, event);
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        self.window.about_to_wait(events);
    }

    fn suspended(&mut self, events: &ActiveEventLoop) {
        self.window.suspended(events);
    }

    fn exiting(&mut self, events: &ActiveEventLoop) {
        self.window.exiting(events);
    }

    fn memory_warning(&mut self, events: &ActiveEventLoop) {
        self.window.memory_warning(events);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_key_is_left_out_while_an_antenna_is_jogged_but_no_press_and_never_esc() {
        let arrow = Key::Named(NamedKey::ArrowRight);
        assert!(is_left_out(&arrow, true, true));
        assert!(!is_left_out(&arrow, false, true));
        assert!(!is_left_out(&arrow, true, false));
        assert!(!is_left_out(&Key::Named(NamedKey::Escape), true, true));
    }
}
