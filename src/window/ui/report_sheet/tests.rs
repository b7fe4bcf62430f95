use super::*;
use crate::{
    astro::{Angle, AzEl, PointingModel, Site, time::add_seconds},
    contract::{
        driver::TimeSync,
        record::{AboutTrack, RecordedPass, RecordedReport, TrackedBy},
    },
    device::Pointing,
    orbit::{PassSearch, Propagator, bundled, passes},
    plan::{
        MountLimits, Sample, Trackability,
        pass_report::{
            Breaks, Evidence, FlownOffsets, MeasuredPosition, PathSource, TrackPoint, TrackedPass,
        },
    },
    station::{AntennaId, Mount},
    ui::page::testing::prints_on_one_sheet,
};

const ISS: u32 = 25_544;
const HALF_BEAM_DEG: f64 = 0.5;
const HOSTILE: &str = "<&\"'>]]>\u{0}\u{1b}[2J\u{202e}\u{ffff} \u{1f6f0}漢字漢字 ";

/// Returns a high pass of the ISS by an antenna that was `late_s` late. It has measurements at the
/// seconds that `is_measured` keeps.
fn opened(late_s: f64, is_measured: impl Fn(u32) -> bool) -> OpenedPass {
    let catalog = bundled().unwrap();
    let elements = catalog.get(ISS).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    let site = Site::new(41.2, -8.6, 120.0).unwrap();
    let start = elements.epoch();
    let search = PassSearch::new(site, start, add_seconds(start, 3.0 * 86_400.0));
    let found = passes(&propagator, &search, &|| false);
    let height = |pass: &&crate::orbit::Pass| pass.max_elevation().degrees();
    let pass = found.iter().max_by(|a, b| height(a).total_cmp(&height(b))).unwrap();
    let (begin, end) = (pass.aos.time, pass.los.time);
    let direction = |time| propagator.look_from(site, time).unwrap().direction;
    let seconds = (0..pass.duration_s() as u32).filter(|second| is_measured(*second));
    let positions: Vec<MeasuredPosition> = seconds
        .map(|second| {
            let time = add_seconds(begin, f64::from(second));
            let AzEl { azimuth, elevation } = direction(add_seconds(time, -late_s));
            let pointing = Pointing { azimuth: Some(azimuth), elevation: Some(elevation) };
            MeasuredPosition { time, pointing }
        })
        .collect();
    let limits = MountLimits {
        mount: Mount::AzEl {
            azimuth_from_deg: 0.0,
            azimuth_to_deg: 540.0,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        },
        maximum_rate_deg_s: 10.0,
        half_beam: Angle::from_degrees(HALF_BEAM_DEG),
        has_elevation: true,
        min_elevation: Angle::from_degrees(0.0),
    };
    let trackability = Trackability::Whole;
    let breaks = Breaks::default();
    let tracked = TrackedPass {
        propagator: &propagator,
        site,
        start: begin,
        end,
        limits,
        trackability,
        ended: None,
        breaks: &breaks,
    };
    let points = positions
        .iter()
        .map(|measured_position| TrackPoint::new(&propagator, site, true, *measured_position));
    let track: Vec<TrackPoint> = points.flatten().collect();
    let measured = track.iter().map(|point| (point.time, point.antenna));
    let steps = (0..=pass.duration_s() as u32 / 2).map(|step| {
        let time = add_seconds(begin, 2.0 * f64::from(step));
        Sample { time, direction: direction(time) }
    });
    OpenedPass {
        path: steps.collect(),
        pass: RecordedPass {
            id: 1,
            antenna: AntennaId(1),
            antenna_name: "North mast".to_owned(),
            report: RecordedReport {
                start: begin,
                end,
                planned: None,
                max_elevation_deg: pass.max_elevation().degrees(),
                age_days: 0.4,
                site: Some(site),
                half_beam_deg: HALF_BEAM_DEG,
                track: AboutTrack {
                    begun: add_seconds(begin, -30.0),
                    tracked_by: TrackedBy::ProgramTrack,
                    sent: Some(640),
                    offsets: FlownOffsets::default(),
                    pointing_model: PointingModel::default(),
                    unit_clock_ahead_s: Some(-late_s),
                    unit_place: None,
                    sync: TimeSync::Synchronised,
                },
                report: tracked.report(&positions),
                causes: Evidence::new(limits.mount, true, limits.half_beam)
                    .with_pass(&propagator, site, PathSource::Azel, measured)
                    .explanations(&[]),
                elements,
            },
        },
        track,
        entries: Vec::new(),
    }
}

fn page(opened: &OpenedPass) -> String {
    html(opened, add_seconds(opened.pass.report.end, 600.0))
}

/// Counts the points of the measured lines over the sky.
fn measured(page: &str) -> usize {
    let lines = page.split("<polyline class=\"thick measured\" points=\"").skip(1);
    lines.map(|line| line.split('"').next().unwrap().split(' ').count()).sum()
}

#[test]
fn the_report_of_a_late_antenna_is_one_page_that_says_so() {
    let opened = opened(1.2, |_| true);
    let page = page(&opened);
    for words in
        ["Pass report", "Verdict: poor", "Time offset", "+1.20 s", "North mast", "program track"]
    {
        assert!(page.contains(words), "{words}");
    }
    assert!(page.contains("The antenna was 1.20 s late"));
    assert!(page.contains("Set the unit's clock first"));
}

#[test]
fn all_that_was_measured_is_drawn_and_nothing_across_a_gap() {
    let whole = opened(0.3, |_| true);
    let broken = opened(0.3, |second| !(200..260).contains(&second));
    assert_eq!(measured(&page(&whole)), whole.track.len());
    assert_eq!(measured(&page(&broken)), broken.track.len());
    let pieces = |page: &str| page.matches("class=\"thick measured\"").count();
    assert_eq!((pieces(&page(&whole)), pieces(&page(&broken))), (1, 2));
}

#[test]
fn a_pass_without_a_position_has_a_page() {
    let page = page(&opened(0.0, |_| false));
    assert!(page.contains("No position was measured in this pass."));
    assert!(page.contains("Nothing was measured"));
}

#[test]
fn names_from_outside_break_nothing() {
    let mut opened = opened(1.2, |_| true);
    opened.pass.antenna_name = HOSTILE.repeat(40);
    assert!(!page(&opened).contains(['\u{1b}', '\u{202e}']));
}

#[test]
#[ignore = "needs Chromium"]
fn chromium_prints_a_report_on_one_page() {
    let mut longest = opened(1.2, |second| second % 40 > 3);
    longest.pass.antenna_name = HOSTILE.repeat(40);
    for opened in [longest, opened(0.3, |_| true), opened(0.0, |_| false)] {
        prints_on_one_sheet(&page(&opened));
    }
}
