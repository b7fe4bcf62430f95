//! Planning settings in the station file.

use super::file::{load, written};
use crate::{
    controller::SPECS,
    station::{
        self, AntennaId, Automatic, AutomationRule, BetweenPasses, ChooseBy, Favourite, HoursOfDay,
        Light, Loaded, Partly, PassChoice, PassLimits, Priority, RuleAction, RuleSubject,
        SatelliteGroup, Scheduling, SunIs, Take, Upkeep,
    },
};

const ANTENNA: &str = "[[antenna]]\nid = 4\nname = 'Dish'\n[antenna.connection]\n\
                       controller = 'satrak'\naddress = 'h:4001'\n";

fn priority(number: i64) -> Priority {
    Priority::try_from(number).unwrap()
}

#[test]
fn everything_about_the_schedule_comes_back_as_it_was_saved() {
    let (_folder, path) = written(ANTENNA);
    let mut station = load(&path).unwrap().station;
    station.favourites.put(Favourite {
        satellite: 25_544,
        priority: Some(priority(1)),
        limits: PassLimits {
            min_max_elevation_deg: Some(20.0),
            min_duration_s: Some(240.0),
            light: Some(Light::Sunlit),
            antennas: Some(vec![AntennaId(4)]),
            max_per_day: Some(3),
        },
        sources: vec!["own".to_owned(), "weather".to_owned()],
    });
    station.scheduling = Scheduling {
        choose_by: ChooseBy::MostMinutes,
        span_h: 48.0,
        partly: Some(Partly { min_percent: 40.0, min_s: 120.0 }),
        hand_over: true,
        max_element_age_d: Some(14.0),
        warn_after_rest_min: 30.0,
        warning_s: 45.0,
    };
    station.groups = vec![SatelliteGroup {
        name: "Weather".to_owned(),
        satellites: vec![43_013, 25_544],
        priority: Some(priority(2)),
        limits: PassLimits { max_per_day: Some(9), ..PassLimits::default() },
    }];
    let time = |text: &str| text.parse().unwrap();
    station.pass_choices = vec![PassChoice {
        satellite: 43_013,
        tca: time("2026-08-12T12:30:00.25Z"),
        take: Take::Never,
        chosen_at: time("2026-08-12T08:00:00Z"),
    }];
    station.rules = vec![
        AutomationRule {
            is_on: true,
            antenna: Some(AntennaId(4)),
            subject: Some(RuleSubject::Group("Weather".to_owned())),
            sun: Some(SunIs::Down),
            hours: Some(HoursOfDay::NIGHT),
            action: RuleAction::Park,
        },
        AutomationRule {
            is_on: false,
            antenna: None,
            subject: Some(RuleSubject::Satellite(25_544)),
            sun: None,
            hours: None,
            action: RuleAction::Take,
        },
    ];
    station.antennas[0].automatic = Automatic {
        is_on_at_start: true,
        between_passes: BetweenPasses::Park,
        resumes_after_crash: true,
        uses_auto_track: true,
        set_up_s: Some(20.0),
    };
    station.antennas[0].upkeep = Upkeep {
        sets_clock: true,
        clock_limit_s: 7.5,
        uploads_elements: true,
        element_limit_d: 1.5,
    };
    station::save(&station, &path, SPECS).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("automatic_operation_at_start = true"), "{text}");
    let Loaded { station: read, notes } = load(&path).unwrap();
    assert_eq!((read, notes), (station, Vec::new()), "{text}");
}

#[test]
fn an_entry_of_an_earlier_version_is_read_in_silence_and_dropped() {
    let entry = "[antenna.upkeep]\nsets_clock = true\n[antenna.upkeep.upload]\nhost = 'unit'\n";
    let (_folder, path) = written(&format!("{ANTENNA}\n{entry}"));
    let Loaded { station, notes } = load(&path).unwrap();
    assert_eq!(notes, []);
    station::save(&station, &path, SPECS).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("sets_clock") && !text.contains("upload]"), "{text}");
}

