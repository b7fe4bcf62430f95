//! Dead-man child, a separate process: standard input carries the beats, standard output is the
//! link.

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

/// Interval between two writes of STOP.
const AGAIN: Duration = Duration::from_millis(200);
/// Duration for which the child repeats STOP.
const INSIST: Duration = Duration::from_secs(2);

/// Watches one motion. Writes STOP if no beat arrives on standard input for 400 ms, or if the input
/// ends. Repeats `stop` on standard output every 200 ms for 2 s, then shuts that connection down.
///
/// Ignores hang-up, interrupt, termination and the stop of a terminal. Returns `true` if it wrote
/// STOP.
pub fn watch_over(stop: &[u8]) -> io::Result<bool> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build()?;
    let _entered = runtime.enter();
    // These handlers replace the default actions until the process ends.
    let _outlived = outlived_signals();
    let input = io::stdin();
    if !beat_ends(input.as_fd()) {
        return Ok(false);
    }
    // Close the pipe now so that the session notices at its next beat.
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
        // A service manager sends this signal to the whole unit.
        SignalKind::user_defined1(),
        stop_of_terminal,
    ];
    // A signal that cannot be caught must not prevent the handling of the others.
    kinds.into_iter().filter_map(|kind| signal(kind).ok()).collect()
}

/// Waits for the end of the beats; returns `false` if the motion is over.
fn beat_ends(input: BorrowedFd<'_>) -> bool {
    let mut bytes = [0; 64];
    let mut deadline = Instant::now() + SILENCE;
    loop {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return true;
        }
        match poll(&mut [PollFd::new(input, PollFlags::POLLIN)], poll_timeout(left)) {
            Err(Errno::EINTR) => continue,
            Ok(0) | Err(_) => return true,
            Ok(_) => {}
        }
        match read(input, &mut bytes) {
            Ok(count @ 1..) => {
                if bytes.iter().take(count).any(|byte| *byte == word::END) {
                    return false;
                }
                deadline = Instant::now() + SILENCE;
            }
            Err(Errno::EINTR | Errno::EAGAIN) => {}
            Ok(0) | Err(_) => return true,
        }
    }
}

/// Converts the remaining time, rounded up so that the time is over when the poll ends.
fn poll_timeout(left: Duration) -> PollTimeout {
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
                // The connection is gone: no byte reaches the unit on this link.
                Err(_) => return,
            }
        }
        if rest.is_empty() {
            rest = stop;
        }
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
    }
    // A unit that accepts one client is then free for the next client. A serial port needs no
    // shutdown.
    TcpStream::from(link).shutdown(Shutdown::Both).ok();
}

fn wait_for(link: &OwnedFd, deadline: Instant) {
    let left = deadline.saturating_duration_since(Instant::now());
    poll(&mut [PollFd::new(link.as_fd(), PollFlags::POLLOUT)], poll_timeout(left)).ok();
}
