//! A session with a simulated Satrak at the other end of a stream in memory.

use std::{num::NonZeroU32, sync::Arc};

use jiff::Timestamp;

use super::{Session, Wires};
use crate::{
    clock::Clock,
    controller::satrak::Satrak,
    driver::{AntennaHandle, Debts, Dial, Orders, Stream},
    plan::Bounds,
    sim::satrak::{Control, Options},
    station::{Antenna, Station},
};

pub(in crate::driver) const START: Timestamp = Timestamp::UNIX_EPOCH;

pub(in crate::driver) fn antenna() -> Antenna {
    Antenna::satrak("Dish", "in memory")
}

/// Starts a session over the stream that `wired` wraps; returns the unit and the handle.
pub(in crate::driver) fn start(
    debts: Debts,
    wired: impl FnOnce(Wires) -> Wires,
) -> (Control, AntennaHandle) {
    let control = Control::new(&Options::new(Station::default().site, START));
    let handle = over(control.clone(), START, debts, wired);
    (control, handle)
}

/// Starts a session with a new unit at `now`; returns the unit and the handle.
pub(in crate::driver) fn start_at(now: Timestamp, debts: Debts) -> (Control, AntennaHandle) {
    let control = Control::new(&Options::new(Station::default().site, now));
    let handle = over(control.clone(), now, debts, |wires| wires);
    (control, handle)
}

/// Starts a session with a unit that runs already, whose time is `now`.
pub(in crate::driver) fn over(
    control: Control,
    now: Timestamp,
    debts: Debts,
    wired: impl FnOnce(Wires) -> Wires,
) -> AntennaHandle {
    let antenna = antenna();
    let serve = control;
    let dial: Dial = Box::new(move || {
        let (near, far) = tokio::io::duplex(4096);
        let control = serve.clone();
        tokio::spawn(async move { control.serve(far).await });
        Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
    });
    let clock = Clock::at_speed(now, NonZeroU32::MIN);
    let bounds = Bounds::of_antenna(&antenna);
    let (wires, handle) =
        Wires::new(&antenna, bounds, clock.now().steady, Arc::new(|| {}), &Orders::default());
    let satrak = Box::new(Satrak::new(antenna.poll, "stations.txt".to_owned()));
    let session = Session::over(satrak, &antenna, dial, clock, wired(wires), debts);
    tokio::spawn(session.run());
    handle
}
