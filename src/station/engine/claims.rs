//! Use of the claims. A second Azel of this machine shows a station or unit, but drives nothing
//! until the first Azel has ended.

use std::{io, path::Path, sync::Arc};

use super::{
    Engine, Hold, StationClaim,
    claim::{Claim, Claims, Elsewhere, LockFolders, Unclaimed, holder_elsewhere, station_lock},
};
#[cfg(unix)]
use super::{
    claim::socket_path,
    stop_elsewhere::{Courier, Press},
};
use crate::{
    contract::{
        Event,
        alarms::AlarmKind,
        claim::{HeldBy, HolderKind},
        driver::Unit,
    },
    engine::alarms::KeepAlarms,
    plan::Bounds,
    station::{self, AntennaId},
};

/// Lock folders that failed, with the reason.
pub(super) struct NoClaims {
    folders: LockFolders,
    kind: HolderKind,
    reason: String,
}

/// Claims of this process, and the courier that sends STOP to processes with other locks.
pub(super) struct ClaimsInUse {
    claims: Arc<Claims>,
    #[cfg(unix)]
    courier: Option<Courier>,
}

/// Returns `holder`, with its previous name if its lock files are gone for a moment.
fn with_name(holder: HeldBy, name_source: Option<&HeldBy>) -> HeldBy {
    match (holder, name_source) {
        (HeldBy::Azel(None), Some(name_source @ HeldBy::Azel(_))) => name_source.clone(),
        (holder, _) => holder,
    }
}

impl Engine {
    /// Sets up the claims, and claims the station file before it is read.
    pub(super) fn take_claims(&mut self, folders_and_kind: Option<(LockFolders, HolderKind)>) {
        let Some((folders, kind)) = folders_and_kind else { return };
        #[cfg(unix)]
        let socket = {
            let path = self.settings_path.as_deref();
            folders.own.first().zip(path).map(|(first, path)| socket_path(&first.path, path))
        };
        #[cfg(not(unix))]
        let socket = None;
        match Claims::new(folders.clone(), kind, socket) {
            Ok(claims) => {
                self.claims = Some(Ok(ClaimsInUse {
                    claims: Arc::new(claims),
                    #[cfg(unix)]
                    courier: Courier::start(folders, self.client.clone())
                        .inspect_err(|error| {
                            tracing::error!(%error, "no thread for STOP to other Azels");
                        })
                        .ok(),
                }));
            }
            Err(error) => {
                let no_claims = NoClaims { folders, kind, reason: error.to_string() };
                let is_news = self.claims.replace(Err(no_claims)).is_none();
                if is_news {
                    self.tell_unclaimed("Azel can lock no unit, so it connects to none; check the disk and the folder of locks", &error);
                }
            }
        }
        if self.settings_path.as_deref().is_some_and(Path::exists) {
            self.claim_station();
        }
    }

    /// Claims the station file, or raises an alarm with the reason why it cannot.
    pub(super) fn claim_station(&mut self) {
        if matches!(self.station_claim, StationClaim::Ours { .. }) {
            return;
        }
        let (Some(Ok(in_use)), Some(path)) = (&self.claims, &self.settings_path) else { return };
        match in_use.claims.station(path) {
            Ok(claim) => {
                #[cfg(unix)]
                let served = in_use.claims.socket().and_then(|(folder, socket)| {
                    let served = super::socket::serve(folder, socket, self.client.clone());
                    let subject = "other programs reach this one by signals only";
                    served.inspect_err(|error| self.tell_unclaimed(subject, error)).ok()
                });
                self.station_claim = StationClaim::Ours {
                    claim,
                    #[cfg(unix)]
                    _served: served,
                };
                self.alarms
                    .clear(None, self.now, |kind| matches!(kind, AlarmKind::StationElsewhere(_)));
            }
            Err(Unclaimed::Held(Elsewhere { holder, .. })) => self.leave_station(holder),
            Err(Unclaimed::Io(error)) => {
                self.tell_unclaimed("the station file is not kept from other programs", &error);
            }
        }
    }

