//! Text of a frame in its painted form: colour, ground, place and clip.

use egui::{
    Color32, FontFamily, Mesh, Pos2, Rect, Shape,
    epaint::{ClippedShape, TextShape},
    pos2,
    text::{ByteIndex, LayoutSection},
    vec2,
};

use crate::window_stories::rig::Window;

/// A piece of one line in one colour.
pub(crate) struct Run {
    pub(crate) text: String,
    pub(super) size: f32,
    pub(super) is_bold: bool,
    pub(super) colour: Color32,
    /// Colour behind the middle of the text.
    pub(super) ground: Color32,
    pub(crate) rect: Rect,
    pub(super) clip: Rect,
    /// `true` if a veil, such as that below a question, covers the text.
    pub(super) is_veiled: bool,
}

/// Opacity from which a fill hides the text below it.
const COVERS: u8 = 150;

impl Run {
    /// Returns the place of the letters, without the free space of the font above and below them.
    fn letters(&self) -> Rect {
        self.rect.shrink2(vec2(0.0, 0.2 * self.rect.height()))
    }
}

/// A shape with the area in which it can be.
struct Layer<'a> {
    shape: &'a Shape,
    area: Rect,
}

/// Returns all visible text of the last frame.
pub(crate) fn runs(window: &Window) -> Vec<Run> {
    let mut layers = Vec::new();
    let mut found = Vec::new();
    for ClippedShape { clip_rect, shape, .. } in &window.output().shapes {
        collect(shape, *clip_rect, &mut layers, &mut found);
    }
    // The renderer clears the window with this colour.
    let clear = window.ctx.global_style().visuals.panel_fill;
    let whole = window.ctx.content_rect();
    let seen = |(below, run): (usize, Run)| {
        let (below, above) = layers.split_at(below);
        under_veils(with_ground(run, below, clear), above, whole)
    };
    found.into_iter().map(seen).collect()
}

/// Blends a run with fills over all of the window, such as the veil below a question.
fn under_veils(mut run: Run, above: &[Layer<'_>], whole: Rect) -> Run {
    for layer in above.iter().filter(|layer| layer.area.contains_rect(whole)) {
        let Some(veil) = fill_at(layer.shape, whole.center()) else { continue };
        [run.colour, run.ground] = [run.colour, run.ground].map(|colour| colour.blend(veil));
        run.is_veiled = true;
    }
    run
}

/// Returns pairs of overlapping texts of the last frame, with nothing painted between them.
pub(super) fn on_each_other(window: &Window) -> Vec<[String; 2]> {
    let mut layers = Vec::new();
    let mut found = Vec::new();
    for ClippedShape { clip_rect, shape, .. } in &window.output().shapes {
        collect(shape, *clip_rect, &mut layers, &mut found);
    }
    let mut pairs = Vec::new();
    for (index, (below, run)) in found.iter().enumerate() {
        for (above, other) in &found[index + 1..] {
            let [seen, over] = [run, other].map(|run| run.letters().intersect(run.clip));
            let common = seen.intersect(over);
            if common.width() < 2.0 || common.height() < 2.0 {
                continue;
            }
            let at = common.center();
            let covers = |layer: &Layer<'_>| {
                layer.area.contains(at)
                    && fill_at(layer.shape, at).is_some_and(|fill| fill.a() >= COVERS)
            };
            if !layers[*below..*above].iter().any(covers) {
                pairs.push([run.text.clone(), other.text.clone()]);
            }
        }
    }
    pairs
}

/// Returns the colour behind this text, which has no blanks.
pub(crate) fn ground_of(window: &Window, words: &str) -> Option<Color32> {
    runs(window).into_iter().find(|run| run.text == words).map(|run| run.ground)
}

/// Returns all visible text of the last frame without blanks, with its places.
pub(crate) fn placed(window: &Window) -> Vec<(String, Rect)> {
    runs(window).into_iter().map(|run| (run.text.clone(), run.letters())).collect()
}

