//! Shapes of the icons.

mod elements;

use super::{
    Icon,
    pen::{Pen, arc_points},
};

/// Stroke of check and cross, grid units: heavy enough to be legible at 12 points.
const HEAVY: f32 = 2.0;
/// Number of vertices for a smooth ellipse of 20 points.
const ELLIPSE_POINTS: usize = 32;

#[expect(clippy::too_many_lines, reason = "one arm an icon")]
pub(super) fn draw(pen: &Pen<'_>, icon: Icon) {
    match icon {
        Icon::Octagon => pen.outline(&[
            (6.7, 2.0),
            (13.3, 2.0),
            (18.0, 6.7),
            (18.0, 13.3),
            (13.3, 18.0),
            (6.7, 18.0),
            (2.0, 13.3),
            (2.0, 6.7),
        ]),
        Icon::Bell => bell(pen),
        Icon::Warning => {
            pen.line(&[(10.0, 2.8), (18.2, 17.0), (1.8, 17.0), (10.0, 2.8)]);
            pen.line(&[(10.0, 8.0), (10.0, 11.8)]);
            pen.disc((10.0, 14.4), 1.0);
        }
        Icon::Check => pen.thick_line(&[(3.5, 10.5), (8.0, 15.0), (16.5, 5.5)], HEAVY),
        Icon::Cross => {
            pen.thick_line(&[(4.5, 4.5), (15.5, 15.5)], HEAVY);
            pen.thick_line(&[(15.5, 4.5), (4.5, 15.5)], HEAVY);
        }
        Icon::Dash => pen.thick_line(&[(4.0, 10.0), (16.0, 10.0)], HEAVY),
        Icon::Lock => {
            pen.line(&[(4.5, 9.0), (15.5, 9.0), (15.5, 17.5), (4.5, 17.5), (4.5, 9.0)]);
            pen.line(&[(6.8, 9.0), (6.8, 6.0)]);
            pen.arc((10.0, 6.0), 3.2, 180.0, 360.0);
            pen.line(&[(13.2, 6.0), (13.2, 9.0)]);
        }
        Icon::ChevronDown => pen.line(&[(5.0, 7.5), (10.0, 12.5), (15.0, 7.5)]),
        Icon::ChevronRight => pen.line(&[(7.5, 5.0), (12.5, 10.0), (7.5, 15.0)]),
        Icon::ChevronLeft => pen.line(&[(12.5, 5.0), (7.5, 10.0), (12.5, 15.0)]),
        Icon::CrossHair => {
            pen.ring((10.0, 10.0), 5.5);
            pen.line(&[(10.0, 1.8), (10.0, 7.2)]);
            pen.line(&[(10.0, 12.8), (10.0, 18.2)]);
            pen.line(&[(1.8, 10.0), (7.2, 10.0)]);
            pen.line(&[(12.8, 10.0), (18.2, 10.0)]);
        }
        Icon::Bars => {
            for (x, y) in [(3.0, 3.5), (6.5, 8.5), (4.5, 13.5)] {
                pen.line(&[(x, y), (x + 10.0, y), (x + 10.0, y + 3.0), (x, y + 3.0), (x, y)]);
            }
        }
        Icon::Orbit => {
            pen.disc((10.0, 10.0), 2.5);
            pen.outline(&ellipse((10.0, 10.0), 8.2, 3.6, -30.0));
            pen.disc((16.0, 5.2), 1.6);
        }
        Icon::Clock => {
            pen.ring((10.0, 10.0), 7.5);
            pen.line(&[(10.0, 5.5), (10.0, 10.0), (13.5, 12.0)]);
        }
        Icon::Prompt => {
            pen.line(&[(2.0, 3.5), (18.0, 3.5), (18.0, 16.5), (2.0, 16.5), (2.0, 3.5)]);
            pen.line(&[(5.0, 7.5), (8.0, 10.2), (5.0, 13.0)]);
            pen.line(&[(10.0, 13.0), (14.0, 13.0)]);
        }
        Icon::Pulse => pen.line(&[
            (2.0, 11.0),
            (5.5, 11.0),
            (8.0, 4.0),
            (11.5, 16.5),
            (13.5, 9.0),
            (15.0, 11.0),
            (18.0, 11.0),
        ]),
        Icon::Globe => {
            pen.ring((10.0, 10.0), 7.5);
            pen.outline(&ellipse((10.0, 10.0), 3.2, 7.5, 0.0));
            pen.line(&[(2.5, 10.0), (17.5, 10.0)]);
        }
        Icon::Sliders => sliders(pen),
        Icon::Antenna => antenna(pen),
        Icon::Pencil => {
            pen.outline(&[(3.0, 17.0), (4.2, 12.6), (13.4, 3.4), (16.6, 6.6), (7.4, 15.8)]);
            pen.line(&[(11.2, 5.6), (14.4, 8.8)]);
        }
        Icon::Eye => {
            pen.outline(&ellipse((10.0, 10.0), 8.0, 5.0, 0.0));
            pen.ring((10.0, 10.0), 2.4);
        }
        Icon::Disc => pen.disc((10.0, 10.0), 6.5),
        Icon::HalfDisc => {
            pen.ring((10.0, 10.0), 6.5);
            pen.filled(&arc_points((10.0, 10.0), 6.5, 90.0, 270.0));
        }
        Icon::CrossedRing => {
            pen.ring((10.0, 10.0), 7.5);
            pen.line(&[(7.0, 7.0), (13.0, 13.0)]);
            pen.line(&[(13.0, 7.0), (7.0, 13.0)]);
        }
        Icon::OpenRing => pen.ring((10.0, 10.0), 6.5),
        Icon::Layers => {
            pen.line(&[(10.0, 3.0), (17.5, 7.2), (10.0, 11.4), (2.5, 7.2), (10.0, 3.0)]);
            pen.line(&[(2.5, 10.2), (10.0, 14.4), (17.5, 10.2)]);
            pen.line(&[(2.5, 13.2), (10.0, 17.4), (17.5, 13.2)]);
        }
        Icon::Info => {
            pen.ring((10.0, 10.0), 7.5);
            pen.line(&[(10.0, 9.4), (10.0, 13.8)]);
            pen.disc((10.0, 6.5), 1.0);
        }
        Icon::Question => {
            pen.ring((10.0, 10.0), 7.5);
            pen.arc((10.0, 8.0), 2.3, 190.0, 405.0);
            pen.line(&[(11.6, 9.6), (10.0, 11.0), (10.0, 11.8)]);
            pen.disc((10.0, 14.2), 1.0);
        }
        other => elements::draw(pen, other),
    }
}

