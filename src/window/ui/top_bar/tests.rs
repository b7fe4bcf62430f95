use egui::{Modal, Role};
use egui_kittest::{Harness, kittest::Queryable as _};

use super::*;
use crate::{
    contract,
    contract::alarms::{AlarmState, Priority},
    model::{ThemeName, View},
    ui::widgets::{alarm_list::AlarmRow, link_chip::LinkGlyph, testing},
};

const ALARM: AlarmRow<'_> = AlarmRow {
    moves_away: None,
    id: 3,
    priority: Priority::Warning,
    state: AlarmState::New,
    follows: false,
    state_words: "new",
    text: "RC2000C does not reply",
    time: "11:05:58Z",
};

#[test]
fn many_antennas_leave_room_for_the_rest() {
    for size in [[1440.0, 900.0], [1024.0, 640.0]] {
        let mut window = testing::window(size, Vec::new(), move |ui, commands| {
            let names = ["North field", "South field", "Mast", "Roof", "Yard", "Hall", "Hill"];
            let chips = names.map(|name| chip(name, LinkGlyph::Live));
            let rect = Rect::from_min_max(pos2(500.0, 8.0), pos2(900.0, 48.0));
            chips::show(ui, rect, &chips, size[0] > 1200.0, commands);
        });
        window.run();
        window.get_by_label_contains("more antennas").click();
        window.run();
        window.get_by_label_contains("Hill: ").click();
        window.run();
        assert_eq!(*window.state(), [UiCommand::SelectAntenna(6)]);
    }
}

fn chip(name: &str, link: LinkGlyph) -> ChipModel<'_> {
    ChipModel { name, link, activity: "Tracking", age: "0.3 s", ..ChipModel::default() }
}

fn show_bar(ui: &mut Ui, stop: StopLook<'_>) -> Vec<UiCommand> {
    let stations = Stations::default();
    let window = ui.ctx().content_rect();
    let rect = Rect::from_min_size(window.min, vec2(window.width(), height(window.height())));
    let chips = [
        chip("Satrak", LinkGlyph::Live),
        chip("Genius", LinkGlyph::Late),
        chip("RC2000C", LinkGlyph::Lost),
    ];
    let model = TopBarModel {
        station: "Şile 1",
        demo: false,
        stations: &stations,
        coordinates: "41.176° N  29.613° E",
        clock: ClockModel {
            utc: "11:06:12",
            date: "Sat 2026-11-14",
            local: Some("14:06:12 local"),
            health: ClockHealth::default(),
        },
        chips: &chips,
        alarms: AlarmModel { rows: &[ALARM], unopened: false },
        stop,
        stop_about: "Stops every antenna.",
        stop_left_out: None,
    };
    show(ui, rect, &model)
}

fn bar(size: [f32; 2]) -> Harness<'static, Vec<UiCommand>> {
    let mut window = testing::window(size, Vec::new(), |ui, commands: &mut Vec<UiCommand>| {
        commands.extend(show_bar(ui, StopLook::Ready));
    });
    window.run();
    window
}

#[test]
fn stop_stands_at_the_right_end_in_every_size() {
    for (size, expected) in [
        ([1440.0, 900.0], Rect::from_min_size(pos2(1280.0, 8.0), stop_button::SIZE)),
        ([1024.0, 640.0], Rect::from_min_size(pos2(896.0, 8.0), stop_button::SMALL_SIZE)),
    ] {
        let mut window = bar(size);
        let stop = window.get_by_label("STOP");
        assert!(expected.expand(0.5).contains_rect(stop.rect()), "{:?}", stop.rect());
        stop.click();
        window.run();
        assert_eq!(*window.state(), [UiCommand::Stop]);
    }
}

#[test]
fn stop_is_the_first_control_in_the_order_of_tab() {
    let mut window = bar([1440.0, 900.0]);
    window.key_press(egui::Key::Tab);
    window.run();
    assert!(window.get_by_label("STOP").is_focused());
}

#[test]
fn stop_works_while_a_dialog_is_open() {
    let mut window = testing::window([1440.0, 900.0], Vec::new(), |ui, commands| {
        commands.extend(show_bar(ui, StopLook::Ready));
        Modal::new(Id::unique("dialog")).show(ui.ctx(), |ui| ui.label("Remove the station?"));
    });
    window.run();
    window.get_by_label("STOP").click();
    window.run();
    assert_eq!(*window.state(), [UiCommand::Stop]);
}

#[test]
fn a_stop_that_is_not_proved_says_so_in_words() {
    let text = "Satrak still moves 3 s after STOP. Use the local panel.";
    for size in [[1440.0, 900.0], [1024.0, 640.0]] {
        let window = testing::window(size, (), move |ui, ()| {
            show_bar(ui, StopLook::NotConfirmed { text });
        });
        let place = window.get_by_label(text).rect();
        assert!(place.width() >= 110.0, "one word stands in a line: {place:?}");
        window.get_by_label(&format!("STOP, not confirmed: {text}"));
    }
}

#[test]
fn a_chip_selects_its_antenna() {
    let mut window = bar([1024.0, 640.0]);
    window.get_by_label_contains("RC2000C: Tracking").click();
    window.run();
    assert_eq!(*window.state(), [UiCommand::SelectAntenna(2)]);
}

#[test]
fn an_alarm_is_acknowledged() {
    let mut window = bar([1440.0, 900.0]);
    window.get_by_label("1 alarm, 1 new").click();
    window.run();
    window.get_by_label("Acknowledge: RC2000C does not reply").click();
    window.run();
    let expected = [
        UiCommand::Station(contract::Command::OpenedAlarms),
        UiCommand::Station(contract::Command::AcknowledgeAlarm(3)),
    ];
    assert_eq!(*window.state(), expected);
}

#[test]
fn the_station_menu_opens_settings_and_changes_the_theme() {
    let mut window = bar([1440.0, 900.0]);
    window.get_by_label("Station Şile 1").click();
    window.run();
    window.get_by_label("Night theme").click();
    window.run();
    window.get_by_label("Station Şile 1").click();
    window.run();
    window.get_by_role_and_label(Role::Button, "Station settings…").click();
    window.run();
    let expected = [UiCommand::SetTheme(ThemeName::Night), UiCommand::Show(View::Preferences)];
    assert_eq!(*window.state(), expected);
}
