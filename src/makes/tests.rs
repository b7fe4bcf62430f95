//! What every make has to keep to.

mod file;

use super::*;
use crate::{
    controller::{
        rc2000c::{BAUD, BUS_ADDRESS},
        rotator_genius::{ROTATORS, Rotators},
    },
    station::{Connection, Holds, Setting},
};

#[test]
fn each_kind_fits_what_it_says_of_itself() {
    let mut keys: Vec<&str> = kinds().iter().map(|kind| kind.key).collect();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), ALL.len(), "two kinds of one key");
    for kind in kinds() {
        assert_eq!(kind.check_address(kind.usual_address), Ok(()), "{kind:?}");
        for setting in kind.settings {
            assert_eq!(setting.check(&setting.usual), Ok(()), "{kind:?}: {}", setting.key);
            let is_left_out = matches!(setting.holds, Holds::Text | Holds::Points);
            assert_eq!(setting.usual.is_empty(), is_left_out, "{kind:?}: {}", setting.key);
        }
        let tables = kind.settings.chunk_by(|a, b| a.table == b.table);
        let tables = tables.map(|settings| settings[0].table.map(|table| table.key));
        let beside = kind.settings.iter().filter(|setting| setting.table.is_none());
        let mut names: Vec<&str> = tables.flatten().chain(beside.map(|of| of.key)).collect();
        names.extend(["controller", "address"]);
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "{kind:?}: two things of one name: {names:?}");
        assert!(kind.makes.iter().all(|make| make.key == kind.key), "{kind:?}");
    }
}

#[test]
fn what_a_setting_cannot_hold_changes_nothing() {
    let mut connection = rc2000c::KIND.connection("COM3");
    let before = connection.clone();
    let put = |connection: &mut Connection, setting: &Setting, value: u32| {
        connection.put(setting, value).unwrap_err()
    };
    assert_eq!(put(&mut connection, &BUS_ADDRESS, 48), "must be a whole number from 49 to 111");
    let speeds = "must be one of 300, 600, 1200, 2400, 4800, 9600";
    assert_eq!(put(&mut connection, &BAUD, 19_200), speeds);
    let why = connection.put(&ROTATORS, Rotators::First).unwrap_err();
    assert_eq!(why, "is no setting of \"rc2000c\"");
    assert_eq!(connection, before);
}
