//! Unit in memory, behind an interface that hides its make.

use std::{future::Future, pin::Pin, time::Duration};

use tokio::io::DuplexStream;

use super::{Control, Unit};
use crate::astro::PointingModel;

/// Trouble for a unit of any make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trouble {
    /// No reply comes, but the unit carries out commands.
    Silence,
    /// Noise precedes each reply.
    Noise,
    /// The unit refuses the commands that a track needs.
    Refusal,
    /// The drives of the first and the second axis have these shares of their full rate, 0 to 1.
    SlowDrives([f64; 2]),
    /// The unit's own clock is late.
    ClockLate(Duration),
    /// The unit follows its track late, although its clock is right.
    TrackLate(Duration),
    /// The unit has lost GPS, and its own clock gains this many seconds a day.
    ClockDrifts(f64),
    /// Max extra reply delay.
    LateReplies(Duration),
    /// The sensors of the axes have these errors.
    Misreads(Misreading),
}

/// Errors of the sensors of an antenna's axes. The true angles still control the drives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Misreading {
    pub model: PointingModel,
    /// Standard deviation of each angle on the sky, degrees.
    pub noise_deg: f64,
}

/// Simulated unit of any make, without a port.
pub trait InMemory: Send + Sync {
    /// Serves one client until it leaves or is dropped.
    fn serve(&self, stream: DuplexStream) -> Pin<Box<dyn Future<Output = ()> + Send>>;

    /// Closes every connection. The unit continues its activity.
    fn drop_clients(&self);

    /// Cuts the unit's power: its connections close, its drives stop and a track ends. The unit
    /// accepts new connections at once.
    fn cut_power(&self);

    /// Begins or ends a trouble. Returns `false` if this make cannot have it.
    fn set_trouble(&self, trouble: Trouble, is_on: bool) -> bool;
}

impl<U: Unit> InMemory for Control<U>
where
    U::Wire: 'static,
    <U::Wire as super::Wire<U>>::Reply: 'static,
{
    fn serve(&self, stream: DuplexStream) -> Pin<Box<dyn Future<Output = ()> + Send>> {
        let control = self.clone();
        Box::pin(async move {
            let result = Control::serve(&control, stream).await;
            tracing::info!(target: "azel::sim", ?result, "client left");
        })
    }

    fn drop_clients(&self) {
        Control::drop_clients(self);
    }

    fn cut_power(&self) {
        self.with_unit(Unit::cut_power);
        Control::drop_clients(self);
    }

    fn set_trouble(&self, trouble: Trouble, is_on: bool) -> bool {
        match trouble {
            Trouble::Silence => self.set_fault(U::SILENCE, is_on),
            Trouble::Noise => self.set_fault(U::NOISE, is_on),
            Trouble::Refusal => self.set_fault(U::REFUSAL, is_on),
            Trouble::SlowDrives(shares) => {
                let shares = shares.map(|share| if is_on { share.clamp(0.0, 1.0) } else { 1.0 });
                self.with_unit(|unit| unit.set_strength(shares));
            }
            Trouble::ClockLate(late) => {
                let late = if is_on { late } else { Duration::ZERO };
                return self.with_unit(|unit| unit.set_clock_late(late));
            }
            Trouble::TrackLate(late) => {
                let late = if is_on { late } else { Duration::ZERO };
                return self.with_unit(|unit| unit.set_track_late(late));
            }
            Trouble::ClockDrifts(gains_s_day) => {
                let gains_s_day = is_on.then_some(gains_s_day);
                return self.with_unit(|unit| unit.set_clock_drift(gains_s_day));
            }
            Trouble::LateReplies(lateness) => {
                self.set_lateness(if is_on { lateness } else { Duration::ZERO });
            }
            Trouble::Misreads(misreading) => {
                let misreading = if is_on { misreading } else { Misreading::default() };
                return self.with_unit(|unit| unit.set_misreading(misreading));
            }
        }
        true
    }
}
