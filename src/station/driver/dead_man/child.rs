//! The far end, a process of its own: standard input is the beat, standard
//! output the link.

use std::{
    io::{self, Write as _},
    net::{Shutdown, TcpStream},
    os::fd::{AsFd, BorrowedFd, OwnedFd},
    time::{Duration, Instant},
};

use nix::{
    errno::Errno,
    poll::{PollFd, PollFlags, PollTimeout, poll},
    unistd::{dup2_stdin, read},
};
use tokio::signal::unix::{Signal, SignalKind, signal};

use super::{SILENCE, word};

/// STOP is written again after this long.
const AGAIN: Duration = Duration::from_millis(200);
/// For how long STOP is written.
const INSIST: Duration = Duration::from_secs(2);

/// Watches over one spell of motion. When the beat on standard input stays away
/// for 400 ms or ends, writes `stop` to standard output at once and every 200 ms
/// for 2 s, and shuts that connection down.
///
/// Outlives hang-up, interrupt, termination and the stop of a terminal. Returns
/// whether it has fired.
pub fn watch_over(stop: &[u8]) -> io::Result<bool> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build()?;
    let _entered = runtime.enter();
    // A handler replaces the default action for the life of the process.
    let _outlived = outlived_signals();
    let input = io::stdin();
    if !beat_ends(input.as_fd()) {
        return Ok(false);
    }
    // The session must learn of it by its next beat, however late that is.
    if let Ok(nothing) = std::fs::File::open("/dev/null") {
        dup2_stdin(nothing).ok();
    }
    insist(stop);
    Ok(true)
}

fn outlived_signals() -> Vec<Signal> {
    let stop_of_terminal = SignalKind::from_raw(nix::libc::SIGTSTP);
    let kinds = [
        SignalKind::hangup(),
        SignalKind::interrupt(),
        SignalKind::terminate(),
        SignalKind::quit(),
        // STOP to the whole unit of a service manager.
        SignalKind::user_defined1(),
        stop_of_terminal,
    ];
    // One that cannot be had must not keep the others from being outlived.
    kinds.into_iter().filter_map(|kind| signal(kind).ok()).collect()
}

/// Waits for the end of the beat; `false` when nothing is out any more.
fn beat_ends(input: BorrowedFd<'_>) -> bool {
    let mut bytes = [0; 64];
    let mut until = Instant::now() + SILENCE;
    loop {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return true;
        }
        match poll(&mut [PollFd::new(input, PollFlags::POLLIN)], in_time(left)) {
            Err(Errno::EINTR) => continue,
            Ok(0) | Err(_) => return true,
            Ok(_) => {}
        }
        match read(input, &mut bytes) {
            Ok(count @ 1..) => {
                if bytes.iter().take(count).any(|byte| *byte == word::END) {
                    return false;
                }
                until = Instant::now() + SILENCE;
            }
            Err(Errno::EINTR | Errno::EAGAIN) => {}
            Ok(0) | Err(_) => return true,
        }
    }
}

/// A little more, so that a poll that ends in time finds the time over.
fn in_time(left: Duration) -> PollTimeout {
    PollTimeout::try_from(left + Duration::from_millis(1)).unwrap_or(PollTimeout::MAX)
}

fn insist(stop: &[u8]) {
    let Ok(link) = io::stdout().as_fd().try_clone_to_owned() else { return };
    let Ok(mut writer) = link.try_clone().map(std::fs::File::from) else { return };
    let start = Instant::now();
    let mut next = start;
    let mut rest: &[u8] = stop;
    while start.elapsed() <= INSIST {
        next += AGAIN;
        // Finish a STOP that was written in part before writing it again.
        while !rest.is_empty() && Instant::now() < next {
            match writer.write(rest) {
                Ok(0) => break,
                Ok(count) => rest = rest.get(count..).unwrap_or_default(),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => wait_for(&link, next),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                // The connection is gone: nothing reaches the unit on it.
                Err(_) => return,
            }
        }
        if rest.is_empty() {
            rest = stop;
        }
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
    }
    // A unit that takes one client is free for the next one. A serial port has
    // no such end.
    TcpStream::from(link).shutdown(Shutdown::Both).ok();
}

fn wait_for(link: &OwnedFd, until: Instant) {
    let left = until.saturating_duration_since(Instant::now());
    poll(&mut [PollFd::new(link.as_fd(), PollFlags::POLLOUT)], in_time(left)).ok();
}
