//! One frame for each request.
//!
//! egui draws two frames per request and requests one after every input, to show results that come
//! a frame late. On a software renderer, this extra frame is most of the cost of a key press. Late
//! results still appear with the frame of the full second.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use egui::{Context, Event, Plugin, RawInput, RequestRepaintInfo};

/// Calls `draw` once per frame requested of `ctx`; replaces the previous callback.
pub fn draw_once(ctx: &Context, draw: impl Fn(RequestRepaintInfo) + Send + Sync + 'static) {
    let only_releases = Arc::<AtomicBool>::default();
    ctx.add_plugin(KeyReleases(Arc::clone(&only_releases)));
    ctx.set_request_repaint_callback(|_| {});
    ctx.set_repaint_observer(move |request| {
        // The first request after an input asks for the extra frame; key releases do not need it.
        if !(request.delay.is_zero() && only_releases.swap(false, Ordering::Relaxed)) {
            draw(request);
        }
    });
}

/// Returns `true` if egui draws another frame after the current input anyway.
pub(super) fn one_follows(ctx: &Context) -> bool {
    ctx.input(|input| !input.raw.events.iter().all(is_release))
}

fn is_release(event: &Event) -> bool {
    matches!(event, Event::Key { pressed: false, .. } | Event::ModifiersChanged(_))
}

/// Plugin that marks input of key releases only, whose effects never come a frame late.
struct KeyReleases(Arc<AtomicBool>);

impl Plugin for KeyReleases {
    fn debug_name(&self) -> &'static str {
        "frames"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        let only = !input.events.is_empty() && input.events.iter().all(is_release);
        // A list keeps scrolling after the wheel stops.
        let glides = ctx.input(egui::InputState::is_scrolling);
        self.0.store(only && !glides, Ordering::Relaxed);
    }
}