/// Returns all texts of the last frame, each with its blanks and in full length if it was cut.
pub(crate) fn texts(window: &Window) -> Vec<String> {
    let mut texts = Vec::new();
    for ClippedShape { shape, .. } in &window.output().shapes {
        add_texts(shape, &mut texts);
    }
    texts
}

/// Returns the texts of the last frame that end with an ellipsis.
pub(crate) fn cut(window: &Window) -> Vec<String> {
    let mut cut = Vec::new();
    for ClippedShape { shape, .. } in &window.output().shapes {
        add_cut(shape, &mut cut);
    }
    cut
}

/// Returns the colours of fills, borders and focus rings whose edges are all nearer than `reach` to
/// those of `place`.
pub(crate) fn around(window: &Window, place: Rect, reach: f32) -> Vec<Color32> {
    let mut found = Vec::new();
    for ClippedShape { shape, .. } in &window.output().shapes {
        add_around(shape, place, reach, &mut found);
    }
    found
}

fn add_around(shape: &Shape, place: Rect, reach: f32, found: &mut Vec<Color32>) {
    let is_near = |rect: Rect| {
        let off = [rect.min - place.min, rect.max - place.max];
        off.iter().all(|off| off.abs().max_elem() < reach)
    };
    match shape {
        Shape::Vec(shapes) => {
            for shape in shapes {
                add_around(shape, place, reach, found);
            }
        }
        Shape::Rect(rect) if is_near(rect.rect) => found.push(rect.stroke.color),
        Shape::Mesh(mesh) if is_near(mesh.calc_bounds()) => {
            let colours = mesh.vertices.iter().map(|of| of.color);
            found.extend(colours.filter(Color32::is_opaque).take(1));
        }
        _ => {}
    }
}

fn add_cut(shape: &Shape, cut: &mut Vec<String>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| add_cut(shape, cut)),
        Shape::Text(text) if text.galley.elided => cut.push(text.galley.text().to_owned()),
        _ => {}
    }
}

fn add_texts(shape: &Shape, texts: &mut Vec<String>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| add_texts(shape, texts)),
        Shape::Text(text) => texts.push(text.galley.text().to_owned()),
        _ => {}
    }
}

/// Sorts a shape into fills and text, each text with the number of fills below it.
fn collect<'a>(
    shape: &'a Shape,
    clip: Rect,
    layers: &mut Vec<Layer<'a>>,
    found: &mut Vec<(usize, Run)>,
) {
    match shape {
        Shape::Vec(shapes) => {
            for shape in shapes {
                collect(shape, clip, layers, found);
            }
        }
        Shape::Text(text) => {
            let below = layers.len();
            found.extend(pieces(text, clip).into_iter().map(|run| (below, run)));
        }
        shape => {
            let area = shape.visual_bounding_rect().intersect(clip);
            if area.is_positive() {
                layers.push(Layer { shape, area });
            }
        }
    }
}

