//! The limits of a satellite, which decide which of its passes the schedule takes. The operator
//! changes them where the satellite is shown.

use egui::{Align2, RichText, Sense, Ui, vec2};

use super::{
    format,
    text::{self, Weight},
    theme,
    widgets::{
        button::{Button, SMALL_HEIGHT},
        check_box::CheckBox,
        drop_down::DropDown,
        paint,
    },
};
use crate::{
    contract,
    model::{Model, UiCommand},
    station::{AntennaId, Light, PassLimits},
};

const ROW: f32 = 30.0;
const LABEL: f32 = 148.0;
const ELEVATIONS_DEG: [f64; 7] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 75.0];
const DURATIONS_S: [f64; 6] = [60.0, 120.0, 240.0, 360.0, 480.0, 600.0];
const PER_DAY: [u32; 6] = [1, 2, 3, 4, 6, 8];
const LIGHTS: [Light; 3] = [Light::Day, Light::Night, Light::Sunlit];

/// Shows the limits of a favourite in `width` points; a choice takes effect immediately. `lock` is
/// the reason why the operator may not change the settings now.
pub(super) fn show(
    ui: &mut Ui,
    width: f32,
    model: &Model,
    number: u32,
    lock: Option<&str>,
    commands: &mut Vec<UiCommand>,
) {
    let Some(favourite) = model.station.favourites.get(number) else { return };
    let t = theme::tokens(ui);
    let title = RichText::new("Limits for this satellite");
    ui.label(title.font(text::sized(13.0, Weight::SemiBold)).color(t.t1));
    let antennas: Vec<(AntennaId, String)> =
        model.antennas.iter().map(|antenna| (antenna.id(), antenna.config.name.clone())).collect();
    let all = model.station.pass_limits(number);
    let mut limits = favourite.limits.clone();
    let form = LimitsForm { width, label_width: LABEL, antennas: &antennas, lock };
    form.show(ui, &mut limits, &all);
    if favourite.limits != limits {
        let command = contract::Command::SetPassLimits { numbers: vec![number], limits };
        commands.push(UiCommand::Station(command));
    }
}

/// Drop-downs for the limits of a satellite or a group.
pub(super) struct LimitsForm<'a> {
    pub(super) width: f32,
    pub(super) label_width: f32,
    /// Antennas to choose from.
    pub(super) antennas: &'a [(AntennaId, String)],
    /// Reason why the operator may not change the limits now.
    pub(super) lock: Option<&'a str>,
}

impl LimitsForm<'_> {
    /// Shows the effective limits `all`, and edits `own`.
    pub(super) fn show(&self, ui: &mut Ui, own: &mut PassLimits, all: &PassLimits) {
        let t = theme::tokens(ui);
        let is_partly_of_a_group = own != all;
        let value = all.min_max_elevation_deg.map_or_else(any, elevation);
        self.row(ui, "Maximum elevation", &value, |ui| {
            choices(ui, &mut own.min_max_elevation_deg, &ELEVATIONS_DEG, elevation);
        });
        let value = all.min_duration_s.map_or_else(any, duration);
        self.row(ui, "Duration", &value, |ui| {
            choices(ui, &mut own.min_duration_s, &DURATIONS_S, duration);
        });
        self.row(ui, "Light", &all.light.map_or_else(any, light), |ui| {
            choices(ui, &mut own.light, &LIGHTS, light);
        });
        let value = all.max_per_day.map_or_else(any, per_day);
        self.row(ui, "Passes a day (UTC)", &value, |ui| {
            choices(ui, &mut own.max_per_day, &PER_DAY, per_day);
        });
        self.row(ui, "Antennas", &names(all, self.antennas), |ui| {
            choose_antennas(ui, self.antennas, own);
        });
        if is_partly_of_a_group {
            let words = "Where it has no limit of its own, its group's applies.";
            ui.label(RichText::new(words).font(text::small()).color(t.t2));
        }
    }

    fn row(&self, ui: &mut Ui, label: &'static str, value: &str, list: impl FnOnce(&mut Ui)) {
        let t = theme::tokens(ui);
        let (rect, _) = ui.allocate_exact_size(vec2(self.width, ROW), Sense::hover());
        paint::text_in(ui, rect, Align2::LEFT_CENTER, label, text::small(), t.t2);
        let room = rect.with_min_x(rect.left() + self.label_width);
        let name = format!("{label}, {value}");
        let button = Button::normal(value).locked_by(self.lock);
        let list_of = DropDown { button, salt: label, name: &name };
        let size = vec2(list_of.width(ui).min(room.width()), SMALL_HEIGHT);
        let place = egui::Rect::from_min_size(room.left_center() - vec2(0.0, size.y / 2.0), size);
        list_of.show(ui, place, list);
    }
}

/// Returns the limits in a few words, such as "from 20°, by night"; empty without limits.
pub(super) fn in_short(limits: &PassLimits, antennas: &[(AntennaId, String)]) -> String {
    let words = [
        limits.min_max_elevation_deg.map(elevation),
        limits.min_duration_s.map(duration),
        limits.light.map(light),
        limits.max_per_day.map(|max| format!("{max} a day")),
        limits.antennas.as_ref().map(|_| format!("by {}", names(limits, antennas))),
    ];
    words.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn any() -> String {
    "any".to_owned()
}

fn elevation(deg: f64) -> String {
    format!("from {}", format::degrees(deg, 0))
}

fn duration(seconds: f64) -> String {
    format!("from {}", format::duration(seconds))
}

fn per_day(max: u32) -> String {
    format!("{max} at most")
}

fn names(limits: &PassLimits, antennas: &[(AntennaId, String)]) -> String {
    let Some(ids) = &limits.antennas else { return any() };
    let named = antennas.iter().filter(|(id, _)| ids.contains(id));
    let names: Vec<&str> = named.map(|(_, name)| name.as_str()).collect();
    if names.is_empty() { "none".to_owned() } else { format::list(&names) }
}

fn light(light: Light) -> String {
    let words = match light {
        Light::Day => "by day",
        Light::Night => "by night",
        Light::Sunlit => "satellite in sunlight",
    };
    words.to_owned()
}

fn choices<T: Copy + PartialEq>(
    ui: &mut Ui,
    value: &mut Option<T>,
    offered: &[T],
    words: impl Fn(T) -> String,
) {
    ui.selectable_value(value, None, "any");
    for choice in offered {
        ui.selectable_value(value, Some(*choice), words(*choice));
    }
}

fn choose_antennas(ui: &mut Ui, antennas: &[(AntennaId, String)], own: &mut PassLimits) {
    if ui.selectable_label(own.antennas.is_none(), "any").clicked() {
        own.antennas = None;
    }
    for (id, name) in antennas {
        let mut list = own.antennas.clone().unwrap_or_default();
        let mut is_on = list.contains(id);
        if ui.add(CheckBox::new(&mut is_on, name)).clicked() {
            list.retain(|antenna| antenna != id);
            list.extend(is_on.then_some(*id));
            own.antennas = (!list.is_empty()).then_some(list);
        }
    }
}
