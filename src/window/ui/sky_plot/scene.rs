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
    /// Time of the displayed sky and of the track. Commanded and measured directions are always
    /// current.
    pub now: Timestamp,
    /// Min elevation of planned passes.
    pub minimum_elevation: Angle,
    /// Horizon mask of the site; `None` without a mask.
    pub mask: Option<&'a HorizonMask>,
    /// Zones into which the antenna must not point.
    pub keep_outs: &'a [KeepOutMark<'a>],
    /// Directions that the mount cannot reach.
    pub keyholes: Option<Keyholes>,
    pub track: Option<Track<'a>>,
    pub others: &'a [OtherSatellite<'a>],
    /// Direction of the Sun, which is not drawn below the horizon.
    pub sun: Option<AzEl>,
    /// Direction of the Moon, which is not drawn below the horizon.
    pub moon: Option<AzEl>,
    /// Marks of the sky of another time; `None` for the current sky.
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
    /// Mark of an antenna with unknown elevation, or at a limit of its azimuth.
    pub bearing: Option<Bearing<'a>>,
    /// The predicted direction of the satellite at the time of the measurement.
    pub predicted: Option<AzEl>,
    /// Measured minus predicted direction of the last 60 s, degrees, oldest first: across (azimuth
    /// times the cosine of the elevation) and in elevation.
    pub recent_errors: &'a [(f32, f32)],
    /// Time of the path that another view marks.
    pub marked: Option<Timestamp>,
    /// Lines of the readout: label and value.
    pub readout: &'a [(&'a str, String)],
    /// State sentence, which screen readers read for the whole plot.
    pub description: &'a str,
}

/// A keep-out as the plot shows it.
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
    /// Returns the keyholes, where the lower axis dips below the travel; `None` for a mount without
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
    /// Current direction of the satellite.
    pub position: Option<AzEl>,
}

/// A direction that the operator previews before Azel sends the antenna there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ghost<'a> {
    pub end: AzEl,
    /// Path that both axes would take; empty while it is unknown.
    pub way: &'a [AzEl],
    /// `true` if Azel would refuse the motion.
    pub is_refused: bool,
}

/// A satellite above the horizon that is not selected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherSatellite<'a> {
    pub catalog_number: u32,
    pub name: &'a str,
    /// Current direction.
    pub direction: AzEl,
    /// Path over the next minutes, in order of time.
    pub ahead: &'a [AzEl],
    /// `true` if the satellite stands still in the sky.
    pub geostationary: bool,
}

/// The antenna as last reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured<'a> {
    /// The reported direction.
    pub direction: AzEl,
    /// Age of the report, such as "14 s", if the link is lost.
    pub lost: Option<&'a str>,
}

/// An antenna that is not selected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherAntenna<'a> {
    /// Index of the antenna in the station.
    pub index: usize,
    pub name: &'a str,
    pub commanded: Option<AzEl>,
    pub measured: Option<Measured<'a>>,
    /// Mark of an antenna with unknown elevation, or at a limit of its azimuth.
    pub bearing: Option<Bearing<'a>>,
}

/// Marks that only the sky of another time shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaterScene<'a> {
    pub antennas: &'a [PlannedAntenna<'a>],
    /// Name of the selected antenna.
    pub selected: Option<&'a str>,
}

/// Planned pointing of an antenna at another time.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedAntenna<'a> {
    /// Index of the antenna in the station.
    pub index: usize,
    pub name: &'a str,
    /// Activity at that time, such as "tracking NOAA 20".
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
    /// Commanded azimuth; `None` without a command.
    pub commanded: Option<Angle>,
    /// Target azimuth of a previewed motion.
    pub ghost: Option<Angle>,
    /// Age of the report, such as "14 s", if the link is lost.
    pub lost: Option<&'a str>,
}
