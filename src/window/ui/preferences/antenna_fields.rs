//! Fields of an antenna of any make: connection, mount, and the fields that every antenna has.

use super::{
    connection_fields,
    fields::{Description, Placed, placed},
};
use crate::{
    astro::{PointingModel, Term},
    station::{AfterPass, Antenna, ControllerSpec, Monitor, Mount, Resume, ranges},
    ui::words::pointing::pointing_term,
};

type AntennaDescription = Description<Antenna>;

/// Titles of the cards of the page.
const MOUNT: &str = "Mount and travel";
pub(super) const POINTING: &str = "Pointing model";
pub(in crate::ui) const UPKEEP: &str = "Upkeep between passes";
const FOLLOWING: &str = "Following and outages";
pub(super) const WATCH: &str = "Polling and supervision";

/// Returns all fields that an antenna of this make may have.
pub(super) fn all(spec: &'static ControllerSpec) -> Vec<Placed<Antenna>> {
    let mut all = connection_fields::unit(spec);
    all.extend(placed(UPKEEP, upkeep()));
    all.extend(placed(MOUNT, mount()));
    all.extend(placed(MOUNT, beam()));
    all.extend(placed(MOUNT, limits()));
    all.extend(connection_fields::tables(spec));
    all.extend(placed(POINTING, Term::ALL.map(pointing)));
    all.extend(placed(FOLLOWING, follow()));
    all.extend(placed(FOLLOWING, outage()));
    all.extend(placed(FOLLOWING, [connects_at_start()]));
    all.extend(placed(WATCH, poll()));
    all.extend(placed(WATCH, watch()));
    all
}

fn mount() -> [AntennaDescription; 7] {
    [
        AntennaDescription::number(
            "Azimuth of the lower axis",
            ranges::LOWER_AXIS_AZIMUTH_DEG,
            "°",
            |antenna| xy(antenna).map(|[azimuth, ..]| azimuth),
        ),
        AntennaDescription::number("Travel from", ranges::TRAVEL_FROM_DEG, "°", |antenna| {
            xy(antenna).map(|[_, start, _]| start)
        }),
        AntennaDescription::number("Travel to", ranges::TRAVEL_TO_DEG, "°", |antenna| {
            xy(antenna).map(|[.., end]| end)
        }),
        AntennaDescription::number("Azimuth from", ranges::AZIMUTH_FROM_DEG, "°", |antenna| {
            az_el(antenna).map(|[start, ..]| start)
        }),
        AntennaDescription::number("Azimuth to", ranges::AZIMUTH_TO_DEG, "°", |antenna| {
            az_el(antenna).map(|[_, end, ..]| end)
        })
        .checked(|antenna| {
            let [(start, end), _] = antenna.mount.travel_deg();
            let is_right = ranges::AZIMUTH_SPAN_DEG.contains(&(end - start));
            is_right.then_some(()).ok_or("must be 1 to 1080° more than Azimuth from")
        }),
        AntennaDescription::number("Elevation from", ranges::ELEVATION_FROM_DEG, "°", |antenna| {
            az_el(antenna).map(|[_, _, start, _]| start)
        })
        .when(has_elevation),
        AntennaDescription::number("Elevation to", ranges::ELEVATION_TO_DEG, "°", |antenna| {
            az_el(antenna).map(|[.., end]| end)
        })
        .when(has_elevation)
        .checked(|antenna| {
            let [_, (start, end)] = antenna.mount.travel_deg();
            let is_right = ranges::ELEVATION_SPAN_DEG.contains(&(end - start));
            is_right.then_some(()).ok_or("must be 1° or more above Elevation from")
        })
        .noted(|antenna| {
            let words = "Beyond 90° the antenna may be tipped over the zenith to track.";
            antenna.mount.can_flip().then(|| words.to_owned())
        }),
    ]
}

/// Returns the azimuth of the lower axis and both ends of the travel, for an X/Y mount.
fn xy(antenna: &mut Antenna) -> Option<[&mut f64; 3]> {
    match &mut antenna.mount {
        Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, travel_to_deg } => {
            Some([lower_axis_azimuth_deg, travel_from_deg, travel_to_deg])
        }
        Mount::AzEl { .. } => None,
    }
}

