//! Station that runs before its window exists: it reads elements and asks units while the system
//! makes the window.

use std::{
    io,
    sync::{
        Arc, Mutex, OnceLock, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use egui::{Context, ViewportCommand, ViewportId};

use super::MOVING_FRAME;
use crate::{
    contract::CommandOrigin,
    driver::Outside,
    engine::{Client, Handle, Settings, signals},
    job::Wake,
};

/// Time within which one frame shows all news.
const MERGED: Duration = Duration::from_millis(30);

/// A running station without a window.
pub struct RunningStation {
    pub(super) station: Handle,
    pub(super) settings: Settings,
    pub(super) outside: Outside,
    pub(super) wake: Wake,
    /// Client of the station in the window; the signal handlers send STOP through it.
    pub(super) client: Arc<Mutex<Client>>,
    /// Flag: the operator or the operating system decided to close, so Azel asks no question.
    pub(super) may_close: Arc<AtomicBool>,
    /// Flag: the operating system ends the program, so nobody can answer a question.
    pub(super) told_to_end: Arc<AtomicBool>,
    /// Flag: an antenna moves, so frames come at the pace of [`MOVING_FRAME`].
    pub(super) is_lively: Arc<AtomicBool>,
    /// Flag: an antenna is jogged.
    pub(super) is_jogging: Arc<AtomicBool>,
    window: Arc<OnceLock<Context>>,
}

impl RunningStation {
    /// Starts the station that `settings` names.
    pub fn start(settings: Settings, outside: impl Into<Outside>) -> io::Result<Self> {
        let outside = outside.into();
        let window = Arc::default();
        let (is_lively, is_jogging) = (Arc::default(), Arc::default());
        let wake = wake(Arc::clone(&window), Arc::clone(&is_lively));
        let station = Handle::start(settings.clone(), outside.clone(), Arc::clone(&wake))?;
        let client = Arc::new(Mutex::new(station.client().clone()));
        let (may_close, told_to_end) = (Arc::default(), Arc::default());
        let flags = [Arc::clone(&may_close), Arc::clone(&told_to_end)];
        close_on_signals(Arc::clone(&client), flags, Arc::clone(&window))?;
        Ok(Self {
            station,
            settings,
            outside,
            wake,
            client,
            may_close,
            told_to_end,
            is_lively,
            is_jogging,
            window,
        })
    }

    /// Returns the flag that is set while an antenna is jogged, once there is a window.
    pub fn is_jogging(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.is_jogging)
    }

    /// Hands the window to the station's waker. Closes the window at once if the operating system
    /// has ended the program.
    pub(super) fn show_in(&self, ctx: &Context) {
        // The cell is still empty: a program has one window.
        let _ = self.window.set(ctx.clone());
        if self.told_to_end.load(Ordering::SeqCst) {
            ctx.send_viewport_cmd_to(ViewportId::ROOT, ViewportCommand::Close);
        }
    }
}

/// Makes a log-out or Ctrl C in the terminal close the window in order, to end a jog with STOP.
fn close_on_signals(
    station: Arc<Mutex<Client>>,
    flags: [Arc<AtomicBool>; 2],
    window: Arc<OnceLock<Context>>,
) -> io::Result<()> {
    // No code panics while it holds the lock.
    let stop = move || {
        let station = station.lock().unwrap_or_else(PoisonError::into_inner).clone();
        station.acting_for(CommandOrigin::Signal).stop_all()
    };
    let end = move || {
        for flag in flags {
            flag.store(true, Ordering::SeqCst);
        }
        if let Some(ctx) = window.get() {
            ctx.send_viewport_cmd_to(ViewportId::ROOT, ViewportCommand::Close);
            ctx.request_repaint_after_for(Duration::from_millis(1), ViewportId::ROOT);
        }
    };
    signals::watch(stop, end)
}

/// Returns a waker that requests a frame soon; the delay merges the requests in between.
///
/// While an antenna moves, news wait for the next regular frame. Otherwise each position of each
/// antenna would cost a frame, and keys would wait for its painting.
fn wake(window: Arc<OnceLock<Context>>, is_lively: Arc<AtomicBool>) -> Wake {
    Arc::new(move || {
        if let Some(ctx) = window.get() {
            let soon = if is_lively.load(Ordering::Relaxed) { MOVING_FRAME } else { MERGED };
            ctx.request_repaint_after_for(soon, ViewportId::ROOT);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn news_of_moving_metal_come_with_its_next_frame() {
        for (is_lively, soon) in [(false, MERGED), (true, MOVING_FRAME)] {
            let window = Arc::<OnceLock<Context>>::default();
            let wake = wake(Arc::clone(&window), Arc::new(is_lively.into()));
            // Without a window there is nothing to draw.
            wake();
            let (ctx, delays) = (Context::default(), Arc::<Mutex<Vec<_>>>::default());
            let notified = Arc::clone(&delays);
            ctx.set_request_repaint_callback(move |request| {
                notified.lock().unwrap().push(request.delay);
            });
            window.set(ctx).unwrap();
            wake();
            assert_eq!(*delays.lock().unwrap(), [soon]);
        }
    }
}
