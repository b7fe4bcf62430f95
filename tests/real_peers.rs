//! Uploads and fetches against the servers that units and stations really run: OpenSSH's `sshd`,
//! `vsftpd` with and without TLS, and HTTPS by `openssl`.
//!
//! The tests need root, both servers and `openssl`. They are ignored by default: run them by name,
//! one after the other.

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
