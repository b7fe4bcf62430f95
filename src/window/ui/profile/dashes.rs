//! Dashes along a curve of many short segments.

use egui::{Painter, Pos2, Stroke};

/// Paints `path` in dashes. Each dash is one line, even around a bend. The ends of separate
/// segments would extend into the gaps.
pub(in crate::ui) fn paint(painter: &Painter, path: &[Pos2], stroke: Stroke, pattern: (f32, f32)) {
    for dash in along(path, pattern) {
        // egui aligns only a horizontal segment with whole pixels.
        if let [start, end] = dash[..] {
            painter.line_segment([start, end], stroke);
        } else {
            painter.line(dash, stroke);
        }
    }
}

/// Returns the dashes of `path` by its arc length; `pattern` contains dash and gap.
fn along(path: &[Pos2], (dash, gap): (f32, f32)) -> Vec<Vec<Pos2>> {
    let mut dashes: Vec<Vec<Pos2>> = Vec::new();
    let mut drawing = false;
    // Remaining length of the dash or the gap.
    let mut left = 0.0;
    for pair in path.windows(2) {
        let &[start, end] = pair else { continue };
        let length = start.distance(end);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            // Unlike lerp, this formula is exact on a horizontal path.
            let here = start + (done / length) * (end - start);
            if drawing {
                dashes.last_mut().into_iter().for_each(|line| line.push(here));
            } else {
                dashes.push(vec![here]);
            }
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
        left -= length - done;
        if drawing {
            dashes.last_mut().into_iter().for_each(|line| line.push(end));
        }
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn dashes_do_not_depend_on_the_segments() {
        let long = along(&[pos2(0.0, 0.0), pos2(24.0, 0.0)], (6.0, 4.5));
        let steps: Vec<Pos2> = (0..=8).map(|step| pos2(3.0 * step as f32, 0.0)).collect();
        let short = along(&steps, (6.0, 4.5));
        let ends = |dashes: &[Vec<Pos2>]| -> Vec<(i32, i32)> {
            let milli = |point: Pos2| (1000.0 * point.x).round() as i32;
            dashes.iter().map(|dash| (milli(dash[0]), milli(dash[dash.len() - 1]))).collect()
        };
        assert_eq!(ends(&long), [(0, 6_000), (10_500, 16_500), (21_000, 24_000)]);
        assert_eq!(ends(&short), ends(&long));
    }

    #[test]
    fn a_dash_goes_round_a_bend() {
        let bend = [pos2(0.0, 0.0), pos2(4.0, 0.0), pos2(4.0, 9.0)];
        assert_eq!(
            along(&bend, (6.0, 9.0)),
            [vec![pos2(0.0, 0.0), pos2(4.0, 0.0), pos2(4.0, 2.0)]]
        );
    }

    #[test]
    fn a_path_without_length_has_no_dashes() {
        assert!(along(&[], (6.0, 4.0)).is_empty());
        assert!(along(&[pos2(1.0, 1.0); 3], (6.0, 4.0)).is_empty());
    }
}
