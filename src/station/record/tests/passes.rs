//! Tests of conclusions from several passes of a record.

use jiff::{Timestamp, ToSpan as _};

use super::{DISH, start};
use crate::{
    astro::Site,
    record::{CannotFitPointing, explain_passes, fit_pointing, testing},
    station::Mount,
};

const ISS: u32 = 25544;

#[test]
fn a_pass_that_ends_with_a_time_is_fitted_and_explained_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    testing::record(&path, [testing::note(DISH, ISS, start())]);
    let site = Site::default();
    let mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg: 360.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    let passes = |end: Timestamp| {
        let span = start()..=end;
        let fitted = match fit_pointing(&path, DISH, site, &span, &[], Vec::new()) {
            Ok(fit) => fit.passes,
            Err(CannotFitPointing::Points { passes, .. }) => passes,
            Err(CannotFitPointing::Record(error)) => panic!("{error}"),
        };
        [fitted, explain_passes(&path, DISH, mount, site, &span).unwrap().passes]
    };
    let last = start() + 10.minutes();
    assert_eq!(passes(last), [1; 2]);
    assert_eq!(passes(last - 1.seconds()), [0; 2]);
}
