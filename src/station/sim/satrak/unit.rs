//! Simulated unit: its memory and activity. It has no I/O and no clock: the caller passes the time
//! since the start.

mod commands;
mod memory;
mod queries;

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::time::Duration;

use jiff::{SignedDuration, Timestamp};

use self::memory::Memory;
use super::mount::{Mount, azel_from_xy, xy_from_azel};
use super::tracking::Tracking;
use super::{Fault, Options, Quirk};
use crate::astro::{Angle, AzEl, Site};
use crate::orbit::Elements;
use crate::protocol::satrak::{Decoder, FaultKind, Settings, SettingsChange};
use crate::sim::harness::{self, Misreading, Switches};
use crate::sim::prng::Prng;

/// Time between two steps of mount and tracking.
const STEP: Duration = Duration::from_millis(50);
/// Max elapsed time that the unit simulates; it skips a longer rest.
const LONGEST_CATCH_UP: Duration = Duration::from_mins(10);

/// Delays of [`Fault::LateSettings`] for the azimuth offset, and for all other settings.
const AZIMUTH_LATE: Duration = Duration::from_secs(5);
const REST_LATE: Duration = Duration::from_secs(40);

/// State of the unit as reported and in truth, for tests and displays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snapshot {
    /// X angle as reported, degrees.
    pub x_deg: f64,
    /// Y angle as reported, degrees.
    pub y_deg: f64,
    /// True angles of both axes, reported or not, degrees.
    pub metal_deg: [f64; 2],
    /// Azimuth, degrees, 0 to 360.
    pub az_deg: f64,
    /// Elevation, degrees.
    pub el_deg: f64,
    pub is_tracking: bool,
    /// `true` if the unit starts tracking on its own.
    pub is_auto: bool,
    pub is_moving: bool,
}

/// State of a simulated unit.
#[derive(Debug)]
pub struct Satrak {
    site: Site,
    lower_axis: Angle,
    elements: BTreeMap<String, Vec<Elements>>,
    pub(super) element_folder: Option<PathBuf>,
    outdated_after: SignedDuration,
    utc_origin: Timestamp,
    gps_lock_after: Duration,
    /// Time since the start of the unit.
    elapsed: Duration,
    /// Clock of the unit minus the time from GPS.
    clock_error: SignedDuration,
    /// Seconds a day that the unit's clock gains without GPS, and the start of the drift.
    drift: Option<(f64, Duration)>,
    /// Delay of the time from GPS behind UTC.
    late: Duration,
    /// Delay of the drives behind a track.
    track_late: Duration,
    misreading: Misreading,
    noise: Prng,
    is_clock_from_gps: bool,
    had_gps_lock: bool,
    mount: Mount,
    tracking: Tracking,
    memory: Memory,
    injected: BTreeSet<FaultKind>,
    refuses_settings: bool,
    applies_late: bool,
    /// Pending changes, with their times since the start of the unit.
    late_changes: Vec<(Duration, SettingsChange)>,
    has_frozen_angles: bool,
    rests_falsely: bool,
    /// Faults that the unit itself has detected.
    found: BTreeSet<FaultKind>,
    /// Last readings, which a dead sensor repeats.
    last_xy_deg: [f64; 2],
}

impl Satrak {
    pub(super) fn new(options: &Options) -> Self {
        let clock_error = if options.clock_is_unset {
            // The clock starts at 2000-01-01, as in the document's example.
            Timestamp::from_second(946_684_800)
                .map_or(SignedDuration::ZERO, |unset| unset.duration_since(options.utc_origin))
        } else {
            SignedDuration::ZERO
        };
        let mut unit = Self {
            site: options.site,
            lower_axis: options.lower_axis,
            elements: options.elements.clone(),
            element_folder: options.element_folder.clone(),
            outdated_after: options.outdated_after,
            utc_origin: options.utc_origin,
            gps_lock_after: options.gps_lock_after,
            elapsed: Duration::ZERO,
            clock_error,
            is_clock_from_gps: false,
            had_gps_lock: false,
            mount: Mount::new(
                options.ends_deg,
                options.full_rate_deg_s,
                &options.mechanics,
                options.seed,
            ),
            tracking: Tracking::default(),
            memory: Memory::default(),
            drift: None,
            late: Duration::ZERO,
            track_late: Duration::ZERO,
            misreading: Misreading::default(),
            noise: Prng::new(1),
            injected: BTreeSet::new(),
            refuses_settings: false,
            applies_late: false,
            late_changes: Vec::new(),
            has_frozen_angles: false,
            rests_falsely: false,
            found: BTreeSet::new(),
            last_xy_deg: [0.0; 2],
        };
        unit.memory.settings.minimum_elevation_deg = options.minimum_elevation_deg;
        unit.last_xy_deg = unit.measured_xy_deg();
        unit
    }

    /// Adds `files` to the element files, and replaces files of the same name.
    pub(super) fn take_files(&mut self, files: BTreeMap<String, Vec<Elements>>) {
        self.elements.extend(files);
    }

