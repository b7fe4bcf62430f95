//! Site, pass, unit and antenna of the tests.

use std::{collections::BTreeMap, sync::Arc};

use azel::{
    astro::{Angle, Site, time},
    clock::Clock,
    contract::driver::Command,
    controller::satrak::Satrak,
    device::TrackTarget,
    driver::{AntennaHandle, Debts, Dial, Session},
    orbit::{Elements, Pass, PassSearch, Propagator, passes, read_elements},
    plan::{OnBoardPass, on_board::KnownOrbit},
    sim::satrak::Options,
    station::Antenna,
};

/// The ISS in 2008, a published example, and the same orbit under another name and number.
const ELEMENTS: &str = "ISS (ZARYA)
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
TWIN
1 25545U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2928
2 25545  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563538
";
/// Name of the element file on the unit.
pub(super) const FILE: &str = "stations.txt";

pub(crate) fn site() -> Site {
    Site::new(41.01, 29.17, 100.0).unwrap().airless()
}

fn elements() -> Vec<Elements> {
    read_elements(ELEMENTS).elements
}

/// Returns a pass high enough to be worth tracking.
pub(super) fn pass() -> Pass {
    first_pass(10.0, |pass| pass.max_elevation().degrees() > 40.0)
}

/// Returns the first pass of this kind in three days.
fn first_pass(aos_elevation_deg: f64, is_wanted: impl Fn(&Pass) -> bool) -> Pass {
    let iss = &elements()[0];
    let propagator = Propagator::new(iss).unwrap();
    let from = iss.epoch();
    let to = time::add_seconds(from, 3.0 * time::DAY_S);
    let aos_elevation = Angle::from_degrees(aos_elevation_deg);
    let search = PassSearch { aos_elevation, ..PassSearch::new(site(), from, to) };
    passes(&propagator, &search, &|| false).into_iter().find(is_wanted).unwrap()
}

/// Returns the ISS for the whole of [`pass`].
pub(crate) fn iss() -> TrackTarget {
    whole(&pass())
}

/// Returns the ISS for a whole pass that begins low in the west.
pub(super) fn from_the_west() -> TrackTarget {
    let is_west = |pass: &Pass| (250.0..290.0).contains(&pass.aos.direction.azimuth_deg());
    whole(&first_pass(5.2, is_west))
}

fn whole(pass: &Pass) -> TrackTarget {
    TrackTarget {
        catalog_number: 25_544,
        name: "ISS (ZARYA)".into(),
        element_file: None,
        start: pass.aos.time,
        end: pass.los.time,
    }
}

/// Returns a command to track `target`, with the orbit that both satellites share.
pub(super) fn track(target: TrackTarget) -> Command {
    Command::Track(Box::new(on_board(target)))
}

pub(crate) fn on_board(target: TrackTarget) -> OnBoardPass {
    let elements = elements().swap_remove(usize::from(target.catalog_number == 25_545));
    OnBoardPass { target, elements, site: site(), is_agreed: false }
}

/// Returns the known orbit of one of the two satellites.
pub(super) fn orbit(catalog_number: u32) -> Arc<KnownOrbit> {
    let elements = elements().swap_remove(usize::from(catalog_number == 25_545));
    Arc::new(KnownOrbit { elements, site: site() })
}

/// Returns the other satellite on the same orbit.
pub(super) fn twin() -> TrackTarget {
    TrackTarget { catalog_number: 25_545, name: "TWIN".into(), ..iss() }
}

/// Returns options of a well-behaved unit 90 seconds before [`pass`].
pub(super) fn options() -> Options {
    Options {
        elements: BTreeMap::from([(FILE.to_owned(), elements())]),
        ..Options::new(site(), time::add_seconds(pass().aos.time, -90.0))
    }
}

pub(crate) fn antenna() -> Antenna {
    Antenna::satrak("Dish", "in memory")
}

/// Creates a session of `antenna` over links from `dial`, and its handle.
pub(super) fn session(antenna: &Antenna, dial: Dial, clock: Clock) -> (Session, AntennaHandle) {
    let satrak = Satrak::new(antenna.poll, FILE.to_owned());
    Session::new(Box::new(satrak), antenna, dial, clock, Arc::new(|| {}), Debts::default())
}
