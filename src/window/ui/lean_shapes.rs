//! Shapes with fewer pixels to shade for the same picture.
//!
//! egui gives every shape a soft edge, even on the border of two pixels. It fills round shapes with
//! slivers that all meet in one point. A software renderer then shades the same pixels again and
//! again; a graphics card does not mind. These shapes draw upright edges as two plain triangles,
//! and round ones as few compact triangles.

mod mesh;
#[cfg(test)]
mod tests;

use egui::{
    Color32, Context, FullOutput, Plugin, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2,
    emath::GuiRounding,
    epaint::{CircleShape, ColorMode, CornerRadiusF32, PathShape, RectShape},
};

/// Min radius of a disc to replace, points: egui draws smaller discs as one textured square.
const SMALLEST_DISC: f32 = 12.0;

/// Plugin that rewrites the shapes of every frame before egui cuts them into triangles.
#[derive(Debug, Default)]
pub(super) struct LeanShapes;

impl Plugin for LeanShapes {
    fn debug_name(&self) -> &'static str {
        "lean shapes"
    }

    fn output_hook(&mut self, _: &Context, output: &mut FullOutput) {
        let scale = output.pixels_per_point;
        for clipped in &mut output.shapes {
            rewrite(&mut clipped.shape, scale);
        }
    }
}

/// Replaces `shape` if there is a leaner one. `scale` is in pixels per point.
fn rewrite(shape: &mut Shape, scale: f32) {
    let leaner = match shape {
        Shape::Vec(shapes) => {
            for shape in shapes {
                rewrite(shape, scale);
            }
            None
        }
        Shape::LineSegment { points: [start, end], stroke } => line(*start, *end, *stroke, scale),
        Shape::Path(path) => dash(path, scale),
        Shape::Rect(rect) => rectangle(rect, scale),
        Shape::Circle(circle) => disc(*circle, scale),
        _ => None,
    };
    if let Some(leaner) = leaner {
        *shape = leaner;
    }
}

/// Returns a lean line between two points, if it is thin, or upright and whole pixels wide.
fn line(start: Pos2, end: Pos2, stroke: Stroke, scale: f32) -> Option<Shape> {
    if stroke.is_empty() || !(start.x + start.y + end.x + end.y).is_finite() || start == end {
        return None;
    }
    let width_px = stroke.width * scale;
    let whole = width_px >= 1.0 && (width_px - width_px.round()).abs() < 1e-3;
    let across = (end - start).abs();
    if whole && across.min_elem() <= 0.0 {
        return Some(upright(start, end, stroke, scale));
    }
    (width_px <= 1.0).then(|| mesh::thin_line(start, end, stroke, scale))
}

/// Returns a lean dash of a dashed line.
fn dash(path: &PathShape, scale: f32) -> Option<Shape> {
    let ColorMode::Solid(colour) = path.stroke.color else { return None };
    match path.points[..] {
        [start, end] if path.stroke.width * scale <= 1.0 => {
            line(start, end, Stroke::new(path.stroke.width, colour), scale)
        }
        _ => None,
    }
}

/// Returns an upright line of whole pixels, placed as egui places it.
fn upright(start: Pos2, last: Pos2, stroke: Stroke, scale: f32) -> Shape {
    let vertical = (last.x - start.x).abs() <= 0.0;
    // Shorten each end by a quarter of a pixel: ends on pixel borders then stay there.
    let shorter = (last - start).normalized() * (0.25 / scale);
    let [start, last] = [start + shorter, last - shorter].map(|mut end| {
        let (across, along) =
            if vertical { (&mut end.x, &mut end.y) } else { (&mut end.y, &mut end.x) };
        stroke.round_center_to_pixel(scale, across);
        *along = along.round_to_pixel_center(scale);
        end
    });
    let (half, cap) = (stroke.width / 2.0, 0.5 / scale);
    let grown = if vertical { Vec2::new(half, cap) } else { Vec2::new(cap, half) };
    mesh::plain(&[Rect::from_two_pos(start, last).expand2(grown)], stroke.color)
}

/// Returns a lean rectangle, with or without rounded corners and a border.
fn rectangle(shape: &RectShape, scale: f32) -> Option<Shape> {
    let RectShape { rect, corner_radius, fill, stroke, .. } = *shape;
    let bordered = !stroke.is_empty();
    let special = shape.brush.is_some()
        || shape.angle != 0.0
        || shape.blur_width != 0.0
        || shape.round_to_pixels == Some(false)
        || (bordered && shape.stroke_kind != StrokeKind::Inside);
    if special || !rect.is_finite() {
        return None;
    }
    let line_of = |width| Stroke::new(width, fill);
    if !bordered && rect.height() <= 2.0 / scale {
        return line(rect.left_center(), rect.right_center(), line_of(rect.height()), scale);
    }
    if !bordered && rect.width() <= 2.0 / scale {
        return line(rect.center_top(), rect.center_bottom(), line_of(rect.width()), scale);
    }
    if rect.size().min_elem() <= 2.0 * stroke.width + 2.0 / scale {
        return None;
    }
    let rect = rect.round_to_pixels(scale);
    let sharp = corner_radius == egui::CornerRadius::ZERO;
    let outline = |shrunk: f32| {
        let mut radius = CornerRadiusF32::from(corner_radius);
        radius -= shrunk;
        mesh::rounded(rect.shrink(shrunk), radius)
    };
    let mut parts = Vec::with_capacity(2);
    if fill != Color32::TRANSPARENT {
        parts.push(if sharp {
            mesh::plain(&[rect], fill)
        } else {
            mesh::soft(&outline(0.0), fill, scale)
        });
    }
    if bordered && sharp {
        parts.push(mesh::plain(&frame(rect, stroke.width), stroke.color));
    } else if bordered {
        parts.push(mesh::ring(&outline(stroke.width / 2.0), stroke, scale));
    }
    Some(Shape::Vec(parts))
}

/// Returns the four sides of a border inside `rect`.
fn frame(rect: Rect, width: f32) -> [Rect; 4] {
    let inner = rect.shrink(width);
    [
        rect.with_max_y(inner.top()),
        rect.with_min_y(inner.bottom()),
        Rect::from_x_y_ranges(rect.left()..=inner.left(), inner.y_range()),
        Rect::from_x_y_ranges(inner.right()..=rect.right(), inner.y_range()),
    ]
}

/// Returns a lean disc or circle, if it is large.
fn disc(shape: CircleShape, scale: f32) -> Option<Shape> {
    let CircleShape { center, radius, fill, stroke } = shape;
    if radius < SMALLEST_DISC || !(center + Vec2::splat(radius)).is_finite() {
        return None;
    }
    let mut parts = Vec::with_capacity(2);
    if fill != Color32::TRANSPARENT {
        parts.push(mesh::soft(&mesh::circle(center, radius, scale), fill, scale));
    }
    if !stroke.is_empty() {
        // egui draws the stroke of a circle around it.
        let middle = radius + stroke.width / 2.0;
        parts.push(mesh::ring(&mesh::circle(center, middle, scale), stroke, scale));
    }
    Some(Shape::Vec(parts))
}