    fn step(&mut self, step_s: f64) {
        let is_gps_locked = self.is_gps_locked();
        if is_gps_locked && !self.had_gps_lock && self.memory.settings.rtc_from_gps {
            self.set_clock_from_gps();
        }
        self.had_gps_lock = is_gps_locked;
        let elapsed = self.elapsed;
        for (_, change) in self.late_changes.extract_if(.., |(due, _)| *due <= elapsed) {
            self.memory.settings = self.memory.settings.after(&change);
        }
        let rtc = self.rtc();
        let settings = self.memory.settings;
        if self.tracking.update(rtc, settings.lead_ms) {
            self.mount.stop();
        }
        let track_late_ms = i64::try_from(self.track_late.as_millis()).unwrap_or(i64::MAX);
        let time_offset_ms = settings.time_offset_ms.saturating_sub(track_late_ms);
        let followed = Settings { time_offset_ms, ..settings };
        match self.tracking.aim(self.own_site(), rtc, &followed, self.elapsed) {
            Some(Ok(direction)) => {
                let target = self.mechanical(xy_from_azel(direction, self.north()));
                self.mount.follow(target, step_s);
            }
            Some(Err(_)) => {
                self.tracking.disable();
                self.mount.stop();
                self.found.insert(FaultKind::TrackingStopped);
            }
            None => {}
        }
        self.mount.advance(step_s);
        let [x_deg, y_deg] = self.misread_xy_deg(self.measured_xy_deg());
        let [x_error_deg, y_error_deg] = self.mount.errors_deg();
        let measured = [x_deg + x_error_deg, y_deg + y_error_deg];
        for ((last, now), sensor) in
            self.last_xy_deg.iter_mut().zip(measured).zip([FaultKind::XSensor, FaultKind::YSensor])
        {
            if !self.injected.contains(&sensor) && !self.has_frozen_angles {
                *last = now;
            }
        }
    }

    fn change_settings(&mut self, change: SettingsChange) {
        if !self.applies_late {
            self.memory.settings = self.memory.settings.after(&change);
            return;
        }
        let azimuth =
            SettingsChange { az_offset_deg: change.az_offset_deg, ..SettingsChange::default() };
        let rest = SettingsChange { az_offset_deg: None, ..change };
        for (late, change) in [(AZIMUTH_LATE, azimuth), (REST_LATE, rest)] {
            self.late_changes.push((self.elapsed + late, change));
        }
    }

    fn utc(&self) -> Timestamp {
        let elapsed = SignedDuration::try_from(self.elapsed).unwrap_or(SignedDuration::ZERO);
        self.utc_origin.checked_add(elapsed).unwrap_or(self.utc_origin)
    }

    /// Returns UTC by the unit's clock.
    fn rtc(&self) -> Timestamp {
        let utc = self.utc();
        let by_gps = utc.checked_sub(self.late).unwrap_or(utc);
        by_gps.checked_add(self.clock_error + self.drifted()).unwrap_or(by_gps)
    }

    /// Returns the time that the unit's clock has gained since it was set.
    fn drifted(&self) -> SignedDuration {
        let Some((gains_s_day, elapsed)) = self.drift else { return SignedDuration::ZERO };
        let days = self.elapsed.saturating_sub(elapsed).as_secs_f64() / 86_400.0;
        SignedDuration::try_from_secs_f64(gains_s_day * days).unwrap_or(SignedDuration::ZERO)
    }

    /// Sets the unit's clock ahead of the GPS time by `clock_error`.
    fn set_clock_error(&mut self, clock_error: SignedDuration) {
        self.clock_error = clock_error;
        self.drift = self.drift.map(|(gains_s_day, _)| (gains_s_day, self.elapsed));
    }

    fn is_gps_locked(&self) -> bool {
        self.elapsed >= self.gps_lock_after
            && self.drift.is_none()
            && !self.injected.contains(&FaultKind::GpsLink)
    }

    fn set_clock_from_gps(&mut self) {
        self.set_clock_error(SignedDuration::ZERO);
        self.is_clock_from_gps = true;
    }

    /// Returns the site that the unit uses.
    fn own_site(&self) -> Site {
        let by_hand = self.memory.gps.filter(|gps| !gps.automatic).map(|gps| gps.position);
        by_hand.map_or(self.site, |place| {
            Site::new(place.latitude_deg(), place.longitude_deg(), self.site.altitude_m())
                .unwrap_or(self.site)
        })
    }

    /// Returns the azimuth of the lower axis by the unit's settings.
    fn north(&self) -> Angle {
        self.lower_axis + Angle::from_degrees(self.memory.settings.north_offset_deg)
    }

    /// Returns the mechanical angles for measured ones, degrees.
    fn mechanical(&self, [x_deg, y_deg]: [f64; 2]) -> [f64; 2] {
        let [x_shift, y_shift] = self.memory.shifts_deg();
        [x_deg - x_shift, y_deg - y_shift]
    }

