//! A texture in its current state.

use egui::{
    Color32, Pos2,
    epaint::{ImageData, ImageDelta},
};

/// The letters of the fonts, or a picture.
#[derive(Default)]
pub(crate) struct Texture {
    width: usize,
    height: usize,
    pixels: Vec<Color32>,
}

impl Texture {
    /// Replaces the whole image, or a part of it.
    pub(crate) fn take(&mut self, change: &ImageDelta) {
        let ImageData::Color(image) = &change.image;
        let [width, height] = image.size;
        let Some([left, top]) = change.pos else {
            (self.width, self.height, self.pixels) = (width, height, image.pixels.clone());
            return;
        };
        for (row, line) in image.pixels.chunks_exact(width.max(1)).enumerate() {
            let start = (top + row) * self.width + left;
            if let Some(place) = self.pixels.get_mut(start..start + width) {
                place.copy_from_slice(line);
            }
        }
    }

    /// Returns the colour at `uv`, interpolated between the four nearest texels: premultiplied, 0
    /// to 1 in each channel.
    pub(crate) fn sample(&self, uv: Pos2) -> [f32; 4] {
        let split = |part: f32, side: usize| {
            let position = (part * side as f32 - 0.5).clamp(0.0, side.saturating_sub(1) as f32);
            (position as usize, position.fract())
        };
        let ((column, right), (row, down)) = (split(uv.x, self.width), split(uv.y, self.height));
        let mut sum = [0.0; 4];
        for (across, along, weight) in [
            (0, 0, (1.0 - right) * (1.0 - down)),
            (1, 0, right * (1.0 - down)),
            (0, 1, (1.0 - right) * down),
            (1, 1, right * down),
        ] {
            if weight > 0.0 {
                let texel = self.texel(column + across, row + along).to_array();
                for (sum, part) in sum.iter_mut().zip(texel) {
                    *sum += weight * f32::from(part) / 255.0;
                }
            }
        }
        sum
    }

    fn texel(&self, column: usize, row: usize) -> Color32 {
        self.pixels.get(row * self.width + column).copied().unwrap_or_default()
    }
}
