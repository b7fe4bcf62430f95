//! Tests of motion by a client's requests.

use super::*;

#[tokio::test(start_paused = true)]
async fn a_move_lasts_until_stop_and_survives_its_client() {
    let (mut client, control) = Client::new(&options(some_day()));
    client.done("MOVE=,2,0").await;
    seconds(3).await;
    let status = client.status().await;
    assert!(status.is_moving() && status.x_deg > 94.0, "{status:?}");
    drop(client);
    let before = control.state().x_deg;
    seconds(10).await;
    let after = control.state();
    assert!(after.is_moving && (after.x_deg - before - 20.0).abs() < 0.2, "{after:?}");
    let mut client = Client::attached(&control);
    client.done("STOP=").await;
    seconds(1).await;
    let status = client.status().await;
    assert!(!status.is_moving());
    let stood = control.state().x_deg;
    seconds(5).await;
    assert!((control.state().x_deg - stood).abs() < 1e-9);
}

#[tokio::test(start_paused = true)]
async fn a_limit_ends_a_move_and_shows_its_flag() {
    let (mut client, _control) = Client::new(&options(some_day()));
    client.done("MOVE=,0,-5").await;
    seconds(20).await;
    let status = client.status().await;
    assert!(status.limits.y_minus && !status.limits.y_plus && !status.limits.x_minus);
    assert!(!status.is_moving());
    client.done("MOVE=,0,1").await;
    seconds(2).await;
    let status = client.status().await;
    assert!(!status.limits.any() && status.is_moving());
}

#[tokio::test(start_paused = true)]
async fn a_goto_arrives_and_a_step_turns_by_its_amount() {
    let (mut client, _control) = Client::new(&options(some_day()));
    client.done("GOTO=,125.1,32.6").await;
    seconds(30).await;
    let status = client.status().await;
    let error = AzEl::from_degrees(status.az_deg, status.el_deg)
        .separation(AzEl::from_degrees(125.1, 32.6))
        .degrees();
    assert!(error < 0.02 && !status.is_moving(), "{status:?}");
    // The angles are 90 degrees larger than on a mount that counts from the zenith.
    assert!((status.x_deg - 142.0).abs() < 0.11 && (status.y_deg - 61.0).abs() < 0.11);
    client.done("GOTO=,NONE,60.5").await;
    seconds(30).await;
    let status = client.status().await;
    assert!((status.az_deg - 125.1).abs() < 0.05 && (status.el_deg - 60.5).abs() < 0.02);
    client.done("STEP=,+2,-1").await;
    seconds(5).await;
    let moved = client.status().await;
    assert!((moved.x_deg - status.x_deg - 2.0).abs() < 0.11);
    assert!((moved.y_deg - status.y_deg + 1.0).abs() < 0.11);
    client.refused("GOTO=,0,2", "4").await;
    client.refused("GOTO=,NONE,NONE", "3").await;
}

#[tokio::test(start_paused = true)]
async fn calibrating_shifts_what_is_reported() {
    let (mut client, _control) = Client::new(&options(some_day()));
    client.done("ANGLE_SETTINGS=,1,0,100.0,0,80.0").await;
    seconds(1).await;
    let status = client.status().await;
    assert!((status.x_deg - 100.0).abs() < 0.1 && (status.y_deg - 80.0).abs() < 0.1);
}
