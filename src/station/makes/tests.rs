//! Rules that every make must keep.

mod file;
mod hooks;
mod keep_out;
mod notices;
mod offsets;
mod schedule;

use super::*;
use crate::{
    controller::{
        SPECS,
        rc2000c::{BAUD, BUS_ADDRESS},
        rotator_genius::{ROTATORS, Rotators},
    },
    device::settings::Value,
    station::{Connection, Setting},
};

#[test]
fn each_make_fits_what_it_says_of_itself() {
    let mut keys: Vec<&str> = SPECS.iter().map(|spec| spec.key).collect();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), SPECS.len(), "two makes of one key");
    for spec in SPECS {
        assert_eq!(spec.check_address(spec.default_address), Ok(()), "{spec:?}");
        for setting in spec.settings {
            let fits = setting.field.kind.check(&(setting.default)());
            assert_eq!(fits, Ok(()), "{spec:?}: {}", setting.field.key);
        }
        let tables = spec.settings.chunk_by(|a, b| a.table == b.table);
        let tables = tables.map(|settings| settings[0].table.map(|table| table.key));
        let others = spec.settings.iter().filter(|setting| setting.table.is_none());
        let mut names: Vec<&str> =
            tables.flatten().chain(others.map(|other| other.field.key)).collect();
        names.extend(["controller", "address"]);
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "{spec:?}: two things of one name: {names:?}");
    }
}

#[test]
fn what_a_setting_cannot_hold_changes_nothing() {
    let mut connection = rc2000c::SPEC.connection("COM3");
    let before = connection.clone();
    let put = |connection: &mut Connection, setting: &Setting, value: Value| {
        connection.put(setting, value).unwrap_err().to_string()
    };
    assert_eq!(
        put(&mut connection, &BUS_ADDRESS, 48.into()),
        "must be a whole number from 49 to 111"
    );
    let speeds = "must be one of 300, 600, 1200, 2400, 4800, 9600";
    assert_eq!(put(&mut connection, &BAUD, Value::Choice(19_200)), speeds);
    let reason = connection.put(&ROTATORS, Rotators::First).unwrap_err();
    assert_eq!(reason.to_string(), "is no setting of \"rc2000c\"");
    assert_eq!(connection, before);
}
