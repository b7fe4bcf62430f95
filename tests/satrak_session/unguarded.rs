//! Jogs over a link that no dead-man can write to.

use std::{
    io,
    pin::Pin,
    task::{Context, Poll},
};

use azel::{
    contract::driver::{Command, Event, Refusal},
    driver::Stream,
    sim::satrak::Control,
};
use tokio::io::{AsyncRead, AsyncWrite, DuplexStream, ReadBuf};

use super::rig::{Rig, antenna, options};

/// A link without a second handle, like a serial port.
struct Single(DuplexStream);

impl Stream for Single {
    fn duplicate(&self) -> io::Result<Option<std::os::fd::OwnedFd>> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

impl AsyncRead for Single {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.0).poll_read(context, buffer)
    }
}

impl AsyncWrite for Single {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.0).poll_write(context, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.0).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.0).poll_shutdown(context)
    }
}

fn link(control: &Control) -> Box<dyn Stream> {
    let (near, far) = tokio::io::duplex(4096);
    let control = control.clone();
    tokio::spawn(async move { control.serve(far).await });
    Box::new(Single(near))
}

#[tokio::test(start_paused = true)]
async fn without_a_dead_man_a_jog_is_refused_and_allowed_for_a_minute_by_the_operators_word() {
    let options = options();
    let control = Control::new(&options);
    let mut rig = Rig::start_over(control, options.utc_origin, &antenna(), None, link);
    rig.until("all is read", 5, |shown| shown.state.on_board.offsets.is_some()).await;
    rig.send(Command::Manual);
    rig.events();
    let refused = Event::NotSent(Refusal::Unguarded);
    rig.hold([1.0, 0.0], 1.0).await;
    rig.send(Command::EndJog);
    assert_eq!(rig.events(), std::slice::from_ref(&refused));
    assert!(rig.shown().unguarded);
    assert_eq!(rig.sent("MOVE="), [""; 0]);

    rig.send(Command::AllowUnguarded);
    rig.hold([1.0, 0.0], 1.0).await;
    assert!(rig.control.state().is_moving);
    rig.send(Command::EndJog);
    rig.seconds(4.0).await;
    assert!(!rig.control.state().is_moving);
    assert_eq!(rig.events(), []);

    rig.seconds(60.0).await;
    let moves = rig.sent("MOVE=").len();
    rig.hold([1.0, 0.0], 1.0).await;
    assert_eq!(rig.events(), [refused], "the minute is over");
    assert_eq!(rig.sent("MOVE=").len(), moves);
}
