//! Groups that the unit only reports (sections 1 and 17).

use jiff::Timestamp;

use crate::{
    device::settings::{Field, Group, Key, Values},
    protocol::satrak::Reply,
};

const CONTROL_UNIT: Key<String> = Key::text("control_unit", super::text);
const DRIVE_UNIT: Key<String> = Key::text("drive_unit", super::text);
const X_DEG: Key<f64> = Key::decimal("x_deg", -360.0, 360.0, 2);
const Y_DEG: Key<f64> = Key::decimal("y_deg", -360.0, 360.0, 2);
const TIME: Key<Timestamp> = Key::time("time");

pub static VERSIONS: Group = Group {
    key: "versions",
    title: "Versions",
    is_service: false,
    fields: &[Field::read(CONTROL_UNIT, "Control unit"), Field::read(DRIVE_UNIT, "Drive unit")],
};

pub static POSITION: Group = Group {
    key: "position",
    title: "Time-stamped position",
    is_service: false,
    fields: &[
        Field::read(X_DEG, "First angle")
            .in_unit("°")
            .description("X as the document says; its example rather looks like an azimuth."),
        Field::read(Y_DEG, "Second angle").in_unit("°"),
        Field::read(TIME, "Measured at"),
    ],
};

pub(super) fn versions(reply: &Reply) -> Option<Values> {
    let Reply::Version(version) = reply else { return None };
    let drive = version.drive_unit.clone().map(|drive| DRIVE_UNIT.entry(drive));
    Some([CONTROL_UNIT.entry(version.control_unit.clone())].into_iter().chain(drive).collect())
}

pub(super) fn position(reply: &Reply) -> Option<Values> {
    let Reply::TimedPosition(position) = reply else { return None };
    Some(Values::from([
        X_DEG.entry(position.x_deg),
        Y_DEG.entry(position.y_deg),
        TIME.entry(position.time),
    ]))
}
