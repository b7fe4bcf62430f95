//! Land, read once from the asset. Azel makes the triangles of land and grid once for each section
//! of the map.

use std::sync::{Arc, LazyLock};

use egui::{
    Color32, Mesh, Painter, Pos2, Shape, Stroke, TextureId,
    epaint::{PathShape, TessellationOptions, Tessellator},
};

use super::{grid, projection::Projection};
use crate::ui::tokens::Tokens;

/// Asset with the land, described in `assets/map/README.md`.
static ASSET: &[u8] = include_bytes!("../../../../assets/map/land-110m.bin");

static OUTLINES: LazyLock<Outlines> = LazyLock::new(|| Outlines::read(ASSET).unwrap_or_default());

/// Outlines of the land by longitude and latitude, degrees. Longitudes continue across the date
/// line.
#[derive(Debug, Default)]
struct Outlines {
    rings: Vec<Vec<(f32, f32)>>,
    triangles: Vec<[u32; 3]>,
}

impl Outlines {
    fn read(bytes: &[u8]) -> Option<Self> {
        let mut numbers = bytes.chunks_exact(2).map(|pair| match pair {
            [low, high] => u16::from_le_bytes([*low, *high]),
            _ => 0,
        });
        let rings = numbers.next()?;
        let triangles = numbers.next()?;
        let lengths: Vec<u16> = numbers.by_ref().take(usize::from(rings)).collect();
        let mut point = || {
            let degrees = |number: u16| f32::from(number.cast_signed()) / 100.0;
            Some((degrees(numbers.next()?), degrees(numbers.next()?)))
        };
        let ring = |length: &u16| (0..*length).map(|_| point()).collect::<Option<Vec<_>>>();
        let rings = lengths.iter().map(ring).collect::<Option<Vec<_>>>()?;
        let mut corner = || numbers.next().map(u32::from);
        let triangle = |_| Some([corner()?, corner()?, corner()?]);
        let triangles = (0..triangles).map(triangle).collect::<Option<Vec<_>>>()?;
        Some(Self { rings, triangles })
    }

    fn points(&self) -> impl Iterator<Item = (f32, f32)> + '_ {
        self.rings.iter().flatten().copied()
    }

    /// Returns the coasts, without the line that closes the land around the South Pole.
    fn coasts(&self) -> impl Iterator<Item = Vec<(f32, f32)>> + '_ {
        let is_pole = |(_, latitude): &(f32, f32)| *latitude <= -89.99;
        self.rings.iter().map(move |ring| {
            let mut coast: Vec<_> =
                ring.iter().take_while(|point| !is_pole(point)).copied().collect();
            if coast.len() == ring.len() {
                coast.extend(ring.first().copied());
            }
            coast
        })
    }
}

