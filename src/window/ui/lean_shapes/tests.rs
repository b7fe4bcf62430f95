use egui::{
    CornerRadius,
    epaint::{ClippedShape, Primitive, TessellationOptions, Tessellator},
    pos2, vec2,
};

use super::*;

const COLOUR: Color32 = Color32::WHITE;

/// Painted result of a shape.
struct Picture {
    /// Area times opacity, square points.
    ink: f32,
    triangles: usize,
    /// Bounds of all vertices that are not transparent.
    bounds: Rect,
}

fn picture(shape: Shape, scale: f32) -> Picture {
    let options = TessellationOptions { prerasterized_discs: false, ..Default::default() };
    let clip = Rect::from_min_size(Pos2::ZERO, vec2(500.0, 500.0));
    let clipped = vec![ClippedShape::new(clip, shape)];
    let mut picture = Picture { ink: 0.0, triangles: 0, bounds: Rect::NOTHING };
    for primitive in Tessellator::new(scale, options, [1, 1], Vec::new()).tessellate_shapes(clipped)
    {
        let Primitive::Mesh(mesh) = primitive.primitive else { continue };
        for corners in mesh.indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| mesh.vertices[corners[corner] as usize]);
            let (ab, ac) = (b.pos - a.pos, c.pos - a.pos);
            let opacity = [a, b, c].map(|corner| f32::from(corner.color.a()) / 255.0);
            picture.ink += (ab.x * ac.y - ab.y * ac.x).abs() / 6.0 * opacity.iter().sum::<f32>();
            picture.triangles += 1;
            for vertex in [a, b, c].iter().filter(|vertex| vertex.color.a() > 0) {
                picture.bounds.extend_with(vertex.pos);
            }
        }
    }
    picture
}

fn lean(mut shape: Shape, scale: f32) -> Shape {
    rewrite(&mut shape, scale);
    shape
}

/// Returns the shapes of the views, on and off the borders of pixels.
fn shapes() -> Vec<(&'static str, Shape)> {
    let stroke = |width: f32| Stroke::new(width, COLOUR);
    let rect = Rect::from_min_size(pos2(20.3, 30.0), vec2(200.0, 41.0));
    let rounded = CornerRadius { nw: 6, ne: 6, sw: 0, se: 12 };
    vec![
        ("hairline", Shape::hline(10.0..=300.0, 20.5, stroke(1.0))),
        ("turned hairline", Shape::line_segment([pos2(9.0, 90.0), pos2(9.0, 9.0)], stroke(2.0))),
        ("slanted thin line", Shape::line_segment([pos2(9.0, 9.0), pos2(70.0, 50.0)], stroke(1.0))),
        ("dash", Shape::line(vec![pos2(9.0, 9.0), pos2(70.0, 50.0)], stroke(1.0))),
        ("rectangle", Shape::rect_filled(rect, 0.0, COLOUR)),
        ("thin rectangle", Shape::rect_filled(rect.with_max_y(31.0), 0.0, COLOUR)),
        ("rounded rectangle", Shape::rect_filled(rect, rounded, COLOUR)),
        ("frame", Shape::rect_stroke(rect, 0.0, stroke(1.0), StrokeKind::Inside)),
        ("rounded frame", Shape::rect_stroke(rect, rounded, stroke(1.0), StrokeKind::Inside)),
        ("heavy frame", Shape::rect_stroke(rect, rounded, stroke(2.0), StrokeKind::Inside)),
        ("disc", Shape::circle_filled(pos2(200.0, 200.0), 150.2, COLOUR)),
        ("circle", Shape::circle_stroke(pos2(200.0, 200.0), 150.2, stroke(1.0))),
        ("heavy circle", Shape::circle_stroke(pos2(200.0, 200.0), 22.0, stroke(1.5))),
    ]
}

#[test]
fn every_shape_leaves_the_same_ink_in_the_same_place_with_fewer_triangles() {
    for scale in [1.0, 1.5, 2.0] {
        for (name, shape) in shapes() {
            let before = picture(shape.clone(), scale);
            let after = picture(lean(shape, scale), scale);
            let ratio = after.ink / before.ink;
            assert!((0.98..1.02).contains(&ratio), "{name} at {scale}: {ratio} of the ink");
            let [was, is] = [before.bounds, after.bounds];
            let apart = (was.min - is.min).length().max((was.max - is.max).length());
            assert!(apart <= 1.5 / scale, "{name} at {scale}: {was} became {is}");
            assert!(
                after.triangles <= before.triangles,
                "{name} at {scale}: {} triangles became {}",
                before.triangles,
                after.triangles
            );
        }
    }
}

#[test]
fn an_upright_fill_on_pixel_borders_is_two_triangles_and_no_more_pixels() {
    let rect = Rect::from_min_max(pos2(20.0, 30.0), pos2(220.0, 70.0));
    let after = picture(lean(Shape::rect_filled(rect, 0.0, COLOUR), 1.0), 1.0);
    assert_eq!((after.triangles, after.bounds), (2, rect));
    let line = picture(lean(Shape::hline(20.0..=220.0, 30.5, (1.0, COLOUR)), 1.0), 1.0);
    assert_eq!(line.triangles, 2);
    assert_eq!(line.bounds, Rect::from_min_max(pos2(20.0, 30.0), pos2(220.0, 31.0)));
}

#[test]
fn what_is_not_understood_stays_as_it_is() {
    let nan = pos2(f32::NAN, 3.0);
    for shape in [
        Shape::line_segment([nan, pos2(1.0, 3.0)], (1.0, COLOUR)),
        Shape::circle_filled(nan, 100.0, COLOUR),
        Shape::circle_filled(pos2(9.0, 9.0), 4.0, COLOUR),
        Shape::rect_filled(Rect::EVERYTHING, 0.0, COLOUR),
        Shape::line_segment([pos2(1.0, 3.0), pos2(5.0, 9.0)], (2.0, COLOUR)),
    ] {
        let before = format!("{shape:?}");
        assert_eq!(format!("{:?}", lean(shape, 1.0)), before);
    }
}
