//! Learned figures of the drives, which outlast the session and the station that learned them.

use azel::{
    contract::{
        Command,
        driver::{self, AxisLessons},
    },
    engine::Client,
    station::Station,
};

use super::unattended::scene_of;
use crate::common::units::{measured, until};

fn learned(client: &Client) -> Option<[AxisLessons; 2]> {
    let learned = client.snapshot().antennas.first()?.snapshot.learned;
    (learned != <[AxisLessons; 2]>::default()).then_some(learned)
}

#[tokio::test(start_paused = true)]
async fn a_start_knows_the_drives_until_the_operator_has_them_learned_anew() {
    let (scene, client, id) = scene_of("Mast", |_| {}).await;
    assert_eq!(learned(&client), None);
    let jog = || Command::Antenna(id, driver::Command::Jog { rates_deg_s: [1.0, 0.0] });
    let taught = until("a lesson", || {
        let _ = client.send(jog());
        learned(&client)
    })
    .await;
    client.stop_all();
    until("standstill", || {
        let snapshot = client.snapshot();
        let antenna = snapshot.antennas.first()?;
        (!antenna.snapshot.unproved).then_some(())
    })
    .await;
    let taught = learned(&client).unwrap_or(taught);
    drop(client);
    let scene = scene.started_again(false).await;
    let client = scene.client();
    assert_eq!(learned(&client), Some(taught));
    measured(&client, "Mast").await;
    assert_eq!(learned(&client), Some(taught), "a new session begins with them");

    let mut station = Station::clone(&client.snapshot().station);
    station.antennas[0].sway_deg += 0.1;
    let save = |station: &Station| Command::SaveStation(Box::new(station.clone()));
    let _ = client.send(save(&station));
    let has_new_settings =
        || (client.snapshot().station.antennas == station.antennas).then_some(());
    until("the new settings", has_new_settings).await;
    assert_eq!(learned(&client), Some(taught), "so does one with other settings");

    let _ = client.send(Command::Antenna(id, driver::Command::ForgetDrives));
    until("the end of the lessons", || learned(&client).is_none().then_some(())).await;
    station.antennas[0].sway_deg += 0.1;
    let _ = client.send(save(&station));
    let has_new_settings =
        || (client.snapshot().station.antennas == station.antennas).then_some(());
    until("the settings after that", has_new_settings).await;
    assert_eq!(learned(&client), None, "other settings bring nothing back");
    drop(client);
    let scene = scene.started_again(false).await;
    assert_eq!(learned(&scene.client()), None, "nor does the next start know them");
}
