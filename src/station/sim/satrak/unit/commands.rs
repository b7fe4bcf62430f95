//! Answers to requests, which the unit carries out at once.

use super::Satrak;
use crate::astro::AzEl;
use crate::protocol::satrak::{
    FaultKind, Frame, Goto, Halt, Motion, Request, SatelliteChoice, Setting, TleMode,
};
use crate::sim::satrak::answer::{Answer, ErrorCode};
use crate::sim::satrak::mount::xy_from_azel;
use crate::sim::satrak::tracking::Target;

impl Satrak {
    /// Answers a frame. Must be called after `advance`.
    pub(in crate::sim::satrak) fn answer(&mut self, frame: &Frame) -> Answer {
        let outcome = match Request::parse(frame) {
            Ok(Request::Query(query)) => return self.query(query),
            Ok(Request::Halt(halt)) => {
                self.halt(halt);
                Ok(())
            }
            Ok(Request::Motion(motion)) => self.start(motion),
            Ok(Request::Setting(setting)) => self.set(setting),
            Err(error) => Err(error.into()),
        };
        match outcome {
            Ok(()) => Answer::done(frame.word()),
            Err(code) => Answer::refused(frame.word(), code),
        }
    }

    fn halt(&mut self, halt: Halt) {
        match halt {
            // Tracking stays on: the document does not describe this case, and this is the worse
            // one.
            Halt::Stop => {
                self.mount.stop();
                self.tracking.hold(self.elapsed);
            }
            Halt::TrackOff => {
                self.tracking.disable();
                self.mount.stop();
            }
            Halt::AutoTrackOff => self.tracking.is_auto = false,
        }
    }

    fn start(&mut self, motion: Motion) -> Result<(), ErrorCode> {
        let locks = [FaultKind::InternalLink, FaultKind::Setup];
        if locks.iter().any(|lock| self.injected.contains(lock)) {
            return Err(ErrorCode::Fault);
        }
        match motion {
            Motion::Move(rates) => {
                self.mount.x.run(rates.x_deg_s());
                self.mount.y.run(rates.y_deg_s());
            }
            Motion::Step(step) => {
                self.mount.x.step(step.x_deg());
                self.mount.y.step(step.y_deg());
            }
            Motion::Goto(goto) => self.go_to(goto)?,
            Motion::TrackOn => {
                if !self.tracking.is_ready(self.rtc()) {
                    return Err(ErrorCode::NotReady);
                }
                self.found.remove(&FaultKind::TrackingStopped);
                self.tracking.enable();
                return Ok(());
            }
            Motion::AutoTrackOn => {
                self.tracking.enable_auto();
                return Ok(());
            }
        }
        self.tracking.hold(self.elapsed);
        Ok(())
    }

    fn go_to(&mut self, goto: Goto) -> Result<(), ErrorCode> {
        let now = self.direction();
        let az_deg = goto.az_deg().unwrap_or(now.azimuth_deg());
        let el_deg = goto.el_deg().unwrap_or(now.elevation_deg());
        if el_deg < self.memory.settings.minimum_elevation_deg {
            return Err(ErrorCode::OutOfReach);
        }
        let axes = xy_from_azel(AzEl::from_degrees(az_deg, el_deg), self.north());
        let is_reachable = self.mount.go_to(self.mechanical(axes));
        if is_reachable { Ok(()) } else { Err(ErrorCode::OutOfReach) }
    }

    fn set(&mut self, setting: Setting) -> Result<(), ErrorCode> {
        if self.refuses_settings {
            return Err(ErrorCode::Refused);
        }
        match setting {
            Setting::Time(time) => {
                self.set_clock_error(time.time().duration_since(self.utc()));
                self.is_clock_from_gps = false;
            }
            Setting::StartStopTime(window) => self.tracking.set_window(window),
            Setting::Settings(request) => self.change_settings(*request.change()),
            Setting::AngleSettings(change) => {
                let mechanical = [self.mount.x.angle_deg(), self.mount.y.angle_deg()];
                self.memory.calibrate(change, mechanical);
            }
            Setting::RtcReupdate if !self.is_gps_locked() => return Err(ErrorCode::NotReady),
            Setting::RtcReupdate => self.set_clock_from_gps(),
            Setting::GpsSettings(change) => self.memory.gps = Some(change),
            Setting::Satellite(choice) => self.choose(choice, TleMode::File),
            Setting::SatelliteHttp(source) => {
                self.memory.settings.tle_mode = TleMode::Web;
                if !source.continue_tracking {
                    self.end_tracking();
                }
                self.memory.http = Some(source);
            }
            Setting::SatelliteFtp(source) => {
                if let Some(selection) = source.selection.clone() {
                    let choice = SatelliteChoice {
                        file: selection.file,
                        name: selection.satellite,
                        period: source.period_days,
                        continue_tracking: true,
                    };
                    self.choose(choice, TleMode::Ftp);
                }
                self.memory.settings.tle_mode = TleMode::Ftp;
                self.memory.ftp = Some(source);
            }
            Setting::LoadImage(file) => self.memory.image = Some(file),
            Setting::Reduction(reduction) => {
                self.memory.reduction = Some(reduction);
                let [x, y] = self.memory.drive_scales();
                self.mount.set_drive_scales(x, y);
            }
        }
        Ok(())
    }

    /// Looks up the satellite. A missing satellite becomes a fault, not a refusal: the document has
    /// fields for it.
    fn choose(&mut self, choice: SatelliteChoice, mode: TleMode) {
        if !choice.continue_tracking {
            self.end_tracking();
        }
        let file = self.elements.get(choice.file.as_str());
        let expected = choice.name.as_str();
        let found = file.and_then(|file| file.iter().find(|set| set.name().trim() == expected));
        self.tracking.target = found.and_then(|elements| Target::new(elements).ok());
        let is_satellite_missing = file.is_some() && self.tracking.target.is_none();
        for (kind, is_set) in [
            (FaultKind::TleMissing, file.is_none()),
            (FaultKind::SatelliteMissing, is_satellite_missing),
        ] {
            if is_set {
                self.found.insert(kind);
            } else {
                self.found.remove(&kind);
            }
        }
        self.memory.settings.tle_mode = mode;
        self.memory.satellite = Some(choice);
    }

    fn end_tracking(&mut self) {
        if self.tracking.is_enabled {
            self.tracking.disable();
            self.mount.stop();
        }
    }
}
