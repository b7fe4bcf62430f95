//! Hours of the sheet, with a lane for each antenna.

use egui::Rangef;
use jiff::Timestamp;
use maud::{Markup, html};

use super::HandOverSheet;
use crate::{
    astro::time::{add_seconds, seconds_between},
    plan::schedule::sets_out,
    ui::{
        format,
        page::{SECTION_HEAD_MM, plot, printable, section},
        time_axis::TimeAxis,
    },
};

/// Heights of a lane and of the names of the hours, millimetres; equal to the values in the style
/// sheet.
const LANE_MM: f64 = 4.6;
const HOURS_MM: f64 = 3.2;
/// Max number of lanes; the sheet counts further antennas.
const LANES: usize = 8;
/// Width and height of a lane in units of its drawing.
const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 10.0;

impl HandOverSheet<'_> {
    pub(super) fn time_line_mm(&self) -> f64 {
        let lanes = self.station.antennas.len().min(LANES);
        SECTION_HEAD_MM + LANE_MM * lanes as f64 + HOURS_MM
    }

    pub(super) fn time_line(&self) -> Markup {
        let remark = "Box: pass; line before it: slew and set-up; grey: night";
        let antennas = &self.station.antennas;
        let more = antennas.len().saturating_sub(LANES);
        let background = html! {
            @for [start, end] in self.nights() {
                (plot::filled("shade", [self.x(start), 0.0], [self.x(end) - self.x(start), HEIGHT]))
            }
            @for hour in self.hours() {
                (plot::filled("filled", [self.x(hour), 0.0], [0.6, HEIGHT]))
            }
        };
        let content = html! {
            @for antenna in antennas.iter().take(LANES) {
                div.lane {
                    span { (printable(&antenna.name)) }
                    svg viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) preserveAspectRatio="none" {
                        (background)
                        @for entry in self.entries().into_iter().filter(|entry| entry.antenna == antenna.id) {
                            @let go_at = sets_out(entry, antenna.automatic.between_passes);
                            @let busy_s = entry.slew_s + entry.set_up_s;
                            @let moves_from = go_at.max(add_seconds(entry.start, -busy_s));
                            @let [departure, start, end] =
                                [moves_from, entry.start, entry.end].map(|time| self.x(time));
                            (plot::filled("filled", [departure, 4.4], [start - departure, 1.2]))
                            (plot::filled("filled", [start, 2.5], [(end - start).max(1.0), 5.0]))
                        }
                    }
                }
            }
            div.lane.hours {
                span { @if more > 0 { "and " (more) " more" } }
                div {
                    @for hour in self.hours() {
                        @let words = format::hour_of_day(hour);
                        span.bold[words == "00"]
                            style=(format!("left: {}%", plot::number(self.x(hour) * 100.0 / WIDTH)))
                        { (words) }
                    }
                }
            }
        };
        section("time-line", "Time line (UTC)", remark, &content)
    }

    /// Returns the x of a time on the sheet, or of the nearer end of the sheet.
    fn x(&self, time: Timestamp) -> f64 {
        self.axis().x_within(time).into()
    }

    fn axis(&self) -> TimeAxis {
        let x = Rangef::new(0.0, WIDTH as f32);
        TimeAxis::lasting(self.start, seconds_between(self.start, self.end), x)
    }

    /// Returns the full hours on the sheet.
    fn hours(&self) -> impl Iterator<Item = Timestamp> + use<> {
        self.axis().multiples(3600)
    }
}
