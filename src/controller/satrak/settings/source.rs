//! The satellite and where its elements come from (sections 23 to 28).

use super::{
    proof::Proof,
    text, url,
    wish::{Wish, cannot},
};
use crate::{
    device::settings::{Field, Group, Kind, Secret, SettleError, Unfit, Value, Values},
    protocol::satrak::{
        FaultKind, Faults, FtpTle, HttpTle, Password, Satellite, SatelliteChoice, SatelliteFtp,
        SatelliteHttp, Setting, TleSelection, UrlValue,
    },
};

const PERIOD: Kind = Kind::Integer { least: 0, most: 365 };
const ON_ERROR: Kind = Kind::Choice(&[(0, "Stop tracking"), (1, "Continue")]);
const CATALOG_NUMBER: Kind = Kind::Integer { least: 0, most: 999_999_999 };

const fn continue_tracking() -> Field {
    Field::write("continue_tracking", "Keep the present track", Kind::Flag)
        .moving()
        .about("Off: what the unit tracks now is stopped. On: it goes on until its end.")
}

pub(in crate::controller::satrak) static FILE: Group = Group {
    key: "file",
    title: "File",
    is_service: false,
    fields: &[
        Field::edit("file", "TLE file", Kind::Text(text))
            .moving()
            .about("In the unit's folder of element files."),
        Field::edit("name", "Satellite", Kind::Text(text))
            .moving()
            .about("Its name as in the file."),
        Field::edit("period", "Update period", PERIOD)
            .moving()
            .about("Its unit is not documented here; days for web and FTP."),
        continue_tracking(),
        Field::read("catalog_number", "Catalogue number", CATALOG_NUMBER)
            .about("Of the satellite that the unit found in the file; 0 for none."),
        Field::read(
            "maximum_elevation_deg",
            "Maximum elevation",
            Kind::Decimal { least: -90.0, most: 90.0, places: 1 },
        )
        .in_unit("°"),
    ],
};

pub(super) static WEB: Group = Group {
    key: "web",
    title: "Web",
    is_service: false,
    fields: &[
        Field::edit("url", "Web address", Kind::Text(url))
            .moving()
            .about("A comma in it is sent as %2C."),
        Field::edit("period_days", "Update period", PERIOD).moving().in_unit("days"),
        Field::edit("on_error", "When a fetch fails", ON_ERROR).moving(),
        continue_tracking(),
    ],
};

pub(super) static FTP: Group = Group {
    key: "ftp",
    title: "FTP",
    is_service: false,
    fields: &[
        Field::edit("address", "Server address", Kind::Text(text)).moving(),
        Field::edit("user", "User", Kind::Text(text)).moving(),
        Field::edit("password", "Password", Kind::Password(password))
            .moving()
            .about("The unit sends it in clear, also when it is asked."),
        Field::edit("port", "Port", Kind::Integer { least: 1, most: 65_535 })
            .moving()
            .about("22 is SFTP, 21 is FTP."),
        Field::edit("file", "TLE file", Kind::Text(text)).moving(),
        Field::edit("satellite", "Satellite", Kind::Text(text))
            .moving()
            .about("Its name as in the file."),
        Field::edit("period_days", "Update period", PERIOD).moving().in_unit("days"),
        Field::edit("on_error", "When a fetch fails", ON_ERROR).moving(),
    ],
};

fn password(text: &str) -> Result<(), Unfit> {
    Password::new(text).map(drop).map_err(super::unfit)
}

pub(super) fn file(satellite: &Satellite) -> Values {
    [
        ("file", Value::Text(satellite.file.clone())),
        ("name", Value::Text(satellite.name.clone())),
        ("period", Value::Integer(satellite.period.into())),
        ("catalog_number", Value::Integer(satellite.catalog_number.into())),
        ("maximum_elevation_deg", Value::Decimal(satellite.maximum_elevation_deg)),
    ]
    .into()
}

pub(super) fn web(web: &SatelliteHttp) -> Values {
    [
        ("url", Value::Text(web.url.clone())),
        ("period_days", Value::Integer(web.period_days.into())),
        ("on_error", Value::Choice(web.on_error.code())),
    ]
    .into()
}

pub(super) fn ftp(ftp: &SatelliteFtp) -> Values {
    [
        ("address", Value::Text(ftp.address.clone())),
        ("user", Value::Text(ftp.user.clone())),
        ("password", Value::Secret(Secret::new(ftp.password.reveal()))),
        ("port", Value::Integer(ftp.port.into())),
        ("file", Value::Text(ftp.file.clone())),
        ("satellite", Value::Text(ftp.satellite.clone())),
        ("period_days", Value::Integer(ftp.period_days.into())),
        ("on_error", Value::Choice(ftp.on_error.code())),
    ]
    .into()
}

pub(super) fn write_file(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    Ok(Setting::Satellite(SatelliteChoice {
        file: wish.text("file")?,
        name: wish.text("name")?,
        period: wish.integer("period")?,
        continue_tracking: wish.flag("continue_tracking"),
    }))
}

pub(super) fn write_web(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    Ok(Setting::SatelliteHttp(HttpTle {
        url: UrlValue::new(wish.str("url")?).map_err(cannot("url"))?,
        period_days: wish.integer("period_days")?,
        continue_on_error: wish.code("on_error")? == 1,
        continue_tracking: wish.flag("continue_tracking"),
    }))
}

pub(super) fn write_ftp(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    Ok(Setting::SatelliteFtp(FtpTle {
        address: wish.text("address")?,
        user: wish.text("user")?,
        password: Password::new(wish.str("password")?).map_err(cannot("password"))?,
        port: wish.integer("port")?,
        selection: Some(TleSelection {
            file: wish.text("file")?,
            satellite: wish.text("satellite")?,
        }),
        period_days: wish.integer("period_days")?,
        continue_on_error: wish.code("on_error")? == 1,
    }))
}

/// An address is on the unit as it was sent: with its commas encoded.
pub(super) fn web_differing(proof: &Proof<'_>) -> Vec<&'static str> {
    proof.differing(|field, new, held| match new {
        Value::Text(url) => {
            UrlValue::new(url).is_ok_and(|url| *held == Value::Text(url.as_str().to_owned()))
        }
        _ => field.kind.same(new, held),
    })
}

/// A unit takes any name and says afterwards that it does not find it.
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
        let held = [
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
        let wish = Wish { new: &new, held: &held.into(), utc: jiff::Timestamp::UNIX_EPOCH };
        let sent = Request::Setting(write_ftp(&wish).unwrap()).to_bytes();
        let documented: &[u8] = b"$SATELLITE_FTP=,10.0.1.2,username,password,22,iridium.txt,\
            IRIDIUM 70 [+],1,1*32\r\n";
        assert_eq!(sent, documented);
    }
}
