//! The whole path: the driver's thread, a TCP port, and the unit behind it.

use std::{
    sync::{Arc, mpsc},
    time::Duration,
};

use azel::{
    clock::Clock,
    contract::driver::{LinkLoss, LinkState, Snapshot, StopState},
    driver::{AntennaHandle, Driver},
    plan::Bounds,
    sim::rotator_genius::Simulator,
    station::Antenna,
};

use super::rig::{pair, to};

/// Time limit of any wait in these tests.
const PATIENCE: Duration = Duration::from_secs(20);

/// Waits for wakes of the driver until the snapshot fulfils the condition.
fn until(handle: &AntennaHandle, woken: &mpsc::Receiver<()>, is_so: impl Fn(&Snapshot) -> bool) {
    while !is_so(&handle.snapshot()) {
        woken.recv_timeout(PATIENCE).unwrap();
    }
}

#[test]
fn an_antenna_over_tcp_is_read_sent_and_stopped_and_a_second_client_turned_away() {
    let runtime = tokio::runtime::Runtime::new().unwrap();
    let any = ([127, 0, 0, 1], 0).into();
    let simulator = runtime.block_on(Simulator::bind(any, pair())).unwrap();
    let address = simulator.local_addr().unwrap().to_string();
    let control = simulator.control();
    runtime.spawn(simulator.run());

    // One wake is enough for any number of changes.
    let (woke, woken) = mpsc::sync_channel(1);
    let wake = Arc::new(move || {
        let _ = woke.try_send(());
    });
    let clock = Clock::new(jiff::Timestamp::now);
    let driver = Driver::start(clock, wake).unwrap();
    let antenna = Antenna::genius("Mast", &address);
    let first =
        driver.open(&antenna, Bounds::of_antenna(&antenna), Default::default(), None, Box::new(()));
    until(&first, &woken, |shown| shown.state.measured.is_some());
    let measured = first.snapshot().state.measured.unwrap();
    assert_eq!(measured.axes.map(|axis| axis.angle_deg), [Some(173.0), Some(0.0)]);

    let second =
        driver.open(&antenna, Bounds::of_antenna(&antenna), Default::default(), None, Box::new(()));
    until(&second, &woken, |shown| {
        // The unit closes the link, or resets it if a question arrives too late.
        let LinkState::Lost { reason, .. } = &shown.link else { return false };
        matches!(reason, LinkLoss::Closed | LinkLoss::Broken(_))
    });

    first.send(to(Some(300.0), Some(80.0))).unwrap();
    until(&first, &woken, |shown| shown.state.measured.unwrap().moving());
    first.stop();
    until(&first, &woken, |shown| matches!(shown.stop, StopState::Stopped { .. }));
    let mut orders: Vec<String> =
        control.received().into_iter().map(|(_, it)| it).filter(|it| it != "|h").collect();
    orders.dedup();
    assert_eq!(orders, ["|A1300", "|A2080", "|S"]);
}