/// Returns both ends of azimuth and elevation, for an elevation-over-azimuth mount.
fn az_el(antenna: &mut Antenna) -> Option<[&mut f64; 4]> {
    match &mut antenna.mount {
        Mount::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_from_deg, elevation_to_deg } => {
            Some([azimuth_from_deg, azimuth_to_deg, elevation_from_deg, elevation_to_deg])
        }
        Mount::Xy { .. } => None,
    }
}

fn beam() -> [AntennaDescription; 3] {
    [
        AntennaDescription::number("Beamwidth", ranges::BEAM_WIDTH_DEG, "°", |antenna| {
            Some(&mut antenna.beam_width_deg)
        }),
        AntennaDescription::number("Park azimuth", ranges::AZIMUTH_DEG, "°", |antenna| {
            Some(&mut antenna.park.azimuth_deg)
        }),
        AntennaDescription::number("Park elevation", ranges::ELEVATION_DEG, "°", |antenna| {
            Some(&mut antenna.park.elevation_deg)
        })
        .when(has_elevation),
    ]
}

fn limits() -> [AntennaDescription; 3] {
    [
        AntennaDescription::number("Minimum elevation", ranges::ELEVATION_DEG, "°", |antenna| {
            Some(&mut antenna.limits.minimum_elevation_deg)
        })
        .described("The antenna is never sent below it."),
        AntennaDescription::number("Maximum rate", ranges::MAXIMUM_RATE_DEG_S, "°/s", |antenna| {
            Some(&mut antenna.limits.maximum_rate_deg_s)
        }),
        AntennaDescription::number("Maximum step", ranges::MAXIMUM_STEP_DEG, "°", |antenna| {
            Some(&mut antenna.limits.maximum_step_deg)
        })
        .when(|antenna| antenna.connection.variant().capabilities.steps),
    ]
}

fn poll() -> [AntennaDescription; 2] {
    [
        AntennaDescription::number("Poll at rest", ranges::POLL_HZ, "Hz", |antenna| {
            Some(&mut antenna.poll.idle_hz)
        }),
        AntennaDescription::number("Poll while moving", ranges::POLL_HZ, "Hz", |antenna| {
            Some(&mut antenna.poll.moving_hz)
        }),
    ]
}

/// Returns the field of a pointing term of an az/el mount: a difference between the axes and the
/// direction of the beam.
fn pointing(term: Term) -> AntennaDescription {
    let (range, unit) = if term == Term::ElevationScale {
        (ranges::POINTING_SCALE, "°/°")
    } else {
        (ranges::POINTING_TERM_DEG, "°")
    };
    let field = AntennaDescription::number(pointing_term(term), range, unit, move |antenna| {
        Some(model(antenna)?.place(term))
    });
    if term == Term::AzimuthOffset {
        field.noted(|antenna| Some(about_model(antenna).to_owned()))
    } else {
        field.when(has_elevation)
    }
}

/// Returns the pointing model of an az/el antenna that takes positions from Azel.
pub(super) fn model(antenna: &mut Antenna) -> Option<&mut PointingModel> {
    let has_model = takes_positions(antenna) && matches!(antenna.mount, Mount::AzEl { .. });
    has_model.then_some(&mut antenna.pointing_model)
}

fn about_model(antenna: &Antenna) -> &'static str {
    let can_flip = antenna.mount.can_flip();
    match antenna.pointing_model.is_none() {
        false if can_flip => {
            "Applied to every track that Azel leads. With a model the antenna is not tipped over \
             the zenith."
        }
        false => "Applied to every track that Azel leads.",
        true => "What the axes read beyond the direction of the beam.",
    }
}

fn follow() -> [AntennaDescription; 4] {
    [
        AntennaDescription::number("New position every", ranges::FOLLOW_PERIOD_S, "s", |antenna| {
            Some(&mut antenna.follow.period_s)
        }),
        AntennaDescription::number("Dead band", ranges::DEAD_BAND_DEG, "°", |antenna| {
            Some(&mut antenna.follow.dead_band_deg)
        }),
        AntennaDescription::number("Latency", ranges::LATENCY_S, "s", |antenna| {
            Some(&mut antenna.follow.latency_s)
        }),
        AntennaDescription::choice(
            "After a pass",
            &[(0, "Hold"), (1, "Park"), (2, "Wait for the next")],
            &[AfterPass::Hold, AfterPass::Park, AfterPass::Next],
            |antenna| &mut antenna.follow.after,
        ),
    ]
}