    fn measured_xy_deg(&self) -> [f64; 2] {
        let [x_shift, y_shift] = self.memory.shifts_deg();
        [self.mount.x.angle_deg() + x_shift, self.mount.y.angle_deg() + y_shift]
    }

    /// Returns the angles that the sensors read at these true angles.
    fn misread_xy_deg(&mut self, xy_deg: [f64; 2]) -> [f64; 2] {
        let Misreading { model, noise_deg } = self.misreading;
        if self.misreading == Misreading::default() {
            return xy_deg;
        }
        let true_direction = azel_from_xy(xy_deg, self.north());
        let AzEl { azimuth, elevation } = model.reading(true_direction).unwrap_or(true_direction);
        let [across_deg, up_deg] = [(), ()].map(|()| self.noise.normal() * noise_deg);
        let turned_deg = across_deg / elevation.radians().cos().max(0.02);
        let read = AzEl {
            azimuth: azimuth + Angle::from_degrees(turned_deg),
            elevation: elevation + Angle::from_degrees(up_deg),
        };
        xy_from_azel(read, self.north())
    }

    /// Returns the measured direction.
    fn direction(&self) -> AzEl {
        azel_from_xy(self.last_xy_deg, self.north())
    }

    /// Returns `true` if the unit reports this fault.
    fn has_fault(&self, kind: FaultKind) -> bool {
        let is_outdated = || {
            let age =
                self.tracking.target.as_ref().map(|target| self.rtc().duration_since(target.epoch));
            age.is_some_and(|age| age > self.outdated_after)
        };
        self.injected.contains(&kind)
            || self.found.contains(&kind)
            || kind == FaultKind::TleOutdated && is_outdated()
    }
}

impl harness::Unit for Satrak {
    type Quirk = Quirk;
    type Fault = Fault;
    type Request = String;
    type Snapshot = Snapshot;
    type Place = [f64; 2];
    type Wire = Decoder;

    const SILENCE: Fault = Fault::Silence;
    const NOISE: Fault = Fault::Garbage;
    const REFUSAL: Fault = Fault::RefuseSettings;
    const SPLIT: Fault = Fault::Split;
    const MERGE: Fault = Fault::Merge;

    fn advance(&mut self, elapsed: Duration) {
        let catch_up_from = elapsed.saturating_sub(LONGEST_CATCH_UP);
        self.elapsed = self.elapsed.max(catch_up_from);
        while self.elapsed < elapsed {
            let step = STEP.min(elapsed.saturating_sub(self.elapsed));
            self.elapsed += step;
            self.step(step.as_secs_f64());
        }
    }

    fn set_switches(&mut self, switches: &Switches<Quirk, Fault>) {
        let Switches { faults, quirks, .. } = switches;
        self.tracking.restarts = quirks.contains(&Quirk::AutoTrackRestarts);
        self.injected = faults
            .iter()
            .filter_map(|fault| if let Fault::Unit(kind) = fault { Some(*kind) } else { None })
            .collect();
        self.refuses_settings = faults.contains(&Fault::RefuseSettings);
        self.applies_late = faults.contains(&Fault::LateSettings);
        if !self.applies_late {
            self.late_changes.clear();
        }
        self.has_frozen_angles = faults.contains(&Fault::FrozenAngles);
        self.rests_falsely = faults.contains(&Fault::FalseRest);
        let has = |kind| self.injected.contains(&kind);
        self.mount.set_dead_motors(has(FaultKind::XMotor), has(FaultKind::YMotor));
    }

    fn set_strength(&mut self, shares: [f64; 2]) {
        self.mount.set_strength(shares);
    }

    fn set_clock_late(&mut self, late: Duration) -> bool {
        self.late = late;
        true
    }

    fn set_track_late(&mut self, late: Duration) -> bool {
        self.track_late = late;
        true
    }

    fn set_clock_drift(&mut self, gains_s_day: Option<f64>) -> bool {
        self.clock_error += self.drifted();
        self.drift = gains_s_day.map(|gains_s_day| (gains_s_day, self.elapsed));
        self.is_clock_from_gps &= gains_s_day.is_none();
        true
    }

    fn cut_power(&mut self) {
        self.tracking.forget();
        self.mount.stop();
        self.late_changes.clear();
    }

    fn set_misreading(&mut self, misreading: Misreading) -> bool {
        self.misreading = misreading;
        true
    }

    fn place(&mut self, axes_deg: [f64; 2]) {
        self.mount.place(axes_deg);
        self.last_xy_deg = self.measured_xy_deg();
    }

    fn snapshot(&self) -> Snapshot {
        let direction = self.direction();
        let [x_deg, y_deg] = self.last_xy_deg;
        Snapshot {
            x_deg,
            y_deg,
            metal_deg: [self.mount.x.angle_deg(), self.mount.y.angle_deg()],
            az_deg: direction.azimuth_deg(),
            el_deg: direction.elevation_deg(),
            is_tracking: self.tracking.is_enabled,
            is_auto: self.tracking.is_auto,
            is_moving: self.mount.is_moving(),
        }
    }

    fn wire(&self) -> Decoder {
        Decoder::new()
    }
}
