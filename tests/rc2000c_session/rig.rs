//! A session with a simulated RC2000C.

use azel::{
    clock::Instant,
    contract::driver::{Command, Event, Found, Snapshot},
    controller::rc2000c::Calibration,
    device::{
        CountPoint,
        panel::{Act, CheckState},
        settings::Value,
    },
    protocol::rc2000c::Frame,
    sim::rc2000c::{Control, Options},
    station::{Antenna, LockOut, Mount},
};
use jiff::Timestamp;

use crate::common::rig;

pub(super) type Rig = rig::Rig<Control>;

/// Returns an antenna of twenty counts a degree, like the simulated one: azimuth 90 to 270 degrees,
/// elevation 0 to 90.
pub(crate) fn antenna() -> Antenna {
    let point = |counts, degrees| CountPoint { counts, degrees };
    let calibration = Calibration {
        azimuth: vec![point(30, 90.0), point(3630, 270.0)],
        elevation: vec![point(30, 0.0), point(1830, 90.0)],
    };
    Antenna {
        mount: Mount::AzEl {
            azimuth_from_deg: 90.0,
            azimuth_to_deg: 270.0,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        },
        ..with_calibration(calibration)
    }
}

pub(super) fn uncalibrated() -> Antenna {
    with_calibration(Calibration::default())
}

fn with_calibration(calibration: Calibration) -> Antenna {
    let mut antenna = Antenna::rc2000c("Dish", "in memory");
    calibration.put_into(&mut antenna.connection).unwrap();
    antenna
}

impl Rig {
    /// Starts a session without an order to connect.
    pub(super) fn start(options: &Options, antenna: &Antenna) -> Self {
        Self::new(Control::new(options), Timestamp::UNIX_EPOCH, |dial, clock| {
            rig::session(antenna, dial, clock)
        })
    }

    /// Starts a session with a unit that is locked out.
    pub(super) fn start_locked_out(antenna: &Antenna, lock_out: LockOut) -> Self {
        Self::new(Control::new(&Options::default()), Timestamp::UNIX_EPOCH, |dial, clock| {
            let (session, handle) = rig::session(antenna, dial, clock);
            (session.with_lock_out(Some(lock_out)), handle)
        })
    }

    /// Starts a session and waits until it has read its unit and the list of satellites, at
    /// standstill.
    pub(crate) async fn connected(options: &Options, antenna: &Antenna) -> Self {
        let mut rig = Self::start(options, antenna);
        rig.send(Command::Connect);
        let is_read = |shown: &Snapshot| {
            reading(shown, "Stored satellites").is_some_and(|text| !text.ends_with('…'))
        };
        rig.until("the list is read", 20, is_read).await;
        rig.seconds(1.0).await;
        rig.events();
        rig
    }

    /// Starts the default unit and antenna, in Manual.
    pub(super) async fn in_manual() -> Self {
        let mut rig = Self::connected(&Options::default(), &antenna()).await;
        rig.send(Command::Manual);
        rig.seconds(0.1).await;
        rig
    }

    pub(super) fn act<const N: usize>(
        &self,
        action: &'static str,
        values: [(&'static str, Value); N],
    ) {
        self.send(Command::Act(Act { action, values: values.into_iter().collect() }));
    }

    /// Requests an action with the operator's consent that it may lead anywhere.
    pub(super) fn act_unseen<const N: usize>(
        &self,
        action: &'static str,
        values: [(&'static str, Value); N],
    ) {
        self.send(Command::ActUnseen(Act { action, values: values.into_iter().collect() }));
    }

    pub(super) async fn until_found(&mut self) {
        let is_found =
            |event: &Event| matches!(event, Event::Connected(Found::Still) | Event::Back { .. });
        self.until_event(12, is_found).await;
    }

    /// Returns all commands that the unit received, as code and data: `1` asks for the status.
    pub(super) fn received(&self) -> Vec<String> {
        self.timed().into_iter().map(|(_, text)| text).collect()
    }

    /// Returns the commands that the unit received, without questions.
    pub(super) fn orders(&self) -> Vec<String> {
        let is_order = |text: &String| !text.starts_with(['0', '1', '5']);
        self.received().into_iter().filter(is_order).collect()
    }

    /// Returns the times of commands that begin with `start`.
    pub(super) fn times(&self, start: &str) -> Vec<Instant> {
        let timed = self.timed().into_iter();
        timed.filter(|(_, text)| text.starts_with(start)).map(|(at, _)| at).collect()
    }

    fn timed(&self) -> Vec<(Instant, String)> {
        let text = |frame: &Frame| {
            let data = String::from_utf8_lossy(frame.data());
            format!("{}{data}", char::from(frame.code()))
        };
        self.control.received().iter().map(|(at, frame)| (*at, text(frame))).collect()
    }

    /// Returns the true positions of the simulated axes, counts.
    pub(super) fn counts(&self) -> [u16; 2] {
        let state = self.control.state();
        [state.az_counts, state.el_counts]
    }
}

/// Returns the text of a line of the panel.
pub(super) fn reading(shown: &Snapshot, label: &str) -> Option<String> {
    let lines = shown.state.readings.iter();
    lines.filter(|line| line.label == label).map(|line| line.text.clone()).next()
}

/// Returns the state of a check.
pub(super) fn check(shown: &Snapshot, name: &str) -> Option<CheckState> {
    shown.state.checks.iter().find(|check| check.name == name).map(|check| check.state)
}
