//! Fields of an antenna that depend on its make: the address of the unit and the settings of the
//! connection. The description of the make defines all of them.

use super::fields::{Description, Placed};
use crate::{
    device::{
        CountLine, CountPoint,
        settings::{Kind, Unfit, Value},
    },
    station::{Antenna, ControllerSpec, Link, Setting},
    ui::format,
};

type ConnectionDescription = Description<Antenna>;

/// Title of the section with the name and the connection.
pub(in crate::ui) const CONNECTION: &str = "Connection";

/// Index of the address among the fields of an antenna, after its name.
pub(in crate::ui) const ADDRESS: usize = 1;

/// Returns the fields of name and address, and the settings without a table.
pub(super) fn unit(spec: &'static ControllerSpec) -> Vec<Placed<Antenna>> {
    let settings = spec.settings.iter().filter(|setting| setting.table.is_none());
    let mut unit = vec![
        (
            CONNECTION,
            ConnectionDescription::text("Name", not_empty, |antenna| Some(&mut antenna.name)),
        ),
        (CONNECTION, address(spec)),
    ];
    unit.extend(settings.map(|setting| (CONNECTION, field(setting))));
    unit
}

/// Returns the settings that have their own tables.
pub(super) fn tables(spec: &'static ControllerSpec) -> Vec<Placed<Antenna>> {
    let placed = |setting: &&'static Setting| Some((setting.table?.title, field(setting)));
    spec.settings.iter().filter_map(placed).collect()
}

pub(super) fn not_empty(text: &str) -> Result<(), Unfit> {
    if text.is_empty() { Err(Unfit::Text("must not be empty".to_owned())) } else { Ok(()) }
}

fn address(spec: &'static ControllerSpec) -> ConnectionDescription {
    let (label, note) = match spec.link {
        Link::Tcp => (format!("Address of the {}", spec.short_name), None),
        Link::Line { .. } => {
            let words = "A serial port, such as /dev/ttyUSB0 or COM3, or the host and port of \
                         a serial server.";
            ("Port or address".to_owned(), Some(words.to_owned()))
        }
    };
    let get = |antenna: &mut Antenna| Some(Value::Text(antenna.connection.address.clone()));
    let put = |antenna: &mut Antenna, value| {
        if let Value::Text(address) = value {
            spec.check_address(&address)?;
            antenna.connection.address = address;
        }
        Ok(())
    };
    ConnectionDescription::new(label, Kind::Text(|_| Ok(())), get, put).noted(move |_| note.clone())
}

fn field(setting: &'static Setting) -> ConnectionDescription {
    ConnectionDescription::new(
        setting.field.label,
        setting.field.kind,
        |antenna| antenna.connection.value(setting).cloned(),
        |antenna, value| {
            antenna.connection.put(setting, value).map_err(|reason| reason.to_string())
        },
    )
    .noted(|antenna| {
        let of_setting = antenna.connection.value(setting).and_then(setting.note);
        let of_points = || fit(antenna.connection.points(setting));
        of_setting.map(str::to_owned).or_else(of_points)
    })
}

/// Describes the quality of the straight line through the points of one axis.
fn fit(points: &[CountPoint]) -> Option<String> {
    // Two points always lie on the line.
    let line = CountLine::from_points(points).ok().filter(|_| points.len() > 2)?;
    let residuals = line.residuals_deg(points);
    let all: Vec<String> =
        residuals.iter().map(|deviation| format::signed(*deviation, 2)).collect();
    let largest =
        points.iter().zip(&residuals).max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
    let (point, _) = largest?;
    let all = all.join("°, ");
    Some(format!("Off a straight line by {all}°, most at {} counts.", point.counts))
}
