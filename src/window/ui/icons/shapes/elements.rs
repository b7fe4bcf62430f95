//! Shapes of the icons of the Elements view.

use super::{Icon, Pen};

/// Draws an icon of the Elements view; draws nothing for other icons.
pub(super) fn draw(pen: &Pen<'_>, icon: Icon) {
    match icon {
        Icon::Star => {
            let star = star();
            for tip in (0..10).step_by(2) {
                let point = |place: usize| star.get(place % 10).copied().unwrap_or_default();
                pen.filled(&[point(tip), point(tip + 1), (10.0, 10.6), point(tip + 9)]);
            }
        }
        Icon::OpenStar => pen.outline(&star()),
        Icon::Plus => {
            pen.line(&[(10.0, 4.0), (10.0, 16.0)]);
            pen.line(&[(4.0, 10.0), (16.0, 10.0)]);
        }
        Icon::Server => {
            pen.outline(&[(3.0, 3.5), (17.0, 3.5), (17.0, 9.0), (3.0, 9.0)]);
            pen.outline(&[(3.0, 11.0), (17.0, 11.0), (17.0, 16.5), (3.0, 16.5)]);
            pen.disc((6.2, 6.2), 1.0);
            pen.disc((6.2, 13.8), 1.0);
        }
        Icon::File => {
            pen.outline(&[(4.5, 2.5), (11.5, 2.5), (15.5, 6.5), (15.5, 17.5), (4.5, 17.5)]);
            pen.line(&[(11.5, 2.5), (11.5, 6.5), (15.5, 6.5)]);
        }
        Icon::Folder => pen.outline(&[
            (2.5, 4.5),
            (8.0, 4.5),
            (9.8, 6.8),
            (17.5, 6.8),
            (17.5, 16.0),
            (2.5, 16.0),
        ]),
        Icon::Package => {
            let top = [(10.0, 2.5), (17.0, 6.2), (10.0, 9.9), (3.0, 6.2)];
            pen.outline(&top);
            pen.line(&[(3.0, 6.2), (3.0, 13.8), (10.0, 17.5), (17.0, 13.8), (17.0, 6.2)]);
            pen.line(&[(10.0, 9.9), (10.0, 17.5)]);
        }
        Icon::Upload => {
            pen.line(&[(10.0, 13.0), (10.0, 3.5)]);
            pen.line(&[(6.0, 7.2), (10.0, 3.5), (14.0, 7.2)]);
            pen.line(&[(3.5, 16.5), (16.5, 16.5)]);
        }
        Icon::Download => {
            pen.line(&[(10.0, 3.5), (10.0, 13.0)]);
            pen.line(&[(6.0, 9.3), (10.0, 13.0), (14.0, 9.3)]);
            pen.line(&[(3.5, 16.5), (16.5, 16.5)]);
        }
        Icon::Copy => {
            pen.outline(&[(7.5, 7.5), (17.0, 7.5), (17.0, 17.0), (7.5, 17.0)]);
            pen.line(&[(5.2, 12.5), (3.0, 12.5), (3.0, 3.0), (12.5, 3.0), (12.5, 5.2)]);
        }
        Icon::Refresh => {
            pen.arc((10.0, 10.0), 6.5, -40.0, 250.0);
            pen.line(&[(15.6, 1.8), (15.3, 6.0), (11.2, 5.6)]);
        }
        Icon::Search => {
            pen.ring((8.5, 8.5), 5.5);
            pen.line(&[(12.6, 12.6), (17.5, 17.5)]);
        }
        _ => {}
    }
}

/// Returns the tips and notches of a star, starting at the upper tip.
fn star() -> [(f32, f32); 10] {
    std::array::from_fn(|corner| {
        let radius = if corner % 2 == 0 { 8.2 } else { 3.5 };
        let (sin, cos) = (std::f32::consts::PI / 5.0 * corner as f32).sin_cos();
        (10.0 + radius * sin, 10.6 - radius * cos)
    })
}
