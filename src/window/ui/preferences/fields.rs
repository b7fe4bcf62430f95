//! Fields of a form: label, access to the value, and constraints. The entered text is separate from
//! the value, so that a typing error loses nothing.

use std::{borrow::Cow, ops::RangeInclusive};

use jiff::civil::Time;

use super::{search::Spot, section::Finding};
use crate::{
    device::settings::{Kind, Unfit, Value, number},
    station::{Antenna, HoursOfDay},
    ui::{widgets::form::Entry, words},
};

/// Access to a value in a `T`; returns `None` if the `T` does not have the value.
pub(super) type Place<T, V> = fn(&mut T) -> Option<&mut V>;
/// Result of a check. The name of the field and the error make a sentence.
pub(super) type Checked = Result<(), &'static str>;
/// A field with its section.
pub(in crate::ui) type Placed<T> = (&'static str, Description<T>);

/// Returns the fields of a section.
pub(super) fn placed<T>(
    section: &'static str,
    fields: impl IntoIterator<Item = Description<T>>,
) -> Vec<Placed<T>> {
    fields.into_iter().map(|field| (section, field)).collect()
}

type Get<T> = Box<dyn Fn(&mut T) -> Option<Value>>;
type Put<T> = Box<dyn Fn(&mut T, Value) -> Result<(), String>>;
type Note<T> = Box<dyn Fn(&T) -> Option<String>>;

/// Kind of editor of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum TextShape {
    Line,
    /// One text, wrapped so that all of it is visible.
    Wrapped,
    /// Several lines. The hint shows while the text is empty.
    Lines {
        hint: &'static str,
    },
}

/// Description of one field of a form.
pub(in crate::ui) struct Description<T> {
    pub(in crate::ui) label: Cow<'static, str>,
    pub(super) kind: Kind,
    /// Unit of measure, shown after the field.
    pub(super) unit: &'static str,
    pub(super) shape: TextShape,
    get: Get<T>,
    put: Put<T>,
    is_used: fn(&T) -> bool,
    check: fn(&T) -> Checked,
    note: Note<T>,
}

impl<T> Description<T> {
    /// Creates a field of any kind. `put` must leave the value unchanged if it fails.
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
            shape: TextShape::Line,
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
        place: impl Fn(&mut T) -> Option<&mut f64> + Copy + 'static,
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

    /// Creates a text field, which removes blanks around the text.
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

    /// Creates a choice among `values`. The codes of `choices` are indices into `values`.
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

    /// Creates a field for a time of day.
    pub(super) fn time(label: &'static str, place: fn(&mut T) -> &mut Time) -> Self
    where
        T: 'static,
    {
        const NO_TIME: &str = "must be a time of day such as 22:00";
        let check = |text: &str| match HoursOfDay::read_time(text) {
            Some(_) => Ok(()),
            None => Err(Unfit::Text(NO_TIME.to_owned())),
        };
        let get = move |whole: &mut T| Some(Value::Text(HoursOfDay::time_text(*place(whole))));
        let put = move |whole: &mut T, value| {
            if let Value::Text(text) = value {
                *place(whole) = HoursOfDay::read_time(&text).ok_or(NO_TIME)?;
            }
            Ok(())
        };
        Self::new(label, Kind::Text(check), get, put)
    }

    pub(super) fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    pub(super) fn wrapped(self) -> Self {
        Self { shape: TextShape::Wrapped, ..self }
    }

    pub(super) fn of_lines(self, hint: &'static str) -> Self {
        Self { shape: TextShape::Lines { hint }, ..self }
    }

    /// Hides and ignores the field unless `is_used` returns `true`.
    pub(super) fn when(self, is_used: fn(&T) -> bool) -> Self {
        Self { is_used, ..self }
    }

    /// Adds a check that involves other fields.
    pub(super) fn checked(self, check: fn(&T) -> Checked) -> Self {
        Self { check, ..self }
    }

    /// Adds a note below the field.
    pub(super) fn noted(self, note: impl Fn(&T) -> Option<String> + 'static) -> Self {
        Self { note: Box::new(note), ..self }
    }

    /// Adds a constant note below the field.
    pub(super) fn described(self, words: &'static str) -> Self {
        self.noted(move |_| Some(words.to_owned()))
    }

    /// Returns the text of the value, if `whole` has the value.
    fn write(&self, whole: &mut T) -> Option<String> {
        (self.get)(whole).map(|value| self.kind.text(&value))
    }

    /// Parses a text and stores the value.
    fn read(&self, whole: &mut T, text: &str) -> Result<(), Problem> {
        let value = self.kind.read(text.trim()).map_err(|reason| Problem {
            short: words::unfit_in_short(&reason, self.unit),
            reason: words::unfit(&reason, self.unit),
            would_do: None,
        })?;
        (self.put)(whole, value).map_err(Problem::new)
    }

    /// Returns the text of the valid number nearest to the entered number.
    fn nearest(&self, text: &str) -> Option<String> {
        let typed = number(text.trim())?;
        let value = match self.kind {
            Kind::Number { min, max } => Value::Decimal(typed.clamp(min, max)),
            Kind::Integer { min, max } => Value::Integer((typed.round() as i64).clamp(min, max)),
            _ => return None,
        };
        Some(self.kind.text(&value))
    }
}

/// A field with its entered text.
pub(in crate::ui) struct Field<T: 'static> {
    /// Section of the field; each section is a card of the page.
    pub(in crate::ui) section: &'static str,
    pub(in crate::ui) description: Description<T>,
    pub(in crate::ui) entry: Entry,
}

