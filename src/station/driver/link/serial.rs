//! Links over a serial port of this computer.

use std::{io, sync::Arc};

use serial2_tokio::{CharSize, FlowControl, SerialPort, Settings, StopBits};

use super::{Dial, Duplicate, Endpoint, Stream, UnitLock, endpoint::device, parity::WithParity};
use crate::protocol::Parity;

impl Stream for SerialPort {
    /// Returns no handle, because the library offers none. The only make on a serial line ends its
    /// jogs without Azel.
    fn duplicate(&self) -> io::Result<Option<Duplicate>> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

/// Returns a dialler for the serial port `name` at `baud` bits a second, with seven bits and even
/// parity. The dialler locks the device first.
pub(super) fn dial_serial(name: &str, baud: u32, lock: Arc<dyn UnitLock>) -> Dial {
    let name: Arc<str> = name.trim().into();
    Box::new(move || {
        let (name, lock) = (Arc::clone(&name), Arc::clone(&lock));
        Box::pin(async move {
            // Some drivers wait for their hardware while they open it.
            let open = move || open_locked(&name, baud, lock.as_ref());
            let opened = tokio::task::spawn_blocking(open).await;
            let (port, parity) = opened.map_err(io::Error::other)?.map_err(plain_error)?;
            Ok(Box::new(WithParity::new(port, parity, Arc::default())) as Box<dyn Stream>)
        })
    })
}

fn open_locked(name: &str, baud: u32, lock: &dyn UnitLock) -> io::Result<(SerialPort, Parity)> {
    let locked = device(name)?;
    lock.lock(&[Endpoint::Port(locked.clone())])?;
    let opened = open(name, baud)?;
    // A changed plug may have connected another device.
    if device(name)? != locked {
        return Err(io::Error::other("the serial port was replaced while it was opened"));
    }
    Ok(opened)
}

/// Opens a port. If the port has no parity, such as a pseudo-terminal, opens it with eight bits;
/// Azel then adds the parity.
fn open(name: &str, baud: u32) -> io::Result<(SerialPort, Parity)> {
    let mut port = SerialPort::open(name, |settings| set_raw(settings, baud))?;
    let mut settings = port.get_configuration()?;
    settings.set_char_size(CharSize::Bits7);
    settings.set_parity(serial2_tokio::Parity::Even);
    let parity = if port.set_configuration(&settings).is_ok() {
        Parity::Port
    } else {
        port.set_configuration(&set_raw(settings, baud)?)?;
        Parity::Software
    };
    // Earlier bytes belong to no query. If a port cannot discard them, the frame parser rejects
    // these bytes.
    port.discard_buffers().ok();
    Ok((port, parity))
}

/// Sets eight bits, no parity and unchanged bytes.
fn set_raw(mut settings: Settings, baud: u32) -> io::Result<Settings> {
    settings.set_raw();
    settings.set_baud_rate(baud)?;
    settings.set_char_size(CharSize::Bits8);
    settings.set_parity(serial2_tokio::Parity::None);
    settings.set_stop_bits(StopBits::One);
    settings.set_flow_control(FlowControl::None);
    Ok(settings)
}

/// Returns a plain error text if the system's text does not help.
fn plain_error(error: io::Error) -> io::Error {
    let words = match error.kind() {
        io::ErrorKind::NotFound => "no such serial port",
        io::ErrorKind::PermissionDenied => {
            "no permission to use the serial port: on Linux, add the user to the dialout group"
        }
        io::ErrorKind::ResourceBusy => "another program uses the serial port",
        io::ErrorKind::IsADirectory => "this is a folder, not a serial port",
        _ => return error,
    };
    io::Error::new(error.kind(), words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn what_is_no_port_is_told_in_words() {
        let missing = "/dev/no-such-port-as-this";
        let Err(error) = dial_serial(missing, 9600, Arc::new(()))().await else { panic!("opened") };
        assert_eq!(error.to_string(), "no such serial port");
        let denied = plain_error(io::ErrorKind::PermissionDenied.into()).to_string();
        assert!(denied.contains("dialout"), "{denied}");
    }
}
