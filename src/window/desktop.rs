//! Notifications, sounds and file dialogs of the desktop. On Linux, notifications go to the
//! notification service of the session, and sounds to the first player that works. Other systems
//! have neither.

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

/// A notification of the desktop, which may replace an earlier one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notification {
    pub title: String,
    pub text: String,
    pub urgency: Urgency,
    /// Number of the notification. A later notification with the same number replaces it.
    pub number: Option<u64>,
}

/// Urgency for the desktop. The desktop may keep a critical notification until the operator closes
/// it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Urgency {
    Normal,
    Critical,
}

/// A sound of two tones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sound {
    Falling,
    Rising,
}

/// Reason why the desktop showed or played nothing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Missing {
    #[error("there is no bus of a desktop session: {0}")]
    Bus(String),
    #[error("no notification service answers: {0}")]
    Service(String),
    /// List of the supported players; none of them is installed.
    #[error("there is no player of sounds: {0}")]
    Player(&'static str),
    /// Error of the last player that Azel tried.
    #[error("the sound was not played: {0}")]
    NotPlayed(String),
    #[error("not on this operating system")]
    Elsewhere,
}

/// Missing outlets of the desktop, as far as Azel has tried them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outlets {
    pub notifications: Option<Missing>,
    pub sounds: Option<Missing>,
}

impl Outlets {
    /// Returns `true` if this computer could play a sound, even if the last sound failed.
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

    /// Shows these notifications and plays the sound at the same time.
    pub async fn tell(&mut self, notifications: &[Notification], sound: Option<Sound>) {
        let show = async {
            let mut shown = None;
            for notification in notifications {
                let is_down = matches!(shown, Some(Err(_)));
                // A service that does not answer must not delay the next notices for long.
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

    /// Closes the notifications with these numbers, if the desktop shows them.
    pub async fn close(&mut self, numbers: &[u64]) {
        for number in numbers {
            self.bus.close(*number).await;
        }
    }

    pub fn outlets(&self) -> &Outlets {
        &self.outlets
    }

    /// Records the outcome of an attempt. Azel logs a missing outlet once.
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
