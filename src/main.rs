//! The program: maps the command line to what it asks for, and the result to
//! an exit code.

use std::process::ExitCode;

use azel::cli::Cli;
use clap::Parser as _;
use tracing_subscriber::EnvFilter;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let filter =
        EnvFilter::try_from_env("AZEL_LOG").unwrap_or_else(|_| EnvFilter::new("warn,azel=info"));
    tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).init();
    match cli.run() {
        Ok(code) => code,
        Err(error) => {
            // The one place that speaks to the terminal of whoever started it.
            #[allow(clippy::print_stderr)]
            {
                eprintln!("{error:#}");
            }
            ExitCode::FAILURE
        }
    }
}
