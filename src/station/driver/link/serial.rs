//! Links over a serial port of this computer.

use std::{io, sync::Arc};

use serial2_tokio::{CharSize, FlowControl, SerialPort, Settings, StopBits};

use super::{Dial, Duplicate, Stream, parity::WithParity};
use crate::protocol::Parity;

impl Stream for SerialPort {
    /// The library gives no handle. The one make on a serial line ends its jogs by itself.
    fn duplicate(&self) -> io::Result<Option<Duplicate>> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

/// Opens the serial port `name` at `baud` bits a second, with seven bits and even parity.
pub(super) fn dial_serial(name: String, baud: u32) -> Dial {
    Box::new(move || {
        let name = name.clone();
        Box::pin(async move {
            // Some drivers wait for their hardware while they open it.
            let opened = tokio::task::spawn_blocking(move || open(name.trim(), baud)).await;
            let (port, parity) = opened.map_err(io::Error::other)?.map_err(in_words)?;
            Ok(Box::new(WithParity::new(port, parity, Arc::default())) as Box<dyn Stream>)
        })
    })
}

/// A port without parity, such as a pseudo-terminal, is opened with eight bits, and this end
/// adds the parity.
fn open(name: &str, baud: u32) -> io::Result<(SerialPort, Parity)> {
    let mut port = SerialPort::open(name, |settings| raw(settings, baud))?;
    let mut settings = port.get_configuration()?;
    settings.set_char_size(CharSize::Bits7);
    settings.set_parity(serial2_tokio::Parity::Even);
    let parity = if port.set_configuration(&settings).is_ok() {
        Parity::Port
    } else {
        port.set_configuration(&raw(settings, baud)?)?;
        Parity::Software
    };
    // Bytes received earlier belong to nobody. A port that cannot discard them delivers bytes
    // that make no frame.
    port.discard_buffers().ok();
    Ok((port, parity))
}

/// Eight bits, no parity, bytes unchanged.
fn raw(mut settings: Settings, baud: u32) -> io::Result<Settings> {
    settings.set_raw();
    settings.set_baud_rate(baud)?;
    settings.set_char_size(CharSize::Bits8);
    settings.set_parity(serial2_tokio::Parity::None);
    settings.set_stop_bits(StopBits::One);
    settings.set_flow_control(FlowControl::None);
    Ok(settings)
}

/// The error in plain words where those of the system do not help.
fn in_words(error: io::Error) -> io::Error {
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
        let Err(error) = dial_serial(missing.to_owned(), 9600)().await else { panic!("opened") };
        assert_eq!(error.to_string(), "no such serial port");
        let denied = in_words(io::ErrorKind::PermissionDenied.into()).to_string();
        assert!(denied.contains("dialout"), "{denied}");
    }
}
