//! Appearance of the window.

use serde::{Deserialize, Serialize};

use super::ThemeName;
use crate::astro::AzEl;

/// Apparent elevation of the Sun's centre at sunrise and sunset, degrees: minus half of the Sun's
/// diameter.
const SUNRISE_DEG: f64 = -0.267;

/// The unit in which the window shows distances.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DistanceUnit {
    #[default]
    Kilometres,
    /// Statute miles.
    Miles,
    NauticalMiles,
}

/// Appearance of the window, as the operator has set it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Appearance {
    pub theme: ThemeName,
    /// `true` if the window uses the light theme while the Sun is above the horizon of the station.
    pub light_by_day: bool,
    /// Scale of the whole window, percent; one of [`Self::SCALES_PERCENT`].
    pub scale_percent: u32,
    /// `true` if the top bar shows the local time next to UTC.
    pub local_time: bool,
    /// Max number of decimals in the angles of an antenna and of the selected satellite; one of
    /// [`Self::ANGLE_DECIMALS`].
    pub angle_decimals: u32,
    pub distances: DistanceUnit,
}

impl Default for Appearance {
    fn default() -> Self {
        Self {
            theme: ThemeName::default(),
            light_by_day: false,
            scale_percent: 100,
            local_time: true,
            angle_decimals: 2,
            distances: DistanceUnit::default(),
        }
    }
}

impl Appearance {
    pub const SCALES_PERCENT: [u32; 5] = [100, 125, 150, 175, 200];
    pub const ANGLE_DECIMALS: [u32; 3] = [1, 2, 3];
    /// Min size of a view in which nothing is cut off, points at 100 %.
    pub const MIN_VIEW: [f32; 2] = [960.0, 540.0];
    /// Min zoom factor at which text is legible.
    pub const MIN_ZOOM: f32 = 0.5;

    /// Returns the zoom factor for a view of this size, points at 100 %. This is the operator's
    /// scale, or less if that scale would cut something off.
    pub fn zoom(self, [width, height]: [f32; 2]) -> f32 {
        let [min_width, min_height] = Self::MIN_VIEW;
        let fitting = (width / min_width).min(height / min_height);
        (self.scale_percent as f32 / 100.0).min(fitting).max(Self::MIN_ZOOM)
    }

    /// Returns the theme for this direction of the Sun.
    pub fn theme_under(self, sun: Option<AzEl>) -> ThemeName {
        let is_day = sun.is_some_and(|sun| sun.elevation_deg() > SUNRISE_DEG);
        match self.theme {
            theme if !self.light_by_day => theme,
            _ if is_day => ThemeName::Light,
            // At night the window needs a dark theme, even if the operator has chosen the light
            // one.
            ThemeName::Light => ThemeName::Dark,
            theme => theme,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_drawn_as_large_as_chosen_and_smaller_where_it_would_be_cut() {
        let zoom =
            |scale_percent, view| Appearance { scale_percent, ..Appearance::default() }.zoom(view);
        let close = |left: f32, right: f32| assert!((left - right).abs() < 1e-3, "{left} {right}");
        close(zoom(100, [1024.0, 640.0]), 1.0);
        close(zoom(175, [1920.0, 1080.0]), 1.75);
        close(zoom(200, [1440.0, 900.0]), 1.5);
        close(zoom(100, [800.0, 440.0]), 0.815);
        close(zoom(100, [100.0, 100.0]), 0.5);
    }

    #[test]
    fn by_day_it_is_light_and_by_night_never() {
        let sun = |elevation_deg: f64| Some(AzEl::from_degrees(90.0, elevation_deg));
        let appearance =
            |theme, light_by_day| Appearance { theme, light_by_day, ..Appearance::default() };
        let night = appearance(ThemeName::Night, true);
        assert_eq!(night.theme_under(sun(-0.2)), ThemeName::Light);
        assert_eq!(night.theme_under(sun(-0.4)), ThemeName::Night);
        assert_eq!(night.theme_under(None), ThemeName::Night);
        assert_eq!(appearance(ThemeName::Light, true).theme_under(sun(-9.0)), ThemeName::Dark);
        assert_eq!(appearance(ThemeName::Dark, false).theme_under(sun(50.0)), ThemeName::Dark);
    }
}
