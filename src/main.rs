//! The program: maps the command line to the app and its result to an exit code.

fn main() {}
