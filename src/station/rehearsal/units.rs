//! Simulated units of a rehearsed station. Their links reach no other unit.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use jiff::Timestamp;

use super::{Fault, FaultKind, RehearsalError};
use crate::{
    astro::time::{add_seconds, seconds_between},
    clock::Clock,
    driver::{Dial, Outside, Stream, UnitLock},
    makes::{self, Surroundings},
    orbit::{Catalog, Elements},
    plan::schedule::Reach,
    sim::{InMemory, Mechanics},
    station::{Antenna, AntennaId, Direction, Station},
};

/// Size of a link's buffer, bytes.
const BUFFER: usize = 4096;

/// Unit and the link to it.
#[derive(Clone)]
struct Linked {
    id: AntennaId,
    antenna: String,
    unit: Arc<dyn InMemory>,
    is_down: Arc<AtomicBool>,
}

pub(super) struct Units(Vec<Linked>);

impl Units {
    /// Creates units for the antennas of a station. Removes antennas without a simulator from the
    /// station, and returns their names.
    pub(super) fn new(
        station: &mut Station,
        catalog: &Catalog,
        mechanics: Mechanics,
        seed: u64,
        clock: &Clock,
    ) -> Result<(Self, Vec<String>), RehearsalError> {
        let numbers = station.favourites.numbers();
        let elements: Vec<Elements> =
            numbers.iter().filter_map(|number| catalog.get(*number).cloned()).collect();
        let (mut units, mut left_out) = (Vec::new(), Vec::new());
        let site = station.site;
        // An antenna that cannot stand at its park position starts in the open sky.
        let begins_at = |antenna: &Antenna| {
            let (reach, now) = (Reach::from_station(station, antenna, None), clock.utc());
            let open = reach.open_sky(now).filter(|_| !reach.can_park(now))?;
            let (azimuth_deg, elevation_deg) = (open.azimuth_deg(), open.elevation_deg());
            Some(Direction { azimuth_deg, elevation_deg })
        };
        let begins_at: Vec<Option<Direction>> = station.antennas.iter().map(begins_at).collect();
        let mut begins_at = begins_at.into_iter();
        station.antennas.retain_mut(|antenna| {
            let park = antenna.park;
            antenna.park = begins_at.next().flatten().unwrap_or(park);
            // Each antenna has its own random sequence.
            let seed = seed.rotate_left(16) ^ u64::from(antenna.id.0);
            let clock = clock.clone();
            let surroundings = Surroundings { site, clock, elements: &elements, mechanics, seed };
            let unit = makes::unit_in_memory(antenna, &surroundings);
            antenna.park = park;
            let (id, name) = (antenna.id, antenna.name.clone());
            let has_unit = unit.is_some();
            match unit {
                Some(unit) => {
                    units.push(Linked { id, antenna: name, unit, is_down: Arc::default() });
                }
                None => left_out.push(name),
            }
            has_unit
        });
        if units.is_empty() {
            return Err(RehearsalError::NoAntenna);
        }
        Ok((Self(units), left_out))
    }

    /// Returns the outside world of the sessions: only these units.
    pub(super) fn outside(self: &Arc<Self>, clock: &Clock) -> Outside {
        let units = Arc::clone(self);
        let dial = Arc::new(move |antenna: &Antenna, _: Arc<dyn UnitLock>| {
            let linked = units.0.iter().find(|linked| linked.id == antenna.id).cloned();
            let dial: Dial = Box::new(move || {
                let linked = linked.clone().filter(|one| !one.is_down.load(Ordering::Relaxed));
                Box::pin(async move { linked.map(Linked::connected).ok_or_else(refused) })
            });
            dial
        });
        Outside { dial, ..Outside::from(clock.clone()) }
    }

    /// Schedules a fault for its units. `start` is the start of the rehearsal.
    pub(super) fn suffer(
        &self,
        fault: &Fault,
        start: Timestamp,
        clock: &Clock,
    ) -> Result<(), RehearsalError> {
        let name = fault.antenna.as_deref();
        let is_meant = |linked: &&Linked| name.is_none_or(|name| linked.antenna == name);
        let linkeds: Vec<&Linked> = self.0.iter().filter(is_meant).collect();
        if let Some(name) = name.filter(|_| linkeds.is_empty()) {
            return Err(RehearsalError::UnknownAntenna(name.to_owned()));
        }
        let can_all: Vec<&Linked> =
            linkeds.into_iter().filter(|linked| linked.set(fault.kind, false)).collect();
        if can_all.is_empty() {
            let name = name.unwrap_or("any antenna").to_owned();
            return Err(RehearsalError::ImpossibleFault(name));
        }
        let begins = add_seconds(start, fault.after.as_secs_f64());
        for linked in can_all {
            let (linked, fault, clock) = (linked.clone(), fault.clone(), clock.clone());
            tokio::spawn(async move {
                let left_s = seconds_between(clock.utc(), begins);
                clock
                    .sleep(std::time::Duration::try_from_secs_f64(left_s).unwrap_or_default())
                    .await;
                linked.set(fault.kind, true);
                if let Some(lasts) = fault.lasts {
                    clock.sleep(lasts).await;
                    linked.set(fault.kind, false);
                }
            });
        }
        Ok(())
    }
}

impl Linked {
    fn connected(self) -> Box<dyn Stream> {
        let (near, far) = tokio::io::duplex(BUFFER);
        tokio::spawn(self.unit.serve(far));
        Box::new(near)
    }

    /// Begins or ends a fault; returns `false` if the unit cannot have it.
    fn set(&self, kind: FaultKind, is_on: bool) -> bool {
        match kind {
            FaultKind::LinkLost => {
                self.is_down.store(is_on, Ordering::Relaxed);
                if is_on {
                    self.unit.drop_clients();
                }
                true
            }
            FaultKind::PowerCut => {
                self.is_down.store(is_on, Ordering::Relaxed);
                if is_on {
                    self.unit.cut_power();
                }
                true
            }
            FaultKind::OfUnit(trouble) => self.unit.set_trouble(trouble, is_on),
        }
    }
}

fn refused() -> io::Error {
    io::Error::new(io::ErrorKind::ConnectionRefused, "the link is down")
}
