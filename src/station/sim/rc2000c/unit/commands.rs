//! Answers to commands, which the unit carries out at once.

use super::Rc2000c;
use crate::protocol::rc2000c::{
    AutoMove, Band, Direction, DriveReset, Frame, Jog, Motion, NameEntry, NameIndex, Polarity,
    PolarizationMove, Query, Reply, Request, Sense, Setting,
};
use crate::sim::rc2000c::satellites::StoredSatellite;
use crate::sim::rc2000c::tracking::Tracking;
use crate::sim::rc2000c::{Fault, Mode, Quirk};

/// Step of the jog timer, milliseconds.
const JOG_STEP_MS: u128 = 150;

/// Error of a command that the unit cannot carry out.
struct CommandRefused;

impl Rc2000c {
    /// Answers a command if it needs an answer. Must be called after `advance`.
    pub(in crate::sim::rc2000c) fn answer(&mut self, frame: &Frame) -> Option<Reply> {
        let code = frame.code();
        let Ok(request) = Request::parse(frame) else {
            let is_silent = self.quirks.contains(&Quirk::SilentRefusal);
            return (!is_silent).then_some(Reply::Refused { code });
        };
        if self.faults.contains(&Fault::RemoteDisabled) {
            return Some(Reply::Offline { code });
        }
        if self.mode == Mode::Manual {
            tracing::info!(target: "azel::sim", "a command takes the panel");
            self.mode = Mode::Remote;
        }
        let outcome = match request {
            Request::Query(Query::DeviceType) => {
                return Some(Reply::DeviceType(self.device_type()));
            }
            Request::Query(Query::Status) => Ok(()),
            Request::Query(Query::SatelliteName(index)) => {
                let entry = self.entry(index).map(Reply::SatelliteName);
                return Some(entry.unwrap_or(Reply::Refused { code }));
            }
            _ if self.faults.contains(&Fault::Refuse) => Err(CommandRefused),
            Request::Stop => {
                self.stop();
                Ok(())
            }
            Request::Motion(motion) => self.start(motion),
            Request::Setting(setting) => self.set(setting),
        };
        Some(match outcome {
            Ok(()) => Reply::Status { command: request.command(), status: self.status() },
            Err(CommandRefused) => Reply::Refused { code },
        })
    }

    fn entry(&self, index: NameIndex) -> Option<NameEntry> {
        let index = index.number();
        let satellite = self.satellites.get(usize::from(index).checked_sub(1)?)?;
        let count = self.satellites.len().try_into().ok()?;
        Some(NameEntry { index, count, name: satellite.name })
    }

    fn stop(&mut self) {
        if self.quirks.contains(&Quirk::StopSparesTracking) && self.tracking.is_some() {
            return;
        }
        self.end_tracking();
        let spares_auto_move = self.quirks.contains(&Quirk::StopSparesAutoMove);
        for axis in [&mut self.azimuth, &mut self.elevation] {
            if !(spares_auto_move && axis.is_auto_moving()) {
                axis.stop();
            }
        }
        if !spares_auto_move {
            self.next_tracking = None;
        }
    }

    fn start(&mut self, motion: Motion) -> Result<(), CommandRefused> {
        match motion {
            Motion::AutoMove(auto_move) => self.auto_move(&auto_move),
            Motion::Jog(jog) => self.jog(jog),
            Motion::Polarization(polarization_move) => self.turn(polarization_move),
            Motion::ResetDrive(DriveReset::Azimuth) => {
                self.azimuth.reset();
                Ok(())
            }
            Motion::ResetDrive(DriveReset::Elevation) => {
                self.elevation.reset();
                Ok(())
            }
            Motion::ResetDrive(DriveReset::Polarization) if self.feed.is_rotating() => Ok(()),
            Motion::ResetDrive(DriveReset::Polarization) => Err(CommandRefused),
            Motion::RestartTracking => {
                self.tracking.as_mut().ok_or(CommandRefused)?.restart();
                Ok(())
            }
        }
    }

