//! The actions that only an RC2000C has, and their commands.

use super::{
    QueuedRequest, Rc2000c,
    refusal::{AUTOMATIC, is_tracking},
};
use crate::{
    device::{
        ControllerEvent, Device, MotionRequest,
        panel::{Act, Action, Lead},
        settings::{Field, Key, Unfit},
    },
    protocol::rc2000c::{
        AutoMove, Band, DriveReset, Motion as UnitMotion, Polarity, PolarizationMove,
        PolarizationUnits, Request, SatelliteName, Setting,
    },
};

const TO_SATELLITE: &str = "to_satellite";
const TO_COUNTS: &str = "to_counts";
const TO_POLARIZATION: &str = "to_polarization";
const POLARIZATION_CW: &str = "polarization_cw";
const POLARIZATION_CCW: &str = "polarization_ccw";
const POLARITY_H: &str = "polarity_h";
const POLARITY_V: &str = "polarity_v";
const AUTO_POLARIZATION_ON: &str = "auto_polarization_on";
const AUTO_POLARIZATION_OFF: &str = "auto_polarization_off";
const RESET_AZIMUTH: &str = "reset_azimuth";
const RESET_ELEVATION: &str = "reset_elevation";
const RESET_POLARIZATION: &str = "reset_polarization";
const RESTART_TRACK: &str = "restart_track";
const TRACK_C_BAND: &str = "track_c_band";
const TRACK_K_BAND: &str = "track_k_band";
const READ_LIST: &str = "read_list";

const SATELLITE: Key<String> = Key::text("satellite", check_name);
const POLARITY: Key<i64> =
    Key::choice("polarity", &[(0, "As it is"), (1, "Stored H"), (2, "Stored V")]);
const END_TRACK: Key<bool> = Key::flag("end_track");
const AZ_COUNTS: Key<i64> = Key::integer("az_counts", 0, 65_535);
const EL_COUNTS: Key<i64> = Key::integer("el_counts", 0, 65_535);
const UNITS: Key<i64> = Key::integer("units", 0, 1023);

const EVEN_DURING_TRACK: Field = Field::write(END_TRACK, "Even during TRACK")
    .description("While the unit tracks by itself, a move is sent only with this.");

const NAMES_ONLY: &str = "the unit tells the names of its satellites and not their places, so \
                          only the unit knows where it will go";
const OWN_SEARCH: &str = "the unit searches for the signal by itself, so only the unit knows \
                          where it will go";
const NOT_CALIBRATED: &str = "the meaning of these counts is not known, so nobody can tell where \
                              the antenna would point: enter two points or more for azimuth and \
                              elevation in Preferences";
const NOT_NOW: &str = "the unit takes no such command in this phase of TRACK: choose H or V, which \
                       it carries out later, or wait";
const UNHEARD_OF: &str = "where this leads is not known";

/// Actions in the order of the panel.
pub(super) const ACTIONS: &[Action] = &[
    Action {
        fields: &[
            Field::write(SATELLITE, "Satellite")
                .description("As in the list of stored satellites."),
            Field::write(POLARITY, "Polarity"),
            EVEN_DURING_TRACK,
        ],
        ..moving(
            TO_SATELLITE,
            "Go to a stored satellite",
            "The unit goes to the position that it has stored. An inclined orbit leads to TRACK: \
             the unit then moves by itself until it is stopped.",
        )
    },
    Action {
        fields: &[
            Field::write(AZ_COUNTS, "Azimuth").in_unit("counts"),
            Field::write(EL_COUNTS, "Elevation").in_unit("counts"),
            EVEN_DURING_TRACK,
        ],
        ..moving(TO_COUNTS, "Go to counts", "Both axes go to these counts of their sensors.")
    },
    Action {
        fields: &[Field::write(UNITS, "Polarization").description(
            "0 to 661 with a polarotor, 0 to 1023 with a rotating feed; more is further CCW.",
        )],
        ..moving(TO_POLARIZATION, "Turn polarization to", "The polarization alone turns.")
    },
    moving(POLARIZATION_CW, "Polarization CW", "Turns for the time that is set in the unit."),
    moving(POLARIZATION_CCW, "Polarization CCW", "Turns for the time that is set in the unit."),
    moving(POLARITY_H, "Polarity H", "Turns to the H of the stored satellite nearest in azimuth."),
    moving(POLARITY_V, "Polarity V", "Turns to the V of the stored satellite nearest in azimuth."),
    moving(
        AUTO_POLARIZATION_ON,
        "Automatic polarization on",
        "The unit sets the polarization with each satellite, and refuses commands for it.",
    ),
    still(AUTO_POLARIZATION_OFF, "Automatic polarization off", "The polarization stays as it is."),
    resetting(RESET_AZIMUTH, "Reset azimuth drive"),
    resetting(RESET_ELEVATION, "Reset elevation drive"),
    resetting(RESET_POLARIZATION, "Reset polarization drive"),
    Action {
        question: Some("The unit starts to track again and moves by itself. Reset TRACK?"),
        ..moving(RESTART_TRACK, "Reset TRACK", "Clears the error of the track mode.")
    },
    still(
        TRACK_C_BAND,
        "TRACK in C band",
        "For a satellite with both bands, while TRACK is active.",
    ),
    still(
        TRACK_K_BAND,
        "TRACK in K band",
        "For a satellite with both bands, while TRACK is active.",
    ),
    still(READ_LIST, "Read the list", "Reads the names of the stored satellites again."),
];

