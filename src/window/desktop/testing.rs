//! A fake notification service that records its calls, also for tests of the parent package.

#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::missing_panics_doc,
    reason = "a test may end here"
)]

use std::{collections::HashMap, os::unix::net::UnixStream, sync::mpsc};

use zbus::{Connection, Guid, connection::Builder, zvariant::OwnedValue};

use super::{
    Desktop,
    bus::{Bus, OBJECT, Service},
    player::Player,
};

/// A call of `Notify`.
#[derive(Debug, Clone, PartialEq)]
pub struct Call {
    pub app: String,
    pub replaces: u32,
    pub title: String,
    pub text: String,
    pub urgency: u8,
    pub is_silent: bool,
}

struct Desk {
    calls: mpsc::SyncSender<Call>,
    capabilities: Vec<String>,
    last_id: u32,
    closed: Vec<u32>,
}

#[zbus::interface(name = "org.freedesktop.Notifications")]
impl Desk {
    fn get_capabilities(&self) -> Vec<String> {
        self.capabilities.clone()
    }

    fn close_notification(&mut self, id: u32) {
        self.closed.push(id);
    }

    // The specification defines this signature.
    #[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
    fn notify(
        &mut self,
        app_name: String,
        replaces_id: u32,
        app_icon: String,
        summary: String,
        body: String,
        actions: Vec<String>,
        hints: HashMap<String, OwnedValue>,
        expire_timeout: i32,
    ) -> u32 {
        assert!(app_icon.is_empty() && actions.is_empty() && expire_timeout == -1);
        let call = Call {
            app: app_name,
            replaces: replaces_id,
            title: summary,
            text: body,
            urgency: hints["urgency"].downcast_ref().unwrap(),
            is_silent: hints["suppress-sound"].downcast_ref().unwrap(),
        };
        self.calls.send(call).unwrap();
        self.last_id += u32::from(replaces_id == 0);
        if replaces_id == 0 { self.last_id } else { replaces_id }
    }
}

/// Returns a connection to a fake service, the service and its calls.
pub(super) async fn desk(capabilities: &[&str]) -> (Bus, Connection, mpsc::Receiver<Call>) {
    let (near, far) = UnixStream::pair().unwrap();
    let (calls, called) = mpsc::sync_channel(1000);
    let capabilities = capabilities.iter().map(|name| (*name).to_owned()).collect();
    let desk = Desk { calls, capabilities, last_id: 0, closed: Vec::new() };
    let server = async {
        let builder = Builder::async_io_unix_stream(far).server(Guid::generate())?.p2p();
        builder.serve_at(OBJECT, desk)?.build().await
    };
    let client = async { Builder::async_io_unix_stream(near).p2p().build().await };
    let (server, client) = tokio::join!(server, client);
    let service = Service::on(client.unwrap()).await.unwrap();
    (Bus::new(service), server.unwrap(), called)
}

/// Returns the ids of the notifications that were closed.
pub async fn closed(server: &Connection) -> Vec<u32> {
    let desk = server.object_server().interface::<_, Desk>(OBJECT).await.unwrap();
    desk.get().await.closed.clone()
}

/// Returns a desktop with a notification service and without sound players.
pub fn desktop() -> (Desktop, Connection, mpsc::Receiver<Call>) {
    let (bus, server, calls) = zbus::block_on(desk(&["body"]));
    (Desktop { bus, player: Player::with_path(None), ..Desktop::default() }, server, calls)
}
