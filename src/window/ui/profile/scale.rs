//! The scales of the plots, which map values to y.

use egui::{Pos2, Rect, pos2};

/// Top of the elevation scale, degrees.
pub(in crate::ui) const ELEVATION_TOP_DEG: f64 = 90.0;
/// Top of the azimuth scale, degrees.
pub(in crate::ui) const AZIMUTH_TOP_DEG: f64 = 360.0;
/// Min top of the error plot, in half beams.
const MIN_ERROR_HALF_BEAMS: f64 = 1.4;
/// Max top of the error plot, in half beams; larger errors lie at the top edge.
const MAX_ERROR_HALF_BEAMS: f64 = 3.0;

/// Returns the y of `value` in `rect`, whose bottom is 0 and whose top is `top`. A value outside
/// this range lies at the edge.
pub(in crate::ui) fn y(rect: Rect, value: f64, top: f64) -> f32 {
    rect.bottom() - (value / top).clamp(0.0, 1.0) as f32 * rect.height()
}

/// Returns the top of the error plot, degrees: 1.4 half beams, or up to 3 for larger errors.
/// Without a beam, the top is the largest error.
pub(in crate::ui) fn error_top_deg(errors: impl Iterator<Item = f64>, half_beam_deg: f64) -> f64 {
    let largest = errors.filter(|error| error.is_finite()).fold(0.0, f64::max);
    if has_beam(half_beam_deg) {
        largest.clamp(MIN_ERROR_HALF_BEAMS * half_beam_deg, MAX_ERROR_HALF_BEAMS * half_beam_deg)
    } else if largest > 0.0 {
        largest
    } else {
        1.0
    }
}

pub(in crate::ui) fn has_beam(half_beam_deg: f64) -> bool {
    half_beam_deg.is_finite() && half_beam_deg > 0.0
}

/// Returns the points of a curve, cut into pieces at values that are not finite.
pub(in crate::ui) fn pieces(
    points: impl Iterator<Item = (f32, f64)>,
    rect: Rect,
    top: f64,
) -> Vec<Vec<Pos2>> {
    let mut pieces = vec![Vec::new()];
    for (x, value) in points {
        if !value.is_finite() {
            pieces.push(Vec::new());
        } else if let Some(piece) = pieces.last_mut() {
            piece.push(pos2(x, y(rect, value, top)));
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

/// Breaks a curve of azimuths in degrees where it crosses north. One piece ends at one edge of the
/// scale, and the next starts at the other edge. A value that is not finite separates them.
pub(in crate::ui) fn broken_at_north(points: impl Iterator<Item = (f32, f64)>) -> Vec<(f32, f64)> {
    let mut broken: Vec<(f32, f64)> = Vec::new();
    for (x, azimuth_deg) in points {
        let azimuth_deg = azimuth_deg.rem_euclid(AZIMUTH_TOP_DEG);
        if let Some(&(last_x, last_deg)) = broken.last()
            && (azimuth_deg - last_deg).abs() > AZIMUTH_TOP_DEG / 2.0
        {
            let (out_deg, in_deg) = if azimuth_deg < last_deg {
                (AZIMUTH_TOP_DEG, 0.0)
            } else {
                (0.0, AZIMUTH_TOP_DEG)
            };
            let before_deg = (out_deg - last_deg).abs();
            let after_deg = (azimuth_deg - in_deg).abs();
            let turn_deg = before_deg + after_deg;
            let part = if turn_deg > 0.0 { before_deg / turn_deg } else { 0.0 };
            let north_x = last_x + part as f32 * (x - last_x);
            broken.extend([(north_x, out_deg), (north_x, f64::NAN), (north_x, in_deg)]);
        }
        broken.push((x, azimuth_deg));
    }
    broken
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::vec2;

    const PLOT: Rect = Rect { min: pos2(40.0, 10.0), max: pos2(340.0, 100.0) };

    fn near(a: f32, b: f32) -> bool {
        (a - b).abs() < 1e-3
    }

    #[test]
    fn values_stay_in_the_plot() {
        assert!(near(y(PLOT, 0.0, 90.0), 100.0) && near(y(PLOT, 90.0, 90.0), 10.0));
        assert!(near(y(PLOT, 30.0, 90.0), 70.0));
        assert!(near(y(PLOT, -3.0, 90.0), 100.0) && near(y(PLOT, 95.0, 90.0), 10.0));
    }

    #[test]
    fn the_error_plot_grows_up_to_three_half_beams() {
        let top = |errors: &[f64]| error_top_deg(errors.iter().copied(), 0.5);
        assert!((top(&[]) - 0.7).abs() < 1e-9);
        assert!((top(&[0.04, f64::NAN]) - 0.7).abs() < 1e-9);
        assert!((top(&[1.1, 0.2]) - 1.1).abs() < 1e-9);
        assert!((top(&[1.1, f64::INFINITY, 40.0]) - 1.5).abs() < 1e-9);
        assert!((error_top_deg([0.3].into_iter(), f64::NAN) - 0.3).abs() < 1e-9);
        assert!(error_top_deg([].into_iter(), 0.0) > 0.0);
    }

    #[test]
    fn azimuth_breaks_at_north_in_both_directions() {
        let east = broken_at_north([(0.0, 350.0), (30.0, 20.0)].into_iter());
        let (xs, degs): (Vec<f32>, Vec<f64>) = east.into_iter().unzip();
        assert!(xs[1..4].iter().all(|&x| near(x, 10.0)), "{xs:?}");
        assert!((degs[1] - 360.0).abs() < 1e-9 && degs[2].is_nan() && degs[3].abs() < 1e-9);

        let west = broken_at_north([(0.0, 5.0), (10.0, 355.0)].into_iter());
        let drawn = pieces(west.into_iter(), PLOT, AZIMUTH_TOP_DEG);
        assert_eq!(drawn.len(), 2);
        assert!(near(drawn[0][1].y, PLOT.bottom()) && near(drawn[1][0].y, PLOT.top()));
    }

    #[test]
    fn azimuth_in_the_south_is_one_piece() {
        let south = [(0.0, 100.0), (10.0, 180.0), (20.0, 260.0)];
        assert_eq!(broken_at_north(south.into_iter()), south);
    }

    #[test]
    fn a_gap_is_not_bridged() {
        let points = [(0.0, 1.0), (1.0, 2.0), (2.0, f64::NAN), (3.0, 1.0), (4.0, 3.0)];
        let drawn =
            pieces(points.into_iter(), Rect::from_min_size(Pos2::ZERO, vec2(9.0, 9.0)), 9.0);
        assert_eq!(drawn.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    }
}
