//! The description of a setting.

use super::{Key, Unfit, Value, Values};

/// Settings that a device reports with one answer and takes with one command.
#[derive(Debug)]
pub struct Group {
    /// Name of the group in files and commands.
    pub key: &'static str,
    /// Title of the group in the form.
    pub title: &'static str,
    /// Fields in the order of the form.
    pub fields: &'static [Field],
    /// `true` for calibration, drive scaling and firmware: a wrong value moves the antenna or
    /// points it wrong.
    pub is_service: bool,
}

/// Description of one setting of a unit.
#[derive(Debug)]
pub struct Field {
    /// Key within its group.
    pub key: &'static str,
    /// Label before the value in the form.
    pub label: &'static str,
    /// Unit after the value; empty for none.
    pub unit: &'static str,
    /// Values that the field can hold.
    pub kind: Kind,
    /// Access of the device and of the operator.
    pub access: Access,
    /// Care that a new value requires.
    pub guard: fn(&Value) -> Guard,
    /// `true` if the field decides where the antenna points or when it starts: changes pass the
    /// gate.
    pub moves: bool,
    /// Name of the whole that the field is a part of. Parts of one whole in a group mean nothing
    /// alone: Azel sends a new value with the values of the other parts, or waits for them.
    pub part_of: Option<&'static str>,
    /// Explanation in a sentence or two.
    pub description: &'static str,
}

/// Values that a field can hold.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// On or off.
    Flag,
    /// One of these codes, each with its name.
    Choice(&'static [(i64, &'static str)]),
    /// One of these words, each with its name.
    Word(&'static [(&'static str, &'static str)]),
    /// A whole number.
    Integer { min: i64, max: i64 },
    /// A number that Azel shows and compares with this number of decimal places, and sends with
    /// three at most.
    Decimal { min: f64, max: f64, places: usize },
    /// A number with the precision that the operator typed.
    Number { min: f64, max: f64 },
    /// An angle with a letter for its sign, such as `41.02N`.
    Place {
        /// Max magnitude, degrees.
        max: f64,
        /// Letters of a positive and a negative angle.
        letters: [char; 2],
    },
    /// Two or more measured points that make a scale, or none.
    Points,
    /// A text that passes this check.
    Text(fn(&str) -> Result<(), Unfit>),
    /// A secret that passes this check. Azel never shows, logs or saves it.
    Password(fn(&str) -> Result<(), Unfit>),
    /// UTC to the second.
    Time,
}

/// Access to a field: the device may report it, the operator may set it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// A value that the device reports and the operator sets.
    Edit,
    /// A value that the device only reports.
    Read,
    /// A value that Azel sends with a change and the device never reports. Its default is the first
    /// choice, or off.
    Write,
}

/// Care that a new value requires.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// No special care.
    Free,
    /// Separate confirmation of this value by the operator.
    Confirm,
    /// Unlocked service functions, and an antenna at rest.
    Service,
}

const fn free(_: &Value) -> Guard {
    Guard::Free
}

impl Field {
    /// Returns a setting without a unit of measure, which the operator may change freely.
    pub const fn edit<T>(key: Key<T>, label: &'static str) -> Self {
        Self {
            key: key.name,
            label,
            unit: "",
            kind: key.kind,
            access: Access::Edit,
            guard: free,
            moves: false,
            part_of: None,
            description: "",
        }
    }

    /// Returns a value that the device only reports.
    pub const fn read<T>(key: Key<T>, label: &'static str) -> Self {
        Self { access: Access::Read, ..Self::edit(key, label) }
    }

    /// Returns a value that Azel sends with a change and the device never reports.
    pub const fn write<T>(key: Key<T>, label: &'static str) -> Self {
        Self { access: Access::Write, ..Self::edit(key, label) }
    }

    /// Returns the field with this unit after its value.
    #[must_use]
    pub const fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Returns the field with this explanation.
    #[must_use]
    pub const fn description(self, text: &'static str) -> Self {
        Self { description: text, ..self }
    }

    /// Returns the field with the care that its values require.
    #[must_use]
    pub const fn guarded(self, guard: fn(&Value) -> Guard) -> Self {
        Self { guard, ..self }
    }

    /// Returns the field as a part of `whole`.
    #[must_use]
    pub const fn part_of(self, whole: &'static str) -> Self {
        Self { part_of: Some(whole), ..self }
    }

    /// Returns the field marked as deciding where the antenna points or when it starts.
    #[must_use]
    pub const fn moving(self) -> Self {
        Self { moves: true, ..self }
    }
}

impl Group {
    /// Returns the field with this key.
    pub fn field(&self, key: &str) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.key == key)
    }

    /// Returns the other parts of the whole that `field` is a part of.
    pub fn other_parts(&self, field: &Field) -> impl Iterator<Item = &'static Field> {
        let (key, whole) = (field.key, field.part_of);
        let is_other = move |other: &&Field| whole.is_some() && other.part_of == whole;
        self.fields.iter().filter(is_other).filter(move |other| other.key != key)
    }

    /// Returns `true` if the group contains a field that can be set.
    pub fn is_writable(&self) -> bool {
        self.fields.iter().any(|field| field.access != Access::Read)
    }

    /// Returns the strictest care that any of `values` requires.
    pub fn guard(&self, values: &Values) -> Guard {
        if self.is_service {
            return Guard::Service;
        }
        let guards = values.iter().filter_map(|(key, value)| Some((self.field(key)?.guard)(value)));
        guards.max_by_key(|guard| *guard as u8).unwrap_or(Guard::Free)
    }

    /// Returns the first field of `values` that decides where the antenna points.
    pub fn moving_field(&self, values: &Values) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.moves && values.contains_key(field.key))
    }
}