/// Draws a dish that looks up, with its feed, on a foot.
fn antenna(pen: &Pen<'_>) {
    pen.outline(&arc_points((9.5, 9.5), 7.0, 45.0, 225.0));
    pen.line(&[(9.5, 9.5), (13.6, 5.4)]);
    pen.disc((14.4, 4.6), 1.6);
    pen.line(&[(7.0, 16.0), (5.6, 18.0)]);
    pen.line(&[(3.4, 18.0), (13.0, 18.0)]);
}

fn bell(pen: &Pen<'_>) {
    pen.line(&[(5.0, 13.5), (5.0, 9.0)]);
    pen.arc((10.0, 8.5), 5.0, 180.0, 360.0);
    pen.line(&[(15.0, 9.0), (15.0, 13.5)]);
    pen.line(&[(3.2, 14.8), (5.0, 13.5)]);
    pen.line(&[(15.0, 13.5), (16.8, 14.8)]);
    pen.line(&[(3.2, 14.8), (16.8, 14.8)]);
    pen.arc((10.0, 15.6), 2.0, 20.0, 160.0);
    pen.line(&[(10.0, 2.2), (10.0, 3.4)]);
}

fn sliders(pen: &Pen<'_>) {
    for (y, knob) in [(4.5, 13.0), (10.0, 6.5), (15.5, 11.0)] {
        pen.line(&[(2.5, y), (knob - 2.0, y)]);
        pen.line(&[(knob + 2.0, y), (17.5, y)]);
        pen.ring((knob, y), 2.0);
    }
}

/// Draws half a disc with its ground line: the sky over the station.
pub(super) fn bowl(pen: &Pen<'_>) {
    pen.arc((10.0, 16.0), 8.0, 180.0, 360.0);
    pen.line(&[(1.5, 16.0), (18.5, 16.0)]);
}

/// Draws the line of sight with the satellite at its end.
pub(super) fn feed(pen: &Pen<'_>) {
    pen.line(&[(10.0, 16.0), (14.2, 5.5)]);
    pen.disc((14.8, 4.0), 2.2);
}

/// Returns the points of an ellipse with these half axes. `turned_deg` turns the long axis
/// clockwise from the right.
fn ellipse(
    (x, y): (f32, f32),
    long: f32,
    short: f32,
    turned_deg: f32,
) -> [(f32, f32); ELLIPSE_POINTS] {
    let (sin, cos) = turned_deg.to_radians().sin_cos();
    std::array::from_fn(|index| {
        let angle = std::f32::consts::TAU * index as f32 / ELLIPSE_POINTS as f32;
        let (along, across) = (long * angle.cos(), short * angle.sin());
        (x + along * cos - across * sin, y + along * sin + across * cos)
    })
}
