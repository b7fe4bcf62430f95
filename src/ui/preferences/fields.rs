//! Fields of a form: what each is called, where its value stands and what it
//! may be. The text as typed is kept apart from the value, so nothing is lost
//! by a typing error.

use std::{borrow::Cow, ops::RangeInclusive};

/// Where a value stands in a `T`; `None` where it has no such.
pub(super) type Place<T, V> = fn(&mut T) -> Option<&mut V>;
/// Why a value cannot be used, to stand behind the name of its field.
pub(super) type Checked = Result<(), &'static str>;
/// What stands above fields that belong together, and one of them.
pub(super) type Placed<T> = (&'static str, Description<T>);

/// How a field looks.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// For a name or an address.
    Words,
    /// For a number.
    Number,
    /// One text, wrapped to be seen whole.
    Wrapped,
    /// Many lines. The hint stands there while it is empty.
    Lines { hint: &'static str },
    /// One of these.
    Choice(Vec<&'static str>),
}

type Write<T> = Box<dyn Fn(&T) -> Option<String>>;
type Read<T> = Box<dyn Fn(&mut T, &str) -> Result<(), String>>;

/// How a value is written and read back.
enum Value<T> {
    Number { range: RangeInclusive<f64>, place: Place<T, f64> },
    Text { check: fn(&str) -> Checked, place: Place<T, String> },
    Choice { words: &'static [&'static str], get: fn(&T) -> Option<usize>, set: fn(&mut T, usize) },
    Written { write: Write<T>, read: Read<T> },
}

/// One line of a form.
pub(super) struct Description<T> {
    pub(super) label: Cow<'static, str>,
    pub(super) look: Look,
    /// Stands behind the field.
    pub(super) unit: &'static str,
    value: Value<T>,
    is_used: fn(&T) -> bool,
    check: fn(&T) -> Checked,
    note: Write<T>,
}

impl<T> Description<T> {
    fn new(label: impl Into<Cow<'static, str>>, look: Look, value: Value<T>) -> Self {
        Self {
            label: label.into(),
            look,
            unit: "",
            value,
            is_used: |_| true,
            check: |_| Ok(()),
            note: Box::new(|_| None),
        }
    }

    pub(super) fn number(
        label: &'static str,
        range: RangeInclusive<f64>,
        unit: &'static str,
        place: Place<T, f64>,
    ) -> Self {
        Self { unit, ..Self::new(label, Look::Number, Value::Number { range, place }) }
    }

    /// Words that `check` takes, without the blanks around them.
    pub(super) fn text(
        label: &'static str,
        check: fn(&str) -> Checked,
        place: Place<T, String>,
    ) -> Self {
        Self::new(label, Look::Words, Value::Text { check, place })
    }

    /// One of `words`, by its place among them.
    pub(super) fn choice(
        label: &'static str,
        words: &'static [&'static str],
        get: fn(&T) -> Option<usize>,
        set: fn(&mut T, usize),
    ) -> Self {
        Self::new(label, Look::Choice(words.to_vec()), Value::Choice { words, get, set })
    }

    /// Anything that has a way to be written and read. What is read with an error
    /// leaves the value as it is.
    pub(super) fn written(
        label: impl Into<Cow<'static, str>>,
        look: Look,
        write: impl Fn(&T) -> Option<String> + 'static,
        read: impl Fn(&mut T, &str) -> Result<(), String> + 'static,
    ) -> Self {
        let value = Value::Written { write: Box::new(write), read: Box::new(read) };
        Self::new(label, look, value)
    }

    /// Not shown, and of no consequence, unless `is_used` says so.
    pub(super) fn when(self, is_used: fn(&T) -> bool) -> Self {
        Self { is_used, ..self }
    }

    /// What must hold together with other fields.
    pub(super) fn checked(self, check: fn(&T) -> Checked) -> Self {
        Self { check, ..self }
    }

    /// What stands below the field.
    pub(super) fn noted(self, note: impl Fn(&T) -> Option<String> + 'static) -> Self {
        Self { note: Box::new(note), ..self }
    }

    /// The text of the value, for a `whole` that has it.
    fn write(&self, whole: &mut T) -> Option<String> {
        match &self.value {
            Value::Number { place, .. } => place(whole).map(|number| number.to_string()),
            Value::Text { place, .. } => place(whole).cloned(),
            Value::Choice { words, get, .. } => {
                words.get(get(whole)?).map(|word| (*word).to_owned())
            }
            Value::Written { write, .. } => write(whole),
        }
    }

    /// Puts a text in its place.
    fn read(&self, whole: &mut T, text: &str) -> Result<(), String> {
        let text = text.trim();
        match &self.value {
            Value::Number { range, place } => {
                let number = number(text).filter(|number| range.contains(number));
                let number = number.ok_or_else(|| self.out_of(range))?;
                put(place(whole), number);
            }
            Value::Text { check, place } => {
                check(text)?;
                put(place(whole), text.to_owned());
            }
            Value::Choice { words, set, .. } => {
                let index = words.iter().position(|word| *word == text);
                set(whole, index.ok_or("must be one of the choices")?);
            }
            Value::Written { read, .. } => read(whole, text)?,
        }
        Ok(())
    }

    fn out_of(&self, range: &RangeInclusive<f64>) -> String {
        let gap = if self.unit == "°" { "" } else { " " };
        let words =
            format!("must be a number from {} to {}{gap}{}", range.start(), range.end(), self.unit);
        words.replace('-', "−")
    }
}

