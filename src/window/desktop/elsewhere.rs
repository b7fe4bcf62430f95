//! Operating systems without notifications and sounds.

use super::{Missing, Notification, Sound};

#[derive(Default)]
pub(super) struct Bus;

#[derive(Default)]
pub(super) struct Player;

impl Bus {
    pub(super) async fn look(&mut self) -> Result<(), Missing> {
        Err(Missing::Elsewhere)
    }

    pub(super) async fn show(&mut self, _: &Notification) -> Result<(), Missing> {
        Err(Missing::Elsewhere)
    }

    pub(super) async fn close(&mut self, _: u64) {}
}

impl Player {
    pub(super) fn look(&self) -> Result<(), Missing> {
        Err(Missing::Elsewhere)
    }

    pub(super) async fn play(&mut self, _: Sound) -> Result<(), Missing> {
        Err(Missing::Elsewhere)
    }
}