impl<T> Field<T> {
    /// Clears the field and its previous value.
    pub(in crate::ui) fn empty(&mut self) {
        self.entry = Entry::saved(String::new());
    }
}

/// Reason why the text of a field is invalid.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct Problem {
    /// Reason that follows the name of the field in a sentence.
    pub(super) reason: String,
    /// Reason in a few words, shown next to the field.
    pub(super) short: String,
    /// A valid text to suggest.
    pub(super) would_do: Option<String>,
}

impl Problem {
    pub(super) fn new(reason: impl Into<String>) -> Self {
        let reason = reason.into();
        Self { short: words::capitalised(&reason), reason, would_do: None }
    }
}

/// Numbers of edited and of invalid fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Counts {
    pub(super) edited: usize,
    pub(super) wrong: usize,
}

/// State of a field.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::ui) struct Standing {
    pub(super) is_used: bool,
    /// `true` if the station does not have the edited item yet.
    pub(super) is_new: bool,
    pub(in crate::ui) problem: Option<Problem>,
    /// Result of a successful test of the value.
    pub(super) proved: Option<String>,
    /// Note below the field.
    pub(super) note: Option<String>,
}

/// Draft of a `T` with all its fields.
pub(in crate::ui) struct Typed<T: 'static> {
    base: T,
    /// `true` if the station does not have the item yet.
    pub(super) is_new: bool,
    /// `true` if saving removes the item from the station. The operator can undo the removal until
    /// then.
    pub(super) is_removed: bool,
    pub(in crate::ui) fields: Vec<Field<T>>,
}

impl<T: Clone> Typed<T> {
    /// Creates a draft with those `fields` that `base` has.
    pub(super) fn new(base: T, fields: Vec<Placed<T>>) -> Self {
        let mut whole = base.clone();
        let fields = fields
            .into_iter()
            .filter_map(|(section, description)| {
                let entry = Entry::saved(description.write(&mut whole)?);
                Some(Field { section, description, entry })
            })
            .collect();
        Self { base, is_new: false, is_removed: false, fields }
    }

    /// Types `text` into the field with this label.
    pub(in crate::ui) fn type_in(&mut self, label: &str, text: String) {
        let mut fields = self.fields.iter_mut();
        if let Some(field) = fields.find(|field| field.description.label == label) {
            field.entry.text = text;
        }
    }

    /// Resets the first `count` fields to their values before any edit.
    pub(in crate::ui) fn reset(&mut self, count: usize) {
        let mut whole = self.base.clone();
        for field in self.fields.iter_mut().take(count) {
            field.entry = Entry::saved(field.description.write(&mut whole).unwrap_or_default());
        }
    }

    /// Returns the labels of the used fields.
    pub(super) fn used_labels(&self) -> Vec<(Cow<'static, str>, Spot)> {
        let standings = self.read().1;
        let used = self.fields.iter().zip(&standings).filter(|(_, standing)| standing.is_used);
        used.map(|(field, _)| (field.description.label.clone(), Spot::Field)).collect()
    }

    /// Returns the number of edited fields.
    pub(super) fn edited(&self) -> usize {
        self.fields.iter().filter(|field| field.entry.is_edited()).count()
    }

