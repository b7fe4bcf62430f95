//! The satellite and the source of its elements (sections 23 to 28).

use super::{
    desired::{Desired, cannot},
    proof::Proof,
    text, url,
};
use crate::{
    device::settings::{Field, Group, Key, Secret, Unfit, Value, Values, WriteError},
    protocol::satrak::{
        FaultKind, Faults, FtpTle, HttpTle, Password, Reply, SatelliteChoice, Setting,
        TleSelection, UrlValue,
    },
};

const ON_ERROR: Key<i64> = Key::choice("on_error", &[(0, "Stop tracking"), (1, "Continue")]);
pub const CONTINUE_TRACKING: Key<bool> = Key::flag("continue_tracking");
const PERIOD_DAYS: Key<i64> = Key::integer("period_days", 0, 365);

/// File name in the groups [`FILE`] and [`FTP`].
pub const FILE_NAME: Key<String> = Key::text("file", text);
/// Satellite name in the group [`FILE`].
pub const SATELLITE_NAME: Key<String> = Key::text("name", text);
pub const PERIOD: Key<i64> = Key::integer("period", 0, 365);
pub const CATALOG_NUMBER: Key<i64> = Key::integer("catalog_number", 0, 999_999_999);
const MAXIMUM_ELEVATION_DEG: Key<f64> = Key::decimal("maximum_elevation_deg", -90.0, 90.0, 1);

pub const URL: Key<String> = Key::text("url", url);

pub const ADDRESS: Key<String> = Key::text("address", text);
pub const USER: Key<String> = Key::text("user", text);
pub const PASSWORD: Key<Secret> = Key::password("password", password);
pub const PORT: Key<i64> = Key::integer("port", 1, 65_535);
/// Satellite name in the group [`FTP`].
pub const SATELLITE: Key<String> = Key::text("satellite", text);

const SATELLITE_OF_FILE: &str = "satellite_of_file";
const SERVER: &str = "server";

const fn continue_tracking() -> Field {
    Field::write(CONTINUE_TRACKING, "Keep present track")
        .moving()
        .description("Off: the present track is stopped. On: it runs to its end.")
}

pub static FILE: Group = Group {
    key: "file",
    title: "File",
    is_service: false,
    fields: &[
        Field::edit(FILE_NAME, "TLE file")
            .part_of(SATELLITE_OF_FILE)
            .moving()
            .description("In the unit's folder of element files."),
        Field::edit(SATELLITE_NAME, "Satellite")
            .part_of(SATELLITE_OF_FILE)
            .moving()
            .description("Its name as in the file."),
        Field::edit(PERIOD, "Update period")
            .moving()
            .description("Its unit is not documented here; days for web and FTP."),
        continue_tracking(),
        Field::read(CATALOG_NUMBER, "Catalogue number")
            .description("Of the satellite that the unit found in the file."),
        Field::read(MAXIMUM_ELEVATION_DEG, "Maximum elevation").in_unit("°"),
    ],
};

pub static WEB: Group = Group {
    key: "web",
    title: "Web",
    is_service: false,
    fields: &[
        Field::edit(URL, "Web address").moving().description("A comma in it is sent as %2C."),
        Field::edit(PERIOD_DAYS, "Update period").moving().in_unit("days"),
        Field::edit(ON_ERROR, "When a fetch fails").moving(),
        continue_tracking(),
    ],
};

pub static FTP: Group = Group {
    key: "ftp",
    title: "FTP",
    is_service: false,
    fields: &[
        Field::edit(ADDRESS, "Server address").part_of(SERVER).moving(),
        Field::edit(USER, "User").part_of(SERVER).moving(),
        Field::edit(PASSWORD, "Password")
            .part_of(SERVER)
            .moving()
            .description("The unit sends it in clear text, also when it is queried."),
        Field::edit(PORT, "Port").part_of(SERVER).moving().description("22 is SFTP, 21 is FTP."),
        Field::edit(FILE_NAME, "TLE file").part_of(SATELLITE_OF_FILE).moving(),
        Field::edit(SATELLITE, "Satellite")
            .part_of(SATELLITE_OF_FILE)
            .moving()
            .description("Its name as in the file."),
        Field::edit(PERIOD_DAYS, "Update period").moving().in_unit("days"),
        Field::edit(ON_ERROR, "When a fetch fails").moving(),
    ],
};

fn password(text: &str) -> Result<(), Unfit> {
    Password::new(text).map(drop).map_err(super::unfit)
}

