//! One triangle of a mesh.

use std::ops::Range;

use egui::{Color32, epaint::Vertex, pos2};

use super::texture::Texture;

/// Parts of a pixel to which corners are rounded. Whole numbers decide without rounding errors
/// which of two triangles owns a pixel on their common edge.
const PARTS: i64 = 256;

/// A triangle on the canvas. The order of its corners makes all edges turn the same way.
pub(crate) struct Triangle<'a> {
    corners: [Corner; 3],
    /// Twice the area, in squared parts of a pixel.
    area: i64,
    texture: &'a Texture,
    /// Texel of a triangle whose corners share one texture position.
    plain: Option<[f32; 4]>,
}

#[derive(Clone, Copy)]
struct Corner {
    x: i64,
    y: i64,
    u: f32,
    v: f32,
    colour: [f32; 4],
}

impl<'a> Triangle<'a> {
    /// Creates the triangle; `None` if it has no area.
    pub(crate) fn new(vertices: [&Vertex; 3], texture: &'a Texture, scale: f32) -> Option<Self> {
        let mut corners = vertices.map(|vertex| Corner {
            x: (vertex.pos.x * scale * PARTS as f32).round() as i64,
            y: (vertex.pos.y * scale * PARTS as f32).round() as i64,
            u: vertex.uv.x,
            v: vertex.uv.y,
            colour: vertex.color.to_array().map(f32::from),
        });
        let [a, b, c] = corners;
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area < 0 {
            corners.swap(1, 2);
        }
        let is_plain = vertices.iter().all(|vertex| vertex.uv == vertices[0].uv);
        let plain = is_plain.then(|| texture.sample(vertices[0].uv));
        (area != 0).then_some(Self { corners, area: area.abs(), texture, plain })
    }

    /// Returns the rows of pixels that the triangle touches, within `rows`.
    pub(crate) fn rows(&self, rows: &Range<usize>) -> Range<usize> {
        span(self.corners.map(|corner| corner.y), rows)
    }

    /// Paints the triangle's part of `row`, within `columns`. `pixels` start at the first pixel of
    /// the row.
    pub(crate) fn paint_row(&self, pixels: &mut [Color32], row: usize, columns: &Range<usize>) {
        let columns = span(self.corners.map(|corner| corner.x), columns);
        let y = middle(row);
        let [a, b, c] = self.corners;
        let Some(pixels) = pixels.get_mut(columns.clone()) else { return };
        for (pixel, column) in pixels.iter_mut().zip(columns) {
            let x = middle(column);
            let weights = [side(b, c, x, y), side(c, a, x, y), side(a, b, x, y)];
            if let [Some(first), Some(second), Some(third)] = weights {
                let weights = [first, second, third].map(|weight| weight as f32 / self.area as f32);
                *pixel = blended(self.colour(weights), *pixel);
            }
        }
    }

    /// Returns the premultiplied colour, 0 to 255, at these weights of the corners.
    fn colour(&self, weights: [f32; 3]) -> [f32; 4] {
        let mixed = |mixed_value: &dyn Fn(&Corner) -> f32| -> f32 {
            self.corners
                .iter()
                .zip(weights)
                .map(|(corner, weight)| mixed_value(corner) * weight)
                .sum()
        };
        let texel = self.plain.unwrap_or_else(|| {
            self.texture.sample(pos2(mixed(&|corner| corner.u), mixed(&|corner| corner.v)))
        });
        let mut colour = [0.0; 4];
        for (corner, weight) in self.corners.iter().zip(weights) {
            for (sum, part) in colour.iter_mut().zip(corner.colour) {
                *sum += part * weight;
            }
        }
        for (part, texel) in colour.iter_mut().zip(texel) {
            *part *= texel;
        }
        colour
    }
}

/// Returns the middle of a row or column of pixels, in parts of a pixel.
fn middle(pixel: usize) -> i64 {
    i64::try_from(pixel).unwrap_or(i64::MAX / (2 * PARTS)) * PARTS + PARTS / 2
}

/// Returns the pixels between the min and max of `ends`, in parts of a pixel, within `whole`.
fn span(ends: [i64; 3], whole: &Range<usize>) -> Range<usize> {
    let [first, last] = ends
        .iter()
        .fold([i64::MAX, i64::MIN], |[first, last], end| [first.min(*end), last.max(*end)]);
    let pixel = |end: i64| usize::try_from(end.div_euclid(PARTS)).unwrap_or(0);
    let start = pixel(first).clamp(whole.start, whole.end);
    start..(pixel(last) + 1).clamp(start, whole.end)
}

/// Returns the distance of a point inside the edge between two corners, as twice an area; `None`
/// outside. A point on the edge belongs to the triangle below or to the right.
fn side(corner: Corner, next: Corner, x: i64, y: i64) -> Option<i64> {
    let product = (next.x - corner.x) * (y - corner.y) - (next.y - corner.y) * (x - corner.x);
    let owns_edge = next.y < corner.y || (next.y == corner.y && next.x > corner.x);
    (product > 0 || (product == 0 && owns_edge)).then_some(product)
}

/// Returns a premultiplied colour blended over another colour.
fn blended(colour: [f32; 4], below: Color32) -> Color32 {
    let transparency = 1.0 - colour[3] / 255.0;
    let mut mixed = [0; 4];
    for ((mixed, above), below) in mixed.iter_mut().zip(colour).zip(below.to_array()) {
        *mixed = (above + f32::from(below) * transparency + 0.5) as u8;
    }
    let [red, green, blue, alpha] = mixed;
    Color32::from_rgba_premultiplied(red, green, blue, alpha)
}