    fn auto_move(&mut self, auto_move: &AutoMove) -> Result<(), CommandRefused> {
        if let Some(position) = auto_move.to_polarization() {
            if self.is_auto_polarization || !self.feed.reaches(position.units()) {
                return Err(CommandRefused);
            }
            self.feed.go_to(position.units());
            return Ok(());
        }
        if let Some((az_counts, el_counts)) = auto_move.to_position() {
            return self.go_to(az_counts, el_counts);
        }
        let (name, polarity) = auto_move.to_satellite().ok_or(CommandRefused)?;
        let stored_satellite = self.satellites.iter().find(|satellite| satellite.name == name);
        let satellite = *stored_satellite.ok_or(CommandRefused)?;
        if polarity.is_some() && self.is_auto_polarization {
            return Err(CommandRefused);
        }
        self.go_to(satellite.az_counts, satellite.el_counts)?;
        // The manual does not say which polarization the automatic mode selects.
        let automatic = self.is_auto_polarization.then_some(Polarity::Horizontal);
        if let Some(polarity) = polarity.or(automatic) {
            self.feed.go_to(units_of(&satellite, polarity));
        }
        if satellite.is_inclined && !self.quirks.contains(&Quirk::Rc2000a) {
            let StoredSatellite { az_counts, el_counts, is_dual_band, .. } = satellite;
            self.next_tracking = Some(Tracking::new(az_counts, el_counts, is_dual_band));
        }
        Ok(())
    }

    fn go_to(&mut self, az_counts: u16, el_counts: u16) -> Result<(), CommandRefused> {
        if !self.azimuth.reaches(az_counts) || !self.elevation.reaches(el_counts) {
            return Err(CommandRefused);
        }
        self.end_tracking();
        self.next_tracking = None;
        self.azimuth.auto_move(az_counts);
        self.elevation.auto_move(el_counts);
        Ok(())
    }

    fn jog(&mut self, jog: Jog) -> Result<(), CommandRefused> {
        let (is_azimuth, sense) = match jog.direction() {
            Direction::CounterClockwise => (true, Sense::Negative),
            Direction::Clockwise => (true, Sense::Positive),
            Direction::Down => (false, Sense::Negative),
            Direction::Up => (false, Sense::Positive),
        };
        let spares_tracking = self.quirks.contains(&Quirk::StopSparesTracking);
        if spares_tracking && self.tracking.as_ref().is_some_and(Tracking::is_peaking) {
            return Err(CommandRefused);
        }
        if !spares_tracking {
            self.end_tracking();
        }
        self.next_tracking = None;
        let (axis, other) = if is_azimuth {
            (&mut self.azimuth, &mut self.elevation)
        } else {
            (&mut self.elevation, &mut self.azimuth)
        };
        if axis.limit() == Some(sense) && self.quirks.contains(&Quirk::RefuseAtLimit) {
            return Err(CommandRefused);
        }
        // The unit jogs one axis at a time.
        other.stop();
        let duration_ms = jog.duration().as_millis().next_multiple_of(JOG_STEP_MS);
        axis.jog(sense, jog.speed(), duration_ms as f64 / 1000.0);
        Ok(())
    }

    fn turn(&mut self, polarization_move: PolarizationMove) -> Result<(), CommandRefused> {
        let is_peaking = self.tracking.as_ref().is_some_and(Tracking::is_peaking);
        let sense = match polarization_move {
            _ if self.is_auto_polarization => return Err(CommandRefused),
            PolarizationMove::ToStored(_) if self.satellites.is_empty() => {
                return Err(CommandRefused);
            }
            PolarizationMove::ToStored(polarity) => {
                match &mut self.tracking {
                    Some(tracking) if is_peaking => tracking.waiting = Some(polarity),
                    _ => self.turn_to(polarity),
                }
                return Ok(());
            }
            _ if is_peaking => return Err(CommandRefused),
            PolarizationMove::JogClockwise => Sense::Negative,
            PolarizationMove::JogCounterClockwise => Sense::Positive,
        };
        self.feed.jog(sense);
        Ok(())
    }

    pub(super) fn turn_to(&mut self, polarity: Polarity) {
        if let Some(units) = self.nearest().map(|satellite| units_of(satellite, polarity)) {
            self.feed.go_to(units);
        }
    }

    fn set(&mut self, setting: Setting) -> Result<(), CommandRefused> {
        match setting {
            Setting::AutoPolarization(is_on) => self.is_auto_polarization = is_on,
            Setting::Band(band) => self.set_band(band)?,
        }
        Ok(())
    }

    fn set_band(&mut self, band: Band) -> Result<(), CommandRefused> {
        let tracking = self.tracking.as_mut().filter(|tracking| tracking.is_dual_band);
        tracking.ok_or(CommandRefused)?.band = band;
        Ok(())
    }
}

fn units_of(satellite: &StoredSatellite, polarity: Polarity) -> u16 {
    match polarity {
        Polarity::Horizontal => satellite.horizontal,
        Polarity::Vertical => satellite.vertical,
    }
}
