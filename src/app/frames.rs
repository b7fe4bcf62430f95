//! One frame for each request.
//!
//! The toolkit draws two frames for each request, and asks for one after every input, so that
//! whatever comes a frame late is shown. Where the processor paints the window, most of the price
//! of a key is that last frame. What would come later still comes with the frame of the full
//! second.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use egui::{Context, Event, Plugin, RawInput, RequestRepaintInfo};

/// Calls `draw` once for each frame that is requested of `ctx`, in place of the callback set before.
pub fn draw_once(ctx: &Context, draw: impl Fn(RequestRepaintInfo) + Send + Sync + 'static) {
    let only_releases = Arc::<AtomicBool>::default();
    ctx.add_plugin(KeyReleases(Arc::clone(&only_releases)));
    ctx.set_request_repaint_callback(|_| {});
    ctx.set_repaint_observer(move |request| {
        // The first request of a frame with input is for the frame after that input.
        if !(request.delay.is_zero() && only_releases.swap(false, Ordering::Relaxed)) {
            draw(request);
        }
    });
}

/// Returns `true` if another frame follows the input of this one in any case.
pub(super) fn one_follows(ctx: &Context) -> bool {
    ctx.input(|input| !input.raw.events.iter().all(is_release))
}

fn is_release(event: &Event) -> bool {
    matches!(event, Event::Key { pressed: false, .. } | Event::ModifiersChanged(_))
}

/// Notes whether the input of a frame only releases keys, whose effects never come a frame late.
struct KeyReleases(Arc<AtomicBool>);

impl Plugin for KeyReleases {
    fn debug_name(&self) -> &'static str {
        "frames"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        let only = !input.events.is_empty() && input.events.iter().all(is_release);
        // A list still glides after the wheel.
        let glides = ctx.input(egui::InputState::is_scrolling);
        self.0.store(only && !glides, Ordering::Relaxed);
    }
}
