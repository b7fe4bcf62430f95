//! Painter of window images for tests. It needs no graphics card, and gives the same image on every
//! machine.
//!
//! Colours are blended as in egui's own painters: premultiplied, in gamma space.

mod texture;
mod triangle;

use std::collections::HashMap;

use egui::{
    Color32, Context, FullOutput, Rect, TextureId,
    epaint::{ClippedPrimitive, Mesh, Primitive, textures::TexturesDelta},
};
use egui_kittest::TestRenderer;
use image::RgbaImage;

use self::{texture::Texture, triangle::Triangle};

/// Renderer of test harnesses. It keeps the textures of the window.
#[derive(Default)]
pub struct Painter {
    textures: HashMap<TextureId, Texture>,
}

impl TestRenderer for Painter {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        for (id, changes) in delta.set.drain() {
            for change in changes {
                self.textures.entry(id).or_default().take(&change);
            }
        }
        for id in delta.free.drain() {
            self.textures.remove(&id);
        }
    }

    fn render(&mut self, ctx: &Context, output: &FullOutput) -> Result<RgbaImage, String> {
        let scale = ctx.pixels_per_point();
        let size = ctx.content_rect().size() * scale;
        let [width, height] = [size.x, size.y].map(|side| side.round() as usize);
        // The program clears its window to this colour, which stays wherever no shape is.
        let ground = ctx.global_style().visuals.panel_fill;
        let mut canvas = Canvas { width, height, pixels: vec![ground; width * height] };
        for ClippedPrimitive { clip_rect, primitive } in
            ctx.tessellate(output.shapes.clone(), scale)
        {
            let Primitive::Mesh(mesh) = primitive else {
                return Err("a shape is painted by a callback".to_owned());
            };
            let texture = self.textures.get(&mesh.texture_id).ok_or("a texture is missing")?;
            canvas.paint(&mesh, texture, clip_rect, scale);
        }
        let bytes = canvas.pixels.iter().flat_map(Color32::to_array).collect();
        RgbaImage::from_raw(width as u32, height as u32, bytes)
            .ok_or_else(|| "the image has another size than its pixels".to_owned())
    }
}

struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<Color32>,
}

impl Canvas {
    fn paint(&mut self, mesh: &Mesh, texture: &Texture, clip: Rect, scale: f32) {
        let edge =
            |position: f32, side: usize| ((position * scale).round().max(0.0) as usize).min(side);
        let columns = edge(clip.left(), self.width)..edge(clip.right(), self.width);
        let rows = edge(clip.top(), self.height)..edge(clip.bottom(), self.height);
        for corners in mesh.indices.chunks_exact(3) {
            let corner = |index: usize| {
                let index = corners.get(index)?;
                mesh.vertices.get(*index as usize)
            };
            let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else { continue };
            let Some(triangle) = Triangle::new([a, b, c], texture, scale) else { continue };
            for row in triangle.rows(&rows) {
                let Some(pixels) = self.pixels.get_mut(row * self.width..) else { continue };
                triangle.paint_row(pixels, row, &columns);
            }
        }
    }
}
