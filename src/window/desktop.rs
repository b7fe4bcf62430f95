//! Notifications, sounds and file dialogs of the desktop. On Linux notifications and sounds go to the notification service of the
//! session and to the first player of sounds that works; elsewhere there are none.

#[cfg(target_os = "linux")]
mod bus;
#[cfg(not(target_os = "linux"))]
mod elsewhere;
pub mod file_dialog;
pub mod folder;
#[cfg(target_os = "linux")]
mod player;
#[cfg(target_os = "linux")]
#[cfg(any(test, feature = "testing"))]
pub mod testing;

#[cfg(not(target_os = "linux"))]
use self::elsewhere::{Bus, Player};
#[cfg(target_os = "linux")]
use self::{bus::Bus, player::Player};

/// A notification of the desktop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notification {
    pub title: String,
    pub text: String,
    pub urgency: Urgency,
    /// A later one with the same number takes its place.
    pub number: Option<u64>,
}

/// How urgent it is to the desktop, which may show what is critical until it is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Urgency {
    Normal,
    Critical,
}

/// Two tones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sound {
    Falling,
    Rising,
}

/// Why nothing is shown or sounded.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Missing {
    #[error("there is no bus of a desktop session: {0}")]
    Bus(String),
    #[error("no notification service answers: {0}")]
    Service(String),
    /// None of these is installed.
    #[error("there is no player of sounds: {0}")]
    Player(&'static str),
    /// The last one that was tried.
    #[error("the sound was not played: {0}")]
    NotPlayed(String),
    #[error("not on this operating system")]
    Elsewhere,
}

/// What of the desktop is missing, as far as it was tried.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outlets {
    pub notifications: Option<Missing>,
    pub sounds: Option<Missing>,
}

impl Outlets {
    /// Whether this computer could play a sound, even if the last one was not played.
    pub fn has_player(&self) -> bool {
        !matches!(self.sounds, Some(Missing::Player(_) | Missing::Elsewhere))
    }
}

/// The desktop of this session.
#[derive(Default)]
pub struct Desktop {
    bus: Bus,
    player: Player,
    outlets: Outlets,
}

impl Desktop {
    /// Looks for the notification service and for players, without showing or sounding anything.
    pub async fn look(&mut self) {
        let notifications = self.bus.look().await;
        self.found(Some(notifications), Some(self.player.look()));
    }

    /// Shows these notifications and plays the sound, both at once.
    pub async fn tell(&mut self, notifications: &[Notification], sound: Option<Sound>) {
        let show = async {
            let mut shown = None;
            for notification in notifications {
                let is_down = matches!(shown, Some(Err(_)));
                // A service that does not answer must not hold up the next news for long.
                if is_down && notification.urgency != Urgency::Critical {
                    continue;
                }
                shown = Some(self.bus.show(notification).await);
            }
            shown
        };
        let play = async {
            match sound {
                Some(sound) => Some(self.player.play(sound).await),
                None => None,
            }
        };
        let (shown, played) = tokio::join!(show, play);
        self.found(shown, played);
    }

    /// Closes the notifications with these numbers, as far as they are shown.
    pub async fn close(&mut self, numbers: &[u64]) {
        for number in numbers {
            self.bus.close(*number).await;
        }
    }

    pub fn outlets(&self) -> &Outlets {
        &self.outlets
    }

    /// Takes what came of an attempt. What is missing is logged once.
    fn found(
        &mut self,
        notifications: Option<Result<(), Missing>>,
        sounds: Option<Result<(), Missing>>,
    ) {
        let attempts = [
            ("are not shown by the desktop", &mut self.outlets.notifications, notifications),
            ("make no sound", &mut self.outlets.sounds, sounds),
        ];
        for (subject, missing, attempt) in attempts {
            match attempt {
                Some(Ok(())) => *missing = None,
                Some(Err(reason)) if missing.is_none() => {
                    tracing::warn!("alarms and reminders {subject}: {reason}");
                    *missing = Some(reason);
                }
                _ => {}
            }
        }
    }
}
