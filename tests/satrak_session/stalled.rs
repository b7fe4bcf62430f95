//! Peer that reads nothing, until the buffers of the link are full.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use azel::{
    contract::driver::{Command, Event, LinkLoss, Safety},
    driver::Stream,
    sim::satrak::Control,
};
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream, duplex},
    sync::watch,
};

use super::rig::{Rig, antenna, options};

/// Capacity of the buffers of both ends, bytes: a question or two.
const BUFFERS: usize = 40;

/// Carries all bytes until the peer stalls. The peer then reads nothing, but the link stays open.
async fn carry(mut here: DuplexStream, mut there: DuplexStream, mut stalls: watch::Receiver<bool>) {
    let (mut out, mut back) = ([0; 64], [0; 1024]);
    loop {
        tokio::select! {
            biased;
            _ = stalls.changed() => break,
            read = here.read(&mut out) => match read {
                Ok(count @ 1..) => there.write_all(&out[..count]).await.unwrap(),
                _ => return,
            },
            read = there.read(&mut back) => match read {
                Ok(count @ 1..) => here.write_all(&back[..count]).await.unwrap(),
                _ => return,
            },
        }
    }
    std::future::pending::<()>().await;
}

#[tokio::test(start_paused = true)]
async fn a_write_that_is_not_taken_ends_the_link_and_stop_is_first_on_the_next() {
    let (stall, stalls) = watch::channel(false);
    let dials = Arc::new(AtomicU64::new(0));
    let link = {
        let dials = Arc::clone(&dials);
        move |control: &Control| -> Box<dyn Stream> {
            let (there, far) = duplex(4096);
            let control = control.clone();
            tokio::spawn(async move { control.serve(far).await });
            // The next link does not stall.
            if dials.fetch_add(1, Ordering::Relaxed) > 0 {
                return Box::new(there);
            }
            let (near, here) = duplex(BUFFERS);
            tokio::spawn(carry(here, there, stalls.clone()));
            Box::new(near)
        }
    };
    let options = azel::sim::satrak::Options { max_clients: 2, ..options() };
    let control = Control::new(&options);
    let mut rig = Rig::start_over(control, options.utc_origin, &antenna(), None, link);
    rig.until("all is read", 5, |shown| shown.state.on_board.offsets.is_some()).await;
    rig.send(Command::Manual);
    rig.hold([1.0, 0.0], 1.0).await;
    assert!(rig.control.state().is_moving);
    rig.events();

    stall.send(true).unwrap();
    let stalled = azel::clock::Instant::now();
    let told = |event: &Event| matches!(event, Event::Safety(Safety::SilentInMotion));
    rig.until_event(3, told).await;
    let lost = rig.until_event(3, |event| matches!(event, Event::LinkLost(_))).await;
    assert!(matches!(lost, Event::LinkLost(LinkLoss::Broken(_))), "{lost:?}");
    assert!(rig.times("STOP=").is_empty(), "it does not reach the unit on that link");
    let received = rig.payloads().len();
    rig.until_up(3).await;
    rig.seconds(4.0).await;
    let after = rig.payloads().split_off(received);
    assert_eq!(after[..2], ["STOP=", "TRACK=,0"], "{after:?}");
    let stop_at = *rig.times("STOP=").first().unwrap();
    let late = stop_at.saturating_duration_since(stalled).as_secs_f64();
    assert!(late < 3.0, "{late}");
    assert!(!rig.control.state().is_moving && !rig.shown().silent);
    assert_eq!(dials.load(Ordering::Relaxed), 2);
}
