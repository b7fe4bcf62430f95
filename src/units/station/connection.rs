//! Connection of an antenna: make, address and settings of the make.

use serde::{Serialize, Serializer, ser::SerializeMap};

use super::{
    ControllerSpec, Setting,
    setting::{Spelled, is_empty},
};
use crate::device::{
    CountPoint, Variant,
    settings::{Unfit, Value},
};

/// Make, address and the settings of the make.
#[derive(Debug, Clone, PartialEq)]
pub struct Connection {
    spec: &'static ControllerSpec,
    /// Host and port such as `192.168.10.21:4001`, or a serial port such as `/dev/ttyUSB0` or
    /// `COM3`.
    pub address: String,
    /// Values in the order of the make's settings.
    values: Vec<Value>,
}

impl Connection {
    /// Returns a connection to `address` with default settings.
    pub(super) fn new(spec: &'static ControllerSpec, address: &str) -> Self {
        let values = spec.settings.iter().map(|setting| (setting.default)()).collect();
        Self { spec, address: address.to_owned(), values }
    }

    pub fn spec(&self) -> &'static ControllerSpec {
        self.spec
    }

    /// Returns the unit's variant with these settings.
    pub fn variant(&self) -> &'static Variant {
        (self.spec.variant)(self)
    }

    /// Returns the value of a setting; `None` if the make does not have the setting.
    pub fn value(&self, setting: &Setting) -> Option<&Value> {
        self.place(setting).and_then(|place| self.values.get(place))
    }

    /// Returns the text or word of a setting; empty if the setting has neither.
    pub fn text(&self, setting: &Setting) -> &str {
        match self.value(setting) {
            Some(Value::Text(text)) => text,
            _ => "",
        }
    }

    /// Returns the whole number or the code of a setting; 0 if it has neither, or does not fit in a
    /// `u32`.
    pub fn whole(&self, setting: &Setting) -> u32 {
        match self.value(setting) {
            Some(Value::Integer(number) | Value::Choice(number)) => {
                u32::try_from(*number).unwrap_or(0)
            }
            _ => 0,
        }
    }

    /// Returns the points of a setting; empty if the setting has none.
    pub fn points(&self, setting: &Setting) -> &[CountPoint] {
        let Some(Value::Points(points)) = self.value(setting) else { return &[] };
        points
    }

    /// Returns the configured element file; `None` for the unit's current file.
    pub fn element_file(&self) -> Option<String> {
        let file = self.text(self.element_file_setting()?);
        (!file.is_empty()).then(|| file.to_owned())
    }

    /// Configures the element file. Does nothing for a make without element files.
    pub fn use_element_file(&mut self, file: &str) -> Result<(), Unfit> {
        self.element_file_setting().map_or(Ok(()), |setting| self.put(setting, file))
    }

    /// Returns `true` if both connections reach a unit in the same way. The name of the element
    /// file does not matter.
    pub fn is_same_link(&self, other: &Self) -> bool {
        let mut other = other.clone();
        let file = self.element_file_setting().and_then(|setting| self.place(setting));
        if let Some(file) = file
            && let (Some(own), Some(theirs)) = (self.values.get(file), other.values.get_mut(file))
        {
            theirs.clone_from(own);
        }
        *self == other
    }

    fn element_file_setting(&self) -> Option<&'static Setting> {
        let key = self.spec.element_files?.setting;
        self.spec.settings.iter().copied().find(|setting| setting.field.key == key)
    }

    /// Sets a value. Changes nothing if the setting cannot hold the value, or if the make does not
    /// have the setting. The reason in the error completes the name of the setting.
    pub fn put(&mut self, setting: &Setting, value: impl Into<Value>) -> Result<(), Unfit> {
        let value = value.into();
        setting.field.kind.check(&value)?;
        let place = self.place(setting).and_then(|place| self.values.get_mut(place));
        *place.ok_or_else(|| Unfit::Text(format!("is no setting of {:?}", self.spec.key)))? = value;
        Ok(())
    }

    fn place(&self, setting: &Setting) -> Option<usize> {
        let is_it =
            |other: &&Setting| (other.field.key, other.table) == (setting.field.key, setting.table);
        self.spec.settings.iter().position(is_it)
    }
}

impl Serialize for Connection {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        let all: Vec<SettingEntry<'_>> =
            self.spec.settings.iter().copied().zip(&self.values).collect();
        let mut map = out.serialize_map(None)?;
        map.serialize_entry("controller", self.spec.key)?;
        map.serialize_entry("address", &self.address)?;
        for values in all.chunk_by(|(a, _), (b, _)| a.table == b.table) {
            match values.first().and_then(|(setting, _)| setting.table) {
                Some(table) => map.serialize_entry(table.key, &OfTable(values))?,
                None => write(values, &mut map)?,
            }
        }
        map.end()
    }
}

type SettingEntry<'a> = (&'static Setting, &'a Value);

/// The settings of one table with their values.
struct OfTable<'a>(&'a [SettingEntry<'a>]);

impl Serialize for OfTable<'_> {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        let mut map = out.serialize_map(None)?;
        write(self.0, &mut map)?;
        map.end()
    }
}

fn write<M: SerializeMap>(values: &[SettingEntry<'_>], map: &mut M) -> Result<(), M::Error> {
    values.iter().filter(|(_, value)| !is_empty(value)).try_for_each(|(setting, value)| {
        map.serialize_entry(setting.field.key, &Spelled(setting, value))
    })
}

/// Checks that `address` is a host and a port; returns the reason if it is not.
pub fn check_address(address: &str) -> Result<(), &'static str> {
    let Some((host, port)) = address.rsplit_once(':') else {
        return Err("must be a host and a port, such as 192.168.10.21:4001");
    };
    if host.is_empty() || host.contains(|c: char| c.is_whitespace() || c == '/') {
        return Err("must have a host without blanks and slashes before the port");
    }
    match port.parse::<u16>() {
        Ok(1..) => Ok(()),
        _ => Err("must have a port from 1 to 65535 after the host"),
    }
}

/// Checks that `address` is a serial port, or a host and a port; returns the reason if it is
/// neither.
pub(crate) fn check_line(address: &str) -> Result<(), &'static str> {
    if address.is_empty() {
        return Err("must be a serial port, such as /dev/ttyUSB0 or COM3, or a host and a port");
    }
    // Paths of serial ports may contain colons too.
    let is_port = address.starts_with(['/', '\\']) || !address.contains(':');
    if is_port { Ok(()) } else { check_address(address) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_a_serial_port_or_a_host_and_a_port() {
        for good in ["/dev/ttyUSB0", "COM3", "/dev/serial/by-path/pci-0000:00:14.0-port0", "h:1"] {
            assert_eq!(check_line(good), Ok(()), "{good}");
        }
        for bad in ["", "host:", "host:0", "host:70000", ":4001"] {
            assert!(check_line(bad).is_err(), "{bad}");
        }
    }
}
