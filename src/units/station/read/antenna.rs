//! Reading of one antenna of the station file.

use std::ops::RangeInclusive;

use toml::Value;

use super::TableFields;
use crate::{
    astro::PointingModel,
    station::{
        AfterPass, Antenna, AntennaId, Connection, ControllerSpec, Direction, Monitor,
        MotionLimits, Mount, PollRates, Resume, Setting, TrackSettings, ranges,
    },
};

impl TableFields<'_> {
    /// Reads an antenna. Controller and address are required; they have no default.
    pub(super) fn antenna(
        &mut self,
        specs: &[&'static ControllerSpec],
        before: &[Antenna],
        used_ids: &[AntennaId],
    ) -> Option<Antenna> {
        let default = self.inner("connection", |connection| connection.connected(specs))?;
        let name = self.text("name", &default.name);
        Some(Antenna {
            id: self.antenna_id(before, used_ids),
            name,
            connects_at_start: self.flag("connects_at_start", false),
            mount: self.inner("mount", |mount| mount.mount(default.mount)),
            beam_width_deg: self.number(
                "beam_width_deg",
                &ranges::BEAM_WIDTH_DEG,
                default.beam_width_deg,
            ),
            park: self.inner("park", |park| park.direction(default.park)),
            limits: self.inner("limits", |limits| limits.limits(default.limits)),
            poll: self.inner("poll", |poll| poll.poll(default.poll)),
            follow: self.inner("follow", |follow| follow.following(default.follow)),
            pointing_model: self
                .inner("pointing_model", |model| model.pointing_model(default.pointing_model)),
            monitor: self.one_of(
                "monitor",
                &[("stop", Monitor::Stop), ("alarm", Monitor::Alarm)],
                default.monitor,
            ),
            sway_deg: self.number("sway_deg", &ranges::SWAY_DEG, default.sway_deg),
            resume: self.resume(default.resume),
            resume_after_s: self.number(
                "resume_after_s",
                &ranges::RESUME_AFTER_S,
                default.resume_after_s,
            ),
            automatic: self.automatic(),
            upkeep: self.upkeep(),
            connection: default.connection,
        })
    }

    /// Returns the id in the file, or a free id if another antenna has that id.
    fn antenna_id(&mut self, before: &[Antenna], used_ids: &[AntennaId]) -> AntennaId {
        let free = AntennaId::free(AntennaId::FIRST, used_ids);
        let Some(value) = self.table.remove("id") else { return free };
        let id = value.as_integer().and_then(|id| u32::try_from(id).ok()).map(AntennaId);
        let is_free = |id: &AntennaId| before.iter().all(|antenna| antenna.id != *id);
        id.filter(is_free).unwrap_or_else(|| {
            self.invalid("id", "must be a whole number that no other antenna has");
            free
        })
    }

    /// Returns an antenna with this connection and the defaults of its make.
    fn connected(&mut self, specs: &[&'static ControllerSpec]) -> Option<Antenna> {
        let controller = self.text("controller", "");
        let address = self.text("address", "");
        let Some(spec) = specs.iter().find(|spec| spec.key == controller) else {
            self.invalid("controller", any_of(specs));
            return None;
        };
        let mut antenna = spec.antenna(spec.short_name, &address);
        for settings in spec.settings.chunk_by(|a, b| a.table == b.table) {
            let connection = &mut antenna.connection;
            match settings.first().and_then(|setting| setting.table) {
                Some(table) => self.inner(table.key, |inner| inner.settings(settings, connection)),
                None => self.settings(settings, connection),
            }
        }
        if let Err(reason) = spec.check_address(&address) {
            self.invalid("address", reason);
            return None;
        }
        Some(antenna)
    }

    fn settings(&mut self, settings: &[&Setting], connection: &mut Connection) {
        for setting in settings {
            let Some(value) = self.table.remove(setting.field.key) else { continue };
            let put = setting.read(value).and_then(|value| connection.put(setting, value));
            if let Err(unfit) = put {
                self.invalid(setting.field.key, unfit.to_string());
            }
        }
    }

    fn direction(&mut self, default: Direction) -> Direction {
        let Direction { azimuth_deg, elevation_deg } = default;
        Direction {
            azimuth_deg: self.number("azimuth_deg", &ranges::AZIMUTH_DEG, azimuth_deg),
            elevation_deg: self.number("elevation_deg", &ranges::ELEVATION_DEG, elevation_deg),
        }
    }

    fn limits(&mut self, default: MotionLimits) -> MotionLimits {
        let MotionLimits { minimum_elevation_deg, maximum_rate_deg_s, maximum_step_deg } = default;
        MotionLimits {
            minimum_elevation_deg: self.number(
                "minimum_elevation_deg",
                &ranges::ELEVATION_DEG,
                minimum_elevation_deg,
            ),
            maximum_rate_deg_s: self.number(
                "maximum_rate_deg_s",
                &ranges::MAXIMUM_RATE_DEG_S,
                maximum_rate_deg_s,
            ),
            maximum_step_deg: self.number(
                "maximum_step_deg",
                &ranges::MAXIMUM_STEP_DEG,
                maximum_step_deg,
            ),
        }
    }

    fn poll(&mut self, default: PollRates) -> PollRates {
        PollRates {
            idle_hz: self.number("idle_hz", &ranges::POLL_HZ, default.idle_hz),
            moving_hz: self.number("moving_hz", &ranges::POLL_HZ, default.moving_hz),
        }
    }

    fn following(&mut self, default: TrackSettings) -> TrackSettings {
        let after =
            [("hold", AfterPass::Hold), ("park", AfterPass::Park), ("next", AfterPass::Next)];
        let TrackSettings { period_s, dead_band_deg, latency_s, .. } = default;
        TrackSettings {
            period_s: self.number("period_s", &ranges::FOLLOW_PERIOD_S, period_s),
            dead_band_deg: self.number("dead_band_deg", &ranges::DEAD_BAND_DEG, dead_band_deg),
            latency_s: self.number("latency_s", &ranges::LATENCY_S, latency_s),
            after: self.one_of("after", &after, default.after),
        }
    }

    fn pointing_model(&mut self, default: PointingModel) -> PointingModel {
        let mut angle = |key, default| self.number(key, &ranges::POINTING_TERM_DEG, default);
        PointingModel {
            azimuth_offset_deg: angle("azimuth_offset_deg", default.azimuth_offset_deg),
            elevation_offset_deg: angle("elevation_offset_deg", default.elevation_offset_deg),
            tilt_north_deg: angle("tilt_north_deg", default.tilt_north_deg),
            tilt_east_deg: angle("tilt_east_deg", default.tilt_east_deg),
            collimation_deg: angle("collimation_deg", default.collimation_deg),
            non_perpendicularity_deg: angle(
                "non_perpendicularity_deg",
                default.non_perpendicularity_deg,
            ),
            sag_deg: angle("sag_deg", default.sag_deg),
            elevation_scale: self.number(
                "elevation_scale",
                &ranges::POINTING_SCALE,
                default.elevation_scale,
            ),
        }
    }

    fn resume(&mut self, default: Resume) -> Resume {
        match self.table.remove("resume") {
            None => default,
            Some(Value::Boolean(true)) => Resume::Continue,
            Some(Value::Boolean(false)) => Resume::Ask,
            Some(_) => {
                self.invalid("resume", "must be true or false");
                default
            }
        }
    }

    pub(super) fn one_of<T: Copy>(&mut self, key: &str, choices: &[(&str, T)], default: T) -> T {
        let Some(value) = self.table.remove(key) else { return default };
        let found = choices.iter().find(|(name, _)| value.as_str() == Some(name));
        found.map_or_else(
            || {
                let names: Vec<String> =
                    choices.iter().map(|(name, _)| format!("{name:?}")).collect();
                self.invalid(key, format!("must be one of {}", names.join(", ")));
                default
            },
            |(_, value)| *value,
        )
    }

    fn mount(&mut self, default: Mount) -> Mount {
        match default {
            Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, travel_to_deg } => {
                self.mount_type("xy");
                Mount::Xy {
                    lower_axis_azimuth_deg: self.number(
                        "lower_axis_azimuth_deg",
                        &ranges::LOWER_AXIS_AZIMUTH_DEG,
                        lower_axis_azimuth_deg,
                    ),
                    travel_from_deg: self.number(
                        "travel_from_deg",
                        &ranges::TRAVEL_FROM_DEG,
                        travel_from_deg,
                    ),
                    travel_to_deg: self.number(
                        "travel_to_deg",
                        &ranges::TRAVEL_TO_DEG,
                        travel_to_deg,
                    ),
                }
            }
            Mount::AzEl {
                azimuth_from_deg: start,
                azimuth_to_deg: end,
                elevation_from_deg: low,
                elevation_to_deg: high,
            } => {
                self.mount_type("azel");
                let first = self.number("azimuth_from_deg", &ranges::AZIMUTH_FROM_DEG, start);
                let low = self.number("elevation_from_deg", &ranges::ELEVATION_FROM_DEG, low);
                Mount::AzEl {
                    azimuth_from_deg: first,
                    azimuth_to_deg: self.number(
                        "azimuth_to_deg",
                        &above(first, &ranges::AZIMUTH_SPAN_DEG, &ranges::AZIMUTH_TO_DEG),
                        end.max(first + ranges::AZIMUTH_SPAN_DEG.start()),
                    ),
                    elevation_from_deg: low,
                    elevation_to_deg: self.number(
                        "elevation_to_deg",
                        &above(low, &ranges::ELEVATION_SPAN_DEG, &ranges::ELEVATION_TO_DEG),
                        high.max(low + ranges::ELEVATION_SPAN_DEG.start()),
                    ),
                }
            }
        }
    }

    /// Notes a mount type that differs from the arrangement of the controller.
    fn mount_type(&mut self, kind: &str) {
        match self.table.remove("type") {
            None => {}
            Some(Value::String(text)) if text == kind => {}
            Some(_) => self.invalid("type", format!("must be {kind:?}")),
        }
    }
}

/// Returns the range of the upper end of an axis whose lower end is `start`.
fn above(
    start: f64,
    span: &RangeInclusive<f64>,
    range: &RangeInclusive<f64>,
) -> RangeInclusive<f64> {
    (start + span.start()).max(*range.start())..=(start + span.end()).min(*range.end())
}

/// Returns the error text with the known makes.
fn any_of(specs: &[&ControllerSpec]) -> String {
    let keys: Vec<String> = specs.iter().map(|spec| format!("{:?}", spec.key)).collect();
    match keys.split_last() {
        Some((last, before)) if !before.is_empty() => {
            format!("must be {} or {last}", before.join(", "))
        }
        _ => format!("must be {}", keys.concat()),
    }
}
