//! What the device remembers of its rotators (section 1.1 of its document), one
//! group for each.
//!
//! A configuration always goes out as a whole, and the device does not report all
//! of it: the stop offset is never read, and has nothing to do with the "Offset"
//! of a status. A status has names of 12 characters, a configuration of 10.

use crate::{
    device::settings::{Field, Group, Kind, SettleError, Unfit, Value, Values},
    protocol::rotator_genius::{
        Configuration, MAX_STOP_OFFSET_DEG, Rotator, RotatorKind, RotatorName, RotatorNumber,
        Status, WholeDegrees,
    },
};

const LIMIT_CW: &str = "limit_cw_deg";
const LIMIT_CCW: &str = "limit_ccw_deg";
const KIND: &str = "kind";
const STOP_OFFSET: &str = "stop_offset_deg";
const NAME: &str = "name";

const ANGLE: Kind = Kind::Integer { least: 0, most: 360 };
const KINDS: &[(i64, &str)] = &[(0, "Azimuth"), (1, "Elevation")];

const fn fields() -> [Field; 5] {
    [
        Field::edit(LIMIT_CW, "CW limit", ANGLE)
            .in_unit("°")
            .about("The end of the travel clockwise."),
        Field::edit(LIMIT_CCW, "CCW limit", ANGLE)
            .in_unit("°")
            .about("The end of the travel counter-clockwise."),
        Field::edit(KIND, "Turns", Kind::Choice(KINDS)),
        Field::write(STOP_OFFSET, "Stop offset", Kind::Integer { least: 0, most: MOST_OFFSET })
            .in_unit("°")
            .about(
                "How early the drive is cut off before a target. The unit never tells it, so it \
                 must be given with every change.",
            ),
        Field::edit(NAME, "Name", Kind::Text(name)).about("At most 10 characters are taken."),
    ]
}

const MOST_OFFSET: i64 = MAX_STOP_OFFSET_DEG as i64;

static ROTATOR_1: Group =
    Group { key: "rotator_1", title: "Rotator 1", fields: &fields(), is_service: true };
static ROTATOR_2: Group =
    Group { key: "rotator_2", title: "Rotator 2", fields: &fields(), is_service: true };

/// The groups of both rotators.
pub static GROUPS: &[&Group] = &[&ROTATOR_1, &ROTATOR_2];

/// The group of a rotator.
pub(super) fn group_of(number: RotatorNumber) -> &'static Group {
    match number {
        RotatorNumber::One => &ROTATOR_1,
        RotatorNumber::Two => &ROTATOR_2,
    }
}

/// The rotator of the group with this key.
pub(super) fn rotator_of(key: &str) -> Option<RotatorNumber> {
    RotatorNumber::ALL.into_iter().find(|number| group_of(*number).key == key)
}

fn name(text: &str) -> Result<(), Unfit> {
    RotatorName::new(text).map(drop).map_err(|problem| Unfit::Text(problem.to_string()))
}

/// What a status tells of the configuration of a rotator.
pub(super) fn values(status: &Status, number: RotatorNumber) -> Values {
    let Rotator { limit_cw, limit_ccw, kind, name, .. } = status.rotator(number);
    let degrees = |limit: &WholeDegrees| Value::Integer(limit.degrees().into());
    let limits = [(LIMIT_CW, limit_cw), (LIMIT_CCW, limit_ccw)];
    let limits =
        limits.into_iter().filter_map(|(key, limit)| Some((key, degrees(limit.as_ref()?))));
    let kind = Value::Choice(i64::from(*kind == RotatorKind::Elevation));
    limits.chain([(KIND, kind), (NAME, Value::Text(name.clone()))]).collect()
}

/// The whole configuration of a rotator: `new` values over those that it holds.
pub(super) fn configuration(
    number: RotatorNumber,
    new: &Values,
    held: &Values,
) -> Result<Configuration, SettleError> {
    let value = |key| new.get(key).or_else(|| held.get(key));
    let integer = |key| match value(key) {
        Some(Value::Integer(integer)) => u16::try_from(*integer).map_err(|_| missing(key)),
        _ => Err(missing(key)),
    };
    let limit =
        |key| WholeDegrees::new(integer(key)?).map_err(|error| cannot(key, error.to_string()));
    let kind = match value(KIND) {
        Some(Value::Choice(0)) => RotatorKind::Azimuth,
        Some(Value::Choice(1)) => RotatorKind::Elevation,
        _ => return Err(missing(KIND)),
    };
    let offset = u8::try_from(integer(STOP_OFFSET)?).map_err(|_| missing(STOP_OFFSET))?;
    let Some(Value::Text(text)) = value(NAME) else { return Err(missing(NAME)) };
    // A name that would be cut short is not sent unasked.
    let name = RotatorName::new(text)
        .map_err(|problem| cannot(NAME, format!("{text:?} {problem}, give another one")))?;
    let limits = [limit(LIMIT_CW)?, limit(LIMIT_CCW)?];
    Configuration::new(number, limits, kind, offset, name)
        .map_err(|error| cannot(STOP_OFFSET, error.to_string()))
}

/// The fields in which `held` is not what `sent` says. All are sent, so all are
/// looked at.
pub(super) fn differing(group: &Group, sent: &Values, held: &Values) -> Vec<&'static str> {
    let differs = |field: &&Field| match (sent.get(field.key), held.get(field.key)) {
        (Some(sent), Some(held)) => !field.kind.same(sent, held),
        (sent, held) => field.key != STOP_OFFSET && sent.is_some() != held.is_some(),
    };
    group.fields.iter().filter(differs).map(|field| field.key).collect()
}

fn missing(field: &'static str) -> SettleError {
    cannot(field, "has no value yet, give one".to_owned())
}

fn cannot(field: &'static str, reason: String) -> SettleError {
    SettleError::CannotBeSent { field, reason: Unfit::Text(reason) }
}