#[test]
fn a_station_file_from_before_schedules_means_what_it_meant() {
    let (_folder, path) = written(&format!("favourites = [43013]\n{ANTENNA}"));
    let Loaded { station, notes } = load(&path).unwrap();
    assert_eq!(notes, []);
    assert_eq!(station.scheduling, Scheduling::default());
    assert_eq!(station.antennas[0].automatic, Automatic::default());
    assert!(station.antennas[0].set_up_s() > 0.0, "that of its make");
    assert_eq!(station.priority(43_013), Some(Priority::default()));
    assert_eq!(station.pass_limits(43_013), PassLimits::default());
}

#[test]
fn a_satellite_has_its_own_priority_and_limits_before_those_of_its_groups() {
    let (_folder, path) = written(
        "favourites = [1, { satellite = 2, priority = 5, min_duration_s = 60 }, 3]\n\
         [[group]]\nname = 'A'\nsatellites = [1, 2]\npriority = 1\nmin_duration_s = 300\n\
         [[group]]\nname = 'B'\nsatellites = [1]\npriority = 4\nmax_per_day = 2\n",
    );
    let station = load(&path).unwrap().station;
    let number = |satellite| station.priority(satellite).map(Priority::number);
    assert_eq!([1, 2, 3, 4].map(number), [Some(1), Some(5), Some(3), None]);
    let limits = |satellite| {
        let limits = station.pass_limits(satellite);
        (limits.min_duration_s, limits.max_per_day)
    };
    assert_eq!(limits(1), (Some(300.0), Some(2)));
    assert_eq!(limits(2), (Some(60.0), None));
    assert_eq!(limits(3), (None, None));
}

#[test]
fn what_cannot_be_read_is_named_and_a_rule_never_becomes_wider() {
    let (_folder, path) = written(&format!(
        "favourites = [{{ satellite = 7, light = 'dusk', antennas = [4, 9] }}]\n\
         [schedule]\nspan_h = 1000\nchoose_by = 'best'\nspn = 1\n\
         [[group]]\nsatellites = [7]\n\
         [[pass]]\nsatellite = 7\ntake = 'always'\ntca = 'noon'\n\
         [[rule]]\nantenna = 8\nthen = 'leave'\n\
         [[rule]]\ngroup = 'None'\nthen = 'leave'\n\
         [[rule]]\nsun = 'gone'\nthen = 'take'\n\
         [[rule]]\nhours = {{ from = '08:00', to = '08:00' }}\nthen = 'take'\n\
         [[rule]]\nsun = 'up'\n\
         [[rule]]\nsatellite = 7\nthen = 'take'\n{ANTENNA}uses_auto_track = 3\n"
    ));
    let Loaded { station, notes } = load(&path).unwrap();
    let places: Vec<&str> = notes.iter().map(|note| note.place.as_str()).collect();
    for place in [
        "favourites[0].light",
        "favourites[0].antennas",
        "schedule.span_h",
        "schedule.choose_by",
        "schedule.spn",
        "group[0].name",
        "pass[0].tca",
        "rule[0].antenna",
        "rule[1].group",
        "rule[2].sun",
        "rule[3].hours",
        "rule[4].then",
    ] {
        assert!(places.contains(&place), "{place} is not named: {places:?}");
    }
    assert_eq!(station.rules.len(), 1);
    assert_eq!(station.rules[0].subject, Some(RuleSubject::Satellite(7)));
    assert_eq!(station.pass_limits(7).antennas, Some(vec![AntennaId(4)]));
    assert_eq!((station.groups, station.pass_choices), (vec![], vec![]));
    assert_eq!(station.scheduling, Scheduling::default());
}

#[test]
fn a_rule_holds_by_its_antenna_its_hours_of_utc_and_the_sun() {
    let rule = AutomationRule {
        is_on: true,
        antenna: Some(AntennaId(4)),
        subject: None,
        sun: Some(SunIs::Down),
        hours: Some(HoursOfDay::NIGHT),
        action: RuleAction::Leave,
    };
    let time = |text: &str| text.parse().unwrap();
    let night = time("2026-08-12T23:00:00Z");
    assert!(rule.holds_at(night, SunIs::Down) && !rule.holds_at(night, SunIs::Up));
    assert!(!rule.holds_at(time("2026-08-12T12:00:00Z"), SunIs::Down));
    assert!(rule.is_for(AntennaId(4)) && !rule.is_for(AntennaId(5)));
    assert!(!AutomationRule { is_on: false, ..rule }.holds_at(night, SunIs::Down));
}
