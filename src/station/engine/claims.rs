//! Uses the claims: the second Azel of this machine on a station or unit shows the station
//! and drives nothing until the first has ended.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::{
    Engine, Event, StationClaim,
    alarms::AlarmKind,
    claim::{Claim, Claims, HeldBy, HolderKind, Unclaimed},
};
#[cfg(unix)]
use super::{claim::socket_path, socket::Answer};
use crate::{
    plan::Bounds,
    station::{self, AntennaId},
};

/// Locks that could not be made.
pub(super) struct NoClaims {
    folder: PathBuf,
    kind: HolderKind,
    why: String,
}

impl Engine {
    /// Sets up the claims and claims the station file before it is read.
    pub(super) fn take_claims(&mut self, wanted: Option<(PathBuf, HolderKind)>) {
        let Some((folder, kind)) = wanted else { return };
        #[cfg(unix)]
        let socket = self.settings_path.as_deref().map(|path| socket_path(&folder, path));
        #[cfg(not(unix))]
        let socket = None;
        match Claims::new(folder.clone(), kind, socket.clone()) {
            Ok(claims) => (self.claims, self.socket) = (Some(Ok(claims)), socket),
            Err(error) => {
                let no_claims = NoClaims { folder, kind, why: error.to_string() };
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

    /// Claims the station file, or raises an alarm that says why not.
    pub(super) fn claim_station(&mut self) {
        if matches!(self.station_claim, StationClaim::Ours { .. }) {
            return;
        }
        let (Some(Ok(claims)), Some(path)) = (&self.claims, &self.settings_path) else { return };
        match claims.station(path) {
            Ok(claim) => {
                #[cfg(unix)]
                if let Some(socket) = &self.socket
                    && let Err(error) = super::socket::serve(socket, self.client.clone())
                {
                    let what = "other programs cannot reach this one, also not with STOP";
                    self.tell_unclaimed(what, &error);
                }
                self.station_claim = StationClaim::Ours { _claim: claim };
                self.alarms
                    .clear(None, self.now, |kind| matches!(kind, AlarmKind::StationElsewhere(_)));
            }
            Err(Unclaimed::Held(by)) => {
                self.alarms.raise(None, AlarmKind::StationElsewhere(by.clone()), self.now);
                self.station_claim = StationClaim::Theirs(by);
            }
            Err(Unclaimed::Io(error)) => {
                self.tell_unclaimed("the station file is not kept from other programs", &error);
            }
        }
    }

    fn tell_unclaimed(&mut self, what: &str, error: &io::Error) {
        let text = format!("{what}: {error}");
        let kind = AlarmKind::Settings(text.clone());
        // Each attempt fails for the same reason.
        if self.alarms.list().iter().any(|alarm| alarm.kind == kind && !alarm.is_over()) {
            return;
        }
        tracing::error!("{text}");
        self.alarms.raise(None, kind, self.now);
    }

    /// Claims the unit of an antenna. `None` where no claim is made; an error names the
    /// holder.
    pub(super) fn claim_unit(&self, antenna: &station::Antenna) -> Result<Option<Claim>, HeldBy> {
        if let StationClaim::Theirs(by) = &self.station_claim {
            return Err(by.clone());
        }
        let claims = match &self.claims {
            None => return Ok(None),
            Some(Err(NoClaims { why, .. })) => return Err(HeldBy::Unknown(why.clone())),
            Some(Ok(claims)) => claims,
        };
        match claims.unit(antenna) {
            Ok(claim) => Ok(Some(claim)),
            Err(Unclaimed::Held(by)) => Err(by),
            // Another program may drive the unit as well.
            Err(Unclaimed::Io(error)) => Err(HeldBy::Unknown(error.to_string())),
        }
    }

    /// Sends STOP to the Azels that drive these antennas.
    pub(super) fn stop_elsewhere(&self, antennas: &[AntennaId]) {
        let held = self.antennas.iter().map(|antenna| &antenna.shown);
        for antenna in held.filter(|antenna| antennas.contains(&antenna.id())) {
            let holder = match &antenna.held_by {
                None => continue,
                Some(HeldBy::Azel(holder)) => holder.clone(),
                // Nobody is known who could stop it.
                Some(HeldBy::Unknown(_)) => {
                    self.client.urgent().is_stop_lost = true;
                    continue;
                }
            };
            // The holder's name of the antenna.
            let name = holder.as_ref().and_then(|holder| holder.antenna.clone());
            let name = name.unwrap_or_else(|| antenna.config.name.clone());
            let client = self.client.clone();
            let stop = move || {
                if !stop_there(holder.and_then(|holder| holder.socket).as_deref(), name) {
                    client.urgent().is_stop_lost = true;
                }
            };
            let thread = std::thread::Builder::new().name("azel-stop-elsewhere".to_owned());
            if let Err(error) = thread.spawn(stop) {
                tracing::error!(%error, "no thread for STOP to the other Azel");
                self.client.urgent().is_stop_lost = true;
            }
        }
    }

    /// Takes over the station or units of an Azel that has ended, at most once a second.
    pub(super) fn watch_claims(&mut self) {
        let is_second = self.now.as_second() != self.claims_looked_at;
        if !is_second {
            return;
        }
        self.claims_looked_at = self.now.as_second();
        if let Some(Err(NoClaims { folder, kind, .. })) = &self.claims {
            let wanted = (folder.clone(), *kind);
            self.take_claims(Some(wanted));
        } else if matches!(self.station_claim, StationClaim::None)
            && self.demo.is_none()
            && self.settings_path.as_deref().is_some_and(Path::exists)
        {
            self.claim_station();
        }
        if matches!(self.station_claim, StationClaim::Theirs(_)) {
            self.take_over_station();
            return;
        }
        for index in 0..self.antennas.len() {
            let Some(antenna) = self.antennas.get(index) else { continue };
            if antenna.shown.held_by.is_none() {
                continue;
            }
            let config = antenna.shown.config.clone();
            let of = Some(config.id);
            let claim = match self.claim_unit(&config) {
                Ok(claim) => claim,
                Err(by) => {
                    self.alarms.raise(of, AlarmKind::UnitElsewhere(by.clone()), self.now);
                    if let Some(antenna) = self.antennas.get_mut(index) {
                        antenna.shown.held_by = Some(by);
                    }
                    continue;
                }
            };
            // The previous holder may have locked the unit out.
            self.load_lock_outs();
            let bounds = Bounds::of(&self.station, &config);
            let opened = self.open_claimed(config, bounds, Ok(claim));
            if let Some(antenna) = self.antennas.get_mut(index) {
                *antenna = opened;
            }
            self.alarms.clear(of, self.now, |kind| matches!(kind, AlarmKind::UnitElsewhere(_)));
            self.publish();
        }
    }

    /// Takes over and reloads the station file if its holder has ended, as the holder may
    /// have changed it. Returns `true` if this station holds it now.
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

/// Returns `true` if the Azel behind `socket` stopped its antenna of this name, with proof.
fn stop_there(socket: Option<&Path>, antenna: String) -> bool {
    #[cfg(unix)]
    if let Some(socket) = socket {
        let ask = super::socket::Ask::Stop { antenna: Some(antenna) };
        return match super::socket::ask(socket, &ask) {
            Ok(Answer::Stopped(stopped)) => stopped.iter().all(|stopped| stopped.proved),
            Ok(answer) => {
                tracing::error!(?answer, "STOP was not taken by the other Azel");
                false
            }
            Err(error) => {
                tracing::error!(%error, "STOP did not get to the other Azel");
                false
            }
        };
    }
    let _ = (socket, antenna);
    false
}
