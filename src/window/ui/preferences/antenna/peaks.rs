//! Peaks of the noise of the Sun and the Moon, entered by hand. They are points for the fit of a
//! pointing model.

use egui::{Label, Response, RichText, TextEdit, Ui};
use jiff::Timestamp;

use crate::{
    contract,
    contract::record::{Peak, PeakBody, PeakChange},
    device::settings::number,
    model::{Model, UiCommand},
    station::AntennaId,
    ui::{
        format, record, text, theme,
        widgets::status_line::{self, Tone},
        words::pointing::peak_of,
    },
};

/// Distance from the Sun or the Moon above which a peak must be a typing error, degrees.
const FAR_DEG: f64 = 20.0;
const TIME: f32 = 172.0;
const ANGLE: f32 = 72.0;

/// A peak being entered; empty fields mean "now".
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::ui::preferences) struct TypedPeak {
    body: PeakBody,
    time_text: String,
    azimuth: String,
    elevation: String,
}

impl Default for TypedPeak {
    fn default() -> Self {
        let [time_text, azimuth, elevation] = [const { String::new() }; 3];
        Self { body: PeakBody::Sun, time_text, azimuth, elevation }
    }
}

impl TypedPeak {
    /// Returns the peak, with the current time and angles for empty fields, or the reason why a
    /// field is invalid.
    fn read(&self, now: Timestamp, measured: Option<[f64; 2]>) -> Result<Peak, String> {
        let time = match self.time_text.trim() {
            "" => now,
            typed => typed
                .parse()
                .map_err(|_| "A time is written as 2026-11-30 12:00:00Z.".to_owned())?,
        };
        if time > now {
            return Err("This time is yet to come.".to_owned());
        }
        // The measured angles apply only to the current time.
        let [azimuth, elevation] = measured
            .filter(|_| self.time_text.trim().is_empty())
            .map_or([None; 2], |[azimuth, elevation]| [Some(azimuth), Some(elevation)]);
        let azimuths = Peak::AZIMUTHS_DEG;
        let elevations = Peak::ELEVATIONS_DEG;
        Ok(Peak {
            body: self.body,
            time,
            azimuth_deg: angle("azimuth", &self.azimuth, azimuth, &azimuths)?,
            elevation_deg: angle("elevation", &self.elevation, elevation, &elevations)?,
        })
    }
}

fn angle(
    name: &str,
    typed: &str,
    measured: Option<f64>,
    range: &std::ops::RangeInclusive<f64>,
) -> Result<f64, String> {
    let read = match (typed.trim(), measured) {
        ("", Some(measured)) => Some(measured),
        ("", None) => return Err(format!("Type the {name} that the antenna showed at the peak.")),
        (typed, _) => number(typed),
    };
    read.filter(|deg| range.contains(deg)).ok_or_else(|| {
        let (start_text, end_text) =
            (format::degrees(*range.start(), 0), format::degrees(*range.end(), 0));
        format!("The {name} is a number from {start_text} to {end_text}.")
    })
}

/// Shows the peaks of an antenna, and the fields for a new peak.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    id: AntennaId,
    typed: &mut TypedPeak,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.add_space(6.0);
    let head = "Peaks of the noise of the Sun and the Moon count in the fit.";
    ui.add(Label::new(RichText::new(head).font(text::small()).color(t.t2)).wrap());
    let lock = record::lock(model);
    let mut change = |change| {
        commands.push(UiCommand::Station(contract::Command::ChangePeaks(id, change)));
    };
    for peak in model.peaks.for_antenna(id) {
        ui.horizontal(|ui| {
            let words = in_words(peak, model);
            ui.label(RichText::new(&words).font(text::small()).color(t.t1));
            let remove = ui.add_enabled(lock.is_none(), egui::Button::new("Remove").small());
            remove.widget_info(|| {
                let name = format!("Remove the peak of {words}");
                egui::WidgetInfo::labeled(egui::Role::Button, lock.is_none(), name)
            });
            if with_reason(remove, lock).clicked() {
                change(PeakChange::Removed(*peak));
            }
        });
    }
    let measured = measured(model, id);
    let hints = measured.map(|deg| deg.map(|angle| format::number(angle, 2)));
    ui.horizontal_wrapped(|ui| {
        for body in [PeakBody::Sun, PeakBody::Moon] {
            ui.radio_value(&mut typed.body, body, peak_of(body));
        }
        let is_now = typed.time_text.trim().is_empty();
        let words = ["az °", "el °"].map(str::to_owned);
        let [azimuth, elevation] = hints.filter(|_| is_now).unwrap_or(words);
        for (name, text, hint, width) in [
            ("Time of the peak", &mut typed.time_text, "now".to_owned(), TIME),
            ("Azimuth at the peak", &mut typed.azimuth, azimuth, ANGLE),
            ("Elevation at the peak", &mut typed.elevation, elevation, ANGLE),
        ] {
            let hint = RichText::new(hint).color(t.t3);
            let edit =
                TextEdit::singleline(text).id_salt(name).hint_text(hint).desired_width(width);
            ui.add(edit).accessible_name(name).on_hover_text(name);
        }
        let read = typed.read(model.now, measured);
        let can_add = lock.is_none() && read.is_ok();
        let add = with_reason(ui.add_enabled(can_add, egui::Button::new("Add peak")), lock);
        if let Ok(peak) = read
            && add.clicked()
        {
            change(PeakChange::Added(peak));
            *typed = TypedPeak { body: typed.body, ..TypedPeak::default() };
        }
    });
    match typed.read(model.now, measured) {
        _ if model.replay.is_some() => {}
        _ if lock.is_some() => {
            status_line::line(ui, Tone::Plain, "Nothing is recorded: no peak can be kept.");
        }
        Err(reason) => status_line::line(ui, Tone::Plain, &reason),
        Ok(peak) => {
            if let Some(far) = far(&peak, model) {
                status_line::line(ui, Tone::Caution, &far);
            }
        }
    }
}

