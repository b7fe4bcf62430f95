//! Hooks of a station that a rehearsal carries out.

use azel::{
    contract::{Command, passes::PredictedPass},
    station::{Hook, HookAction, HookEvent},
};

use super::scene::Scene;
use crate::common::units::{self, measured, start, until};

#[tokio::test(start_paused = true)]
async fn a_rehearsal_calls_no_hook() {
    let action = || HookAction::Command(vec!["true".to_owned()]);
    let hooks: Vec<Hook> = (HookEvent::WORDS.into_iter())
        .map(|(word, event)| Hook::new(word, event, action()))
        .collect();
    let mut station = units::station();
    station.antennas.retain(|antenna| antenna.name == "Dish");
    station.hooks.clone_from(&hooks);
    let scene = Scene::new(start(), &station);
    let client = scene.client();
    let id = measured(&client, "Dish").await;
    let pass = until("a pass", || {
        client.snapshot().pass_lists.next(client.now().utc).map(PredictedPass::key)
    });
    let pass = pass.await;
    client.send(Command::Track { antenna: id, pass, is_agreed: true }).unwrap();
    client.send(Command::TryHook(Box::new(hooks[0].clone()))).unwrap();
    until("the track", || client.snapshot().antennas.first()?.tracks().then_some(())).await;
    until("its end", || {
        let station = client.snapshot();
        (!station.antennas.first()?.tracks()).then_some(())
    })
    .await;
    assert_eq!(*client.snapshot().hooks, []);
}
