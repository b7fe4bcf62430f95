//! The content of the sky plot, as plain data.

use jiff::Timestamp;

use crate::{
    astro::{Angle, AzEl, HorizonMask, Zone},
    device::Pointing,
    plan::Sample,
    station::Mount,
};

/// Content of the plot at one moment. The plot leaves out directions that are not finite.
#[derive(Debug, Clone)]
pub struct SkyScene<'a> {
    /// The displayed time, of the track as well. All that is commanded or measured is of now.
    pub now: Timestamp,
    /// Lowest elevation at which passes are planned.
    pub minimum_elevation: Angle,
    /// The horizon mask of the site.
    pub mask: Option<&'a HorizonMask>,
    /// Zones into which the antenna must not point.
    pub keep_outs: &'a [KeepOutMark<'a>],
    /// Directions that the mount cannot reach.
    pub keyholes: Option<Keyholes>,
    pub track: Option<Track<'a>>,
    pub others: &'a [OtherSatellite<'a>],
    /// The Sun; not drawn below the horizon.
    pub sun: Option<AzEl>,
    /// The Moon; not drawn below the horizon.
    pub moon: Option<AzEl>,
    /// In the sky of another time; `None` for now.
    pub later: Option<LaterScene<'a>>,
    /// The commanded direction.
    pub commanded: Option<AzEl>,
    /// Preview of a motion.
    pub ghost: Option<Ghost<'a>>,
    /// Full width of the beam.
    pub beam_width: Angle,
    /// The measured direction.
    pub measured: Option<Measured<'a>>,
    /// The antennas that are not selected.
    pub antennas: &'a [OtherAntenna<'a>],
    /// The ends of azimuth axes.
    pub stops: &'a [AzimuthStop<'a>],
    /// The antenna, while only its azimuth or a limit of its azimuth is known.
    pub bearing: Option<Bearing<'a>>,
    /// The predicted direction of the satellite at the time of the measurement.
    pub predicted: Option<AzEl>,
    /// Measured minus predicted of the last 60 s in degrees, oldest first:
    /// across (azimuth times the cosine of the elevation) and in elevation.
    pub recent_errors: &'a [(f32, f32)],
    /// A time of the path that is marked elsewhere.
    pub marked: Option<Timestamp>,
    /// Lines of the readout: label and value.
    pub readout: &'a [(&'a str, String)],
    /// The state sentence, read aloud for the whole plot.
    pub description: &'a str,
}

/// A region in which the antenna must not point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeepOutMark<'a> {
    /// The operator's name for the zone.
    pub name: &'a str,
    pub zone: &'a Zone,
    /// Distance that the antenna keeps from the zone.
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
    /// The keyholes where the lower axis dips below the travel; `None` for a mount without
    /// such an axis.
    pub fn new(mount: &Mount) -> Option<Self> {
        let Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, .. } = *mount else {
            return None;
        };
        Some(Self {
            lower_axis_azimuth: Angle::from_degrees(lower_axis_azimuth_deg),
            radius: Angle::from_degrees(travel_from_deg.clamp(1.0, 45.0)),
        })
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track<'a> {
    pub catalog_number: u32,
    pub name: &'a str,
    /// The path in order of time, dense enough for straight lines between samples.
    pub samples: &'a [Sample],
    pub aos: Sample,
    pub tca: Sample,
    pub los: Sample,
    /// `false` if the path begins at the start of the prediction window.
    pub show_aos: bool,
    /// `false` if the path ends at the end of the prediction window.
    pub show_los: bool,
    /// Present direction of the satellite.
    pub position: Option<AzEl>,
}

/// A direction that the operator looks at before the antenna is sent there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ghost<'a> {
    pub end: AzEl,
    /// The way that both axes would take; empty while it is not known.
    pub way: &'a [AzEl],
    /// The antenna would not be sent there.
    pub is_refused: bool,
}

/// A satellite above the horizon that is not selected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherSatellite<'a> {
    pub catalog_number: u32,
    pub name: &'a str,
    /// Present direction.
    pub direction: AzEl,
    /// The path of the next minutes, in order of time.
    pub ahead: &'a [AzEl],
    /// The satellite stands still in the sky.
    pub geostationary: bool,
}

/// The antenna as last reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured<'a> {
    /// The reported direction.
    pub direction: AzEl,
    /// The age of the report, such as "14 s", once the link is lost.
    pub lost: Option<&'a str>,
}

/// An antenna that is not selected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherAntenna<'a> {
    /// Its place in the station.
    pub index: usize,
    pub name: &'a str,
    pub commanded: Option<AzEl>,
    pub measured: Option<Measured<'a>>,
    /// While only its azimuth or a limit of its azimuth is known.
    pub bearing: Option<Bearing<'a>>,
}

/// Marks that only the sky of another time shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaterScene<'a> {
    pub antennas: &'a [PlannedAntenna<'a>],
    /// Name of the selected antenna.
    pub selected: Option<&'a str>,
}

/// Where the plan has an antenna at another time.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedAntenna<'a> {
    /// Its place in the station.
    pub index: usize,
    pub name: &'a str,
    /// Its activity then, such as "tracking NOAA 20".
    pub doing: String,
    pub pointing: Pointing,
}

/// The end of an azimuth axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AzimuthStop<'a> {
    /// The antennas whose axis ends there.
    pub names: std::borrow::Cow<'a, str>,
    pub azimuth: Angle,
}

/// An antenna with unknown elevation, or at a limit of its azimuth.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bearing<'a> {
    pub name: &'a str,
    /// Measured azimuth, or the end of the travel at `limit`.
    pub measured: Option<Angle>,
    /// Name of the limit at which the unit shows no azimuth, such as "CCW limit".
    pub limit: Option<&'static str>,
    /// Commanded azimuth.
    pub commanded: Option<Angle>,
    /// Target azimuth of a previewed motion.
    pub ghost: Option<Angle>,
    /// The age of the report, such as "14 s", once the link is lost.
    pub lost: Option<&'a str>,
}