fn upkeep() -> [AntennaDescription; 4] {
    let has_clock = |antenna: &Antenna| antenna.connection.variant().clock.is_some();
    [
        AntennaDescription::choice(
            "Clock of the unit",
            &[(0, "Leave alone"), (1, "Set")],
            &[false, true],
            |antenna| &mut antenna.upkeep.sets_clock,
        )
        .when(has_clock)
        .noted(|antenna| {
            let words = if antenna.upkeep.sets_clock {
                "Azel sets the clock only while automatic operation is on and the clock of this \
                 computer is synchronised."
            } else {
                "Azel can set it between the passes of automatic operation."
            };
            Some(words.to_owned())
        }),
        AntennaDescription::number("Maximum clock error", ranges::CLOCK_LIMIT_S, "s", |antenna| {
            Some(&mut antenna.upkeep.clock_limit_s)
        })
        .when(|antenna| antenna.upkeep.sets_clock && antenna.connection.variant().clock.is_some()),
        AntennaDescription::choice(
            "Elements on the unit",
            &[(0, "Leave alone"), (1, "Upload newer")],
            &[false, true],
            |antenna| &mut antenna.upkeep.uploads_elements,
        )
        .when(takes_elements)
        .noted(|antenna| {
            let words = if antenna.upkeep.uploads_elements {
                "Azel repeats the last verified upload with all favourites. Upload once by hand first."
            } else {
                "Azel can upload newer ones between the passes of automatic operation."
            };
            Some(words.to_owned())
        }),
        AntennaDescription::number("Maximum age of elements", ranges::ELEMENT_AGE_D, "days", |antenna| {
            Some(&mut antenna.upkeep.element_limit_d)
        })
        .when(|antenna| antenna.upkeep.uploads_elements && takes_elements(antenna)),
    ]
}

fn takes_elements(antenna: &Antenna) -> bool {
    antenna.connection.spec().element_files.is_some()
}

fn connects_at_start() -> AntennaDescription {
    AntennaDescription::choice(
        "When Azel starts",
        &[(0, "Wait for Connect"), (1, "Connect automatically")],
        &[false, true],
        |antenna| &mut antenna.connects_at_start,
    )
    .when(|antenna| antenna.connection.variant().capabilities.waits_for_word)
    .noted(|antenna| {
        let words = "Connecting interrupts anyone who works at the unit's panel.";
        antenna.connects_at_start.then(|| words.to_owned())
    })
}

fn outage() -> [AntennaDescription; 2] {
    [
        AntennaDescription::number(
            "Resume after outages up to",
            ranges::RESUME_AFTER_S,
            "s",
            |antenna| Some(&mut antenna.resume_after_s),
        )
        .when(takes_positions),
        AntennaDescription::choice(
            "After a longer outage",
            &[(0, "Stop and ask"), (1, "Keep tracking")],
            &[Resume::Ask, Resume::Continue],
            |antenna| &mut antenna.resume,
        )
        .when(takes_positions)
        .noted(|antenna| {
            let words = match antenna.resume {
                Resume::Ask => "The antenna stays stopped until you let it continue.",
                Resume::Continue => {
                    "Continues by itself if the antenna is where it was left. Otherwise it asks."
                }
            };
            Some(words.to_owned())
        }),
    ]
}

fn watch() -> [AntennaDescription; 2] {
    [
        AntennaDescription::choice(
            "If others enter a keep-out",
            &[(0, "STOP and alarm"), (1, "Alarm only")],
            &[Monitor::Stop, Monitor::Alarm],
            |antenna| &mut antenna.monitor,
        )
        .described(
            "Also if they come too close to the Sun. Others are the panel, other \
                         programs and the unit's own program; motion commanded by Azel is always \
                         stopped.",
        ),
        AntennaDescription::number("Allowed sway", ranges::SWAY_DEG, "°", |antenna| {
            Some(&mut antenna.sway_deg)
        })
        .described("How much the angle may change between two readings of an antenna at rest."),
    ]
}

/// Returns `true` if the antenna is capable of program track.
fn takes_positions(antenna: &Antenna) -> bool {
    antenna.connection.variant().capabilities.takes_positions
}

/// Returns `true` if the antenna moves in azimuth and elevation.
pub(super) fn has_elevation(antenna: &Antenna) -> bool {
    antenna.connection.variant().capabilities.has_elevation()
}
