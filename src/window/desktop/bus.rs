//! The notification service of the desktop session ("Desktop Notifications Specification" of
//! freedesktop.org).

use std::{
    collections::{BTreeMap, HashMap},
    time::Duration,
};

use zbus::{Connection, Message, connection::Builder, zvariant::Value};

use super::{Missing, Notification, Urgency};

const SERVICE: &str = "org.freedesktop.Notifications";
pub(super) const OBJECT: &str = "/org/freedesktop/Notifications";
/// Timeout of a call; the desktop may have to start the service first.
const PATIENCE: Duration = Duration::from_secs(5);
/// Max number of replaceable notifications, the same as the max number of alarms.
const MAX_CHARS: usize = 200;
/// Value with which the service decides how long it shows a notification.
const ITS_OWN_TIME: i32 = -1;

/// A connection to the service, opened on first use.
#[derive(Default)]
pub(super) struct Bus {
    service: Option<Service>,
    /// Ids that the service assigned, by Azel's own numbers.
    shown: BTreeMap<u64, u32>,
}

pub(super) struct Service {
    bus: Connection,
    reads_markup: bool,
}

impl Bus {
    #[cfg(any(test, feature = "testing"))]
    pub(super) fn new(service: Service) -> Self {
        Self { service: Some(service), ..Self::default() }
    }

    pub(super) async fn look(&mut self) -> Result<(), Missing> {
        self.service().await.map(drop)
    }

    pub(super) async fn show(&mut self, notification: &Notification) -> Result<(), Missing> {
        let is_old = self.service.is_some();
        let mut shown = self.notify(notification).await;
        // The session bus may have restarted since the last call.
        if shown.is_err() && is_old {
            shown = self.notify(notification).await;
        }
        let id = shown?;
        if let Some(number) = notification.number {
            self.shown.insert(number, id);
            while self.shown.len() > MAX_CHARS {
                self.shown.pop_first();
            }
        }
        Ok(())
    }

    /// Closes the notification with this number, if it was shown. If the operator has closed it
    /// already, the service answers with an error.
    pub(super) async fn close(&mut self, number: u64) {
        let Some(id) = self.shown.remove(&number) else { return };
        let Some(service) = &self.service else { return };
        if let Err(error) = service.call("CloseNotification", &(id,)).await {
            tracing::debug!(%error, "a notification was not closed");
        }
    }

    async fn notify(&mut self, notification: &Notification) -> Result<u32, Missing> {
        let Notification { title, text, urgency, number } = notification;
        let replaces = number.and_then(|number| self.shown.get(&number)).copied();
        let service = self.service().await?;
        let urgency: u8 = match urgency {
            Urgency::Normal => 1,
            Urgency::Critical => 2,
        };
        let hints = HashMap::from([
            ("urgency", Value::from(urgency)),
            ("desktop-entry", Value::from("azel")),
            // The operator sets the sound in Azel.
            ("suppress-sound", Value::from(true)),
        ]);
        let text = if service.reads_markup { escaped(text) } else { text.clone() };
        let (icon, actions) = ("", [""; 0]);
        let replaces = replaces.unwrap_or(0);
        let arguments =
            ("Azel", replaces, icon, title, text, actions.as_slice(), hints, ITS_OWN_TIME);
        let answer = service.call("Notify", &arguments).await;
        match answer.and_then(|answer| answer.body().deserialize()) {
            Ok(id) => Ok(id),
            Err(error) => {
                self.service = None;
                Err(Missing::Service(error.to_string()))
            }
        }
    }

    async fn service(&mut self) -> Result<&Service, Missing> {
        let service = match self.service.take() {
            Some(service) => service,
            None => Service::on(session_bus().await?).await?,
        };
        Ok(self.service.insert(service))
    }
}

async fn session_bus() -> Result<Connection, Missing> {
    let connect = async { Builder::session()?.method_timeout(PATIENCE).build().await };
    let no_bus = |error: zbus::Error| Missing::Bus(error.to_string());
    match tokio::time::timeout(PATIENCE, connect).await {
        Ok(bus) => bus.map_err(no_bus),
        Err(error) => Err(Missing::Bus(error.to_string())),
    }
}

impl Service {
    pub(super) async fn on(bus: Connection) -> Result<Self, Missing> {
        let mut service = Self { bus, reads_markup: false };
        let answer = service.call("GetCapabilities", &()).await;
        let capabilities: Vec<String> = answer
            .and_then(|answer| answer.body().deserialize())
            .map_err(|error| Missing::Service(error.to_string()))?;
        service.reads_markup = capabilities.iter().any(|name| name == "body-markup");
        Ok(service)
    }

    async fn call<B>(&self, method: &str, arguments: &B) -> zbus::Result<Message>
    where
        B: serde::Serialize + zbus::zvariant::DynamicType,
    {
        self.bus.call_method(Some(SERVICE), OBJECT, Some(SERVICE), method, arguments).await
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desktop::testing::{Call, closed, desk};

    fn notification(title: &str, urgency: Urgency, number: Option<u64>) -> Notification {
        Notification { title: title.to_owned(), text: "X < Y & Z".to_owned(), urgency, number }
    }

    #[tokio::test]
    async fn a_notification_comes_as_it_was_meant_and_a_repeat_takes_its_place() {
        let (mut bus, _server, calls) = desk(&["body", "body-markup"]).await;
        let first = notification("Alarm", Urgency::Critical, Some(7));
        let other = notification("Reminder", Urgency::Normal, None);
        for notification in [&first, &other, &first, &other] {
            bus.show(notification).await.unwrap();
        }
        let call = |title: &str, urgency, replaces| Call {
            app: "Azel".to_owned(),
            replaces,
            title: title.to_owned(),
            text: "X &lt; Y &amp; Z".to_owned(),
            urgency,
            is_silent: true,
        };
        let expected = [
            call("Alarm", 2, 0),
            call("Reminder", 1, 0),
            call("Alarm", 2, 1),
            call("Reminder", 1, 0),
        ];
        assert_eq!(calls.try_iter().collect::<Vec<_>>(), expected);
    }

    #[tokio::test]
    async fn a_notification_is_closed_once_and_comes_anew_afterwards() {
        let (mut bus, server, calls) = desk(&[]).await;
        let alarm = notification("Alarm", Urgency::Critical, Some(7));
        bus.show(&alarm).await.unwrap();
        bus.close(8).await;
        bus.close(7).await;
        bus.close(7).await;
        assert_eq!(closed(&server).await, [1]);
        bus.show(&alarm).await.unwrap();
        let replaced: Vec<u32> = calls.try_iter().map(|call| call.replaces).collect();
        assert_eq!(replaced, [0, 0]);
    }

    #[tokio::test]
    async fn a_service_that_reads_no_markup_gets_plain_text() {
        let (mut bus, _server, calls) = desk(&["body"]).await;
        bus.show(&notification("Alarm", Urgency::Normal, None)).await.unwrap();
        assert_eq!(calls.recv().unwrap().text, "X < Y & Z");
    }

    #[tokio::test]
    async fn what_is_kept_for_replacement_is_bounded() {
        let (mut bus, _server, _calls) = desk(&[]).await;
        for number in 0..300 {
            bus.show(&notification("Alarm", Urgency::Normal, Some(number))).await.unwrap();
        }
        assert_eq!((bus.shown.len(), bus.shown.contains_key(&299)), (MAX_CHARS, true));
    }
}
