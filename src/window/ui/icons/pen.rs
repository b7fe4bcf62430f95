//! Pen that draws on the grid of an icon.

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

/// Side length of the grid, grid units.
const GRID: f32 = 20.0;
/// Default width of a line, grid units.
const STROKE: f32 = 1.5;
/// Min width of lines with round ends, points.
const THINNEST_ROUND_POINTS: f32 = 1.4;
/// Min width of lines in small icons, points.
const THINNEST_POINTS: f32 = 1.25;

/// Pen of one colour over the square of one icon. Places and lengths are in grid units, x to the
/// right and y down.
pub(super) struct Pen<'a> {
    painter: &'a Painter,
    origin: Pos2,
    scale: f32,
    colour: Color32,
}

impl<'a> Pen<'a> {
    pub(super) fn new(painter: &'a Painter, rect: Rect, colour: Color32) -> Self {
        let side = rect.width().min(rect.height());
        let origin = rect.center() - vec2(side, side) / 2.0;
        Self { painter, origin, scale: side / GRID, colour }
    }

    fn point(&self, (x, y): (f32, f32)) -> Pos2 {
        self.origin + vec2(x, y) * self.scale
    }

    fn width(&self, grid: f32) -> f32 {
        (grid * self.scale).max(THINNEST_POINTS)
    }

    /// Draws a line through the points with round joins and caps.
    pub(super) fn line(&self, points: &[(f32, f32)]) {
        self.thick_line(points, STROKE);
    }

    /// Draws a line of the given width, grid units.
    pub(super) fn thick_line(&self, points: &[(f32, f32)], width: f32) {
        let width = self.width(width);
        for pair in points.windows(2) {
            if let [a, b] = pair {
                let ends = [self.point(*a), self.point(*b)];
                self.painter.line_segment(ends, Stroke::new(width, self.colour));
            }
        }
        // egui ends lines flat. On a thin line, a round end would be a smudge.
        if width < THINNEST_ROUND_POINTS {
            return;
        }
        for point in points {
            self.painter.circle_filled(self.point(*point), width / 2.0, self.colour);
        }
    }

    /// Draws a closed outline with the default line width.
    pub(super) fn outline(&self, points: &[(f32, f32)]) {
        let points = points.iter().map(|point| self.point(*point)).collect();
        self.painter.add(Shape::closed_line(points, Stroke::new(self.width(STROKE), self.colour)));
    }

    /// Draws a ring with the default line width.
    pub(super) fn ring(&self, centre: (f32, f32), radius: f32) {
        let stroke = Stroke::new(self.width(STROKE), self.colour);
        self.painter.circle_stroke(self.point(centre), radius * self.scale, stroke);
    }

    /// Draws a disc filled with the pen's colour.
    pub(super) fn disc(&self, centre: (f32, f32), radius: f32) {
        self.painter.circle_filled(self.point(centre), radius * self.scale, self.colour);
    }

    /// Fills a convex shape with the pen's colour.
    pub(super) fn filled(&self, points: &[(f32, f32)]) {
        let points = points.iter().map(|point| self.point(*point)).collect();
        self.painter.add(Shape::convex_polygon(points, self.colour, Stroke::NONE));
    }

    /// Draws part of a circle; angles in degrees, zero to the right, growing clockwise on the
    /// screen.
    pub(super) fn arc(&self, centre: (f32, f32), radius: f32, from_deg: f32, to_deg: f32) {
        let stroke = Stroke::new(self.width(STROKE), self.colour);
        let points = arc_points(centre, radius, from_deg, to_deg);
        let points: Vec<Pos2> = points.into_iter().map(|point| self.point(point)).collect();
        self.painter.add(Shape::line(points, stroke));
    }
}

/// Returns points on part of a circle, for arcs and filled sectors.
pub(super) fn arc_points(
    (x, y): (f32, f32),
    radius: f32,
    from_deg: f32,
    to_deg: f32,
) -> Vec<(f32, f32)> {
    const STEPS: u8 = 16;
    (0..=STEPS)
        .map(|step| {
            let part = f32::from(step) / f32::from(STEPS);
            let (sin, cos) = (from_deg + (to_deg - from_deg) * part).to_radians().sin_cos();
            let point = pos2(x + radius * cos, y + radius * sin);
            (point.x, point.y)
        })
        .collect()
}
