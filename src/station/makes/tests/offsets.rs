//! Remembered offsets in the station file.

use super::file::{load, written};
use crate::{
    astro::{Angle, Offset, TrackOffsets},
    controller::SPECS,
    station::{self, AntennaId, Loaded, OffsetsSubject},
};

const ANTENNA: &str = "[[antenna]]\nid = 4\nname = 'Dish'\n[antenna.connection]\n\
                       controller = 'satrak'\naddress = 'h:4001'\n";

#[test]
fn they_come_back_as_they_were_remembered() {
    let (_folder, path) = written(ANTENNA);
    let mut station = load(&path).unwrap().station;
    let with_step = |step| TrackOffsets::NONE.plus(step).unwrap();
    let along = with_step(Offset::Along(Angle::from_degrees(-0.3)));
    station.keep_offsets(OffsetsSubject::Satellite(25_544), along);
    let azimuth = with_step(Offset::Azimuth(Angle::from_degrees(0.1)));
    station.keep_offsets(OffsetsSubject::Antenna(AntennaId(4)), azimuth);
    station::save(&station, &path, SPECS).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("satellite = 25544\nalong_deg = -0.3\n"), "{text}");
    let Loaded { station: read, notes } = load(&path).unwrap();
    assert_eq!((read, notes), (station, Vec::new()), "{text}");
}

#[test]
fn what_cannot_be_used_is_left_out_with_a_note() {
    for wrong in [
        "satellite = 25544\ntime_s = 999",
        "satellite = 25544\nazimuth_deg = 'x'",
        "satellite = 25544\nantenna = 4\nalong_deg = 1",
        "antenna = 7\nazimuth_deg = 1",
        "azimuth_deg = 1",
        "satellite = 25544\nroll_deg = 1",
    ] {
        let (_folder, path) = written(&format!("{ANTENNA}[[offsets]]\n{wrong}\n"));
        let Loaded { station, notes } = load(&path).unwrap();
        assert!(!notes.is_empty(), "{wrong}");
        assert!(station.first_offsets(AntennaId(4), Some(25_544)).is_none(), "{wrong}");
    }
}