fn pieces(text: &TextShape, clip: Rect) -> Vec<Run> {
    // Turned text would need a turned place, but the window has none.
    assert!(text.angle == 0.0, "turned text: {:?}", text.galley.text());
    let job = &text.galley.job;
    let mut runs: Vec<Run> = Vec::new();
    let mut places = job.text.char_indices().map(|(place, _)| place);
    for row in &text.galley.rows {
        let mut last = None;
        for glyph in &row.row.glyphs {
            // The ellipsis of a cut text stands in place of the next letter.
            let place = places.next().unwrap_or(job.text.len().saturating_sub(1));
            let holds = |section: &LayoutSection| section.byte_range.contains(&ByteIndex(place));
            let Some(index) = job.sections.iter().position(holds) else { continue };
            if glyph.chr.is_whitespace() {
                continue;
            }
            let min = text.pos + row.pos.to_vec2() + glyph.pos.to_vec2();
            let min = min - vec2(0.0, glyph.font_ascent);
            let rect = Rect::from_min_size(min, vec2(glyph.advance_width, glyph.font_height));
            if let Some(run) = runs.last_mut().filter(|_| last == Some(index)) {
                run.text.push(glyph.chr);
                run.rect = run.rect.union(rect);
                continue;
            }
            last = Some(index);
            let format = &job.sections[index].format;
            // A selection changes the colours of the glyphs alone.
            let painted = row.row.visuals.mesh.vertices.get(glyph.first_vertex as usize);
            let painted = painted.map_or(format.color, |vertex| vertex.color);
            let is_own = painted != Color32::PLACEHOLDER;
            let own = if is_own { painted } else { text.fallback_color };
            let colour = text.override_text_color.unwrap_or(own);
            let family = &format.font_id.family;
            runs.push(Run {
                text: glyph.chr.to_string(),
                size: format.font_id.size,
                is_bold: matches!(family, FontFamily::Name(name) if name.contains("bold")),
                colour: colour.gamma_multiply(text.opacity_factor),
                ground: Color32::TRANSPARENT,
                rect,
                clip,
                is_veiled: false,
            });
        }
        if row.ends_with_newline {
            places.next();
        }
    }
    runs.retain(|run| run.rect.intersect(clip).is_positive());
    runs
}

fn with_ground(mut run: Run, below: &[Layer<'_>], clear: Color32) -> Run {
    let at = run.rect.intersect(run.clip).center();
    let mut seen = Vec::new();
    for layer in below.iter().rev().filter(|layer| layer.area.contains(at)) {
        let Some(fill) = fill_at(layer.shape, at) else { continue };
        seen.push(fill);
        if fill.is_opaque() {
            break;
        }
    }
    run.ground = seen.into_iter().rev().fold(clear, Color32::blend);
    run.colour = run.ground.blend(run.colour);
    run
}

/// Returns the colour with which a shape fills a point.
fn fill_at(shape: &Shape, at: Pos2) -> Option<Color32> {
    let fill = match shape {
        Shape::Rect(rect) if rect.rect.contains(at) => rect.fill,
        Shape::Circle(circle) if circle.center.distance(at) <= circle.radius => circle.fill,
        Shape::Path(path) if path.closed && is_inside(&path.points, at) => path.fill,
        Shape::Mesh(mesh) => mesh_at(mesh, at)?,
        _ => return None,
    };
    (fill != Color32::TRANSPARENT).then_some(fill)
}

fn mesh_at(mesh: &Mesh, at: Pos2) -> Option<Color32> {
    let corner = |index: &u32| mesh.vertices[*index as usize];
    mesh.indices.chunks_exact(3).rev().find_map(|triangle| {
        let [a, b, c] = [&triangle[0], &triangle[1], &triangle[2]].map(corner);
        let side = |from: Pos2, to: Pos2| {
            (to.x - from.x) * (at.y - from.y) - (to.y - from.y) * (at.x - from.x)
        };
        let sides = [side(a.pos, b.pos), side(b.pos, c.pos), side(c.pos, a.pos)];
        let is_in = sides.iter().all(|of| *of >= 0.0) || sides.iter().all(|of| *of <= 0.0);
        let has_area = sides.iter().any(|of| *of != 0.0);
        // The soft edge of a shape is no ground.
        let is_even = a.color == b.color && b.color == c.color;
        (is_in && has_area && is_even).then_some(a.color)
    })
}

fn is_inside(points: &[Pos2], at: Pos2) -> bool {
    let mut inside = false;
    let mut before = points.last().copied().unwrap_or(pos2(0.0, 0.0));
    for point in points {
        if (point.y > at.y) != (before.y > at.y)
            && at.x < (before.x - point.x) * (at.y - point.y) / (before.y - point.y) + point.x
        {
            inside = !inside;
        }
        before = *point;
    }
    inside
}
