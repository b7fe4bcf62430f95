//! Triangles of lines, discs, rings and rounded rectangles.

use std::f32::consts::{FRAC_PI_2, TAU};

use egui::{Color32, Mesh, Pos2, Rect, Shape, Stroke, Vec2, epaint::CornerRadiusF32, pos2};

/// Max distance of a side from its arc, pixels: too small to see.
const FLATNESS_PX: f32 = 0.1;

/// Returns rectangles of two triangles each.
pub(super) fn plain(rects: &[Rect], colour: Color32) -> Shape {
    let mut mesh = Mesh::default();
    for rect in rects {
        mesh.add_colored_rect(*rect, colour);
    }
    Shape::mesh(mesh)
}

/// Returns a line of at most a pixel, which fades over a pixel on both sides.
pub(super) fn thin_line(start: Pos2, last: Pos2, stroke: Stroke, scale: f32) -> Shape {
    let side = (last - start).normalized().rot90() / scale;
    let colour = stroke.color.gamma_multiply(stroke.width * scale);
    let mut mesh = Mesh::default();
    for end in [start, last] {
        mesh.colored_vertex(end - side, Color32::TRANSPARENT);
        mesh.colored_vertex(end, colour);
        mesh.colored_vertex(end + side, Color32::TRANSPARENT);
    }
    for first in [0, 1] {
        quad(&mut mesh, first, first + 1, first + 4, first + 3);
    }
    Shape::mesh(mesh)
}

/// Returns a convex shape whose edge fades over a pixel. The outline runs clockwise on the screen.
pub(super) fn soft(outline: &[Pos2], colour: Color32, scale: f32) -> Shape {
    let half_px = 0.5 / scale;
    let mut mesh = Mesh::default();
    loops(&mut mesh, outline, &[(-half_px, colour), (half_px, Color32::TRANSPARENT)]);
    fill_inside(&mut mesh, 2, 0, outline.len().saturating_sub(1));
    Shape::mesh(mesh)
}

/// Returns a line along a closed convex outline, clockwise on the screen.
pub(super) fn ring(outline: &[Pos2], stroke: Stroke, scale: f32) -> Shape {
    let colour = stroke.color.gamma_multiply((stroke.width * scale).min(1.0));
    let pixel = 1.0 / scale;
    let full = (stroke.width - pixel).max(0.0) / 2.0;
    let edge = full + pixel;
    let clear = Color32::TRANSPARENT;
    let mut mesh = Mesh::default();
    if full < 0.05 * pixel {
        loops(&mut mesh, outline, &[(-edge, clear), (0.0, colour), (edge, clear)]);
    } else {
        let edges = [(-edge, clear), (-full, colour), (full, colour), (edge, clear)];
        loops(&mut mesh, outline, &edges);
    }
    Shape::mesh(mesh)
}

/// Returns the corners of a circle, clockwise.
pub(super) fn circle(centre: Pos2, radius: f32, scale: f32) -> Vec<Pos2> {
    let sides = sides(radius, scale);
    let step = TAU / f32::from(sides);
    (0..sides).map(|side| centre + radius * Vec2::angled(step * f32::from(side))).collect()
}

/// Returns the outline of a rectangle with rounded corners, clockwise.
pub(super) fn rounded(rect: Rect, radius: CornerRadiusF32) -> Vec<Pos2> {
    let max = rect.size().min_elem() / 2.0;
    let corners = [
        (rect.left_top(), pos2(1.0, 1.0), radius.nw, 2.0),
        (rect.right_top(), pos2(-1.0, 1.0), radius.ne, 3.0),
        (rect.right_bottom(), pos2(-1.0, -1.0), radius.se, 0.0),
        (rect.left_bottom(), pos2(1.0, -1.0), radius.sw, 1.0),
    ];
    let mut outline = Vec::with_capacity(24);
    for (corner, inwards, radius, quarter) in corners {
        let radius = radius.min(max);
        if radius < 0.5 {
            outline.push(corner);
            continue;
        }
        let centre = corner + inwards.to_vec2() * radius;
        outline.extend((0..=5_u8).map(|step| {
            let turn = quarter + f32::from(step) / 5.0;
            centre + radius * Vec2::angled(turn * FRAC_PI_2)
        }));
    }
    outline
}

fn sides(radius: f32, scale: f32) -> u16 {
    (TAU / 2.0 * (radius * scale / (2.0 * FLATNESS_PX)).sqrt()).ceil().clamp(16.0, 512.0) as u16
}

/// Adds one closed line of vertices for each distance to the outline, joined to bands.
fn loops(mesh: &mut Mesh, outline: &[Pos2], edges: &[(f32, Color32)]) {
    let count = outline.len();
    let width = edges.len() as u32;
    let corner = |index: usize| outline.get(index % count).copied().unwrap_or_default();
    for index in 0..count {
        let before = (corner(index) - corner(index + count - 1)).normalized().rot90();
        let after = (corner(index + 1) - corner(index)).normalized().rot90();
        // Mitre: extend the corner as far out as both neighbouring sides reach.
        let outwards = (before + after) / (1.0 + before.dot(after)).max(0.5);
        for (distance, colour) in edges {
            mesh.colored_vertex(corner(index) + outwards * *distance, *colour);
        }
        let here = index as u32 * width;
        let next = ((index + 1) % count) as u32 * width;
        for band in 0..width.saturating_sub(1) {
            quad(mesh, here + band, here + band + 1, next + band + 1, next + band);
        }
    }
}

fn quad(mesh: &mut Mesh, a: u32, b: u32, c: u32, d: u32) {
    mesh.add_triangle(a, b, c);
    mesh.add_triangle(a, c, d);
}

/// Fills between the innermost vertices from `first` to `last`, one in `width` vertices: the
/// largest triangle in the middle, then both sides in the same way.
fn fill_inside(mesh: &mut Mesh, width: usize, first: usize, last: usize) {
    let middle = usize::midpoint(first, last);
    if middle == first {
        return;
    }
    let [a, b, c] = [first, middle, last].map(|corner| (corner * width) as u32);
    mesh.add_triangle(a, b, c);
    fill_inside(mesh, width, first, middle);
    fill_inside(mesh, width, middle, last);
}
