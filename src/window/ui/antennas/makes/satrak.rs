//! Cards of a Satrak.

mod checks;
mod clock;
mod gps;
mod minimum;
mod satellite;
mod window;

use super::Own;
use crate::{
    controller::satrak::{
        SPEC,
        settings::{
            ANGLES, CLOCK, FILE, FTP, GENERAL, GPS, IMAGE, POSITION, RECEIVER, REDUCTION, VERSIONS,
            WEB, WINDOW,
        },
    },
    ui::antennas::{
        cards::{fields, service},
        row,
        section::{Column, Section},
    },
};

pub(super) const OWN: Own = Own { key: SPEC.key, sections: &SECTIONS, versions: &VERSIONS };

static SECTIONS: [Section; 7] = [
    Section {
        title: "General",
        keys: &[GENERAL.key],
        is_service: false,
        column: Some(Column::Left),
        content: |ui, unit, form, _, _| {
            row::head(ui);
            fields(ui, unit, form, GENERAL.key, |_| true);
            minimum::show(ui, unit, form);
        },
    },
    Section {
        title: "GPS",
        keys: &[GPS.key, RECEIVER.key],
        is_service: false,
        column: Some(Column::Left),
        content: |ui, unit, form, _, _| gps::show(ui, unit, form),
    },
    Section {
        title: "Tracking window",
        keys: &[WINDOW.key],
        is_service: false,
        column: Some(Column::Left),
        content: |ui, unit, form, _, effects| window::show(ui, unit, form, effects.commands),
    },
    Section {
        title: "Satellite and TLE",
        keys: &[FILE.key, WEB.key, FTP.key],
        is_service: false,
        column: Some(Column::Right),
        content: |ui, unit, form, _, effects| satellite::show(ui, unit, form, effects),
    },
    Section {
        title: "Clock",
        keys: &[CLOCK.key],
        is_service: false,
        column: Some(Column::Right),
        content: |ui, unit, form, _, effects| clock::show(ui, unit, form, effects.commands),
    },
    Section {
        title: "Versions and faults",
        keys: &[VERSIONS.key, POSITION.key],
        is_service: false,
        column: Some(Column::Left),
        content: |ui, unit, form, _, _| checks::show(ui, unit, form),
    },
    Section {
        title: "Service",
        keys: &[ANGLES.key, REDUCTION.key, IMAGE.key],
        is_service: true,
        column: Some(Column::Right),
        content: service::show,
    },
];
