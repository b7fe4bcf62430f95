//! Call of a program, in a process group of its own.

use std::{env, io, process::Stdio, time::Duration};

use tokio::{
    io::{AsyncRead, AsyncReadExt as _},
    process::{Child, Command},
    time::{Instant, sleep, sleep_until, timeout},
};

use super::{Call, CappedOutput};
use crate::contract::hooks::HookResult;

/// Variables of Azel's own environment that a program receives. All others stay back, because they
/// may contain secrets.
const PASSED_ON: [&str; 20] = [
    "PATH",
    "HOME",
    "USER",
    "LOGNAME",
    "SHELL",
    "LANG",
    "LC_ALL",
    "TZ",
    "TMPDIR",
    "DISPLAY",
    "WAYLAND_DISPLAY",
    "XDG_RUNTIME_DIR",
    "DBUS_SESSION_BUS_ADDRESS",
    // Programs of Windows do not start without these.
    "SystemRoot",
    "SystemDrive",
    "USERPROFILE",
    "APPDATA",
    "LOCALAPPDATA",
    "PATHEXT",
    "TEMP",
];

/// Time in which the output of an ended program still counts. A program that it left in the
/// background may hold the pipes open for hours.
const LAST_OUTPUT: Duration = Duration::from_millis(100);
/// Length of one read, bytes: all that a pipe holds.
const READ: usize = 64 * 1024;
/// Pause between two reads of output that is dropped, so that a flood takes no processor.
const FLOOD_PAUSE: Duration = Duration::from_millis(1);
/// Time in which a killed program must end.
const DIES_WITHIN: Duration = Duration::from_secs(1);

pub(super) fn run(arguments: &[String], call: &Call) -> (HookResult, CappedOutput) {
    let mut output = CappedOutput::default();
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let result = runtime.and_then(|runtime| {
        runtime.block_on(async {
            let child = start(arguments, call)?;
            follow(child, Instant::now() + call.timeout, &mut output).await
        })
    });
    (result.unwrap_or_else(|error| HookResult::CannotStart(error.to_string())), output)
}

fn start(arguments: &[String], call: &Call) -> io::Result<Child> {
    let (program, arguments) =
        arguments.split_first().ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
    let own = PASSED_ON.iter().filter_map(|name| Some((*name, env::var_os(name)?)));
    let mut command = Command::new(program);
    command
        .args(arguments)
        .env_clear()
        .envs(own)
        .envs(call.environment.iter().map(|(name, value)| (*name, value)))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    #[cfg(unix)]
    command.process_group(0);
    command.spawn()
}

/// Reads the output of a program until it ends, or kills it at `deadline`.
async fn follow(
    mut child: Child,
    deadline: Instant,
    output: &mut CappedOutput,
) -> io::Result<HookResult> {
    let (mut stdout, mut stderr) = (child.stdout.take(), child.stderr.take());
    let (mut first, mut second) = (vec![0; READ], vec![0; READ]);
    let mut deadline = deadline;
    let mut ended = None;
    loop {
        tokio::select! {
            biased;
            () = sleep_until(deadline) => break,
            status = child.wait(), if ended.is_none() => {
                ended = Some(status?);
                deadline = deadline.min(Instant::now() + LAST_OUTPUT);
            }
            count = read(&mut stdout, &mut first), if stdout.is_some() => {
                take(&mut stdout, first.get(..count), output);
            }
            count = read(&mut stderr, &mut second), if stderr.is_some() => {
                take(&mut stderr, second.get(..count), output);
            }
        }
        if output.is_cut {
            sleep(FLOOD_PAUSE).await;
        }
        if ended.is_some() && stdout.is_none() && stderr.is_none() {
            break;
        }
    }
    if let Some(status) = ended {
        return Ok(status.code().map_or(HookResult::Killed, HookResult::Exited));
    }
    kill(&mut child);
    if timeout(DIES_WITHIN, child.wait()).await.is_err() {
        tracing::warn!("a program of a hook does not end");
    }
    Ok(HookResult::TimedOut)
}

/// Returns the number of bytes read; 0 at the end of the output.
async fn read(pipe: &mut Option<impl AsyncRead + Unpin>, buffer: &mut [u8]) -> usize {
    match pipe {
        Some(pipe) => pipe.read(buffer).await.unwrap_or(0),
        None => 0,
    }
}

fn take<T>(pipe: &mut Option<T>, bytes: Option<&[u8]>, output: &mut CappedOutput) {
    match bytes {
        Some(bytes) if !bytes.is_empty() => output.push(bytes),
        _ => *pipe = None,
    }
}

/// Kills a program with all that it has started in its process group.
fn kill(child: &mut Child) {
    #[cfg(unix)]
    {
        // The process is not reaped yet, so its number still names its group.
        let group = child.id().and_then(|id| i32::try_from(id).ok());
        if let Some(group) = group.and_then(rustix::process::Pid::from_raw) {
            let signal = rustix::process::Signal::KILL;
            if let Err(error) = rustix::process::kill_process_group(group, signal) {
                tracing::warn!(%error, "the group of a hook is not killed");
            }
        }
    }
    if let Err(error) = child.start_kill() {
        tracing::debug!(%error, "a program of a hook has ended");
    }
}
