//! A station file and a unit have one Azel of this machine at a time. Whoever comes second
//! shows the station and drives nothing, until the first has ended.

use std::path::{Path, PathBuf};

use super::{
    Engine, StationClaim,
    alarms::AlarmKind,
    claim::{Claim, Claims, HeldBy, HolderKind, Unclaimed},
};
use crate::station;

impl Engine {
    /// Claims the station file before it is read.
    pub(super) fn take_claims(&mut self, wanted: Option<(PathBuf, HolderKind)>) {
        let Some((folder, kind)) = wanted else { return };
        match Claims::new(folder, kind) {
            Ok(claims) => self.claims = Some(claims),
            Err(error) => {
                // One Azel alone needs no claim, and must not stand still for it.
                tracing::warn!(%error, "other programs cannot be kept off the units");
            }
        }
        if self.settings_path.as_deref().is_some_and(Path::exists) {
            self.claim_station();
        }
    }

    /// Claims the station file; why not, in words.
    pub(super) fn claim_station(&mut self) {
        if matches!(self.station_claim, StationClaim::Ours { .. }) {
            return;
        }
        let (Some(claims), Some(path)) = (&self.claims, &self.settings_path) else { return };
        match claims.station(path) {
            Ok(claim) => {
                #[cfg(unix)]
                if let Err(error) = super::socket::serve(&claims.socket(path), self.client.clone())
                {
                    tracing::warn!(%error, "no socket for other programs");
                }
                self.station_claim = StationClaim::Ours { _claim: claim };
                self.alarms.clear(None, |kind| matches!(kind, AlarmKind::StationElsewhere(_)));
            }
            Err(Unclaimed::Held(by)) => {
                self.alarms.raise(None, AlarmKind::StationElsewhere(by.clone()), self.now);
                self.station_claim = StationClaim::Theirs(by);
            }
            Err(Unclaimed::Io(error)) => {
                tracing::warn!(%error, "the station file is not kept from other programs");
            }
        }
    }

    /// Claims the unit of an antenna: no claim where none is made, or who has it.
    pub(super) fn claim_unit(&self, antenna: &station::Antenna) -> Result<Option<Claim>, HeldBy> {
        if let StationClaim::Theirs(by) = &self.station_claim {
            return Err(by.clone());
        }
        match self.claims.as_ref().map(|claims| claims.unit(antenna)).transpose() {
            Ok(claim) => Ok(claim),
            Err(Unclaimed::Held(by)) => Err(by),
            Err(Unclaimed::Io(error)) => {
                tracing::warn!(%error, "a unit is not kept from other programs");
                Ok(None)
            }
        }
    }

    /// STOP goes to whoever has the station file, too.
    pub(super) fn stop_elsewhere(&self) {
        #[cfg(unix)]
        if let StationClaim::Theirs(_) = &self.station_claim
            && let (Some(claims), Some(path)) = (&self.claims, &self.settings_path)
        {
            let socket = claims.socket(path);
            let stop = move || {
                let ask = super::socket::Ask::Stop { antenna: None };
                if let Err(error) = super::socket::ask(&socket, &ask) {
                    tracing::error!(%error, "STOP did not get to the other Azel");
                }
            };
            let thread = std::thread::Builder::new().name("azel-stop-elsewhere".to_owned());
            if let Err(error) = thread.spawn(stop) {
                tracing::error!(%error, "no thread for STOP to the other Azel");
            }
        }
    }

    /// Takes over what another one has left.
    pub(super) fn watch_claims(&mut self) {
        let is_second = self.now.as_second() != self.claims_looked_at;
        if !is_second {
            return;
        }
        self.claims_looked_at = self.now.as_second();
        if matches!(self.station_claim, StationClaim::Theirs(_)) {
            self.claim_station();
            if matches!(self.station_claim, StationClaim::Ours { .. }) {
                // It may have been changed there.
                self.load_lock_outs();
                self.load_station();
            }
            return;
        }
        for index in 0..self.antennas.len() {
            let Some(antenna) = self.antennas.get(index) else { continue };
            let Some(by) = antenna.shown.held_by.clone() else { continue };
            let config = antenna.shown.config.clone();
            let of = Some(config.id);
            let bounds = crate::plan::Bounds::of(&self.station, &config);
            let opened = self.open_antenna(config, bounds);
            if opened.shown.held_by.is_some() {
                self.alarms.raise(of, AlarmKind::UnitElsewhere(by), self.now);
                continue;
            }
            if let Some(antenna) = self.antennas.get_mut(index) {
                *antenna = opened;
            }
            self.alarms.clear(of, |kind| matches!(kind, AlarmKind::UnitElsewhere(_)));
        }
    }
}
