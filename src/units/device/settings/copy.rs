//! A copy of a unit's settings in a file. Azel writes it from the values that it has read, and
//! compares it with the unit's current values.
//!
//! The file is TOML with one table for each group. It contains no password. Azel shows service
//! settings from the file, but never applies them.

use std::fmt::Write as _;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Access, Field, Group, GroupStates, Guard, Kind, Unfit, Value};
use crate::name::{self, Name};

/// Version of the files that this program writes.
const VERSION: i64 = 1;

/// Origin of a copy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CopyHead {
    /// Antenna name in the station file.
    pub antenna: String,
    /// Address of the controller.
    pub address: String,
    /// Make of the controller, such as `satrak`.
    pub controller: String,
    pub saved_at: Timestamp,
}

/// A copy read from a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SettingsCopy {
    pub head: CopyHead,
    /// Values in the file that exist on units of this make, in the order of the forms.
    pub values: Vec<CopiedValue>,
    /// Names in the file that exist on no unit of this make, as `group.field`.
    pub unknown: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CopiedValue {
    /// Key of the group.
    #[serde(deserialize_with = "name::one")]
    pub group: Name,
    /// Key of the field.
    #[serde(deserialize_with = "name::one")]
    pub field: Name,
    /// The value, or the reason why it cannot be used.
    pub value: Result<Value, Unfit>,
    /// Value as in the file.
    written: toml::Value,
}

/// A setting that differs between a copy and the unit.
#[derive(Debug, Clone)]
pub struct Difference {
    pub group: &'static Group,
    pub field: &'static Field,
    /// Value in the copy, or the reason why it cannot be used.
    pub copied: Result<Value, Unfit>,
    /// Value on the unit; `None` if unknown.
    pub current: Option<Value>,
    pub verdict: Verdict,
}

/// Decision on applying a value from a copy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// A value that the operator may apply.
    Free,
    /// A service setting, which Azel only shows.
    Service,
    /// A value that cannot be used; its error gives the reason.
    Unfit,
    /// A setting whose value on the unit was not read.
    NotRead,
}

/// Reason why a file is not a copy of settings.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CopyError {
    #[error("it is not TOML: {0}")]
    Syntax(String),
    /// Another or damaged file without this key.
    #[error("it is not a copy of settings: {0} is missing")]
    NoCopy(&'static str),
    /// A file from a newer Azel.
    #[error("it has version {0}, this program knows {VERSION}; use the newer program")]
    Newer(i64),
    /// A copy for another make.
    #[error("it holds settings of a {found}, not of a {expected}")]
    OtherController {
        /// Make in the file.
        found: String,
        /// Make of the antenna.
        expected: String,
    },
}

/// Returns `true` for the fields that a copy contains.
fn is_copied(field: &Field) -> bool {
    field.access == Access::Edit && !matches!(field.kind, Kind::Password(_))
}

