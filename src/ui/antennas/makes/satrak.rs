//! The cards of a Satrak.

mod checks;
mod clock;
mod gps;
mod minimum;
mod satellite;
mod window;

use crate::{
    controller::satrak::{GROUPS, SPEC},
    device::settings::Group,
    ui::antennas::{
        cards::{fields, service},
        row,
        section::{Column, Section},
    },
};

pub(super) const KEY: &str = SPEC.key;

pub(super) static SECTIONS: [Section; 7] = [
    Section {
        title: "General",
        keys: &["general"],
        is_service: false,
        column: Some(Column::Left),
        content: |ui, unit, form, _, _| {
            row::head(ui);
            fields(ui, unit, form, "general", |_| true);
            minimum::show(ui, unit, form);
        },
    },
    Section {
        title: "GPS",
        keys: &["gps", "receiver"],
        is_service: false,
        column: Some(Column::Left),
        content: |ui, unit, form, _, _| gps::show(ui, unit, form),
    },
    Section {
        title: "Tracking window",
        keys: &["window"],
        is_service: false,
        column: Some(Column::Left),
        content: |ui, unit, form, _, desk| window::show(ui, unit, form, desk.commands),
    },
    Section {
        title: "Satellite and TLE",
        keys: &["file", "web", "ftp"],
        is_service: false,
        column: Some(Column::Right),
        // The upload of elements to the unit has its place below this card.
        content: |ui, unit, form, _, desk| satellite::show(ui, unit, form, desk),
    },
    Section {
        title: "Clock",
        keys: &["clock"],
        is_service: false,
        column: Some(Column::Right),
        content: |ui, unit, form, _, desk| clock::show(ui, unit, form, desk.commands),
    },
    Section {
        title: "Versions and faults",
        keys: &["versions", "position"],
        is_service: false,
        column: Some(Column::Left),
        content: |ui, unit, form, _, _| checks::show(ui, unit, form),
    },
    Section {
        title: "Service",
        keys: &["angles", "reduction", "image"],
        is_service: true,
        column: Some(Column::Right),
        content: service::show,
    },
];

/// The description of the group with this key.
fn group(key: &str) -> Option<&'static Group> {
    GROUPS.iter().copied().find(|group| group.key == key)
}