fn put<V>(place: Option<&mut V>, value: V) {
    if let Some(place) = place {
        *place = value;
    }
}

/// A number with a point or a comma, and with either minus.
pub(super) fn number(text: &str) -> Option<f64> {
    text.replace(',', ".").replace('−', "-").parse().ok()
}

/// A field with what is typed in it.
pub(super) struct Field<T: 'static> {
    /// What stands above it and its neighbours.
    pub(super) section: &'static str,
    pub(super) description: Description<T>,
    pub(super) text: String,
    /// As it was before anything was typed.
    before: String,
}

impl<T> Field<T> {
    /// Something else is typed than what was there.
    pub(super) fn is_edited(&self) -> bool {
        self.text != self.before
    }
}

/// How a field stands.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Standing {
    pub(super) is_used: bool,
    /// Why it cannot be used, to stand behind its name.
    pub(super) problem: Option<String>,
    /// What stands below it.
    pub(super) note: Option<String>,
}

/// All fields of one thing.
pub(super) struct Typed<T: 'static> {
    base: T,
    pub(super) fields: Vec<Field<T>>,
}

impl<T: Clone> Typed<T> {
    /// Those of `fields` that `base` has.
    pub(super) fn of(base: T, fields: Vec<Placed<T>>) -> Self {
        let mut whole = base.clone();
        let fields = fields
            .into_iter()
            .filter_map(|(section, description)| {
                let before = description.write(&mut whole)?;
                Some(Field { section, description, text: before.clone(), before })
            })
            .collect();
        Self { base, fields }
    }

    /// As it was before anything was typed.
    pub(super) fn before(&self) -> &T {
        &self.base
    }

    /// What is typed, as far as it can be used, and how each field stands.
    pub(super) fn read(&self) -> (T, Vec<Standing>) {
        let mut whole = self.base.clone();
        let read = |field: &Field<T>| field.description.read(&mut whole, &field.text).err();
        let problems: Vec<Option<String>> = self.fields.iter().map(read).collect();
        let described = || self.fields.iter().map(|field| &field.description).zip(&problems);
        // Together they say nothing while one of them is wrong.
        let is_whole = described().all(|(of, problem)| problem.is_none() || !(of.is_used)(&whole));
        let standings = described()
            .map(|(of, problem)| {
                if !(of.is_used)(&whole) {
                    return Standing::default();
                }
                let together = || (of.check)(&whole).err().filter(|_| is_whole);
                let problem = problem.clone().or_else(|| together().map(str::to_owned));
                Standing { is_used: true, problem, note: (of.note)(&whole) }
            })
            .collect();
        (whole, standings)
    }
}

impl<T: PartialEq> PartialEq for Typed<T> {
    fn eq(&self, other: &Self) -> bool {
        let texts = self.fields.iter().map(|field| &field.text);
        self.base == other.base && texts.eq(other.fields.iter().map(|field| &field.text))
    }
}