/// Adds a tooltip with the reason to a locked button.
fn with_reason(button: Response, lock: Option<&'static str>) -> Response {
    match lock {
        Some(reason) => button.on_disabled_hover_text(reason),
        None => button,
    }
}

/// Returns the angles that the axes of the antenna measure now, degrees.
fn measured(model: &Model, id: AntennaId) -> Option<[f64; 2]> {
    let antenna = model.antenna_of(id).filter(|antenna| antenna.is_live())?;
    let pointing = antenna.snapshot.state.measured?.pointing;
    Some([pointing.azimuth?.degrees(), pointing.elevation?.degrees()])
}

fn in_words(peak: &Peak, model: &Model) -> String {
    let (name, time_text) = (peak_of(peak.body), format::moment(peak.time, model.now));
    let [azimuth, elevation] =
        [peak.azimuth_deg, peak.elevation_deg].map(|deg| format::degrees(deg, 2));
    format!("{name}, {time_text}: az {azimuth}, el {elevation}")
}

/// Returns a warning if a peak is far from the position of the Sun or the Moon.
fn far(peak: &Peak, model: &Model) -> Option<String> {
    let point = peak.point(model.station.site);
    let off_deg = point.direction.separation(point.measured).degrees();
    (off_deg > FAR_DEG).then(|| {
        let name = peak_of(peak.body);
        let (deviation_text, time_text) =
            (format::degrees(off_deg, 0), format::pointing_at(point.direction));
        format!("The {name} was at {time_text} then: that is {deviation_text} from there.")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn now() -> Timestamp {
        "2026-11-30T12:00:00Z".parse().unwrap()
    }

    fn typed(time_text: &str, azimuth: &str, elevation: &str) -> TypedPeak {
        let [time_text, azimuth, elevation] = [time_text, azimuth, elevation].map(str::to_owned);
        TypedPeak { body: PeakBody::Moon, time_text, azimuth, elevation }
    }

    #[test]
    fn what_is_empty_is_that_of_now() {
        let measured = Some([180.5, 30.25]);
        let read = |typed: TypedPeak| typed.read(now(), measured);
        let peak =
            Peak { body: PeakBody::Moon, time: now(), azimuth_deg: 180.5, elevation_deg: 30.25 };
        assert_eq!(read(typed("", "", "")), Ok(peak));
        assert_eq!(read(typed("", "181", "")), Ok(Peak { azimuth_deg: 181.0, ..peak }));
        let time = "2026-11-30T11:00:00Z".parse().unwrap();
        let earlier = Peak { time, azimuth_deg: -170.0, elevation_deg: 20.0, ..peak };
        assert_eq!(read(typed("2026-11-30 11:00:00Z", "-170", " 20 ")), Ok(earlier));
        assert!(read(typed("2026-11-30 11:00:00Z", "", "")).is_err(), "that is not of then");
        assert!(typed("", "", "").read(now(), None).is_err());
    }

    #[test]
    fn what_cannot_be_is_not_read() {
        for (time_text, azimuth, elevation) in [
            ("noon", "1", "2"),
            ("2026-12-01 00:00:00Z", "1", "2"),
            ("", "721", "2"),
            ("", "1", "x"),
        ] {
            let read = typed(time_text, azimuth, elevation).read(now(), Some([1.0, 2.0]));
            assert!(read.is_err(), "{time_text} {azimuth} {elevation}");
        }
    }
}