pub(super) fn file(reply: &Reply) -> Option<Values> {
    let Reply::Satellite(satellite) = reply else { return None };
    let mut values = Values::from([
        FILE_NAME.entry(satellite.file.clone()),
        SATELLITE_NAME.entry(satellite.name.clone()),
        PERIOD.entry(satellite.period.into()),
    ]);
    // Both values are 0 while the unit has found no satellite.
    if satellite.catalog_number > 0 {
        values.extend([
            CATALOG_NUMBER.entry(satellite.catalog_number.into()),
            MAXIMUM_ELEVATION_DEG.entry(satellite.maximum_elevation_deg),
        ]);
    }
    Some(values)
}

pub(super) fn web(reply: &Reply) -> Option<Values> {
    let Reply::SatelliteHttp(web) = reply else { return None };
    Some(Values::from([
        URL.entry(web.url.clone()),
        PERIOD_DAYS.entry(web.period_days.into()),
        ON_ERROR.entry(web.on_error.code()),
    ]))
}

pub(super) fn ftp(reply: &Reply) -> Option<Values> {
    let Reply::SatelliteFtp(ftp) = reply else { return None };
    Some(Values::from([
        ADDRESS.entry(ftp.address.clone()),
        USER.entry(ftp.user.clone()),
        PASSWORD.entry(Secret::new(ftp.password.reveal())),
        PORT.entry(ftp.port.into()),
        FILE_NAME.entry(ftp.file.clone()),
        SATELLITE.entry(ftp.satellite.clone()),
        PERIOD_DAYS.entry(ftp.period_days.into()),
        ON_ERROR.entry(ftp.on_error.code()),
    ]))
}

pub(super) fn write_file(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    Ok(Setting::Satellite(SatelliteChoice {
        file: desired.text(&FILE_NAME)?,
        name: desired.text(&SATELLITE_NAME)?,
        period: desired.whole(&PERIOD)?,
        continue_tracking: desired.is_on(&CONTINUE_TRACKING),
    }))
}

pub(super) fn write_web(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    Ok(Setting::SatelliteHttp(HttpTle {
        url: UrlValue::new(&desired.get(&URL)?).map_err(cannot(URL.name))?,
        period_days: desired.whole(&PERIOD_DAYS)?,
        continue_on_error: desired.get(&ON_ERROR)? == 1,
        continue_tracking: desired.is_on(&CONTINUE_TRACKING),
    }))
}

pub(super) fn write_ftp(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    let password = desired.get(&PASSWORD)?;
    Ok(Setting::SatelliteFtp(FtpTle {
        address: desired.text(&ADDRESS)?,
        user: desired.text(&USER)?,
        password: Password::new(password.reveal()).map_err(cannot(PASSWORD.name))?,
        port: desired.whole(&PORT)?,
        selection: Some(TleSelection {
            file: desired.text(&FILE_NAME)?,
            satellite: desired.text(&SATELLITE)?,
        }),
        period_days: desired.whole(&PERIOD_DAYS)?,
        continue_on_error: desired.get(&ON_ERROR)? == 1,
    }))
}

/// Returns the fields that differ. The unit stores an address as Azel sent it, with its commas
/// encoded.
pub(super) fn web_differing(proof: &Proof<'_>) -> Vec<&'static str> {
    proof.differing(|field, new, current| match new {
        Value::Text(url) => {
            UrlValue::new(url).is_ok_and(|url| *current == Value::Text(url.as_str().to_owned()))
        }
        _ => field.kind.same(new, current),
    })
}

/// Returns the unit's objection to the file. The unit accepts any name, and reports later that the
/// name does not exist.
pub(super) fn judge_file(faults: Faults) -> Option<&'static str> {
    let is_active = |kind| faults.active().any(|active| active == kind);
    if is_active(FaultKind::TleMissing) {
        return Some("the unit does not find the file");
    }
    is_active(FaultKind::SatelliteMissing)
        .then_some("the unit does not find the satellite in the file")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::Request;

    #[test]
    fn all_eight_values_of_the_ftp_source_go_out() {
        let stored = [
            ("address", Value::Text("10.0.1.2".to_owned())),
            ("user", Value::Text("username".to_owned())),
            ("password", Value::Secret(Secret::new("password"))),
            ("port", Value::Integer(21)),
            ("file", Value::Text("iridium.txt".to_owned())),
            ("satellite", Value::Text("IRIDIUM 70 [+]".to_owned())),
            ("period_days", Value::Integer(1)),
            ("on_error", Value::Choice(1)),
        ];
        let new = [("port", Value::Integer(22))].into();
        let desired =
            Desired { new: &new, unit_values: &stored.into(), utc: jiff::Timestamp::UNIX_EPOCH };
        let sent = Request::Setting(write_ftp(&desired).unwrap()).to_bytes();
        let documented: &[u8] = b"$SATELLITE_FTP=,10.0.1.2,username,password,22,iridium.txt,\
            IRIDIUM 70 [+],1,1*32\r\n";
        assert_eq!(sent, documented);
    }
}
