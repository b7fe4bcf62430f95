//! Priorities, limits, groups and automation rules in the preferences.

use std::sync::Arc;

use azel::{
    model::View,
    station::{
        AntennaId, AutomationRule, HoursOfDay, PassLimits, Priority, RuleAction, RuleSubject,
        SatelliteGroup, Station, SunIs,
    },
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    preferences::{asked, open, saved, write},
    rig::{self, NOAA_20, SIZES, Window, says, settle},
    states,
};

const ISS: u32 = 25_544;
const SATELLITES: &str = "Satellites and priorities";
const RULES: &str = "Automation rules";

fn rule() -> AutomationRule {
    let then = RuleAction::Leave;
    AutomationRule {
        is_on: true,
        antenna: None,
        subject: None,
        sun: None,
        hours: None,
        action: then,
    }
}

fn of_weather() -> AutomationRule {
    AutomationRule {
        antenna: Some(AntennaId(1)),
        subject: Some(RuleSubject::Group("Weather".to_owned())),
        hours: Some(HoursOfDay::NIGHT),
        ..rule()
    }
}

fn of_iss() -> AutomationRule {
    let of = Some(RuleSubject::Satellite(ISS));
    AutomationRule { subject: of, sun: Some(SunIs::Down), action: RuleAction::Take, ..rule() }
}

fn weather() -> SatelliteGroup {
    SatelliteGroup {
        name: "Weather".to_owned(),
        satellites: vec![NOAA_20],
        priority: Priority::try_from(2).ok(),
        limits: PassLimits { min_max_elevation_deg: Some(20.0), ..PassLimits::default() },
    }
}

/// Returns the page of a station with a group and these rules.
fn page(size: [f32; 2], page: &str, rules: Vec<AutomationRule>) -> Window {
    let mut model = rig::model(states::holding());
    model.view = View::Preferences;
    let station = Station { groups: vec![weather()], rules, ..Station::clone(&model.station) };
    model.shown_mut().station = Arc::new(station);
    let mut window = rig::window(size, model);
    open(&mut window, page);
    window
}

/// Returns the page of two rules, of which the first is chosen.
pub(crate) fn view(size: [f32; 2]) -> Window {
    page(size, RULES, vec![of_weather(), of_iss()])
}

fn press(window: &mut Window, role: Role, name: &str) {
    window.get_by_role_and_label(role, name).scroll_to_me();
    settle(window);
    window.get_by_role_and_label(role, name).click();
    settle(window);
}

/// Presses the segment of this choice.
fn choose(window: &mut Window, choice: &str, segment: &str) {
    let group = || window.get_by_role_and_label(Role::RadioGroup, choice);
    group().scroll_to_me();
    group().get_by_label(segment).click();
    settle(window);
}

fn key(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    settle(window);
}

fn save(window: &mut Window) -> Station {
    key(window, Modifiers::COMMAND, Key::Enter);
    saved(asked(window))
}

#[test]
fn a_favourite_gets_a_priority_and_limits() {
    for size in rig::sizes() {
        let mut window = page(size, SATELLITES, Vec::new());
        assert!(says(&window, "Priority of NOAA 20: 2, Weather"));
        assert!(says(&window, "Priority of ISS: 3, default"));
        choose(&mut window, "Priority of ISS", "1");
        press(&mut window, Role::Button, "Limits of ISS: No limits");
        press(&mut window, Role::ComboBox, "Light, any");
        window.get_by_label("by night").click();
        settle(&mut window);
        assert!(says(&window, "Satellites and priorities: 2 edited"));
        let station = save(&mut window);
        assert_eq!(station.priority(ISS).map(Priority::number), Some(1));
        assert_eq!(station.pass_limits(ISS).light, Some(azel::station::Light::Night));
        assert_eq!(station.groups, [weather()]);
        assert_eq!(station.favourites.get(NOAA_20).unwrap().priority, None);
    }
}

#[test]
fn a_favourite_gives_its_priority_back_to_its_group() {
    let mut window = page(rig::LARGE, SATELLITES, Vec::new());
    choose(&mut window, "Priority of NOAA 20", "5");
    assert!(!says(&window, "Priority of NOAA 20: 2, Weather"));
    choose(&mut window, "Priority of NOAA 20", "Default");
    assert!(says(&window, "Priority of NOAA 20: 2, Weather"));
    assert!(says(&window, "Nothing to save."));
}