    /// Returns the invalid fields.
    pub(super) fn findings_in(&self, standings: &[Standing]) -> Vec<Finding> {
        let finding = |(field, standing): (&Field<T>, &Standing)| {
            let label = field.description.label.to_string();
            Some(Finding { label, problem: standing.problem.clone()? })
        };
        self.fields.iter().zip(standings).filter_map(finding).collect()
    }

    /// Returns the entered value if every field is valid.
    pub(in crate::ui) fn valid(&self) -> Option<T> {
        let (whole, standings) = self.read();
        standings.iter().all(|standing| standing.problem.is_none()).then_some(whole)
    }

    /// Returns the text of the first field, which is the name.
    pub(super) fn name(&self) -> &str {
        self.fields.first().map_or("", |field| &field.entry.text)
    }

    /// Returns the state of each field. `reason` is the problem of a name that equals one of
    /// `others`. A suggested name differs from all `names`.
    pub(super) fn standings_among<'a>(
        &self,
        mut others: impl Iterator<Item = &'a str>,
        names: &[&str],
        reason: &str,
    ) -> Vec<Standing> {
        let (own, mut standings) = (self.name(), self.read().1);
        if let Some(Standing { problem: problem @ None, .. }) = standings.first_mut()
            && others.any(|other| Antenna::same_name(other, own))
        {
            let free = Antenna::free_name(own.trim(), names);
            *problem = Some(Problem { would_do: Some(free), ..Problem::new(reason) });
        }
        standings
    }

    /// Returns the sections with the numbers of their fields, in order.
    pub(super) fn sections(&self) -> Vec<(&'static str, usize)> {
        let chunks = self.fields.chunk_by(|a, b| a.section == b.section);
        chunks.filter_map(|chunk| Some((chunk.first()?.section, chunk.len()))).collect()
    }

    /// Returns the value before any edit.
    pub(in crate::ui) fn before(&self) -> &T {
        &self.base
    }

    /// Returns the value with every valid field, and the state of each field.
    pub(in crate::ui) fn read(&self) -> (T, Vec<Standing>) {
        let texts: Vec<&str> = self.fields.iter().map(|field| field.entry.text.as_str()).collect();
        let (whole, mut standings) = self.read_as(&texts);
        for (index, standing) in standings.iter_mut().enumerate() {
            if let Some(problem) = &mut standing.problem {
                problem.would_do = self.would_do(index, &texts);
            }
        }
        (whole, standings)
    }

    /// Returns a valid text for the field at `index`, with all other fields as entered. This is the
    /// number nearest to the entered one, or the previous text.
    fn would_do(&self, index: usize, texts: &[&str]) -> Option<String> {
        let field = self.fields.get(index)?;
        let candidates =
            [field.description.nearest(&field.entry.text), Some(field.entry.before().to_owned())];
        candidates.into_iter().flatten().find(|candidate| {
            let mut texts = texts.to_vec();
            if let Some(text) = texts.get_mut(index) {
                *text = candidate;
            }
            let (_, standings) = self.read_as(&texts);
            standings.get(index).is_some_and(|standing| standing.problem.is_none())
        })
    }

    /// Reads the value like [`Self::read`], with these texts in the fields.
    fn read_as(&self, texts: &[&str]) -> (T, Vec<Standing>) {
        let mut whole = self.base.clone();
        let read = |(field, text): (&Field<T>, &&str)| field.description.read(&mut whole, text);
        let problems: Vec<Option<Problem>> =
            self.fields.iter().zip(texts).map(read).map(Result::err).collect();
        let described = || self.fields.iter().map(|field| &field.description).zip(&problems);
        // Combined checks run only if every single field is valid.
        let is_whole = described()
            .all(|(description, problem)| problem.is_none() || !(description.is_used)(&whole));
        let standings = described()
            .map(|(description, problem)| {
                if !(description.is_used)(&whole) {
                    return Standing::default();
                }
                let joint_problem = || (description.check)(&whole).err().filter(|_| is_whole);
                let problem = problem.clone().or_else(|| joint_problem().map(Problem::new));
                let (is_new, note) = (self.is_new, (description.note)(&whole));
                Standing { is_used: true, is_new, problem, proved: None, note }
            })
            .collect();
        (whole, standings)
    }
}

impl<T: PartialEq> PartialEq for Typed<T> {
    fn eq(&self, other: &Self) -> bool {
        let texts = self.fields.iter().map(|field| &field.entry.text);
        self.base == other.base
            && self.is_removed == other.is_removed
            && texts.eq(other.fields.iter().map(|field| &field.entry.text))
    }
}
