//! The two clocks of a session.

use std::sync::Arc;

use jiff::Timestamp;
use tokio::time::Instant;

use crate::controller::Moment;

/// Where UTC comes from; the steady clock is tokio's, so that tests can pause it.
#[derive(Clone)]
pub struct Clock(Arc<dyn Fn() -> Timestamp + Send + Sync>);

impl Clock {
    /// The clock of the operating system.
    pub fn system() -> Self {
        Self(Arc::new(Timestamp::now))
    }

    /// A clock of one's own.
    pub fn new(utc: impl Fn() -> Timestamp + Send + Sync + 'static) -> Self {
        Self(Arc::new(utc))
    }

    /// UTC now.
    pub fn utc(&self) -> Timestamp {
        (self.0)()
    }

    /// Both clocks now. Only within a runtime.
    pub fn now(&self) -> Moment {
        Moment { steady: Instant::now().into_std(), utc: self.utc() }
    }
}
