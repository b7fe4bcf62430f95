//! Station that runs in the caller's runtime, without a thread of its own.

use std::{future::Future, io, sync::Arc};

use tokio::sync::{Notify, mpsc};

use super::{Client, Engine, Outbox, Settings, handle::Request, wake_of};
use crate::{
    contract::Event,
    driver::{Driver, Outside},
};

/// Max number of pending requests.
const REQUESTS: usize = 64;
/// Max number of pending events.
const EVENTS: usize = 64;

/// Station in the caller's runtime. To end it, drop `InPlace` and await its future to the end.
pub struct InPlace {
    client: Client,
    _requests: mpsc::Sender<Request>,
}

impl InPlace {
    /// Starts a station. Its sessions are tasks of the current runtime.
    pub fn start(
        settings: &Settings,
        outside: Outside,
    ) -> io::Result<(Self, impl Future<Output = ()> + use<>)> {
        let runtime = tokio::runtime::Handle::try_current().map_err(io::Error::other)?;
        let (requests, inbox) = mpsc::channel(REQUESTS);
        let (tell, mut events) = mpsc::channel::<Event>(EVENTS);
        // Discard events: the snapshots have their content too.
        runtime.spawn(async move { while events.recv().await.is_some() {} });
        let woken = Arc::new(Notify::new());
        let driver = Driver::on_runtime(runtime, outside.clone(), wake_of(&woken))
            .marking_in(settings.marks.clone());
        let outbox = Outbox { events: tell, wake: Arc::new(|| {}) };
        let weak = requests.downgrade();
        let (engine, client) = Engine::driving(driver, woken, settings, outside, outbox, weak);
        let station = Self { client, _requests: requests };
        Ok((station, engine.run(inbox)))
    }

    pub fn client(&self) -> &Client {
        &self.client
    }
}
