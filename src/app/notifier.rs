//! Reports of a station's news through the desktop, on a separate thread. The notifier is one more
//! client of the station: it waits for no window, and nothing waits for it. While it is busy, news
//! stay in the snapshots, which lose no top-priority alarm.

use std::{io, thread, time::Duration};

use jiff::tz::TimeZone;
use tokio::{
    sync::{mpsc, watch},
    time::timeout,
};

use crate::{
    contract::Snapshot,
    desktop::{Desktop, Notification, Outlets, Sound, Urgency},
    engine::Client,
    job::Wake,
    model::notices::{Notice, NoticeSubject, Teller},
    station::Tones,
    ui::words,
};

/// Max time between two publications of a working station.
const STANDS: Duration = Duration::from_secs(2);

/// Handle on a running notifier, which ends with its station.
pub struct Notifier {
    outlets: watch::Receiver<Outlets>,
    trials: mpsc::Sender<Sound>,
}

impl Notifier {
    /// Starts to report the news of `station` to `desktop`. Calls `wake` when an outlet goes
    /// missing or comes back.
    pub fn start(station: Client, desktop: Desktop, wake: Wake) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let (tell_outlets, outlets) = watch::channel(Outlets::default());
        let (trials, receiver) = mpsc::channel(1);
        thread::Builder::new().name("azel-notifier".to_owned()).spawn(move || {
            let notify = |outlets: &Outlets| {
                let is_news = tell_outlets.send_if_modified(|last_outlets| {
                    let is_news = last_outlets != outlets;
                    last_outlets.clone_from(outlets);
                    is_news
                });
                if is_news {
                    wake();
                }
            };
            runtime.block_on(tell_all(station, desktop, receiver, notify));
        })?;
        Ok(Self { outlets, trials })
    }

    /// Returns the outlets that are missing.
    pub fn outlets(&self) -> Outlets {
        self.outlets.borrow().clone()
    }

    /// Shows and sounds an example despite all settings; does nothing while another example waits.
    pub fn try_out(&self, sound: Sound) {
        let _ = self.trials.try_send(sound);
    }
}

async fn tell_all(
    mut station: Client,
    mut desktop: Desktop,
    mut trials: mpsc::Receiver<Sound>,
    notify: impl Fn(&Outlets),
) {
    let (mut teller, mut stood) = (Teller::default(), None);
    desktop.look().await;
    notify(desktop.outlets());
    loop {
        let snapshot = station.snapshot();
        let news = teller.look(&snapshot, stood, &TimeZone::system());
        if !news.notices.is_empty() {
            let notifications = notifications(&news.notices, &snapshot);
            desktop.tell(&notifications, sound(&news.notices)).await;
            notify(desktop.outlets());
        }
        desktop.close(&news.ended).await;
        tokio::select! {
            changed = timeout(STANDS, station.changed()) => match changed {
                Ok(true) => stood = None,
                Ok(false) => break,
                Err(_) => stood = Some(STANDS),
            },
            Some(sound) = trials.recv() => {
                desktop.tell(&[trial(sound)], Some(sound)).await;
                notify(desktop.outlets());
            }
        }
    }
}

fn trial(sound: Sound) -> Notification {
    let (title, text) = words::trial(sound);
    Notification { title, text, urgency: Urgency::Normal, number: None }
}

fn notifications(news: &[Notice], station: &Snapshot) -> Vec<Notification> {
    let shown = news.iter().filter(|notice| notice.is_shown);
    shown.map(|notice| notification(&notice.subject, station)).collect()
}

fn notification(notice_subject: &NoticeSubject, station: &Snapshot) -> Notification {
    let (title, text) = words::notice(notice_subject, station);
    let urgency =
        if notice_subject.has_top_priority() { Urgency::Critical } else { Urgency::Normal };
    let number = match notice_subject {
        NoticeSubject::Alarm(alarm) => Some(alarm.row),
        NoticeSubject::StationStands(_) | NoticeSubject::Reminder(_) => None,
    };
    Notification { title, text, urgency, number }
}

/// Returns one sound for all news: the sound of the most urgent.
fn sound(news: &[Notice]) -> Option<Sound> {
    match news.iter().map(|notice| notice.tones).max()? {
        Tones::None => None,
        Tones::Rising => Some(Sound::Rising),
        Tones::Falling => Some(Sound::Falling),
    }
}

#[cfg(target_os = "linux")]
#[cfg(test)]
mod tests {
    use std::sync::{Arc, mpsc};

    use super::*;
    use crate::{
        clock::Clock,
        desktop::{Missing, testing},
        engine::{Handle, Settings},
    };

    const PATIENCE: Duration = Duration::from_mins(1);

    /// Starts a station whose file is `text`; returns the station and its folder.
    fn station(text: &str) -> (Handle, tempfile::TempDir) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        std::fs::write(&path, text).unwrap();
        let settings = Settings {
            path: Some(path),
            library: Some(folder.path().join("elements")),
            ..Settings::default()
        };
        (Handle::start(settings, Clock::system(), Arc::new(|| {})).unwrap(), folder)
    }

    #[test]
    fn a_top_priority_alarm_reaches_the_desktop_whatever_is_set() {
        let (desktop, _server, calls) = testing::desktop();
        let (station, _folder) = station(
            "name = 'Şile 1'\nsound = 3\n[notices]\nnotifications = false\nsounds = false\n\
             quiet = { from = '00:00', to = '23:59' }\n[[keep_out]]\nname = 'mast'\n",
        );
        let (wake, woken) = mpsc::sync_channel(10);
        let wake: Wake = Arc::new(move || wake.send(()).unwrap());
        let mut notifier = Notifier::start(station.client().clone(), desktop, wake).unwrap();
        let call = calls.recv_timeout(PATIENCE).unwrap();
        assert_eq!((&*call.title, call.urgency), ("Alarm, Şile 1", 2));
        assert!(call.text.starts_with("mast does not apply: it has no corners."), "{}", call.text);
        woken.recv_timeout(PATIENCE).unwrap();
        notifier.try_out(Sound::Rising);
        let trial = calls.recv_timeout(PATIENCE).unwrap();
        assert_eq!((&*trial.text, trial.urgency), ("This is how rising tones sound.", 1));
        let outlets = notifier.outlets();
        assert_eq!(outlets.notifications, None);
        assert!(matches!(outlets.sounds, Some(Missing::Player(_))));
        drop(station);
        while zbus::block_on(notifier.outlets.changed()).is_ok() {}
        assert_eq!(calls.try_iter().next(), None, "nothing of a lower rank");
    }
}
