//! Repeats of a held key, which are nothing new while the key moves an antenna.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use eframe::{EframeWinitApplication, UserEvent};
use winit::{
    application::ApplicationHandler,
    event::{DeviceEvent, DeviceId, StartCause, WindowEvent},
    event_loop::ActiveEventLoop,
    window::WindowId,
};

/// A window to which repeats of keys are not passed on while one of them moves an antenna. The
/// toolkit draws a frame for each, 25 a second, and Esc would have to wait for many of them.
pub(super) struct WithoutRepeats<'app> {
    pub(super) window: EframeWinitApplication<'app>,
    pub(super) is_jogging: Arc<AtomicBool>,
}

impl ApplicationHandler<UserEvent> for WithoutRepeats<'_> {
    fn window_event(&mut self, events: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        let repeats = matches!(&event, WindowEvent::KeyboardInput { event, .. } if event.repeat);
        if !(repeats && self.is_jogging.load(Ordering::Relaxed)) {
            self.window.window_event(events, id, event);
        }
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
