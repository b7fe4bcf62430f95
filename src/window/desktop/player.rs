//! The sound players that desktops install.

use std::{
    env,
    ffi::OsString,
    fs::File,
    io::{self, Seek as _, Write as _},
    path::PathBuf,
    process::{ExitStatus, Stdio},
    time::Duration,
};

use tokio::{process::Command, time::timeout};

use super::{Missing, Sound};

/// Programs of the players, with the arguments before the file name.
const PLAYERS: [(&str, &[&str]); 4] =
    [("pw-play", &[]), ("paplay", &[]), ("aplay", &["-q"]), ("canberra-gtk-play", &["-f"])];
const NAMES: &str = "pw-play, paplay, aplay or canberra-gtk-play";
/// Timeout of a player. The sounds last less than half a second.
const PATIENCE: Duration = Duration::from_secs(5);

/// The players found, the last successful one first.
pub(super) struct Player {
    found: Vec<(PathBuf, &'static [&'static str])>,
}

impl Default for Player {
    fn default() -> Self {
        Self::with_path(env::var_os("PATH"))
    }
}

impl Player {
    /// Creates a player from the programs found in these folders.
    pub(super) fn with_path(path: Option<OsString>) -> Self {
        let path = path.unwrap_or_default();
        let place = |name: &str| {
            let mut folders = env::split_paths(&path).filter(|folder| folder.is_absolute());
            folders.find_map(|folder| Some(folder.join(name)).filter(|file| file.is_file()))
        };
        let found = PLAYERS.iter().filter_map(|(name, arguments)| Some((place(name)?, *arguments)));
        Self { found: found.collect() }
    }

    pub(super) fn look(&self) -> Result<(), Missing> {
        if self.found.is_empty() { Err(Missing::Player(NAMES)) } else { Ok(()) }
    }

    /// Plays the sound to its end with the first player that works.
    pub(super) async fn play(&mut self, sound: Sound) -> Result<(), Missing> {
        let mut outcome = self.look();
        for index in 0..self.found.len() {
            let Some((program, arguments)) = self.found.get(index) else { break };
            let reason = match run(program, arguments, sound).await {
                Ok(status) if status.success() => {
                    self.found.rotate_left(index);
                    return Ok(());
                }
                Ok(status) => status.to_string(),
                Err(error) => error.to_string(),
            };
            outcome = Err(Missing::NotPlayed(format!("{}: {reason}", program.display())));
        }
        outcome
    }
}

async fn run(program: &PathBuf, arguments: &[&str], sound: Sound) -> io::Result<ExitStatus> {
    let mut player = Command::new(program)
        .args(arguments)
        // All players accept a file name; some accept nothing else.
        .arg("/dev/stdin")
        .stdin(file(sound)?)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .kill_on_drop(true)
        .spawn()?;
    timeout(PATIENCE, player.wait()).await.map_err(io::Error::from)?
}

/// Returns a temporary file with the sound. The operating system deletes the file after the last
/// reader.
fn file(sound: Sound) -> io::Result<File> {
    let bytes: &[u8] = match sound {
        Sound::Falling => include_bytes!("../../../assets/sounds/alarm.wav"),
        Sound::Rising => include_bytes!("../../../assets/sounds/reminder.wav"),
    };
    let mut file = tempfile::tempfile()?;
    file.write_all(bytes)?;
    file.rewind()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use std::{fs, os::unix::fs::PermissionsExt as _, path::Path};

    use super::*;

    /// Writes a fake player with this script. `$log` is a file in its folder.
    fn player(folder: &Path, name: &str, script: &str) {
        let path = folder.join(name);
        let log = folder.join("log");
        let text = format!("#!/bin/sh\nlog='{}'\n{script}\n", log.display());
        fs::write(&path, text).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }

    fn log(folder: &Path) -> String {
        fs::read_to_string(folder.join("log")).unwrap_or_default()
    }

    fn players(folder: &Path) -> Player {
        Player::with_path(Some(folder.as_os_str().to_owned()))
    }

    #[tokio::test]
    async fn the_first_player_that_works_plays_the_sound_and_is_asked_first_from_then_on() {
        let folder = tempfile::tempdir().unwrap();
        player(folder.path(), "pw-play", "echo pw-play >> $log; exit 1");
        player(folder.path(), "aplay", "echo aplay \"$@\" >> $log; /bin/cat \"$2\" > $log.wav");
        let mut player = players(folder.path());
        player.play(Sound::Falling).await.unwrap();
        player.play(Sound::Rising).await.unwrap();
        let expected = "pw-play\naplay -q /dev/stdin\naplay -q /dev/stdin\n";
        assert_eq!(log(folder.path()), expected);
        let played = fs::read(folder.path().join("log.wav")).unwrap();
        assert_eq!(played, include_bytes!("../../../assets/sounds/reminder.wav"));
    }

    #[tokio::test]
    async fn players_that_fail_and_none_at_all_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let mut none = players(folder.path());
        assert_eq!(none.look(), Err(Missing::Player(NAMES)));
        assert_eq!(none.play(Sound::Falling).await, Err(Missing::Player(NAMES)));
        player(folder.path(), "paplay", "exit 3");
        let mut broken = players(folder.path());
        assert_eq!(broken.look(), Ok(()));
        let Err(Missing::NotPlayed(reason)) = broken.play(Sound::Falling).await else { panic!() };
        assert!(reason.ends_with("paplay: exit status: 3"), "{reason}");
        assert_eq!(Player::with_path(None).look(), Err(Missing::Player(NAMES)));
    }
}
