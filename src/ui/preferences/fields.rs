//! Fields of a form: what each is called, where its value stands and what it
//! may be. The text as typed is kept apart from the value, so nothing is lost
//! by a typing error.

use std::{borrow::Cow, ops::RangeInclusive};

use crate::{
    device::settings::{Kind, Unfit, Value},
    ui::words,
};

/// Where a value stands in a `T`; `None` where that `T` does not have it.
pub(super) type Place<T, V> = fn(&mut T) -> Option<&mut V>;
/// Why a value cannot be used; reads on from the name of its field.
pub(super) type Checked = Result<(), &'static str>;
/// The heading above fields that belong together, and one of them.
pub(super) type Placed<T> = (&'static str, Description<T>);

type Get<T> = Box<dyn Fn(&mut T) -> Option<Value>>;
type Put<T> = Box<dyn Fn(&mut T, Value) -> Result<(), String>>;
type Note<T> = Box<dyn Fn(&T) -> Option<String>>;

/// One line of a form.
pub(super) struct Description<T> {
    pub(super) label: Cow<'static, str>,
    pub(super) kind: Kind,
    /// Stands behind the field.
    pub(super) unit: &'static str,
    /// A text that is wrapped, to be seen whole.
    pub(super) is_wrapped: bool,
    get: Get<T>,
    put: Put<T>,
    is_used: fn(&T) -> bool,
    check: fn(&T) -> Checked,
    note: Note<T>,
}

impl<T> Description<T> {
    /// A field of any kind. A value that is not put leaves all as it was.
    pub(super) fn new(
        label: impl Into<Cow<'static, str>>,
        kind: Kind,
        get: impl Fn(&mut T) -> Option<Value> + 'static,
        put: impl Fn(&mut T, Value) -> Result<(), String> + 'static,
    ) -> Self {
        Self {
            label: label.into(),
            kind,
            unit: "",
            is_wrapped: false,
            get: Box::new(get),
            put: Box::new(put),
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
    ) -> Self
    where
        T: 'static,
    {
        let kind = Kind::Number { min: *range.start(), max: *range.end() };
        let get = move |whole: &mut T| place(whole).map(|number| Value::Decimal(*number));
        let put = move |whole: &mut T, value| {
            if let (Some(place), Value::Decimal(number)) = (place(whole), value) {
                *place = number;
            }
            Ok(())
        };
        Self { unit, ..Self::new(label, kind, get, put) }
    }

    /// Text without the blanks around it.
    pub(super) fn text(
        label: impl Into<Cow<'static, str>>,
        check: fn(&str) -> Result<(), Unfit>,
        place: Place<T, String>,
    ) -> Self
    where
        T: 'static,
    {
        let get = move |whole: &mut T| place(whole).map(|text| Value::Text(text.clone()));
        let put = move |whole: &mut T, value| {
            if let (Some(place), Value::Text(text)) = (place(whole), value) {
                *place = text;
            }
            Ok(())
        };
        Self::new(label, Kind::Text(check), get, put)
    }

    /// One of `values`. The codes of `choices` are their indices.
    pub(super) fn choice<V: Copy + PartialEq + 'static>(
        label: &'static str,
        choices: &'static [(i64, &'static str)],
        values: &'static [V],
        place: fn(&mut T) -> &mut V,
    ) -> Self
    where
        T: 'static,
    {
        let get = move |whole: &mut T| {
            let index = values.iter().position(|value| value == place(whole));
            index.and_then(|index| i64::try_from(index).ok()).map(Value::Choice)
        };
        let put = move |whole: &mut T, value| {
            if let Value::Choice(code) = value {
                let value = usize::try_from(code).ok().and_then(|index| values.get(index));
                *place(whole) = value.copied().unwrap_or(*place(whole));
            }
            Ok(())
        };
        Self::new(label, Kind::Choice(choices), get, put)
    }

    pub(super) fn wrapped(self) -> Self {
        Self { is_wrapped: true, ..self }
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
        (self.get)(whole).map(|value| self.kind.text(&value))
    }

    /// Puts a text in its place.
    fn read(&self, whole: &mut T, text: &str) -> Result<(), String> {
        let value = self.kind.read(text.trim()).map_err(|why| words::unfit(&why, self.unit))?;
        (self.put)(whole, value)
    }
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
