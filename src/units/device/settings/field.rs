//! The description of a setting.

use super::{Key, Unfit, Value, Values};

/// Settings that a device reports with one answer and takes with one command.
#[derive(Debug)]
pub struct Group {
    /// Names the group in files and commands.
    pub key: &'static str,
    /// Its head in the form.
    pub title: &'static str,
    /// In the order of the form.
    pub fields: &'static [Field],
    /// Calibration, drive scaling, firmware: a wrong value moves the antenna or
    /// points it wrong.
    pub is_service: bool,
}

/// One setting.
#[derive(Debug)]
pub struct Field {
    /// Key within its group.
    pub key: &'static str,
    /// Label before its value in the form.
    pub label: &'static str,
    /// Unit behind its value; empty for none.
    pub unit: &'static str,
    /// Values that it can hold.
    pub kind: Kind,
    /// Access of the device and of the operator.
    pub access: Access,
    /// How much care a new value takes.
    pub guard: fn(&Value) -> Guard,
    /// It decides where the antenna points or when it starts: it passes the gate.
    pub moves: bool,
    /// Whole that it is a part of. Parts of one whole in a group mean nothing alone: a new value
    /// goes out with the values of the other parts, or waits for them.
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
    /// A number that is shown and compared with so many decimal places, and sent with three
    /// at most.
    Decimal { min: f64, max: f64, places: usize },
    /// A number as precise as it is typed.
    Number { min: f64, max: f64 },
    /// An angle with a letter for its sign, such as `41.02N`.
    Place {
        /// Largest magnitude, degrees.
        max: f64,
        /// Letters of positive and negative.
        letters: [char; 2],
    },
    /// Two measured points or more that make a scale, or none.
    Points,
    /// A text that passes this check.
    Text(fn(&str) -> Result<(), Unfit>),
    /// A secret that passes this check. Never shown, logged or saved.
    Password(fn(&str) -> Result<(), Unfit>),
    /// UTC to the second.
    Time,
}

/// Access to a field: who reports it and who sets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Reported by the device and set by the operator.
    Edit,
    /// Only reported.
    Read,
    /// Goes along with a change and is never reported. Its first choice, or
    /// off, stands where the operator says nothing.
    Write,
}

/// How much care a new value takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// Nothing special.
    Free,
    /// The operator confirms it by itself.
    Confirm,
    /// Only with the service functions unlocked, and while the antenna stands.
    Service,
}

const fn free(_: &Value) -> Guard {
    Guard::Free
}

impl Field {
    /// A setting without a unit that the operator may change freely.
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

    /// A value that is only reported.
    pub const fn read<T>(key: Key<T>, label: &'static str) -> Self {
        Self { access: Access::Read, ..Self::edit(key, label) }
    }

    /// A value that goes along with a change and is never reported.
    pub const fn write<T>(key: Key<T>, label: &'static str) -> Self {
        Self { access: Access::Write, ..Self::edit(key, label) }
    }

    /// With the unit behind its value.
    #[must_use]
    pub const fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// With what it does.
    #[must_use]
    pub const fn description(self, text: &'static str) -> Self {
        Self { description: text, ..self }
    }

    /// With the care that its values take.
    #[must_use]
    pub const fn guarded(self, guard: fn(&Value) -> Guard) -> Self {
        Self { guard, ..self }
    }

    /// As a part of this whole.
    #[must_use]
    pub const fn part_of(self, whole: &'static str) -> Self {
        Self { part_of: Some(whole), ..self }
    }

    /// With the mark of what decides where the antenna points or when it starts.
    #[must_use]
    pub const fn moving(self) -> Self {
        Self { moves: true, ..self }
    }
}

impl Group {
    /// The field with this key.
    pub fn field(&self, key: &str) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.key == key)
    }

    /// The other parts of what `field` is a part of.
    pub fn other_parts(&self, field: &Field) -> impl Iterator<Item = &'static Field> {
        let (key, whole) = (field.key, field.part_of);
        let is_other = move |other: &&Field| whole.is_some() && other.part_of == whole;
        self.fields.iter().filter(is_other).filter(move |other| other.key != key)
    }

    /// Something in it can be set.
    pub fn is_writable(&self) -> bool {
        self.fields.iter().any(|field| field.access != Access::Read)
    }

    /// The most care that any of `values` takes.
    pub fn guard(&self, values: &Values) -> Guard {
        if self.is_service {
            return Guard::Service;
        }
        let guards = values.iter().filter_map(|(key, value)| Some((self.field(key)?.guard)(value)));
        guards.max_by_key(|guard| *guard as u8).unwrap_or(Guard::Free)
    }

    /// The first field of `values` that decides where the antenna points.
    pub fn moving_field(&self, values: &Values) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.moves && values.contains_key(field.key))
    }
}