#[test]
fn a_group_is_made_with_satellites_from_the_favourites_and_from_the_catalogue() {
    for size in rig::sizes() {
        let mut window = page(size, SATELLITES, Vec::new());
        press(&mut window, Role::Button, "Add a group");
        write(&mut window, "Name", "Stations");
        press(&mut window, Role::ComboBox, "Favourite");
        window.get_by_role_and_label(Role::Button, "ISS").click();
        settle(&mut window);
        window.get_by_role_and_label(Role::TextInput, "Search for a satellite").focus();
        settle(&mut window);
        window.event(Event::Text("54234".to_owned()));
        settle(&mut window);
        window.key_press(Key::Enter);
        settle(&mut window);
        window.get_by_role_and_label(Role::Button, "Remove ISS from Stations");
        choose(&mut window, "Priority", "4");
        press(&mut window, Role::ComboBox, "Antennas, any");
        window.get_by_role_and_label(Role::CheckBox, "Satrak").click();
        settle(&mut window);
        window.key_press(Key::Escape);
        settle(&mut window);
        let wanted = SatelliteGroup {
            name: "Stations".to_owned(),
            satellites: vec![ISS, 54_234],
            priority: Priority::try_from(4).ok(),
            limits: PassLimits { antennas: Some(vec![AntennaId(1)]), ..PassLimits::default() },
        };
        assert_eq!(save(&mut window).groups, [weather(), wanted]);
    }
}

#[test]
fn a_group_needs_a_name_of_its_own() {
    for size in rig::sizes() {
        let mut window = page(size, SATELLITES, Vec::new());
        press(&mut window, Role::Button, "Add a group");
        write(&mut window, "Name", "weather");
        assert!(says(&window, "Name must differ from those of the other groups."));
        let twin = ": cannot be saved, its name must differ from those of the other groups";
        assert_eq!(window.query_all_by_label_contains(twin).count(), 2, "at each of them");
        assert!(says(&window, "Satellites and priorities: 1 edited, 2 not valid"), "both names");
        key(&mut window, Modifiers::COMMAND, Key::Enter);
        assert_eq!(asked(&mut window), []);
        write(&mut window, "Name", "Clouds");
        assert_eq!(save(&mut window).groups[1].name, "Clouds");
    }
}

#[test]
fn a_removed_group_can_be_kept_and_a_rule_that_names_it_cannot_be_saved() {
    for size in rig::sizes() {
        let mut window = page(size, SATELLITES, vec![of_weather()]);
        press(&mut window, Role::Button, "Remove: group Weather");
        assert!(says(&window, "Automation rules: 1 not valid"));
        key(&mut window, Modifiers::COMMAND, Key::Enter);
        assert_eq!(asked(&mut window), []);
        open(&mut window, RULES);
        assert!(says(&window, "it names a group that does not exist"));
        open(&mut window, SATELLITES);
        press(&mut window, Role::Button, "Undo: keep it: group Weather");
        assert!(says(&window, "Nothing to save."));
    }
}

#[test]
fn the_rules_of_the_file_are_shown_in_their_order_with_what_hinders_them() {
    for size in rig::sizes() {
        let mut window = page(size, RULES, vec![of_iss(), of_weather(), rule(), of_iss()]);
        let sentences = [
            "Rule 1: While the Sun is down, any antenna may take passes of ISS, whatever their \
             limits.",
            "Rule 2: From 22:00 to 06:00 UTC, Satrak leaves passes of the group Weather out.",
            "Rule 3: No antenna takes any pass.",
            "Rule 4: While the Sun is down, any antenna may take passes of ISS, whatever their \
             limits. It cannot act: rule 1 decides before it.",
        ];
        for sentence in sentences {
            window.get_by_role_and_label(Role::RadioButton, sentence);
        }
        press(&mut window, Role::RadioButton, sentences[3]);
        assert!(says(&window, "It cannot act: rule 1 decides before it."));
        press(&mut window, Role::Switch, "Rule 1 is on");
        assert!(!says(&window, "rule 1 decides before it"), "it is off");
        assert!(says(&window, "rule 3 decides before it"));
    }
}

#[test]
fn a_rule_is_made_by_mouse() {
    for size in rig::sizes() {
        let mut window = page(size, RULES, Vec::new());
        assert!(says(&window, "There are no rules: only priorities and limits decide."));
        press(&mut window, Role::Button, "Add rule");
        press(&mut window, Role::ComboBox, "Antenna, All");
        window.get_by_role_and_label(Role::Button, "Satrak").click();
        settle(&mut window);
        choose(&mut window, "Satellites", "Group");
        assert!(says(&window, "it names a group that does not exist"));
        press(&mut window, Role::ComboBox, "Group, Choose a group");
        window.get_by_label("Weather").click();
        settle(&mut window);
        choose(&mut window, "Hours", "Some");
        press(&mut window, Role::Switch, "Rule 1 is on");
        assert!(says(
            &window,
            "From 22:00 to 06:00 UTC, Satrak leaves passes of the group Weather out."
        ));
        assert_eq!(save(&mut window).rules, [of_weather()]);
    }
}

