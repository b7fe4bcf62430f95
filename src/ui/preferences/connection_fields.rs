//! The fields of an antenna that its make sets: where its controller answers
//! and what that has to know. All of them follow from the description of the make.

use super::{
    fields::{Checked, Description, Look, Placed},
    points,
};
use crate::{
    station::{Antenna, ControllerSpec, CountLine, CountPoint, Holds, Link, Setting, Value},
    ui::format,
};

type Of = Description<Antenna>;

/// The name, the address and the settings that stand beside it.
pub(super) fn unit(spec: &'static ControllerSpec) -> Vec<Placed<Antenna>> {
    let settings = spec.settings.iter().filter(|setting| setting.table.is_none());
    let mut unit = vec![
        ("", Of::text("Name", not_empty, |antenna| Some(&mut antenna.name))),
        ("", address(spec)),
    ];
    unit.extend(settings.map(|setting| ("", field(setting))));
    unit
}

/// The settings that stand in tables of their own.
pub(super) fn tables(spec: &'static ControllerSpec) -> Vec<Placed<Antenna>> {
    let placed = |setting: &&'static Setting| Some((setting.table?.title, field(setting)));
    spec.settings.iter().filter_map(placed).collect()
}

pub(super) fn not_empty(text: &str) -> Checked {
    if text.is_empty() { Err("must not be empty") } else { Ok(()) }
}

fn address(spec: &'static ControllerSpec) -> Of {
    let (label, note) = match spec.link {
        Link::Tcp => (format!("Address of the {}", spec.short_name), None),
        Link::Line { .. } => {
            let words = "A serial port, such as /dev/ttyUSB0 or COM3, or the host and port of \
                         a serial server.";
            ("Port or address".to_owned(), Some(words.to_owned()))
        }
    };
    let write = |antenna: &Antenna| Some(antenna.connection.address.clone());
    let read = |antenna: &mut Antenna, text: &str| {
        spec.check_address(text)?;
        text.clone_into(&mut antenna.connection.address);
        Ok(())
    };
    Of::written(label, Look::Words, write, read).noted(move |_| note.clone())
}

fn field(setting: &'static Setting) -> Of {
    let look = match &setting.holds {
        Holds::Text => Look::Words,
        Holds::OneOf(choices) => Look::Choice(choices.iter().map(|(_, name)| *name).collect()),
        Holds::Whole(_) => Look::Number,
        Holds::Points => Look::Lines { hint: "counts degrees, one pair a line" },
    };
    Of::written(
        setting.label,
        look,
        |antenna| Some(text(&setting.holds, antenna.connection.value(setting))),
        |antenna, text| antenna.connection.put(setting, value(setting, text)?),
    )
    .noted(|antenna| {
        let value = antenna.connection.value(setting);
        let of_setting = (setting.note)(value).map(str::to_owned);
        of_setting.or_else(|| fit(antenna.connection.points(setting)))
    })
}

/// A value as it is shown and typed.
fn text(holds: &Holds, value: &Value) -> String {
    if let Holds::OneOf(choices) = holds {
        let chosen = choices.iter().find(|(choice, _)| choice == value);
        return chosen.map(|(_, name)| (*name).to_owned()).unwrap_or_default();
    }
    match value {
        Value::Text(text) => text.clone(),
        Value::Word(word) => (*word).to_owned(),
        Value::Whole(number) => number.to_string(),
        Value::Points(points) => points::write(points),
    }
}

/// The value that is meant by what is typed.
fn value(setting: &Setting, text: &str) -> Result<Value, String> {
    let value = match &setting.holds {
        Holds::Text => Some(text.into()),
        Holds::OneOf(choices) => {
            let named = choices.iter().find(|(_, name)| *name == text);
            named.map(|(choice, _)| choice.clone())
        }
        Holds::Whole(_) => text.parse().ok().map(Value::Whole),
        Holds::Points => Some(points::read(text)?.into()),
    };
    value.ok_or_else(|| setting.wanted())
}

/// How well the points of one axis fit a straight line.
fn fit(points: &[CountPoint]) -> Option<String> {
    // Two points are always on it.
    let line = CountLine::through(points).ok().filter(|_| points.len() > 2)?;
    let residuals = line.residuals_deg(points);
    let all: Vec<String> = residuals.iter().map(|off| format::signed(*off, 2)).collect();
    let largest =
        points.iter().zip(&residuals).max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
    let (point, _) = largest?;
    let all = all.join("°, ");
    Some(format!("Off a straight line by {all}°, the most at {} counts.", point.counts))
}
