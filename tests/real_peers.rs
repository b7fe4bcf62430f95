//! Uploads and fetches against the servers that units and stations really run:
//! OpenSSH's `sshd`, `vsftpd` with and without TLS, and HTTPS by `openssl`.
//!
//! Needs root, both servers and `openssl`; the tests are ignored by default and
//! run by name, one after the other, where those are installed.

// A test ends loudly, and its scene is part of it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing)]

#[cfg(target_os = "linux")]
mod real_peers {
    mod breaks;
    mod doorman;
    mod fetches;
    mod ftp_server;
    mod https_server;
    mod library;
    mod log_in;
    mod narrow;
    mod unit;
    mod uploads;
    mod user;
    mod whole_way;
}
