//! The transfer of element files to a Satrak.

use super::{
    ELEMENT_FILE,
    checks::FILE_CHECKS,
    settings::{
        CATALOG_NUMBER, CONTINUE_TRACKING, FILE, FILE_NAME, GENERAL, SATELLITE_NAME, TLE_FROM_FILE,
        TLE_SOURCE,
    },
};
use crate::{
    device::{ElementFiles, settings::Values},
    protocol::satrak::TextValue,
};

/// Description from the protocol document, section 23 and the chapter on its server.
pub static ELEMENT_FILES: ElementFiles = ElementFiles {
    folder: "/svs/satrak/tle",
    factory_user: "sftpsatr",
    factory_digest: "1cbcd885a8bcd187c65f4bbefba29967dd520511f5887bd5f4ae1011ebca100c",
    check_name: |field, name| {
        TextValue::new(field, name).map(|_| ()).map_err(|problem| problem.to_string())
    },
    setting: ELEMENT_FILE.field.key,
    group: FILE.key,
    choose: |file, satellite| {
        Values::from([
            FILE_NAME.entry(file.to_owned()),
            SATELLITE_NAME.entry(satellite.to_owned()),
            CONTINUE_TRACKING.entry(false),
        ])
    },
    number: CATALOG_NUMBER,
    source_group: GENERAL.key,
    are_fetched_by_unit: |values| {
        TLE_SOURCE.get(values).is_some_and(|source| source != TLE_FROM_FILE)
    },
    checks: &FILE_CHECKS,
};