const fn still(key: &'static str, label: &'static str, subject: &'static str) -> Action {
    Action { key, label, description: subject, fields: &[], moves: false, question: None }
}

const fn moving(key: &'static str, label: &'static str, subject: &'static str) -> Action {
    Action { moves: true, ..still(key, label, subject) }
}

/// Returns the action that clears an alarm. An alarm forbids motion, so the action does not count
/// as motion. Azel sends a stop first to end any pending motion.
const fn resetting(key: &'static str, label: &'static str) -> Action {
    Action {
        question: Some(
            "The drive gets power again. Is the cause of its alarm fixed, and nobody near the \
             antenna?",
        ),
        ..still(key, label, "Stops the axes, then clears the alarm of this drive.")
    }
}

fn check_name(typed: &str) -> Result<(), Unfit> {
    let name = SatelliteName::new(&typed.trim().to_ascii_uppercase());
    name.map(drop).map_err(|error| Unfit::Text(error.to_string()))
}

impl Rc2000c {
    pub(super) fn act_on(&mut self, act: &Act) {
        let origin = MotionRequest::Action(act.action);
        if self.motion_under_way() {
            let reason = "another command is under way".to_owned();
            return self.events.push_back(ControllerEvent::Refused(origin, reason));
        }
        match act.action {
            READ_LIST => self.names = super::SatelliteNames::default(),
            RESET_AZIMUTH => self.reset(DriveReset::Azimuth, origin),
            RESET_ELEVATION => self.reset(DriveReset::Elevation, origin),
            RESET_POLARIZATION => self.reset(DriveReset::Polarization, origin),
            _ => {
                let request = self.request_of(act);
                self.order(origin, request);
            }
        }
    }

    fn reset(&mut self, drive: DriveReset, origin: MotionRequest) {
        let reset = Request::Motion(UnitMotion::ResetDrive(drive));
        let origin = Some(origin);
        self.orders.extend([Request::Stop, reset].map(|request| QueuedRequest { request, origin }));
    }

    fn request_of(&self, act: &Act) -> Result<Request, String> {
        let polarization =
            |polarization_move| Request::Motion(UnitMotion::Polarization(polarization_move));
        let in_track = |request| {
            let tracks = self.status.as_ref().is_some_and(is_tracking);
            if tracks { Ok(request) } else { Err("TRACK is not active".to_owned()) }
        };
        match act.action {
            TO_SATELLITE => self.to_satellite(act).map(auto_move),
            TO_COUNTS => self.to_counts(act).map(auto_move),
            TO_POLARIZATION => {
                let units = integer(act, &UNITS)?;
                let units = PolarizationUnits::new(units).map_err(|error| error.to_string())?;
                Ok(auto_move(AutoMove::polarization(units)))
            }
            POLARIZATION_CW => Ok(polarization(PolarizationMove::JogClockwise)),
            POLARIZATION_CCW => Ok(polarization(PolarizationMove::JogCounterClockwise)),
            POLARITY_H => Ok(polarization(PolarizationMove::ToStored(Polarity::Horizontal))),
            POLARITY_V => Ok(polarization(PolarizationMove::ToStored(Polarity::Vertical))),
            AUTO_POLARIZATION_ON => Ok(Request::Setting(Setting::AutoPolarization(true))),
            AUTO_POLARIZATION_OFF => Ok(Request::Setting(Setting::AutoPolarization(false))),
            RESTART_TRACK => in_track(Request::Motion(UnitMotion::RestartTracking)),
            TRACK_C_BAND => in_track(Request::Setting(Setting::Band(Band::C))),
            TRACK_K_BAND => in_track(Request::Setting(Setting::Band(Band::K))),
            _ => Err("the controller cannot do this".to_owned()),
        }
    }

