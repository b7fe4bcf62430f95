//! What the sky plot shows, as plain data.

use jiff::Timestamp;

use crate::{
    astro::{Angle, AzEl, HorizonMask, Zone},
    plan::Sample,
    station::Mount,
};

/// Everything in the plot at one moment. A direction that is not finite is
/// left out.
#[derive(Debug, Clone)]
pub struct SkyScene<'a> {
    /// The moment shown.
    pub now: Timestamp,
    /// Lowest elevation at which passes are planned.
    pub minimum_elevation: Angle,
    /// What blocks the sky of the site.
    pub mask: Option<&'a HorizonMask>,
    /// Where the antenna must not point.
    pub keep_outs: &'a [KeepOutMark<'a>],
    /// Where the mount cannot point.
    pub keyholes: Option<Keyholes>,
    /// The selected pass.
    pub track: Option<Track<'a>>,
    /// Satellites that are not selected.
    pub others: &'a [OtherSatellite<'a>],
    /// The Sun; not drawn below the horizon.
    pub sun: Option<AzEl>,
    /// The Moon; not drawn below the horizon.
    pub moon: Option<AzEl>,
    /// Where the antenna is told to point.
    pub commanded: Option<AzEl>,
    /// Preview of a motion: from here to there.
    pub ghost: Option<(AzEl, AzEl)>,
    /// Full width of the beam.
    pub beam_width: Angle,
    /// Where the antenna points.
    pub measured: Option<Measured<'a>>,
    /// The antenna, while only its azimuth is known.
    pub bearing: Option<Bearing<'a>>,
    /// Where the satellite was at the time of the measurement.
    pub predicted: Option<AzEl>,
    /// Measured minus predicted of the last 60 s in degrees, oldest first:
    /// across (azimuth times the cosine of the elevation) and in elevation.
    pub recent_errors: &'a [(f32, f32)],
    /// Lines of the upper left corner: label and value.
    pub readout: &'a [(&'a str, String)],
    /// The state sentence, read aloud for the whole plot.
    pub description: &'a str,
}

/// A region in which the antenna must not point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeepOutMark<'a> {
    /// What the operator calls it.
    pub name: &'a str,
    /// Its edges.
    pub zone: &'a Zone,
    /// How far the antenna stays away from them.
    pub margin: Angle,
}

/// The caps on the horizon at both ends of the lower axis of an X/Y mount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keyholes {
    /// Azimuth of one end of the lower axis.
    pub lower_axis_azimuth: Angle,
    /// Angular radius of each cap.
    pub radius: Angle,
}

impl Keyholes {
    /// Where the lower axis dips below what the travel reaches; `None` for a mount
    /// without such an axis.
    pub fn of(mount: &Mount) -> Option<Self> {
        let Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, .. } = *mount else {
            return None;
        };
        Some(Self {
            lower_axis_azimuth: Angle::from_degrees(lower_axis_azimuth_deg),
            radius: Angle::from_degrees(travel_from_deg.clamp(1.0, 45.0)),
        })
    }
}

/// The selected pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track<'a> {
    /// Catalog number of the satellite.
    pub catalog_number: u32,
    /// Name of the satellite.
    pub name: &'a str,
    /// The path in order of time, dense enough to be joined by straight lines.
    pub samples: &'a [Sample],
    /// Rise.
    pub aos: Sample,
    /// Highest point.
    pub tca: Sample,
    /// Set.
    pub los: Sample,
    /// False when the path begins with the window of the prediction.
    pub show_aos: bool,
    /// False when the path ends with the window of the prediction.
    pub show_los: bool,
    /// Where the satellite is now.
    pub position: Option<AzEl>,
}

/// A satellite above the horizon that is not selected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherSatellite<'a> {
    /// Catalog number.
    pub catalog_number: u32,
    /// Name.
    pub name: &'a str,
    /// Where it is now.
    pub direction: AzEl,
    /// The path of the next minutes, in order of time.
    pub ahead: &'a [AzEl],
    /// Whether it stands still in the sky.
    pub geostationary: bool,
}

/// The antenna as last reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured<'a> {
    /// Where it pointed.
    pub direction: AzEl,
    /// The age of the report, such as "14 s", once the link is lost.
    pub lost: Option<&'a str>,
}

/// An antenna without a known elevation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bearing<'a> {
    /// Name of the antenna.
    pub name: &'a str,
    /// Where it points.
    pub measured: Option<Angle>,
    /// Where it is told to point.
    pub commanded: Option<Angle>,
    /// Preview of a motion to here.
    pub ghost: Option<Angle>,
    /// The age of the report, such as "14 s", once the link is lost.
    pub lost: Option<&'a str>,
}
