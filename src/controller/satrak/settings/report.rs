//! What the unit only reports (sections 1 and 17).

use crate::{
    device::settings::{Field, Group, Kind, Value, Values},
    protocol::satrak::{TimedPosition, Version},
};

const TEXT: Kind = Kind::Text(super::text);
const ANGLE: Kind = Kind::Decimal { least: -360.0, most: 360.0, places: 2 };

pub(super) static VERSIONS: Group = Group {
    key: "versions",
    title: "Versions",
    is_service: false,
    fields: &[
        Field::read("control_unit", "Control unit", TEXT),
        Field::read("drive_unit", "Drive unit", TEXT),
    ],
};

pub(super) static POSITION: Group = Group {
    key: "position",
    title: "Time-stamped position",
    is_service: false,
    fields: &[
        Field::read("x_deg", "First angle", ANGLE)
            .in_unit("°")
            .about("X as the document says; its example rather looks like an azimuth."),
        Field::read("y_deg", "Second angle", ANGLE).in_unit("°"),
        Field::read("time", "Measured at", Kind::Time).in_unit("UTC"),
    ],
};

pub(super) fn versions(version: &Version) -> Values {
    let mut values = Values::from([("control_unit", Value::Text(version.control_unit.clone()))]);
    values.extend(version.drive_unit.clone().map(|drive| ("drive_unit", Value::Text(drive))));
    values
}

pub(super) fn position(position: &TimedPosition) -> Values {
    [
        ("x_deg", Value::Decimal(position.x_deg)),
        ("y_deg", Value::Decimal(position.y_deg)),
        ("time", Value::Time(position.time)),
    ]
    .into()
}
