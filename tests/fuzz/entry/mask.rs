//! Any bytes as a file of a horizon mask.

use azel::astro::{Angle, HorizonMask};

pub(crate) fn run(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Ok(mask) = HorizonMask::parse(&text) {
        sound(&mask);
    }
    match HorizonMask::import(&text) {
        Ok((mask, _)) => sound(&mask),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

fn sound(mask: &HorizonMask) {
    assert_eq!(HorizonMask::parse(&mask.to_string()).as_ref(), Ok(mask));
    let (imported, _) = HorizonMask::import(&mask.to_csv()).expect("a table of its own");
    assert_eq!(imported, *mask);
    let lies_within = |elevation: Angle| {
        let (lowest, highest) = (mask.lowest().degrees(), mask.highest().degrees());
        (lowest - 1e-9..=highest + 1e-9).contains(&elevation.degrees())
    };
    let points = mask.points_deg().iter().map(|(azimuth_deg, _)| *azimuth_deg);
    for azimuth_deg in points.chain([0.0, 90.0, 359.999_999, 360.0, -1e-12, 725.0]) {
        let elevation = mask.elevation_at(Angle::from_degrees(azimuth_deg));
        assert!(lies_within(elevation), "{azimuth_deg}: {elevation:?}");
    }
}
