//! The fields of an antenna that its make sets: where its controller answers
//! and what that has to know.

use super::{
    antenna_fields::has_elevation,
    fields::{Checked, Description, Look},
    points,
};
use crate::{
    station::{
        Antenna, Calibration, Connection, CountLine, CountPoint, Rotators, check_address,
        check_line, ranges,
    },
    ui::format,
};

type Of = Description<Antenna>;

pub(super) const UNIT: &[Of] = &[
    Of::text("Name", not_empty, |antenna| Some(&mut antenna.name)),
    Of::text("Address of the Satrak", check_address, |antenna| match &mut antenna.connection {
        Connection::Satrak { address, .. } => Some(address),
        _ => None,
    }),
    Of::text(
        "Element file on the unit",
        |_| Ok(()),
        |antenna| match &mut antenna.connection {
            Connection::Satrak { element_file, .. } => Some(element_file),
            _ => None,
        },
    ),
    Of::text("Address of the Genius", check_address, |antenna| match &mut antenna.connection {
        Connection::Genius { address, .. } => Some(address),
        _ => None,
    }),
    Of::choice(
        "Rotators of this antenna",
        &["Azimuth, elevation", "First one", "Second one"],
        |antenna| match &antenna.connection {
            Connection::Genius { rotators, .. } => ROTATORS.iter().position(|of| of == rotators),
            _ => None,
        },
        |antenna, index| {
            let (Connection::Genius { rotators, .. }, Some(chosen)) =
                (&mut antenna.connection, ROTATORS.get(index))
            else {
                return;
            };
            *rotators = *chosen;
        },
    )
    .noted(|antenna| {
        let words = "It turns the azimuth; the other rotator turns something else.";
        (!has_elevation(antenna)).then(|| words.to_owned())
    }),
    Of::text("Port or address", check_line, |antenna| match &mut antenna.connection {
        Connection::Rc2000c { address, .. } => Some(address),
        _ => None,
    })
    .noted(|_| {
        let words = "A serial port, such as /dev/ttyUSB0 or COM3, or the host and port of \
                     a serial server.";
        Some(words.to_owned())
    }),
    Of::choice(
        "Line speed, baud",
        &["300", "600", "1200", "2400", "4800", "9600"],
        |antenna| match &antenna.connection {
            Connection::Rc2000c { baud, .. } => ranges::BAUDS.iter().position(|of| of == baud),
            _ => None,
        },
        |antenna, index| {
            let (Connection::Rc2000c { baud, .. }, Some(chosen)) =
                (&mut antenna.connection, ranges::BAUDS.get(index))
            else {
                return;
            };
            *baud = *chosen;
        },
    ),
    Of::written("Bus address", Look::Number, write_bus_address, read_bus_address),
];

const POINTS: Look = Look::Lines { hint: "counts degrees, one pair a line" };

pub(super) const CALIBRATION: &[Of] = &[
    Of::written(
        "Azimuth counts",
        POINTS,
        |antenna| Some(points::write(&calibration(antenna)?.azimuth)),
        |antenna, text| put_points(antenna, text, |table| &mut table.azimuth),
    )
    .noted(|antenna| fit(&calibration(antenna)?.azimuth)),
    Of::written(
        "Elevation counts",
        POINTS,
        |antenna| Some(points::write(&calibration(antenna)?.elevation)),
        |antenna, text| put_points(antenna, text, |table| &mut table.elevation),
    )
    .noted(|antenna| fit(&calibration(antenna)?.elevation)),
];

const ROTATORS: [Rotators; 3] = [Rotators::Pair, Rotators::First, Rotators::Second];

pub(super) fn not_empty(text: &str) -> Checked {
    if text.is_empty() { Err("must not be empty") } else { Ok(()) }
}

fn write_bus_address(antenna: &Antenna) -> Option<String> {
    let Connection::Rc2000c { bus_address, .. } = antenna.connection else { return None };
    Some(bus_address.to_string())
}

fn read_bus_address(antenna: &mut Antenna, text: &str) -> Result<(), String> {
    let read = text.parse().ok().filter(|number| ranges::BUS_ADDRESS.contains(number));
    let (low, high) = ranges::BUS_ADDRESS.into_inner();
    let read = read.ok_or_else(|| format!("must be a whole number from {low} to {high}"))?;
    if let Connection::Rc2000c { bus_address, .. } = &mut antenna.connection {
        *bus_address = read;
    }
    Ok(())
}

fn calibration(antenna: &Antenna) -> Option<&Calibration> {
    let Connection::Rc2000c { calibration, .. } = &antenna.connection else { return None };
    Some(calibration)
}

fn put_points(
    antenna: &mut Antenna,
    text: &str,
    place: fn(&mut Calibration) -> &mut Vec<CountPoint>,
) -> Result<(), String> {
    let read = points::read(text)?;
    if let Connection::Rc2000c { calibration, .. } = &mut antenna.connection {
        *place(calibration) = read;
    }
    Ok(())
}

/// How well the points of one axis fit a straight line.
fn fit(points: &[CountPoint]) -> Option<String> {
    if points.is_empty() {
        let words = "Not calibrated: the antenna is shown in counts and goes to no angle.";
        return Some(words.to_owned());
    }
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
