//! Lines of the console, written to a file on a thread.

use std::{path::PathBuf, sync::Arc};

use jiff::Timestamp;

use super::App;
use crate::{job::Job, model::ConsoleLine, whole_file};

/// Writer that puts one log file after the other into a folder.
#[derive(Default)]
pub(super) struct LogWork {
    folder: Option<PathBuf>,
    job: Option<Job<Result<PathBuf, String>>>,
}

impl LogWork {
    /// Creates a writer for the folder `console` beside the element library.
    pub(super) fn new(library: Option<PathBuf>) -> Self {
        Self { folder: library.map(|library| library.with_file_name("console")), job: None }
    }
}

impl App {
    /// Starts to write `lines`, or reports why it cannot.
    pub(super) fn save_log(&mut self, lines: Vec<Arc<ConsoleLine>>) {
        if self.log_work.job.is_some() {
            return self.views.log_saved(Err("the last file is still being written".to_owned()));
        }
        let Some(folder) = &self.log_work.folder else {
            return self.views.log_saved(Err("this user has no folder for data".to_owned()));
        };
        let now = self.model.now;
        let path = folder.join(format!("console-{}.txt", now.strftime("%Y%m%dT%H%M%S%.3fZ")));
        let write = move |_: &(dyn Fn() -> bool + Sync)| {
            let text = text(&lines, now);
            match whole_file::replace(&path, text.as_bytes()) {
                Ok(()) => Ok(path),
                Err(error) => Err(format!("{error}: {}", path.display())),
            }
        };
        self.log_work.job = Some(Job::start("azel-log-file", Arc::clone(&self.wake), write));
    }

    /// Takes the result of the log thread.
    pub(super) fn take_log_file(&mut self) {
        if let Some(end) = Job::take(&mut self.log_work.job) {
            self.views.log_saved(end.unwrap_or_else(|broke_off| Err(broke_off.to_string())));
        }
    }
}

fn text(lines: &[Arc<ConsoleLine>], now: Timestamp) -> String {
    let saved = now.strftime("%FT%TZ");
    let mut text = format!(
        "# Azel console, saved {saved}, {} lines, times in UTC\n\
         # time\tantenna\tdirection\tframe\treply after\tmeaning\n",
        lines.len()
    );
    for line in lines {
        text.push_str(&line.report());
        text.push('\n');
    }
    text
}