impl SettingsCopy {
    /// Returns the text of a copy with the values of `groups` in `unit_settings`. A comment names
    /// each group that was not read, with the reason.
    pub fn text(head: &CopyHead, groups: &[&'static Group], unit_settings: &GroupStates) -> String {
        let text = |text: &str| toml::Value::String(text.to_owned());
        let mut lines = format!(
            "# Settings of an antenna controller, saved by Azel. Passwords are left out.\n\
             version = {VERSION}\ncontroller = {}\nantenna = {}\naddress = {}\nsaved_at = {}\n",
            text(&head.controller),
            text(&head.antenna),
            text(&head.address),
            text(&head.saved_at.strftime("%Y-%m-%dT%H:%M:%SZ").to_string()),
        );
        for group in groups.iter().filter(|group| group.fields.iter().any(is_copied)) {
            let state = unit_settings.get(group.key);
            let Some(read) = state.and_then(|state| state.last_read.as_ref()) else {
                let failure = state.and_then(|state| state.failure.as_ref());
                let reason = failure.map_or("nobody asked".to_owned(), ToString::to_string);
                let _ = write!(lines, "\n# {}: not read, {reason}\n", group.key);
                continue;
            };
            let _ = write!(lines, "\n[{}]\n", group.key);
            for field in group.fields.iter().filter(|field| is_copied(field)) {
                let Some(value) = read.values.get(field.key) else { continue };
                let gap = if field.unit.is_empty() { "" } else { ", " };
                let comment = format!("{}{gap}{}", field.label, field.unit);
                let _ = writeln!(lines, "{} = {} # {comment}", field.key, as_toml(field, value));
            }
        }
        lines
    }

    /// Reads a copy for a unit of make `controller` with these groups. A bad value does not affect
    /// the other values.
    pub fn read(
        text: &str,
        controller: &str,
        groups: &[&'static Group],
    ) -> Result<Self, CopyError> {
        let table: toml::Table =
            text.parse().map_err(|error: toml::de::Error| CopyError::Syntax(first_line(&error)))?;
        let version = table.get("version").and_then(toml::Value::as_integer);
        match version.ok_or(CopyError::NoCopy("version"))? {
            version if version > VERSION => return Err(CopyError::Newer(version)),
            _ => {}
        }
        let word = |key: &'static str| {
            let word = table.get(key).and_then(toml::Value::as_str);
            word.map(str::to_owned).ok_or(CopyError::NoCopy(key))
        };
        let head = CopyHead {
            antenna: word("antenna")?,
            address: word("address")?,
            controller: word("controller")?,
            saved_at: word("saved_at")?.parse().map_err(|_| CopyError::NoCopy("saved_at"))?,
        };
        if head.controller != controller {
            let expected = controller.to_owned();
            return Err(CopyError::OtherController { found: head.controller, expected });
        }
        let mut values = Vec::new();
        for group in groups {
            let of_group = table.get(group.key).and_then(toml::Value::as_table);
            for field in group.fields.iter().filter(|field| is_copied(field)) {
                if let Some(value) = of_group.and_then(|of_group| of_group.get(field.key)) {
                    let (written, value) = (value.clone(), from_toml(field, value));
                    values.push(CopiedValue { group: group.key, field: field.key, value, written });
                }
            }
        }
        Ok(Self { head, values, unknown: unknown(&table, groups) })
    }

    /// Returns the settings that differ on the unit.
    pub fn differences(
        &self,
        groups: &[&'static Group],
        unit_settings: &GroupStates,
    ) -> Vec<Difference> {
        let difference = |copied: &CopiedValue| {
            let group = *groups.iter().find(|group| group.key == copied.group)?;
            let field = group.field(copied.field)?;
            let of_group = unit_settings.get(group.key).and_then(|state| state.last_read.as_ref());
            let current = of_group.and_then(|read| read.values.get(field.key)).cloned();
            // The unit may hold a value that cannot be sent, such as an empty text.
            let is_held = |current: &Value| match &copied.value {
                Ok(value) => field.kind.same(value, current),
                Err(_) => as_toml(field, current) == copied.written,
            };
            if current.as_ref().is_some_and(is_held) {
                return None;
            }
            let verdict = match &copied.value {
                Err(_) => Verdict::Unfit,
                Ok(_) if group.is_service => Verdict::Service,
                Ok(value) if (field.guard)(value) == Guard::Service => Verdict::Service,
                Ok(_) if of_group.is_none() => Verdict::NotRead,
                Ok(_) => Verdict::Free,
            };
            Some(Difference { group, field, copied: copied.value.clone(), current, verdict })
        };
        self.values.iter().filter_map(difference).collect()
    }
}

fn first_line(error: &toml::de::Error) -> String {
    error.message().lines().next().unwrap_or_default().to_owned()
}

/// Converts a value to TOML: choices by name, and times and texts as the operator reads them.
fn as_toml(field: &Field, value: &Value) -> toml::Value {
    match value {
        Value::Flag(on) => toml::Value::Boolean(*on),
        Value::Integer(number) => toml::Value::Integer(*number),
        Value::Decimal(number) => toml::Value::Float(*number),
        Value::Choice(code) => match field.kind.read(&field.kind.text(value)) {
            Ok(_) => toml::Value::String(field.kind.text(value)),
            Err(_) => toml::Value::Integer(*code),
        },
        Value::Text(_) | Value::Time(_) | Value::Points(_) => {
            toml::Value::String(field.kind.text(value))
        }
        Value::Secret(_) => toml::Value::String(String::new()),
    }
}

fn from_toml(field: &Field, value: &toml::Value) -> Result<Value, Unfit> {
    match value {
        toml::Value::Boolean(on) => field.kind.read(if *on { "On" } else { "Off" }),
        toml::Value::Integer(number) => field.kind.read(&number.to_string()),
        toml::Value::Float(number) => field.kind.read(&number.to_string()),
        toml::Value::String(text) => field.kind.read(text),
        _ => Err(Unfit::Text("must be one value".to_owned())),
    }
}

fn unknown(table: &toml::Table, groups: &[&'static Group]) -> Vec<String> {
    let mut unknown = Vec::new();
    for (key, value) in table {
        let Some(of_group) = value.as_table() else { continue };
        let group = groups.iter().find(|group| group.key == key);
        let is_known =
            |field: &str| group.and_then(|group| group.field(field)).is_some_and(is_copied);
        let strange = of_group.keys().filter(|field| !is_known(field));
        unknown.extend(strange.map(|field| format!("{key}.{field}")));
    }
    unknown
}