/// Shapes of land and grid for one section of the map.
pub(super) struct Land {
    made_of: MadeOf,
    fill: Arc<Mesh>,
    coast: Arc<Mesh>,
    grid: Arc<Mesh>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct MadeOf {
    projection: Projection,
    pixels_per_point: f32,
    colours: [Color32; 3],
}

/// Paints the land and the grid. Reuses the shapes of the last frame if nothing changed.
pub(super) fn paint(
    painter: &Painter,
    projection: Projection,
    has_grid: bool,
    stored: &mut Option<Land>,
    t: &Tokens,
) {
    let pixels_per_point = painter.pixels_per_point();
    let made_of = MadeOf { projection, pixels_per_point, colours: [t.mask, t.hatch, t.grid] };
    let land = match stored.take() {
        Some(land) if land.made_of == made_of => land,
        _ => Land::new(made_of),
    };
    painter.add(Shape::Mesh(Arc::clone(&land.fill)));
    painter.add(Shape::Mesh(Arc::clone(&land.coast)));
    if has_grid {
        painter.add(Shape::Mesh(Arc::clone(&land.grid)));
    }
    *stored = Some(land);
}

impl Land {
    fn new(made_of: MadeOf) -> Self {
        let outlines = &*OUTLINES;
        let [fill, coast, grid] = made_of.colours;
        Self {
            made_of,
            fill: Arc::new(filled(outlines, made_of.projection, fill)),
            coast: Arc::new(drawn(outlines, &made_of, coast)),
            grid: Arc::new(grid::lines(made_of.projection, grid)),
        }
    }
}

fn filled(outlines: &Outlines, projection: Projection, colour: Color32) -> Mesh {
    let mut mesh = Mesh::with_texture(TextureId::default());
    // Siberia, the easternmost land, reaches beyond the date line.
    for turn in projection.turns(-180.0, 191.0) {
        let first = mesh.vertices.len() as u32;
        for (longitude, latitude) in outlines.points() {
            mesh.colored_vertex(projection.point_at(longitude + turn, latitude), colour);
        }
        for [a, b, c] in &outlines.triangles {
            mesh.add_triangle(first + a, first + b, first + c);
        }
    }
    mesh
}

/// Returns the coasts as triangles, to avoid their tessellation in every frame.
fn drawn(outlines: &Outlines, made_of: &MadeOf, colour: Color32) -> Mesh {
    let options = TessellationOptions::default();
    let mut tessellator = Tessellator::new(made_of.pixels_per_point, options, [1, 1], Vec::new());
    let mut mesh = Mesh::default();
    for coast in outlines.coasts() {
        for line in made_of.projection.copies(&coast) {
            let points: Vec<Pos2> = line;
            let path = PathShape::line(points, Stroke::new(1.0, colour));
            tessellator.tessellate_path(&path, &mut mesh);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_land(latitude_deg: f32, longitude_deg: f32) -> bool {
        let points: Vec<(f32, f32)> = OUTLINES.points().collect();
        let point = |corner: u32| points[corner as usize];
        [-360.0, 0.0, 360.0].iter().any(|turn| {
            let here = (longitude_deg + turn, latitude_deg);
            OUTLINES.triangles.iter().any(|[a, b, c]| {
                let side = |(x, y): (f32, f32), (u, v): (f32, f32)| {
                    (u - x) * (here.1 - y) - (v - y) * (here.0 - x)
                };
                let [a, b, c] = [point(*a), point(*b), point(*c)];
                let sides = [side(a, b), side(b, c), side(c, a)];
                sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0)
            })
        })
    }

    #[test]
    fn the_asset_is_whole() {
        let land = Outlines::read(ASSET).unwrap();
        let points = land.points().count();
        assert_eq!((land.rings.len(), points, land.triangles.len()), (126, 5000, 4752));
        assert_eq!(ASSET.len(), 2 * (2 + 126 + 2 * 5000 + 3 * 4752));
        assert!(land.triangles.iter().flatten().all(|corner| (*corner as usize) < points));
        assert!(land.points().all(|(longitude, latitude)| {
            (-180.0..191.0).contains(&longitude) && (-90.0..84.0).contains(&latitude)
        }));
        assert!(Outlines::read(&ASSET[..ASSET.len() - 1]).is_none());
        assert!(Outlines::read(&[]).is_none());
    }

    #[test]
    fn land_and_sea_are_where_they_are() {
        for (latitude, longitude) in [
            (39.0, 35.0),
            (-75.0, 0.0),
            (-89.5, 100.0),
            (-85.0, 179.9),
            (66.5, -175.0),
            (66.5, 179.0),
            (-20.0, 130.0),
            (0.0, 25.0),
            (75.0, -40.0),
        ] {
            assert!(is_land(latitude, longitude), "{latitude} {longitude}");
        }
        for (latitude, longitude) in
            [(0.0, -30.0), (42.0, 51.0), (0.0, 180.0), (89.0, 0.0), (-60.0, 100.0), (35.0, 20.0)]
        {
            assert!(!is_land(latitude, longitude), "{latitude} {longitude}");
        }
    }

    #[test]
    fn a_coast_ends_where_it_begins_or_at_the_edge_of_the_world() {
        let mut open = 0;
        for coast in OUTLINES.coasts() {
            let (first, last) = (coast[0], coast[coast.len() - 1]);
            if first != last {
                open += 1;
                assert!(
                    (last.0 - first.0).abs() > 359.9 && (last.1 - first.1).abs() < 1e-3,
                    "{first:?} {last:?}"
                );
            }
        }
        assert_eq!(open, 1, "the Antarctic");
    }
}
