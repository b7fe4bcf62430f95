//! Choice of the satellite and the source of its elements (sections 23 to 28).

use super::coded::coded;
use super::fields::{FieldError, FrameFields};
use super::text::{Password, TextValue, UrlValue};

coded! {
    /// Action of the unit when an update of the elements fails.
    UpdateErrorAction {
        Stop = 0,
        /// Further use of the last elements.
        Continue = 1,
    }
}

/// Reply to `SATELLITE?`.
#[derive(Debug, Clone, PartialEq)]
pub struct Satellite {
    /// File with the elements.
    pub file: String,
    /// Name as in the file; may contain commas.
    pub name: String,
    /// Update period. The document gives no unit here, but days elsewhere.
    pub period: u32,
    pub catalog_number: u32,
    /// Max elevation, degrees; presumably of the next pass.
    pub maximum_elevation_deg: f64,
}

impl Satellite {
    pub(super) const FIELDS: usize = 5;

    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        // The name is the only value that may contain commas. `max` keeps the subtractions below
        // from becoming negative.
        let last = fields.count().max(Self::FIELDS);
        Ok(Self {
            file: fields.text(1)?.to_owned(),
            name: fields.joined(1, 3)?,
            period: fields.integer(last - 2)?,
            catalog_number: fields.integer(last - 1)?,
            maximum_elevation_deg: fields.decimal(last)?,
        })
    }
}

/// Values of `SATELLITE=`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SatelliteChoice {
    /// File with the elements.
    pub file: TextValue,
    /// Name as in the file.
    pub name: TextValue,
    /// Update period; see [`Satellite::period`].
    pub period: u16,
    /// `true` to continue the current track instead of stopping it.
    pub continue_tracking: bool,
}

impl SatelliteChoice {
    pub(super) fn values(&self) -> Vec<String> {
        vec![
            self.file.as_str().to_owned(),
            self.name.as_str().to_owned(),
            self.period.to_string(),
            flag(self.continue_tracking),
        ]
    }
}

/// Reply to `SATELLITE_HTTP?`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SatelliteHttp {
    /// Web address of the elements.
    pub url: String,
    /// Update period, days.
    pub period_days: u32,
    pub on_error: UpdateErrorAction,
}

impl SatelliteHttp {
    pub(super) const FIELDS: usize = 3;

    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        let last = fields.count().max(Self::FIELDS);
        Ok(Self {
            // An address may contain commas, but the two numbers after it cannot.
            url: fields.joined(0, 2)?,
            period_days: fields.integer(last - 1)?,
            on_error: UpdateErrorAction::from_code(fields.integer(last)?),
        })
    }
}

/// Values of `SATELLITE_HTTP=`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HttpTle {
    /// Web address of the elements.
    pub url: UrlValue,
    /// Update period, days.
    pub period_days: u16,
    /// `true` to continue with the last elements when an update fails, instead of stopping.
    pub continue_on_error: bool,
    /// `true` to continue the current track instead of stopping it.
    pub continue_tracking: bool,
}

impl HttpTle {
    pub(super) fn values(&self) -> Vec<String> {
        vec![
            self.url.as_str().to_owned(),
            self.period_days.to_string(),
            flag(self.continue_on_error),
            flag(self.continue_tracking),
        ]
    }
}

/// Reply to `SATELLITE_FTP?`. The unit returns its password in clear.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SatelliteFtp {
    /// Address of the server.
    pub address: String,
    pub user: String,
    pub password: Password,
    pub port: u16,
    /// File with the elements.
    pub file: String,
    /// Name of the satellite as in the file.
    pub satellite: String,
    /// Update period, days.
    pub period_days: u32,
    pub on_error: UpdateErrorAction,
}

impl SatelliteFtp {
    /// Number of values. With more values, an unknown one of four texts contains a comma.
    pub(super) const FIELDS: usize = 8;

    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        Ok(Self {
            address: fields.text(1)?.to_owned(),
            user: fields.text(2)?.to_owned(),
            password: Password::reported(fields.text(3)?),
            port: fields.integer(4)?,
            file: fields.text(5)?.to_owned(),
            satellite: fields.text(6)?.to_owned(),
            period_days: fields.integer(7)?,
            on_error: UpdateErrorAction::from_code(fields.integer(8)?),
        })
    }
}

/// File with elements, and a satellite in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TleSelection {
    /// File with the elements.
    pub file: TextValue,
    /// Name of the satellite as in the file.
    pub satellite: TextValue,
}

/// Values of `SATELLITE_FTP=`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FtpTle {
    /// Address of the server.
    pub address: TextValue,
    pub user: TextValue,
    pub password: Password,
    /// TCP port. The document's example has 22, which is SFTP.
    pub port: u16,
    /// File and satellite on the server. `None` is the six-value form of the document's example; a
    /// console sends all eight values.
    pub selection: Option<TleSelection>,
    /// Update period, days.
    pub period_days: u16,
    /// `true` to continue with the last elements when an update fails, instead of stopping.
    pub continue_on_error: bool,
}

impl FtpTle {
    pub(super) fn values(&self) -> Vec<String> {
        let mut values = vec![
            self.address.as_str().to_owned(),
            self.user.as_str().to_owned(),
            self.password.reveal().to_owned(),
            self.port.to_string(),
        ];
        if let Some(TleSelection { file, satellite }) = &self.selection {
            values.extend([file.as_str().to_owned(), satellite.as_str().to_owned()]);
        }
        values.extend([self.period_days.to_string(), flag(self.continue_on_error)]);
        values
    }
}

fn flag(value: bool) -> String {
    u8::from(value).to_string()
}
