//! Check of a station file before the current station makes way for it.

use std::path::PathBuf;

use super::{Settings, claim::holder_of_station};
use crate::{
    contract::claim::HeldBy,
    controller::SPECS,
    station::{self, LoadError},
};

/// Reason why a station cannot be opened. Azel has changed nothing.
#[derive(Debug, thiserror::Error)]
pub enum CannotOpen {
    #[error("the file is gone: {}", .0.display())]
    Missing(PathBuf),
    #[error(transparent)]
    Unread(LoadError),
    #[error("it is open in {holder}, close it there first: {}", path.display())]
    Held { holder: HeldBy, path: PathBuf },
}

/// Returns the name of the station that `settings` would open.
pub fn look_at(settings: &Settings) -> Result<String, CannotOpen> {
    let path = settings.station_path().ok_or(CannotOpen::Unread(LoadError::Missing))?;
    let loaded = station::load(&path, SPECS).map_err(|error| match error {
        LoadError::Missing => CannotOpen::Missing(path.clone()),
        error => CannotOpen::Unread(error),
    })?;
    let folders = settings.claims.as_ref().map(|(folders, _)| folders);
    if let Some(holder) = folders.and_then(|folders| holder_of_station(folders, &path)) {
        return Err(CannotOpen::Held { holder, path });
    }
    Ok(loaded.station.name)
}
