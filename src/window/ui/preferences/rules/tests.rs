use super::{
    cannot_act::{CannotAct, RuleContext},
    draft::{DraftSubject, RulesDraft},
    sentence::{sentence, then_in_short, when_in_short},
};
use crate::{
    makes::DemoAddresses,
    station::{
        AntennaId, AutomationRule, HoursOfDay, PassLimits, RuleAction, RuleSubject, SatelliteGroup,
        Station, SunIs,
    },
    ui::preferences::draft::Draft,
};

const ISS: u32 = 25_544;
const NOAA_20: u32 = 43_013;
const NO_FAVOURITE: u32 = 7;
const GENIUS: AntennaId = AntennaId(2);

fn rule() -> AutomationRule {
    AutomationRule {
        is_on: true,
        antenna: None,
        subject: None,
        sun: None,
        hours: None,
        action: RuleAction::Leave,
    }
}

fn of_group(name: &str) -> AutomationRule {
    AutomationRule { subject: Some(RuleSubject::Group(name.to_owned())), ..rule() }
}

fn of_satellite(number: u32) -> AutomationRule {
    AutomationRule { subject: Some(RuleSubject::Satellite(number)), ..rule() }
}

fn hours(start_text: &str, end_text: &str) -> HoursOfDay {
    let time = |text| HoursOfDay::read_time(text).unwrap();
    HoursOfDay { start: time(start_text), end: time(end_text) }
}

fn group(name: &str, satellites: &[u32]) -> SatelliteGroup {
    let limits = PassLimits::default();
    SatelliteGroup { name: name.to_owned(), satellites: satellites.into(), priority: None, limits }
}

fn station(rules: Vec<AutomationRule>) -> Station {
    Station {
        groups: vec![group("Weather", &[NOAA_20, 59_051]), group("Empty", &[])],
        favourites: [NOAA_20, ISS, 59_051].into(),
        rules,
        ..Station::demo(&DemoAddresses {
            satrak: "127.0.0.1:4001".to_owned(),
            genius: "127.0.0.1:9006".to_owned(),
            rc2000c: "/dev/pts/7".to_owned(),
        })
    }
}

