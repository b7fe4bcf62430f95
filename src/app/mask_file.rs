//! Files with horizon masks, read and written on a thread.

use std::{fs, path::PathBuf, sync::Arc};

use super::App;
use crate::{
    astro::{HorizonMask, MaskForm},
    job::Job,
    model::MaskNews,
    orbit::decoded,
    whole_file,
};

/// Max size of a mask file, bytes.
const MAX: u64 = 4 << 20;

/// Job that reads or writes one file at a time; written files go to one folder.
#[derive(Default)]
pub(super) struct MaskWork {
    folder: Option<PathBuf>,
    job: Option<Job<MaskNews>>,
}

impl MaskWork {
    /// Creates the job with the folder `horizon` beside the element library.
    pub(super) fn new(library: Option<PathBuf>) -> Self {
        Self { folder: library.map(|library| library.with_file_name("horizon")), job: None }
    }
}

impl App {
    /// Starts to read the mask at `path`.
    pub(super) fn import_mask(&mut self, path: PathBuf) {
        self.begin_mask_work(move |_| match read(&path) {
            Ok((mask, form)) => MaskNews::Read(mask, form),
            Err(reason) => MaskNews::Failed(format!("{reason}: {}", path.display())),
        });
    }

    /// Starts to write a mask as a table.
    pub(super) fn export_mask(&mut self, mask: &HorizonMask) {
        let Some(folder) = &self.mask_work.folder else {
            let reason = "this user has no folder for data".to_owned();
            return self.views.mask_news(MaskNews::Failed(reason));
        };
        let name = format!("horizon-{}.csv", self.model.now.strftime("%Y%m%dT%H%M%SZ"));
        let (path, text) = (folder.join(name), mask.to_csv());
        self.begin_mask_work(move |_| match whole_file::replace(&path, text.as_bytes()) {
            Ok(()) => MaskNews::Written(path),
            Err(error) => MaskNews::Failed(format!("{error}: {}", path.display())),
        });
    }

    fn begin_mask_work(
        &mut self,
        work: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> MaskNews + Send + 'static,
    ) {
        self.mask_work.job = Some(Job::start("azel-mask-file", Arc::clone(&self.wake), work));
    }

    /// Takes the result of the mask thread.
    pub(super) fn take_mask_file(&mut self) {
        let Some(end) = Job::take(&mut self.mask_work.job) else { return };
        self.views.mask_news(end.unwrap_or_else(|broke| MaskNews::Failed(broke.to_string())));
    }
}

fn read(path: &std::path::Path) -> Result<(HorizonMask, MaskForm), String> {
    let size = fs::metadata(path).map_err(|error| error.to_string())?.len();
    if size > MAX {
        return Err(format!("the file has {size} bytes, a mask has {MAX} at most"));
    }
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    HorizonMask::import(&decoded(&bytes)).map_err(|error| error.to_string())
}