    /// Leaves the station to another process.
    fn leave_station(&mut self, holder: HeldBy) {
        let station_holder = match &self.station_claim {
            StationClaim::Theirs(station_holder) => Some(station_holder),
            StationClaim::None | StationClaim::Ours { .. } => None,
        };
        let holder = with_name(holder, station_holder);
        self.alarms.raise(None, AlarmKind::StationElsewhere(holder.clone()), self.now);
        self.station_claim = StationClaim::Theirs(holder);
    }

    fn tell_unclaimed(&mut self, subject: &str, error: &io::Error) {
        let text = format!("{subject}: {error}");
        let kind = AlarmKind::Settings(text.clone());
        // The same alarm is already active; every attempt would repeat it.
        if self.alarms.list().iter().any(|alarm| alarm.kind == kind && !alarm.is_over()) {
            return;
        }
        tracing::error!("{text}");
        self.alarms.raise(None, kind, self.now);
    }

    /// Claims the unit of an antenna, with `also`, the lock that another process had before.
    /// Returns `None` if claims are switched off; an error names the holder.
    pub(super) fn claim_unit(
        &self,
        antenna: &station::Antenna,
        also: Option<&str>,
    ) -> Result<Option<Claim>, Elsewhere> {
        if let StationClaim::Theirs(holder) = &self.station_claim {
            let lock = self.settings_path.as_deref().map(station_lock);
            return Err(Elsewhere { holder: holder.clone(), lock });
        }
        let unknown = |reason: String| Elsewhere { holder: HeldBy::Unknown(reason), lock: None };
        let claims = match &self.claims {
            None => return Ok(None),
            Some(Err(NoClaims { reason: explanation, .. })) => {
                return Err(unknown(explanation.clone()));
            }
            Some(Ok(in_use)) => &in_use.claims,
        };
        match claims.unit(antenna, also) {
            Ok(claim) => Ok(Some(claim)),
            Err(Unclaimed::Held(elsewhere)) => Err(elsewhere),
            // Without a lock, another program may also drive the unit.
            Err(Unclaimed::Io(error)) => Err(unknown(error.to_string())),
        }
    }

    /// Sends STOP to the Azels that drive these antennas.
    pub(super) fn stop_elsewhere(&mut self, antennas: &[AntennaId]) {
        for antenna in &self.antennas {
            let Hold::Elsewhere(lock) = &antenna.hold else { continue };
            if !antennas.contains(&antenna.shown.id()) {
                continue;
            }
            #[cfg(unix)]
            if let (Some(lock), Some(Ok(ClaimsInUse { courier: Some(courier), .. }))) =
                (lock, &mut self.claims)
            {
                let antenna = &antenna.shown;
                let press = Press { lock: lock.clone(), antenna: antenna.config.name.clone() };
                courier.press(antenna.id(), press);
                continue;
            }
            // No other process is known that could stop the unit.
            let _ = lock;
            self.client.urgent().is_stop_lost = true;
        }
    }