fn with_draft<R>(station: &Station, see: impl FnOnce(&mut RulesDraft, &RuleContext<'_>) -> R) -> R {
    let mut draft = Draft::new(station);
    let mut rules = std::mem::replace(&mut draft.rules, RulesDraft::new(&Station::default()));
    see(&mut rules, &draft.around_rules())
}

fn text(rule: AutomationRule) -> String {
    let name = |number: u32| if number == ISS { "ISS".to_owned() } else { number.to_string() };
    with_draft(&station(vec![rule]), |rules, context| sentence(&rules.all()[0], context, &name))
}

/// Returns the reason why the last of these rules cannot act.
fn hindrance(rules: Vec<AutomationRule>) -> Option<CannotAct> {
    let last = rules.len() - 1;
    with_draft(&station(rules), |rules, context| rules.cannot_act(last, context))
}

#[test]
fn a_rule_is_one_sentence_made_from_its_fields() {
    let genius = Some(GENIUS);
    for (rule, expected) in [
        (rule(), "No antenna takes any pass."),
        (
            AutomationRule { action: RuleAction::Take, ..of_satellite(ISS) },
            "Any antenna may take passes of ISS, whatever their limits.",
        ),
        (
            AutomationRule { antenna: genius, sun: Some(SunIs::Down), ..of_group("Weather") },
            "While the Sun is down, Genius leaves passes of the group Weather out.",
        ),
        (
            AutomationRule {
                antenna: genius,
                sun: Some(SunIs::Up),
                hours: Some(hours("22:00", "06:30")),
                action: RuleAction::Park,
                ..rule()
            },
            "While the Sun is up, from 22:00 to 06:30 UTC, Genius is parked and takes no passes.",
        ),
        (
            AutomationRule { action: RuleAction::Park, ..rule() },
            "All antennas are parked and take no passes.",
        ),
        (
            AutomationRule { antenna: genius, action: RuleAction::Park, ..of_satellite(ISS) },
            "Genius leaves passes of ISS out, but is not parked.",
        ),
        (
            AutomationRule { action: RuleAction::Park, ..of_satellite(ISS) },
            "No antenna takes passes of ISS, but none is parked.",
        ),
    ] {
        assert_eq!(text(rule), expected);
    }
}

#[test]
fn the_table_says_a_rule_in_a_few_words() {
    let name = |number: u32| number.to_string();
    let words = |rule| {
        with_draft(&station(vec![rule]), |rules, context| {
            let rule = &rules.all()[0];
            (when_in_short(rule, context, &name), then_in_short(rule))
        })
    };
    assert_eq!(words(rule()), ("always".to_owned(), "leave out"));
    let night = AutomationRule {
        sun: Some(SunIs::Down),
        hours: Some(hours("22:00", "06:00")),
        action: RuleAction::Take,
        ..of_group("Weather")
    };
    let when = "Weather, Sun down, 22:00 to 06:00 UTC".to_owned();
    assert_eq!(words(night), (when, "take, whatever the limits"));
}

#[test]
fn a_rule_that_names_nothing_planned_cannot_act() {
    assert_eq!(hindrance(vec![rule()]), None);
    assert_eq!(hindrance(vec![of_satellite(ISS)]), None);
    assert_eq!(hindrance(vec![of_satellite(NO_FAVOURITE)]), Some(CannotAct::NoFavourite));
    assert_eq!(hindrance(vec![of_group("Weather")]), None);
    assert_eq!(hindrance(vec![of_group("Empty")]), Some(CannotAct::EmptyGroup(1)));
}

#[test]
fn a_rule_is_hidden_by_an_earlier_one_that_holds_wherever_it_does() {
    let hidden = Some(CannotAct::Behind(1));
    let night = AutomationRule { hours: Some(hours("22:00", "06:00")), ..rule() };
    let late = AutomationRule { hours: Some(hours("23:30", "06:00")), ..rule() };
    let early = AutomationRule { hours: Some(hours("06:00", "07:00")), ..rule() };
    let genius = AutomationRule { antenna: Some(GENIUS), ..rule() };
    let satrak = AutomationRule { antenna: Some(AntennaId(1)), ..rule() };
    let by_day = AutomationRule { sun: Some(SunIs::Up), ..rule() };
    let disabled = AutomationRule { is_on: false, ..rule() };
    for (first, second, obstacle) in [
        (rule(), rule(), hidden),
        (rule(), night.clone(), hidden),
        (night.clone(), rule(), None),
        (night.clone(), late.clone(), hidden),
        (late, night.clone(), None),
        (night, early, None),
        (genius.clone(), genius.clone(), hidden),
        (genius.clone(), rule(), None),
        (rule(), genius.clone(), hidden),
        (satrak, genius, None),
        (by_day.clone(), rule(), None),
        (by_day.clone(), by_day, hidden),
        (disabled, rule(), None),
        (of_group("Weather"), of_satellite(NOAA_20), hidden),
        (of_group("Weather"), of_satellite(ISS), None),
        (of_satellite(NOAA_20), of_group("Weather"), None),
        (of_group("Weather"), rule(), None),
        (of_group("Empty"), of_group("Weather"), None),
    ] {
        let rules = vec![first, second];
        assert_eq!(hindrance(rules.clone()), obstacle, "{rules:?}");
    }
}

#[test]
fn a_rule_whose_antenna_or_group_is_removed_cannot_be_saved() {
    let genius = AutomationRule { antenna: Some(GENIUS), ..rule() };
    let mut draft = Draft::new(&station(vec![of_group("Weather"), genius.clone()]));
    let whole = draft.read().unwrap();
    assert_eq!(whole.rules, [of_group("Weather"), genius]);
    draft.toggle_removed(1);
    assert_eq!(draft.read(), None);
    let finding = &draft.rules.wrong(&draft.around_rules())[0];
    assert_eq!(finding.sentence(), "Rule 2 cannot be saved: its antenna is removed.");
    draft.rules.get_mut(1).unwrap().is_removed = true;
    assert_eq!(draft.read().unwrap().rules, [of_group("Weather")]);
    draft.satellites.group_mut(0).unwrap().is_removed = true;
    assert_eq!(draft.read(), None);
    draft.rules.get_mut(0).unwrap().subject = DraftSubject::Satellite(None);
    assert_eq!(draft.read(), None);
    draft.rules.get_mut(0).unwrap().subject = DraftSubject::Satellite(Some(ISS));
    assert_eq!(draft.read().unwrap().rules, [of_satellite(ISS)]);
}

#[test]
fn a_rule_follows_the_new_name_of_its_group() {
    let mut draft = Draft::new(&station(vec![of_group("Weather")]));
    draft.satellites.group_mut(0).unwrap().rename("Clouds");
    let station = draft.read().unwrap();
    assert_eq!(station.rules, [of_group("Clouds")]);
    assert_eq!(station.groups[0].name, "Clouds");
    draft.satellites.group_mut(0).unwrap().rename("empty");
    assert_eq!(draft.read(), None, "another group has the name");
}

#[test]
fn another_order_is_one_edit_and_duplicates_are_off() {
    let saved = station(vec![of_satellite(ISS), of_group("Weather"), rule()]);
    let before = RulesDraft::new(&saved);
    with_draft(&saved, |rules, context| {
        let edited = |rules: &RulesDraft| rules.edited(&before);
        assert_eq!(edited(rules), 0);
        rules.reorder(2, 0);
        assert_eq!(edited(rules), 1);
        let copy = rules.duplicate(0).unwrap();
        assert_eq!((copy, edited(rules)), (1, 2));
        let read = rules.read(context).unwrap();
        let disabled = AutomationRule { is_on: false, ..rule() };
        assert_eq!(read, [rule(), disabled, of_satellite(ISS), of_group("Weather")]);
        rules.get_mut(0).unwrap().is_removed = true;
        assert_eq!((rules.number(0), rules.number(1), edited(rules)), (None, Some(1), 3));
    });
}

#[test]
fn limits_do_not_name_an_antenna_that_is_removed() {
    let mut changed = station(Vec::new());
    changed.groups[0].limits.antennas = Some(vec![AntennaId(1), GENIUS]);
    let limits = PassLimits { antennas: Some(vec![GENIUS]), ..PassLimits::default() };
    changed.favourites.set_limits(ISS, limits);
    let mut draft = Draft::new(&changed);
    assert_eq!(draft.read(), Some(changed));
    draft.toggle_removed(1);
    let station = draft.read().unwrap();
    assert_eq!(station.groups[0].limits.antennas, Some(vec![AntennaId(1)]));
    assert_eq!(station.pass_limits(ISS).antennas, Some(Vec::new()), "a limit is not widened");
}