#[test]
fn hours_that_are_empty_or_no_times_are_explained_and_not_saved() {
    for size in rig::sizes() {
        let mut window = page(size, RULES, vec![of_weather()]);
        write(&mut window, "To", "22:00");
        assert!(says(&window, "To must differ from From."));
        assert!(says(&window, "Automation rules: 1 edited, 1 not valid"));
        write(&mut window, "To", "7 o'clock");
        assert!(says(&window, "To must be a time of day such as 22:00."));
        key(&mut window, Modifiers::COMMAND, Key::Enter);
        assert_eq!(asked(&mut window), []);
        write(&mut window, "To", "07:30");
        let to = HoursOfDay::read_time("07:30").unwrap();
        let wanted = HoursOfDay { end: to, ..HoursOfDay::NIGHT };
        assert_eq!(save(&mut window).rules[0].hours, Some(wanted));
    }
}

#[test]
fn a_rule_of_a_satellite_finds_it_by_name_and_says_if_it_is_not_planned() {
    let mut window = page(rig::LARGE, RULES, vec![rule()]);
    choose(&mut window, "Satellites", "One");
    assert!(says(&window, "it names no satellite"));
    window.get_by_role_and_label(Role::TextInput, "Search for a satellite").focus();
    settle(&mut window);
    window.event(Event::Text("54234".to_owned()));
    settle(&mut window);
    window.key_press(Key::Enter);
    settle(&mut window);
    assert!(says(&window, "it names no favourite, and only favourites are planned"));
    let of = Some(RuleSubject::Satellite(54_234));
    assert_eq!(save(&mut window).rules, [AutomationRule { subject: of, ..rule() }]);
}

#[test]
fn rules_are_chosen_moved_and_removed_by_keys() {
    for size in rig::sizes() {
        let mut window = page(size, RULES, vec![of_iss(), of_weather(), rule()]);
        let rows = |window: &Window| {
            let rows = window.query_all_by_role(Role::RadioButton);
            let names = rows.filter_map(|row| row.accesskit_node().label());
            names.filter(|name| name.contains("antenna") || name.contains("Satrak leaves")).count()
        };
        assert_eq!(rows(&window), 3);
        let first = "Rule 1: While the Sun is down, any antenna may take passes of ISS, whatever \
                     their limits.";
        window.get_by_role_and_label(Role::RadioButton, first).focus();
        settle(&mut window);
        key(&mut window, Modifiers::ALT, Key::ArrowDown);
        key(&mut window, Modifiers::ALT, Key::ArrowDown);
        let last = window.get_by_role_and_label(
            Role::RadioButton,
            "Rule 3: While the Sun is down, any antenna may take passes of ISS, whatever their \
             limits. It cannot act: rule 2 decides before it.",
        );
        assert!(last.is_focused(), "the focus goes with it");
        key(&mut window, Modifiers::NONE, Key::ArrowUp);
        key(&mut window, Modifiers::NONE, Key::Delete);
        assert!(says(&window, "removed when you save"));
        press(&mut window, Role::Button, "Undo: keep it");
        press(&mut window, Role::Button, "Remove rule");
        assert_eq!(save(&mut window).rules, [of_weather(), of_iss()]);
    }
}

#[test]
fn rules_are_moved_and_duplicated_by_buttons_and_dragged() {
    for size in SIZES {
        let mut window = page(size, RULES, vec![of_iss(), of_weather(), rule()]);
        press(&mut window, Role::Button, "Move down");
        press(&mut window, Role::Button, "Duplicate");
        let row = |window: &Window, name: &str| {
            let mut rows = window.query_all_by_role(Role::RadioButton);
            let is_it = |name: &str, label: Option<String>| {
                label.is_some_and(|label| label.starts_with(name))
            };
            let found = rows.find(|row| is_it(name, row.accesskit_node().label()));
            found.expect("such a rule").rect()
        };
        let (from, to) = (row(&window, "Rule 4"), row(&window, "Rule 1"));
        let grip = from.left_center() + egui::vec2(18.0, 0.0);
        window.drag_at(grip);
        settle(&mut window);
        for at in [from.center(), to.center()] {
            window.hover_at(egui::pos2(grip.x, at.y));
            settle(&mut window);
        }
        window.drop_at(egui::pos2(grip.x, to.center().y));
        settle(&mut window);
        let copy = AutomationRule { is_on: false, ..of_iss() };
        assert_eq!(save(&mut window).rules, [rule(), of_weather(), of_iss(), copy]);
    }
}

#[test]
fn a_rule_says_how_many_passes_it_decides_and_which() {
    let mut window = page(rig::LARGE, RULES, vec![rule()]);
    let model = &window.state().model;
    let count = model.pass_lists.favourites.upcoming_within(model.now, 48).iter().count();
    assert!(count > 1 && says(&window, &format!("Next 48 h: {count} passes")));
    assert!(says(&window, "NOAA 20, "));
    choose(&mut window, "Hours", "Some");
    write(&mut window, "From", "03:00");
    write(&mut window, "To", "03:01");
    assert!(says(&window, "Next 48 h: no pass"));
}
