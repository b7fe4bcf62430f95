//! The program: maps the command line to what it asks for, and the result to
//! an exit code.

use std::process::ExitCode;

use azel::cli::{Cli, log::Log};
use clap::Parser as _;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let log = match Log::start(cli.log_filter()) {
        Ok(log) => log,
        Err(error) => {
            // There is nothing better to say it with.
            #[allow(clippy::print_stderr)]
            {
                eprintln!("The log could not be started: {error}");
            }
            return ExitCode::FAILURE;
        }
    };
    let code = cli.run().unwrap_or_else(|error| {
        log.say(&format!("{error:#}"));
        ExitCode::FAILURE
    });
    log.finish();
    code
}
