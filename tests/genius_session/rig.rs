//! A session with a simulated Rotator Genius.

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{Command, Snapshot, StopState},
    controller::rotator_genius::{ROTATORS, Rotators},
    protocol::rotator_genius::WholeDegrees,
    sim::rotator_genius::{Control, Options, RotatorOptions, RotatorState},
    station::Antenna,
};
use jiff::Timestamp;

use crate::common::rig;

/// Returns an antenna whose unit has these rotators.
pub(crate) fn antenna(rotators: Rotators) -> Antenna {
    let mut antenna = Antenna::genius("Mast", "in memory");
    antenna.connection.put(&ROTATORS, rotators).unwrap();
    antenna
}

/// Returns options of an azimuth rotator at 173 degrees and an elevation rotator at the horizon.
pub(crate) fn pair() -> Options {
    Options {
        rotators: [RotatorOptions::default(), RotatorOptions::elevation()],
        ..Options::default()
    }
}

/// Returns options of an azimuth rotator with this name and position.
pub(super) fn azimuth(name: &str, position: u16) -> RotatorOptions {
    RotatorOptions {
        name: name.to_owned(),
        position: WholeDegrees::new(position).unwrap(),
        ..RotatorOptions::default()
    }
}

/// Returns a command to go to a position; `None` keeps an angle.
pub(super) fn to(azimuth_deg: Option<f64>, elevation_deg: Option<f64>) -> Command {
    Command::Position {
        azimuth: azimuth_deg.map(Angle::from_degrees),
        elevation: elevation_deg.map(Angle::from_degrees),
    }
}

pub(super) fn is_stopping(stop: StopState) -> bool {
    matches!(stop, StopState::Stopping { .. })
}

pub(crate) type Rig = rig::Rig<Control>;

impl Rig {
    /// Starts a session that is not connected yet.
    pub(super) fn start(options: &Options, antenna: &Antenna) -> Self {
        Self::new(Control::new(options), Timestamp::UNIX_EPOCH, |dial, clock| {
            rig::session(antenna, dial, clock)
        })
    }

    /// Starts a session and waits until it has read its unit.
    pub(crate) async fn connected(options: &Options, rotators: Rotators) -> Self {
        let mut rig = Self::start(options, &antenna(rotators));
        rig.until("it is read", 5, |shown| shown.state.measured.is_some()).await;
        rig.seconds(0.1).await;
        rig.events();
        rig
    }

    /// Starts a session with the default pair of rotators.
    pub(super) async fn pair() -> Self {
        Self::connected(&pair(), Rotators::Pair).await
    }

    pub(super) async fn until_still(&mut self, limit_s: u64) {
        let stands = |shown: &Snapshot| shown.state.measured.is_some_and(|it| !it.moving());
        self.until("it stands", limit_s, stands).await;
    }

    /// Returns the shown angles of the two axes, degrees.
    pub(super) fn axes_deg(&self) -> [Option<f64>; 2] {
        self.shown().state.measured.unwrap().axes.map(|axis| axis.angle_deg)
    }

    /// Returns the text of a shown reading.
    pub(super) fn reading(&self, label: &str) -> String {
        let shown = self.shown();
        let reading = shown.state.readings.iter().find(|reading| reading.label == label);
        reading.map_or_else(String::new, |reading| reading.text.clone())
    }

    /// Returns the true state of rotator 1 or 2.
    pub(super) fn rotator(&self, number: usize) -> RotatorState {
        self.control.state().rotators[number - 1]
    }

    /// Returns the commands that the unit received, without questions. A STOP repeated until its
    /// proof counts once.
    pub(super) fn orders(&self) -> Vec<String> {
        let mut orders = self.commands();
        orders.retain(|command| command != "|h");
        orders.dedup_by(|a, b| a == b && a == "|S");
        orders
    }

    /// Returns all commands that the unit received, questions included.
    pub(super) fn commands(&self) -> Vec<String> {
        self.control.received().into_iter().map(|(_, command)| command).collect()
    }

    /// Returns the times at which the unit received this command.
    pub(super) fn times(&self, command: &str) -> Vec<Instant> {
        let received = self.control.received().into_iter();
        received.filter(|(_, other)| other == command).map(|(at, _)| at).collect()
    }
}
