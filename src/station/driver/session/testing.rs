//! Session with a simulated Satrak at the other end of an in-memory stream.

use std::{collections::BTreeMap, num::NonZeroU32, sync::Arc};

use jiff::Timestamp;

use super::{Session, Wires};
use crate::{
    astro::{Angle, Site, time::add_seconds},
    clock::Clock,
    controller::satrak::Satrak,
    device::TrackTarget,
    driver::{AntennaHandle, Debts, Dial, Orders, Stream},
    orbit::{Pass, PassSearch, Propagator, passes, read_elements},
    plan::{Bounds, OnBoardPass, on_board::KnownOrbit},
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
    let handle = start_with(control.clone(), START, debts, wired);
    (control, handle)
}

/// Starts a session with a new unit at `now`; returns the unit and the handle.
pub(in crate::driver) fn start_at(now: Timestamp, debts: Debts) -> (Control, AntennaHandle) {
    let control = Control::new(&Options::new(Station::default().site, now));
    let handle = start_with(control.clone(), now, debts, |wires| wires);
    (control, handle)
}

/// Starts a session with a running unit whose time is `now`.
pub(in crate::driver) fn start_with(
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
    let session = Session::with_wires(satrak, &antenna, dial, clock, wired(wires), debts);
    tokio::spawn(session.run());
    handle
}

/// Elements of the ISS in 2008, a published example.
const ELEMENTS: &str = "ISS (ZARYA)
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
";

fn site() -> Site {
    Site::new(41.01, 29.17, 100.0).unwrap()
}

/// Returns a high pass of the ISS.
pub(in crate::driver) fn pass() -> OnBoardPass {
    let elements = read_elements(ELEMENTS).elements.swap_remove(0);
    let (propagator, start) = (Propagator::new(&elements).unwrap(), elements.epoch());
    let aos_elevation = Angle::from_degrees(10.0);
    let search = PassSearch {
        aos_elevation,
        ..PassSearch::new(site(), start, add_seconds(start, 3.0 * 86_400.0))
    };
    let is_high = |pass: &Pass| pass.max_elevation().degrees() > 40.0;
    let pass = passes(&propagator, &search, &|| false).into_iter().find(is_high).unwrap();
    let target = TrackTarget {
        catalog_number: 25_544,
        name: "ISS (ZARYA)".into(),
        element_file: None,
        start: pass.aos.time,
        end: pass.los.time,
    };
    OnBoardPass { target, elements, site: site(), is_agreed: false }
}

/// Returns a unit that starts `after_s` seconds after AOS.
pub(in crate::driver) fn unit(after_s: f64) -> (Control, Timestamp) {
    let pass = pass();
    let now = add_seconds(pass.target.start, after_s);
    let elements = BTreeMap::from([("stations.txt".to_owned(), vec![pass.elements])]);
    (Control::new(&Options { elements, ..Options::new(site(), now) }), now)
}

pub(in crate::driver) fn orbit() -> Arc<KnownOrbit> {
    let OnBoardPass { elements, site, .. } = pass();
    Arc::new(KnownOrbit { elements, site })
}