    /// Returns the reason for which the unit would refuse to turn the polarization now. The unit
    /// accepts H and V in every phase of TRACK.
    pub(super) fn objection_to(&self, origin: &MotionRequest) -> Option<&'static str> {
        let MotionRequest::Action(TO_POLARIZATION | POLARIZATION_CW | POLARIZATION_CCW) = origin
        else {
            return None;
        };
        let status =
            self.status.as_ref().filter(|status| status.allows_polarization() == Some(false))?;
        let is_automatic = status.polarization_mode.is_some_and(|mode| mode.is_automatic);
        Some(if is_automatic { AUTOMATIC } else { NOT_NOW })
    }

    pub(super) fn lead(&self, act: &Act) -> Lead {
        // An action that cannot be sent leads nowhere; Azel reports the reason when it sends the
        // action.
        if self.request_of(act).is_err() {
            return Lead::Nowhere;
        }
        match act.action {
            TO_SATELLITE => Lead::Unseen(NAMES_ONLY),
            RESTART_TRACK => Lead::Unseen(OWN_SEARCH),
            TO_COUNTS => match Self::counts_of(act) {
                Ok(counts) => {
                    self.axes.degrees(counts).map_or(Lead::Unknown(NOT_CALIBRATED), Lead::To)
                }
                Err(_) => Lead::Nowhere,
            },
            TO_POLARIZATION | POLARIZATION_CW | POLARIZATION_CCW | POLARITY_H | POLARITY_V
            | AUTO_POLARIZATION_ON => Lead::Nowhere,
            _ => Lead::Unknown(UNHEARD_OF),
        }
    }

    fn to_satellite(&self, act: &Act) -> Result<AutoMove, String> {
        self.check_track(act)?;
        let typed = SATELLITE.get(&act.values).ok_or("no satellite was named")?;
        if !self.names.is_complete() {
            return Err("the list of stored satellites was not read yet".to_owned());
        }
        let name = self.names.find(&typed);
        let name = name.ok_or_else(|| format!("no satellite {:?} is stored", typed.trim()))?;
        let polarity = match POLARITY.get(&act.values) {
            Some(1) => Some(Polarity::Horizontal),
            Some(2) => Some(Polarity::Vertical),
            _ => None,
        };
        AutoMove::satellite(name, polarity).map_err(|error| error.to_string())
    }

    fn to_counts(&self, act: &Act) -> Result<AutoMove, String> {
        self.check_track(act)?;
        let [az_counts, el_counts] = Self::counts_of(act)?;
        Ok(AutoMove::position(az_counts, el_counts))
    }

    fn counts_of(act: &Act) -> Result<[u16; 2], String> {
        Ok([integer(act, &AZ_COUNTS)?, integer(act, &EL_COUNTS)?])
    }

    /// Refuses a move that would end the unit's own tracking, unless the operator agreed to that.
    fn check_track(&self, act: &Act) -> Result<(), String> {
        let is_told = END_TRACK.get(&act.values) == Some(true);
        if is_told || !self.status.as_ref().is_some_and(is_tracking) {
            Ok(())
        } else {
            Err("TRACK is active on the unit".to_owned())
        }
    }
}

fn auto_move(target: AutoMove) -> Request {
    Request::Motion(UnitMotion::AutoMove(target))
}

fn integer(act: &Act, key: &Key<i64>) -> Result<u16, String> {
    let number = key.get(&act.values).and_then(|number| u16::try_from(number).ok());
    number.ok_or_else(|| format!("{} is missing", key.name))
}
