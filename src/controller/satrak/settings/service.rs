//! Service functions: calibration, drive scaling, image (sections 14, 15 and 29
//! to 32).

use super::{
    proof::Proof,
    text,
    wish::{Wish, cannot},
};
use crate::{
    device::settings::{Field, Group, Kind, SettleError, Value, Values},
    protocol::satrak::{AngleChange, AngleSettings, ImageStatus, Reduction, SensorAngles, Setting},
};

const COUNT: Kind = Kind::Integer { least: 0, most: 65_535 };
const ANGLE: Kind = Kind::Decimal { least: -360.0, most: 360.0, places: 1 };
const RATIO: Kind = Kind::Decimal { least: 0.001, most: 1_000_000.0, places: 0 };

const GIVEN: i64 = 0;
const PRESENT: i64 = 1;

pub(super) static ANGLES: Group = Group {
    key: "angles",
    title: "Angle calibration",
    is_service: true,
    fields: &[
        Field::write(
            "reference",
            "Sensor references",
            Kind::Choice(&[(GIVEN, "As given"), (PRESENT, "Present position")]),
        )
        .moving()
        .about("Present position: the unit takes the references from where it stands."),
        Field::edit("x_sensor", "X sensor reference", COUNT).moving(),
        Field::edit("x_deg", "X angle at it", ANGLE).moving().in_unit("°"),
        Field::edit("y_sensor", "Y sensor reference", COUNT).moving(),
        Field::edit("y_deg", "Y angle at it", ANGLE).moving().in_unit("°"),
    ],
};

pub(super) static REDUCTION: Group = Group {
    key: "reduction",
    title: "Drive reduction",
    is_service: true,
    fields: &[
        Field::edit("x", "X reduction", RATIO).moving().about("Its unit is not documented."),
        Field::edit("y", "Y reduction", RATIO).moving().about("Its unit is not documented."),
    ],
};

pub(super) static IMAGE: Group = Group {
    key: "image",
    title: "System image",
    is_service: true,
    fields: &[
        Field::read("status", "Update status", Kind::Text(text))
            .about("As the unit says it: its values are not documented."),
        Field::write("file", "Image file", Kind::Text(text))
            .moving()
            .about("On the unit. Presumably firmware or configuration."),
    ],
};

pub(super) fn angles(angles: &AngleSettings) -> Values {
    [
        ("x_sensor", Value::Integer(angles.x_sensor)),
        ("x_deg", Value::Decimal(angles.x_deg)),
        ("y_sensor", Value::Integer(angles.y_sensor)),
        ("y_deg", Value::Decimal(angles.y_deg)),
    ]
    .into()
}

pub(super) fn reduction(reduction: Reduction) -> Values {
    [("x", Value::Decimal(reduction.x())), ("y", Value::Decimal(reduction.y()))].into()
}

pub(super) fn image(status: &ImageStatus) -> Values {
    [("status", Value::Text(status.raw.clone()))].into()
}

pub(super) fn write_angles(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    let angles = SensorAngles::new(wish.decimal("x_deg")?, wish.decimal("y_deg")?)
        .map_err(cannot("x_deg"))?;
    let change = if wish.code("reference").unwrap_or(GIVEN) == PRESENT {
        AngleChange::PresentPosition(angles)
    } else {
        AngleChange::Given {
            x_sensor: wish.integer("x_sensor")?,
            y_sensor: wish.integer("y_sensor")?,
            angles,
        }
    };
    Ok(Setting::AngleSettings(change))
}

pub(super) fn write_reduction(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    let reduction = Reduction::new(wish.decimal("x")?, wish.decimal("y")?).map_err(cannot("x"))?;
    Ok(Setting::Reduction(reduction))
}

pub(super) fn write_image(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    Ok(Setting::LoadImage(wish.text("file")?))
}

/// Where the references are taken from the present position, nobody knows them
/// before.
pub(super) fn angles_differing(proof: &Proof<'_>) -> Vec<&'static str> {
    let takes_present = proof.new.get("reference") == Some(&Value::Choice(PRESENT));
    proof.differing(|field, new, held| {
        let is_measured = takes_present && matches!(field.kind, Kind::Integer { .. });
        is_measured || field.kind.same(new, held)
    })
}
