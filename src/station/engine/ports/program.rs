//! Name of the program at the other end of a connection from this computer.

use std::net::SocketAddr;

/// Returns the name of the program that has the connection from `peer` to `port`. `None` for
/// another computer, and if the operating system does not report the program.
#[cfg(target_os = "linux")]
pub(super) fn name(peer: SocketAddr, port: SocketAddr) -> Option<String> {
    if !peer.ip().is_loopback() {
        return None;
    }
    let is_meant = |entry: &procfs::net::TcpNetEntry| {
        entry.local_address == peer && entry.remote_address.port() == port.port()
    };
    let own = procfs::process::Process::myself().ok()?;
    let inode = own.tcp().ok()?.into_iter().find(is_meant)?.inode;
    let has_socket = |process: &procfs::process::Process| {
        let Ok(mut files) = process.fd() else { return false };
        files.any(|file| {
            file.is_ok_and(|file| file.target == procfs::process::FDTarget::Socket(inode))
        })
    };
    let mut processes = procfs::process::all_processes().ok()?.filter_map(Result::ok);
    let process = processes.find(has_socket)?;
    process.stat().ok().map(|stat| stat.comm)
}

#[cfg(not(target_os = "linux"))]
pub(super) fn name(_: SocketAddr, _: SocketAddr) -> Option<String> {
    None
}