    /// Takes over the station or units of an Azel that has ended, at most once a second.
    pub(super) fn watch_claims(&mut self) {
        let is_second = self.now.as_second() != self.claims_looked_at;
        if !is_second {
            return;
        }
        self.claims_looked_at = self.now.as_second();
        if let Some(Err(NoClaims { folders, kind, .. })) = &self.claims {
            let request = (folders.clone(), *kind);
            self.take_claims(Some(request));
        } else if matches!(self.station_claim, StationClaim::None)
            && self.demo.is_none()
            && self.settings_path.as_deref().is_some_and(Path::exists)
        {
            self.claim_station();
        }
        if let Some(Ok(in_use)) = &self.claims {
            in_use.claims.renew();
        }
        if let StationClaim::Ours { claim, .. } = &self.station_claim
            && let Some(Elsewhere { holder, .. }) = holder_elsewhere(claim)
        {
            self.leave_station(holder);
            for index in 0..self.antennas.len() {
                self.leave_unit(index, None);
            }
        }
        if matches!(self.station_claim, StationClaim::Theirs(_)) {
            self.take_over_station();
            return;
        }
        self.settle_left_units();
        for index in 0..self.antennas.len() {
            match self.antennas.get(index).map(|antenna| &antenna.hold) {
                None | Some(Hold::Ours(None)) => {}
                Some(Hold::Ours(Some(claim))) => {
                    if let Some(elsewhere) = claim.elsewhere() {
                        self.leave_unit(index, Some(elsewhere));
                    }
                }
                Some(Hold::Elsewhere(_)) => self.try_unit(index),
            }
        }
    }

    /// Opens an antenna if the process that held its unit has ended.
    fn try_unit(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let Hold::Elsewhere(lock) = &antenna.hold else { return };
        let (config, lock) = (Arc::clone(&antenna.shown.config), lock.clone());
        let antenna_id = Some(config.id);
        match self.claim_unit(&config, lock.as_deref()) {
            Ok(claim) => {
                // The previous holder may have locked the unit out.
                self.load_lock_outs();
                self.reopen(index, Ok(claim));
                self.alarms.clear(antenna_id, self.now, |kind| {
                    matches!(kind, AlarmKind::UnitElsewhere(_))
                });
            }
            Err(Elsewhere { holder: lock_holder, lock }) => {
                let antenna = self.antennas.get(index);
                let holder = with_name(
                    lock_holder,
                    antenna.and_then(|antenna| antenna.shown.held_by.as_ref()),
                );
                self.alarms.raise(antenna_id, AlarmKind::UnitElsewhere(holder.clone()), self.now);
                if let Some(antenna) = self.antennas.get_mut(index) {
                    antenna.shown.held_by = Some(holder);
                    antenna.hold = Hold::Elsewhere(lock);
                }
            }
        }
    }

    /// Leaves a unit to the process that has one of its locks, or that has the station. That
    /// process also handles an owed STOP.
    fn leave_unit(&mut self, index: usize, elsewhere: Option<Elsewhere>) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let config = Arc::clone(&antenna.shown.config);
        let owes_stop = self.driver.debts().owes(&Unit::new(&config));
        let claim = match elsewhere {
            Some(elsewhere) => {
                let kind = AlarmKind::UnitElsewhere(elsewhere.holder.clone());
                self.alarms.raise(Some(config.id), kind, self.now);
                Err(elsewhere)
            }
            None => self.claim_unit(&config, None),
        };
        self.reopen(index, claim);
        if owes_stop {
            self.stop_elsewhere(&[config.id]);
        }
    }

    /// Replaces the session of an antenna, or opens one if it has none.
    fn reopen(&mut self, index: usize, claim: Result<Option<Claim>, Elsewhere>) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let config = Arc::clone(&antenna.shown.config);
        let bounds = Bounds::new(&self.station, &config);
        self.note_learned_drives();
        let opened = self.open_claimed(config, bounds, claim);
        self.cancel_resumption(index);
        if let Some(antenna) = self.antennas.get_mut(index) {
            *antenna = opened;
        }
        self.note_reopened(index);
        // From here on, STOP goes to the new session.
        self.publish();
    }

    /// Takes over the station file if its holder has ended, and reloads the file, which the holder
    /// may have changed. Returns `true` if this station now holds it.
    pub(super) fn take_over_station(&mut self) -> bool {
        self.claim_station();
        if !matches!(self.station_claim, StationClaim::Ours { .. }) {
            return false;
        }
        self.settings_unread = false;
        self.load_lock_outs();
        self.take_over_last_run();
        self.load_station();
        self.tell(Event::Changed);
        true
    }
}
