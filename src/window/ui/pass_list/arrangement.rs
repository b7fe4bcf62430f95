//! Order and filters of the list, in chips.

use egui::{Rect, Ui, pos2, vec2};
use serde::{Deserialize, Serialize};

use super::PassListModel;
use crate::ui::widgets::{
    button::{Button, SMALL_HEIGHT},
    chip,
    drop_down::DropDown,
};

const GAP: f32 = 6.0;

/// Order and filters of the list, except the text filter.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Arrangement {
    pub order: Order,
    /// A group of the catalogue; `None` for all satellites.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// Daylight at the site when the satellite is highest: Sun up, Sun down, or either.
    pub light: Light,
    /// `true` for passes in which the Sun shines on the satellite when it is highest.
    pub sunlit: bool,
    /// `true` for passes that the selected antenna can track at least in part.
    pub trackable: bool,
    /// `true` for passes whose satellite has not risen yet.
    pub to_come: bool,
}

/// Order of the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    #[default]
    Aos,
    /// Descending maximum elevation.
    Maximum,
    /// Descending duration.
    Duration,
}

/// Time of day.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Light {
    #[default]
    Any,
    Day,
    Night,
}

impl Order {
    const ALL: [Self; 3] = [Self::Aos, Self::Maximum, Self::Duration];

    fn words(self) -> &'static str {
        match self {
            Self::Aos => "By AOS",
            Self::Maximum => "Highest first",
            Self::Duration => "Longest first",
        }
    }
}

impl Light {
    const ALL: [Self; 3] = [Self::Any, Self::Day, Self::Night];

    fn words(self) -> &'static str {
        match self {
            Self::Any => "Day and night",
            Self::Day => "By day",
            Self::Night => "By night",
        }
    }
}

impl Arrangement {
    /// Returns the differences from the default list, in words.
    pub(super) fn words(&self) -> String {
        let mut words: Vec<&str> = Vec::new();
        if self.order != Order::Aos {
            words.push(self.order.words());
        }
        words.extend(self.group.as_deref());
        if self.light != Light::Any {
            words.push(self.light.words());
        }
        for (on, word) in
            [(self.sunlit, SUNLIT), (self.trackable, TRACKABLE), (self.to_come, TO_COME)]
        {
            words.extend(on.then_some(word));
        }
        words.join(" \u{b7} ")
    }
}

const SUNLIT: &str = "Sunlit";
const TRACKABLE: &str = "Trackable";
const TO_COME: &str = "Upcoming";
const ANY_GROUP: &str = "All groups";

/// A chip and its width.
#[derive(Clone, Copy)]
enum Chip {
    Order,
    Group,
    Light,
    Sunlit,
    Trackable,
    ToCome,
}

const CHIPS: [Chip; 6] =
    [Chip::Order, Chip::Group, Chip::Light, Chip::Trackable, Chip::Sunlit, Chip::ToCome];

impl Chip {
    fn width(self, ui: &Ui, arrangement: &Arrangement) -> f32 {
        let drop_down = |words: &str| Button::quiet(words).chevron().width(ui).min(150.0);
        match self {
            Self::Order => drop_down(arrangement.order.words()),
            Self::Group => drop_down(arrangement.group.as_deref().unwrap_or(ANY_GROUP)),
            Self::Light => drop_down(arrangement.light.words()),
            Self::Sunlit => chip::width(ui, SUNLIT),
            Self::Trackable => chip::width(ui, TRACKABLE),
            Self::ToCome => chip::width(ui, TO_COME),
        }
    }
}

/// Returns the places of the chips from the upper left corner of `room`, in as many lines as
/// needed.
fn places(ui: &Ui, room: Rect, arrangement: &Arrangement) -> Vec<(Chip, Rect)> {
    let mut position = room.min;
    let place = |chip: &Chip| {
        let width = chip.width(ui, arrangement);
        if position.x > room.left() && position.x + width > room.right() {
            position = pos2(room.left(), position.y + SMALL_HEIGHT + GAP);
        }
        let rect = Rect::from_min_size(position, vec2(width, SMALL_HEIGHT));
        position.x = rect.right() + GAP;
        (*chip, rect)
    };
    CHIPS.iter().map(place).collect()
}

/// Returns the height of the chips in a column of this `room`, points.
pub(super) fn height(ui: &Ui, room: Rect, arrangement: &Arrangement) -> f32 {
    let lowest = places(ui, room, arrangement).last().map_or(0.0, |(_, place)| place.bottom());
    lowest - room.top()
}

/// Shows the chips from the upper left corner of `room`.
pub(super) fn show(ui: &Ui, room: Rect, model: &PassListModel<'_>, arrangement: &mut Arrangement) {
    for (chip, place) in places(ui, room, arrangement) {
        match chip {
            Chip::Order => {
                let words = arrangement.order.words();
                drop_down(ui, place, "order", "Order", words, |ui| {
                    for order in Order::ALL {
                        ui.selectable_value(&mut arrangement.order, order, order.words());
                    }
                });
            }
            Chip::Group => {
                let words = arrangement.group.clone().unwrap_or_else(|| ANY_GROUP.to_owned());
                drop_down(ui, place, "group", "Group", &words, |ui| {
                    ui.selectable_value(&mut arrangement.group, None, ANY_GROUP);
                    for group in model.groups {
                        ui.selectable_value(
                            &mut arrangement.group,
                            Some((*group).to_owned()),
                            *group,
                        );
                    }
                });
            }
            Chip::Light => {
                let words = arrangement.light.words();
                drop_down(ui, place, "light", "Time of day", words, |ui| {
                    for light in Light::ALL {
                        ui.selectable_value(&mut arrangement.light, light, light.words());
                    }
                });
            }
            Chip::Sunlit => chip::show(ui, "sunlit", place, SUNLIT, &mut arrangement.sunlit),
            Chip::Trackable => {
                chip::show(ui, "trackable", place, TRACKABLE, &mut arrangement.trackable);
            }
            Chip::ToCome => chip::show(ui, "to come", place, TO_COME, &mut arrangement.to_come),
        }
    }
}

fn drop_down(
    ui: &Ui,
    place: Rect,
    salt: &'static str,
    subject: &str,
    words: &str,
    choices: impl FnOnce(&mut Ui),
) {
    let name = format!("{subject}: {words}");
    DropDown { button: Button::quiet(words), salt, name: &name }.show(ui, place, choices);
}
