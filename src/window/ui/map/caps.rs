//! Circles on the ground: footprints and the night.

use egui::{Color32, Mesh, Pos2};

use super::projection::Projection;
use crate::astro::{Cap, CapRow};

/// Fills a cap with a mesh, because egui fills only convex shapes.
pub(super) fn fill(projection: &Projection, cap: &Cap, colour: Color32) -> Mesh {
    let centre_deg = cap.centre.longitude.degrees() as f32;
    let mut mesh = Mesh::default();
    for turn in projection.turns(centre_deg - 180.0, centre_deg + 180.0) {
        let mut above = None;
        for row in cap.rows() {
            let first = mesh.vertices.len() as u32;
            for (longitude, latitude) in ends(centre_deg, &row) {
                mesh.colored_vertex(projection.point_at(longitude + turn, latitude), colour);
            }
            if let Some(above) = above {
                mesh.add_triangle(above, above + 1, first);
                mesh.add_triangle(above + 1, first, first + 1);
            }
            above = Some(first);
        }
    }
    mesh
}

/// Returns the edge of a cap on every visible turn: a closed line, or around a pole a line from
/// edge to edge of the world.
pub(super) fn outline(projection: &Projection, cap: &Cap) -> Vec<Vec<Pos2>> {
    let centre_deg = cap.centre.longitude.degrees() as f32;
    let edge = cap.edge();
    let side =
        |end: usize| edge.iter().filter_map(move |row| ends(centre_deg, row).get(end).copied());
    let is_open = |row: Option<&CapRow>| row.is_some_and(|row| row.half_width.degrees() > 179.0);
    let (west, east): (Vec<_>, Vec<_>) = (side(0).collect(), side(1).collect());
    let down_and_up = |down: Vec<(f32, f32)>, up: Vec<(f32, f32)>| {
        down.into_iter().chain(up.into_iter().rev()).collect::<Vec<_>>()
    };
    let line = if is_open(edge.last()) {
        // Over the South Pole the line goes up one side and down the other.
        west.into_iter().rev().chain(east).collect()
    } else {
        let mut line = down_and_up(east, west);
        if !is_open(edge.first()) {
            line.extend(line.first().copied());
        }
        line
    };
    projection.copies(&line)
}

/// Returns the west and the east end of a row as longitude, beyond 180 degrees without a wrap, and
/// latitude.
fn ends(centre_deg: f32, row: &CapRow) -> [(f32, f32); 2] {
    let (half_width, latitude) = (row.half_width.degrees() as f32, row.latitude.degrees() as f32);
    [(centre_deg - half_width, latitude), (centre_deg + half_width, latitude)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::{Angle, GroundPoint},
        ui::map::projection::Zoom,
    };
    use egui::{Rect, pos2};

    const WORLD: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(720.0, 360.0) };

    fn cap(latitude_deg: f64, longitude_deg: f64, radius_deg: f64) -> Cap {
        let centre = GroundPoint::from_degrees(latitude_deg, longitude_deg);
        Cap { centre, radius: Angle::from_degrees(radius_deg) }
    }

    fn projection() -> Projection {
        Projection::new(WORLD, Zoom::default())
    }

    /// Returns `true` if the mesh covers `position`.
    fn holds(mesh: &Mesh, position: Pos2) -> bool {
        mesh.indices.as_chunks::<3>().0.iter().any(|corners| {
            let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize].pos);
            let side = |start: Pos2, end: Pos2| {
                (end.x - start.x) * (position.y - start.y)
                    - (end.y - start.y) * (position.x - start.x)
            };
            let sides = [side(a, b), side(b, c), side(c, a)];
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }

    #[test]
    fn a_cap_is_filled_where_it_is_on_the_ground() {
        for cap in [cap(10.0, 20.0, 25.0), cap(-20.0, 175.0, 30.0), cap(70.0, -100.0, 40.0)]
            .into_iter()
            .chain([cap(-80.0, 179.0, 23.0), cap(-18.0, 90.0, 89.167)])
        {
            let mesh = fill(&projection(), &cap, Color32::WHITE);
            for latitude in (-88..=88).step_by(8) {
                for longitude in (-179..180).step_by(7) {
                    let place =
                        GroundPoint::from_degrees(f64::from(latitude), f64::from(longitude));
                    let deviation = (cap.centre.distance(place) - cap.radius).degrees();
                    if deviation.abs() > 1.0 {
                        let position = projection().point(place);
                        assert_eq!(holds(&mesh, position), deviation < 0.0, "{cap:?} {place:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn an_outline_is_closed_unless_it_goes_round_a_pole() {
        let is_closed = |line: &Vec<Pos2>| line[0].distance(line[line.len() - 1]) < 0.1;
        for (cap, copies) in [(cap(10.0, 20.0, 25.0), 1), (cap(-20.0, 175.0, 30.0), 2)] {
            let lines = outline(&projection(), &cap);
            assert_eq!(lines.len(), copies);
            assert!(lines.iter().all(is_closed));
        }
        for cap in [cap(80.0, 30.0, 23.0), cap(-80.0, 30.0, 23.0)] {
            let lines = outline(&projection(), &cap);
            let longest = |line: &Vec<Pos2>| {
                line.windows(2).map(|pair| pair[0].distance(pair[1])).fold(0.0, f32::max)
            };
            for line in &lines {
                let across = (line[0].x - line[line.len() - 1].x).abs();
                assert!((across - 720.0).abs() < 1.0, "{across}");
                assert!(longest(line) < 40.0, "no line back: {}", longest(line));
            }
        }
    }
}
