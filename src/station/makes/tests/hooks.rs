//! Hooks in the station file.

use super::{
    super::*,
    file::{load, written},
};
use crate::{
    controller::SPECS,
    station::{
        AntennaId, Hook, HookAction, HookEvent, Loaded, NoteReason, PassLimits, RuleSubject,
        SatelliteGroup, Station, save,
    },
};

fn command(words: &[&str]) -> HookAction {
    HookAction::Command(words.iter().map(|word| (*word).to_owned()).collect())
}

#[test]
fn hooks_come_back_as_they_were_saved() {
    let mut station = Station::demo(&DemoAddresses {
        satrak: "192.168.10.21:4001".to_owned(),
        genius: "192.168.1.250:9006".to_owned(),
        rc2000c: "/dev/ttyUSB0".to_owned(),
    });
    let antenna = station.antennas[0].id;
    station.groups.push(SatelliteGroup {
        name: "Weather".to_owned(),
        satellites: vec![43_013],
        priority: None,
        limits: PassLimits::default(),
    });
    let record = command(&["/usr/bin/record", "--name", "a \"b\" $HOME"]);
    let webhook = HookAction::Webhook("https://example.org/hook".to_owned());
    station.hooks = vec![
        Hook { delay_s: -30.0, ..Hook::new("Recorder", HookEvent::Aos, record) },
        Hook {
            is_on: false,
            antenna: Some(antenna),
            subject: Some(RuleSubject::Satellite(25_544)),
            timeout_s: 5.5,
            ..Hook::new("Web", HookEvent::MissedPass, webhook.clone())
        },
        Hook {
            subject: Some(RuleSubject::Group("Weather".to_owned())),
            ..Hook::new("Group", HookEvent::TrackingEnd, webhook)
        },
    ];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    save(&station, &path, SPECS).unwrap();
    let loaded = load(&path).unwrap();
    assert_eq!(loaded.notes, []);
    assert_eq!(loaded.station.hooks, station.hooks);
    for hook in &station.hooks {
        let text = serde_json::to_string(hook).unwrap();
        assert_eq!(serde_json::from_str::<Hook>(&text).unwrap(), *hook, "{text}");
    }
}

#[test]
fn a_hook_that_cannot_be_used_is_named_and_kept_and_the_others_go_on() {
    let bad = "\
        [[hooks]]\nevent = 'aos'\ncommand = ['true']\n\
        [[hooks]]\nname = 'b'\nevent = 'sunrise'\ncommand = ['true']\n\
        [[hooks]]\nname = 'c'\nevent = 'aos'\ncommand = 'true'\n\
        [[hooks]]\nname = 'd'\nevent = 'aos'\ncommand = []\n\
        [[hooks]]\nname = 'e'\nevent = 'aos'\nwebhook = 'ftp://example.org'\n\
        [[hooks]]\nname = 'f'\nevent = 'aos'\nwebhook = 'http://op:word@example.org'\n\
        [[hooks]]\nname = 'g'\nevent = 'aos'\ncommand = ['true']\nwebhook = 'http://h'\n\
        [[hooks]]\nname = 'h'\nevent = 'aos'\n\
        [[hooks]]\nname = 'i'\nevent = 'aos'\ncommand = ['true']\nantenna = 9\n\
        [[hooks]]\nname = 'j'\nevent = 'aos'\ncommand = ['true']\ngroup = 'None'\n\
        [[hooks]]\nname = 'k'\nevent = 'aos'\ncommand = ['true']\nsatellite = 'ISS'\n\
        [[hooks]]\nname = 'l'\nevent = 'aos'\ncommand = ['true']\ndelay_s = 700\n\
        [[hooks]]\nname = 'm'\nevent = 'alarm'\ncommand = ['true']\ndelay_s = -1\n\
        [[hooks]]\nname = 'n'\nevent = 'alarm'\ncommand = ['true']\nsatellite = 7\n\
        [[hooks]]\nname = 'o'\nevent = 'aos'\ncommand = ['true']\ntimeout_s = 0\n\
        [[hooks]]\nname = 'p'\nevent = 'aos'\ncommand = ['a\\u0000b']\n";
    let bad = bad.replace("'a\\u0000b'", "\"a\\u0000b\"");
    let good = "[[hooks]]\nname = 'Good'\nevent = 'los'\ndelay_s = 5\ncommand = ['true']\n";
    let twice = "[[hooks]]\nname = 'Good'\nevent = 'aos'\ncommand = ['true']\n";
    let (_folder, path) = written(&format!("{bad}{good}{twice}"));
    let Loaded { station, notes } = load(&path).unwrap();
    let places: Vec<&str> = notes.iter().map(|note| note.place.as_str()).collect();
    let keys = [
        "name",
        "event",
        "command",
        "command",
        "webhook",
        "webhook",
        "command",
        "command",
        "antenna",
        "group",
        "satellite",
        "delay_s",
        "delay_s",
        "event",
        "timeout_s",
        "command",
    ];
    let expected: Vec<String> = (keys.iter().enumerate())
        .map(|(index, key)| format!("hooks[{index}].{key}"))
        .chain(["hooks[17].name".to_owned()])
        .collect();
    assert_eq!(places, expected);
    assert!(notes.iter().all(|note| matches!(note.reason, NoteReason::Invalid(_))));
    assert!(!format!("{notes:?}").contains("word@"), "a password is in a note");
    let names: Vec<&str> = station.hooks.iter().map(|hook| &*hook.name).collect();
    assert_eq!(names, ["Good"]);
    assert_eq!(station.unread, [], "no hook locks an antenna");

    let changed = Station { name: "Other".to_owned(), ..station };
    save(&changed, &path, SPECS).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    for part in ["sunrise", "ftp://example.org", "group = 'None'", "delay_s = 700"] {
        assert!(text.contains(part), "{part} is lost: {text}");
    }
    assert_eq!(load(&path).unwrap().station.hooks, changed.hooks);
}

#[test]
fn a_station_has_at_most_a_hundred_hooks() {
    let hook = |number: usize| {
        format!("[[hooks]]\nname = 'h{number}'\nevent = 'aos'\ncommand = ['true']\n")
    };
    let text: String = (0..=Hook::MAX_NUMBER).map(hook).collect();
    let (_folder, path) = written(&text);
    let Loaded { station, notes } = load(&path).unwrap();
    assert_eq!((station.hooks.len(), notes.len()), (Hook::MAX_NUMBER, 1));
    assert_eq!(station.hooks[0].antenna, None::<AntennaId>);
}
