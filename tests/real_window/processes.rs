//! Processes and sockets as the kernel lists them.

use std::{fs, net::SocketAddr};

/// Process with its start time, because a later process may have the same id.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Process {
    pub(super) id: u32,
    start: u64,
}

/// A line of `/proc/<id>/stat`.
struct Stat {
    state: char,
    parent: u32,
    start: u64,
}

fn stat(id: u32) -> Option<Stat> {
    let text = fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    // The name of the program is in brackets and may hold anything.
    let (_, rest) = text.rsplit_once(") ")?;
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    Some(Stat {
        state: words.first()?.chars().next()?,
        parent: words.get(1)?.parse().ok()?,
        start: words.get(19)?.parse().ok()?,
    })
}

impl Process {
    /// Returns `true` if the process still runs. A process that has ended, but whose parent has not
    /// yet collected it, does not run.
    pub(super) fn runs(self) -> bool {
        stat(self.id).is_some_and(|now| now.start == self.start && now.state != 'Z')
    }
}

/// Returns `true` if a signal has stopped the process.
pub(super) fn is_stopped(id: u32) -> bool {
    stat(id).is_some_and(|now| now.state == 'T')
}

/// Returns the running dead-men that `parent` has started.
pub(super) fn dead_men_of(parent: u32) -> Vec<Process> {
    let ids = fs::read_dir("/proc").expect("/proc").filter_map(|entry| {
        let name = entry.ok()?.file_name();
        name.to_str()?.parse::<u32>().ok()
    });
    let is_dead_man = |id: u32| {
        let line = fs::read(format!("/proc/{id}/cmdline")).unwrap_or_default();
        line.split(|byte| *byte == 0).nth(1) == Some(b"dead-man")
    };
    ids.filter(|id| is_dead_man(*id))
        .filter_map(|id| Some((id, stat(id)?)))
        .filter(|(_, now)| now.parent == parent && now.state != 'Z')
        .map(|(id, now)| Process { id, start: now.start })
        .collect()
}

/// Returns the number of open connections to the listener at `address`.
pub(super) fn established_at(address: SocketAddr) -> usize {
    let port = format!(":{:04X}", address.port());
    let table = fs::read_to_string("/proc/net/tcp").expect("/proc/net/tcp");
    table
        .lines()
        .map(|line| line.split_ascii_whitespace().collect::<Vec<_>>())
        .filter(|words| {
            words.get(1).is_some_and(|local| local.ends_with(&port)) && words.get(3) == Some(&"01")
        })
        .count()
}
