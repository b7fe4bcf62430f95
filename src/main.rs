//! Program entry: runs the command line and maps the result to an exit code.

use std::process::ExitCode;

use azel::cli::{Cli, log::Log};
use clap::Parser as _;

/// Formats the error with its causes. Skips a cause that the text already holds.
fn in_words(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |text, cause| {
        if text.is_empty() {
            cause
        } else if text.contains(&cause) {
            text
        } else {
            format!("{text}: {cause}")
        }
    })
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let log = match Log::start(cli.log_filter()) {
        Ok(log) => log,
        Err(error) => {
            // Without a log, standard error is the only way to report this.
            #[allow(clippy::print_stderr)]
            {
                eprintln!("The log could not be started: {error}");
            }
            return ExitCode::FAILURE;
        }
    };
    let code = cli.run().unwrap_or_else(|error| {
        log.say(&in_words(&error));
        ExitCode::FAILURE
    });
    log.finish();
    code
}
