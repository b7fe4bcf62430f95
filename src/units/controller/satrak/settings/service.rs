//! Service functions: calibration, drive scaling, image (sections 14, 15 and 29
//! to 32).

use super::{
    desired::{Desired, cannot},
    proof::Proof,
    text,
};
use crate::{
    device::settings::{Field, Group, Key, Kind, Values, WriteError},
    protocol::satrak::{AngleChange, Reduction, Reply, SensorAngles, Setting},
};

const FIXED_ADDRESS: i64 = 0;
const PRESENT: i64 = 1;

const REFERENCE: Key<i64> =
    Key::choice("reference", &[(FIXED_ADDRESS, "As entered below"), (PRESENT, "Present position")]);
const X_SENSOR: Key<i64> = Key::integer("x_sensor", 0, 65_535);
const X_DEG: Key<f64> = Key::decimal("x_deg", -360.0, 360.0, 1);
const Y_SENSOR: Key<i64> = Key::integer("y_sensor", 0, 65_535);
const Y_DEG: Key<f64> = Key::decimal("y_deg", -360.0, 360.0, 1);
const X_RATIO: Key<f64> = Key::decimal("x", 0.001, 1_000_000.0, 0);
const Y_RATIO: Key<f64> = Key::decimal("y", 0.001, 1_000_000.0, 0);
const STATUS: Key<String> = Key::text("status", text);
const FILE: Key<String> = Key::text("file", text);

const X_REFERENCE: &str = "x_reference";
const Y_REFERENCE: &str = "y_reference";

pub static ANGLES: Group = Group {
    key: "angles",
    title: "Angle calibration",
    is_service: true,
    fields: &[
        Field::write(REFERENCE, "Sensor references").moving().description(
            "Present position: the unit takes the references from its present position.",
        ),
        Field::edit(X_SENSOR, "X sensor reference").part_of(X_REFERENCE).moving(),
        Field::edit(X_DEG, "X angle at reference").part_of(X_REFERENCE).moving().in_unit("°"),
        Field::edit(Y_SENSOR, "Y sensor reference").part_of(Y_REFERENCE).moving(),
        Field::edit(Y_DEG, "Y angle at reference").part_of(Y_REFERENCE).moving().in_unit("°"),
    ],
};

pub static REDUCTION: Group = Group {
    key: "reduction",
    title: "Drive reduction",
    is_service: true,
    fields: &[
        Field::edit(X_RATIO, "X reduction").moving().description("Its unit is not documented."),
        Field::edit(Y_RATIO, "Y reduction").moving().description("Its unit is not documented."),
    ],
};

pub static IMAGE: Group = Group {
    key: "image",
    title: "System image",
    is_service: true,
    fields: &[
        Field::read(STATUS, "Update status")
            .description("As the unit reports it: its values are not documented."),
        Field::write(FILE, "Image file")
            .moving()
            .description("On the unit. Presumably firmware or configuration."),
    ],
};

pub(super) fn angles(reply: &Reply) -> Option<Values> {
    let Reply::AngleSettings(angles) = reply else { return None };
    Some(Values::from([
        X_SENSOR.entry(angles.x_sensor),
        X_DEG.entry(angles.x_deg),
        Y_SENSOR.entry(angles.y_sensor),
        Y_DEG.entry(angles.y_deg),
    ]))
}

pub(super) fn reduction(reply: &Reply) -> Option<Values> {
    let Reply::Reduction(reduction) = reply else { return None };
    Some(Values::from([X_RATIO.entry(reduction.x()), Y_RATIO.entry(reduction.y())]))
}

pub(super) fn image(reply: &Reply) -> Option<Values> {
    let Reply::ImageStatus(status) = reply else { return None };
    Some(Values::from([STATUS.entry(status.raw.clone())]))
}

pub(super) fn write_angles(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    let angles = SensorAngles::new(desired.get(&X_DEG)?, desired.get(&Y_DEG)?)
        .map_err(cannot(X_DEG.name))?;
    let change = if desired.get(&REFERENCE).unwrap_or(FIXED_ADDRESS) == PRESENT {
        AngleChange::PresentPosition(angles)
    } else {
        AngleChange::Given {
            x_sensor: desired.whole(&X_SENSOR)?,
            y_sensor: desired.whole(&Y_SENSOR)?,
            angles,
        }
    };
    Ok(Setting::AngleSettings(change))
}

pub(super) fn write_reduction(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    let reduction = Reduction::new(desired.get(&X_RATIO)?, desired.get(&Y_RATIO)?);
    reduction.map(Setting::Reduction).map_err(cannot(X_RATIO.name))
}

pub(super) fn write_image(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    Ok(Setting::LoadImage(desired.text(&FILE)?))
}

/// Returns the fields that differ. References that the unit takes from its current position are not
/// known in advance and always match.
pub(super) fn angles_differing(proof: &Proof<'_>) -> Vec<&'static str> {
    let takes_present = REFERENCE.get(proof.new) == Some(PRESENT);
    proof.differing(|field, new, current| {
        let is_measured = takes_present && matches!(field.kind, Kind::Integer { .. });
        is_measured || field.kind.same(new, current)
    })
}
