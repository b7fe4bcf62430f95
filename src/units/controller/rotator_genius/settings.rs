//! The configuration of the rotators that the unit stores (section 1.1 of its document), one
//! group for each.
//!
//! Azel always sends a whole configuration, but the unit does not report all of it. The stop offset
//! cannot be read, and differs from the "Offset" of a status. A status has names of 12 characters,
//! a configuration of 10.

use crate::{
    device::settings::{Field, Group, Key, Unfit, Values, WriteError},
    protocol::rotator_genius::{
        Configuration, MAX_STOP_OFFSET_DEG, Rotator, RotatorKind, RotatorName, RotatorNumber,
        Status, WholeDegrees,
    },
};

const LIMIT_CW: Key<i64> = Key::integer("limit_cw_deg", 0, 360);
const LIMIT_CCW: Key<i64> = Key::integer("limit_ccw_deg", 0, 360);
const KIND: Key<i64> = Key::choice("kind", &[(0, "Azimuth"), (1, "Elevation")]);
const STOP_OFFSET: Key<i64> = Key::integer("stop_offset_deg", 0, MAX_STOP_OFFSET_DEG as i64);
const NAME: Key<String> = Key::text("name", check_name);

const TRAVEL: &str = "travel";

const fn fields() -> [Field; 5] {
    [
        Field::edit(LIMIT_CW, "CW limit")
            .part_of(TRAVEL)
            .in_unit("°")
            .description("The end of the travel clockwise."),
        Field::edit(LIMIT_CCW, "CCW limit")
            .part_of(TRAVEL)
            .in_unit("°")
            .description("The end of the travel counter-clockwise."),
        Field::edit(KIND, "Axis"),
        Field::write(STOP_OFFSET, "Stop offset").in_unit("°").description(
            "How early the drive is cut off before a target. The unit never reports it, so it \
             must be given with every change.",
        ),
        Field::edit(NAME, "Name").description("At most 10 characters are taken."),
    ]
}

static ROTATOR_1: Group =
    Group { key: "rotator_1", title: "Rotator 1", fields: &fields(), is_service: true };
static ROTATOR_2: Group =
    Group { key: "rotator_2", title: "Rotator 2", fields: &fields(), is_service: true };

pub static GROUPS: &[&Group] = &[&ROTATOR_1, &ROTATOR_2];

pub(super) fn group_of(number: RotatorNumber) -> &'static Group {
    match number {
        RotatorNumber::One => &ROTATOR_1,
        RotatorNumber::Two => &ROTATOR_2,
    }
}

pub(super) fn rotator_of(key: &str) -> Option<RotatorNumber> {
    RotatorNumber::ALL.into_iter().find(|number| group_of(*number).key == key)
}

fn check_name(text: &str) -> Result<(), Unfit> {
    RotatorName::new(text).map(drop).map_err(|problem| Unfit::Text(problem.to_string()))
}

/// Returns the part of a rotator's configuration that a status reports.
pub(super) fn values(status: &Status, number: RotatorNumber) -> Values {
    let Rotator { limit_cw, limit_ccw, kind, name, .. } = status.rotator(number);
    let limits = [(LIMIT_CW, limit_cw), (LIMIT_CCW, limit_ccw)].into_iter();
    let limits =
        limits.filter_map(|(key, limit)| Some(key.entry(limit.as_ref()?.degrees().into())));
    let kind = KIND.entry(i64::from(*kind == RotatorKind::Elevation));
    limits.chain([kind, NAME.entry(name.clone())]).collect()
}

/// Returns the whole configuration of a rotator: `new` values, and the unit's values for the rest.
pub(super) fn configuration(
    number: RotatorNumber,
    new: &Values,
    unit_values: &Values,
) -> Result<Configuration, WriteError> {
    let integer = |key: &Key<i64>| key.get(new).or_else(|| key.get(unit_values));
    let limit = |key: &Key<i64>| {
        let degrees = integer(key).and_then(|degrees| u16::try_from(degrees).ok());
        WholeDegrees::new(degrees.ok_or_else(|| missing(key.name))?)
            .map_err(|error| cannot(key.name, error.to_string()))
    };
    let kind = match integer(&KIND) {
        Some(0) => RotatorKind::Azimuth,
        Some(1) => RotatorKind::Elevation,
        _ => return Err(missing(KIND.name)),
    };
    let offset = integer(&STOP_OFFSET).and_then(|offset| u8::try_from(offset).ok());
    let offset = offset.ok_or_else(|| missing(STOP_OFFSET.name))?;
    let text = NAME.get(new).or_else(|| NAME.get(unit_values)).ok_or_else(|| missing(NAME.name))?;
    // Azel does not shorten a name without asking.
    let name = RotatorName::new(&text)
        .map_err(|problem| cannot(NAME.name, format!("{text:?} {problem}, give another one")))?;
    let limits = [limit(&LIMIT_CW)?, limit(&LIMIT_CCW)?];
    Configuration::new(number, limits, kind, offset, name)
        .map_err(|error| cannot(STOP_OFFSET.name, error.to_string()))
}

/// Returns the fields in which `unit_values` differs from `sent`. Azel sends and compares all.
pub(super) fn differing(group: &Group, sent: &Values, unit_values: &Values) -> Vec<&'static str> {
    let differs = |field: &&Field| match (sent.get(field.key), unit_values.get(field.key)) {
        (Some(sent), Some(current)) => !field.kind.same(sent, current),
        (sent, current) => field.key != STOP_OFFSET.name && sent.is_some() != current.is_some(),
    };
    group.fields.iter().filter(differs).map(|field| field.key).collect()
}

fn missing(field: &'static str) -> WriteError {
    cannot(field, "has no value yet, give one".to_owned())
}

fn cannot(field: &'static str, reason: String) -> WriteError {
    WriteError::CannotBeSent { field, reason: Unfit::Text(reason) }
}
