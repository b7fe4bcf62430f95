//! Questions to the operator during an upload.

use azel::{
    contract::{
        host_keys::DoubtfulKey,
        transfer::UploadStep,
        uploads::{Ask, Busy, Failure, SecretWanted, Stage},
    },
    secret::Secret,
};
use egui::{Event, Key, Role};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::upload_rig::{
    SECRET, WIDTHS, Window, asked, at, click, is_disabled, part, says, settle, uploaded, working,
};

fn wanted() -> SecretWanted {
    SecretWanted {
        user: "op".to_owned(),
        address: "192.168.10.21:22".to_owned(),
        is_passphrase: false,
        refused: None,
        keyring_problem: None,
    }
}

fn type_secret(window: &mut Window) {
    window.event(Event::Text(SECRET.to_owned()));
    settle(window);
    let told = format!("{:?}", window.root());
    assert!(!told.contains(SECRET), "who listens to the window hears it");
}

#[test]
fn a_new_host_is_asked_about_with_its_fingerprint() {
    let key = DoubtfulKey {
        address: "192.168.10.21".to_owned(),
        algorithm: "ssh-ed25519".to_owned(),
        fingerprint: "SHA256:abc".to_owned(),
        pinned: Vec::new(),
    };
    for width in WIDTHS {
        let mut window = part(width, at(Stage::AsksAboutHostKey(key.clone())));
        for words in ["192.168.10.21 is new here", "ssh-ed25519", "SHA256:abc"] {
            assert!(says(&window, words), "{words}");
        }
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [], "not by a careless key");
        click(&mut window, "It is the right key");
        assert_eq!(asked(&mut window), [Ask::TrustHostKey]);
        click(&mut window, "No");
        assert_eq!(asked(&mut window), [Ask::Cancel]);
        window.key_press(Key::Escape);
        assert_eq!(asked(&mut window), [Ask::Cancel]);
    }
}

#[test]
fn a_changed_host_key_is_shown_with_both_and_forgotten_on_purpose_only() {
    let changed_key = Some(DoubtfulKey {
        address: "192.168.10.21".to_owned(),
        algorithm: "ssh-ed25519".to_owned(),
        fingerprint: "SHA256:new".to_owned(),
        pinned: vec!["SHA256:old".to_owned()],
    });
    let failure = Failure { text: "changed".to_owned(), changed_key, ..Failure::default() };
    let mut window = part(WIDTHS[0], at(Stage::Failed(failure)));
    for words in ["Refused: the host key", "SHA256:old", "SHA256:new", "ssh-keygen -l"] {
        assert!(says(&window, words), "{words}");
    }
    click(&mut window, "Forget the known key…");
    assert_eq!(asked(&mut window), []);
    click(&mut window, "Cancel");
    assert_eq!(asked(&mut window), []);
    click(&mut window, "Forget the known key…");
    click(&mut window, "Forget it (Enter)");
    assert_eq!(asked(&mut window), [Ask::ForgetHostKey]);
}

#[test]
fn a_password_is_asked_for_masked_and_kept_only_with_a_tick() {
    for width in WIDTHS {
        let mut window = part(width, at(Stage::AsksForSecret(wanted())));
        assert!(is_disabled(&window, "Log in (Enter)"));
        type_secret(&mut window);
        window.key_press(Key::Enter);
        let secret = Secret::new(SECRET);
        assert_eq!(asked(&mut window), [Ask::Secret { secret: secret.clone(), keep: false }]);
        type_secret(&mut window);
        window.get_by_role(Role::CheckBox).click();
        settle(&mut window);
        click(&mut window, "Log in (Enter)");
        assert_eq!(asked(&mut window), [Ask::Secret { secret, keep: true }]);
        let field = egui::Id::unique("password field");
        let held = egui::text_edit::TextEditState::load(&window.ctx, field).unwrap();
        assert!(!format!("{:?}", held.undoer()).contains(SECRET), "it cannot be undone back");
        type_secret(&mut window);
        window.key_press(Key::Escape);
        assert_eq!(asked(&mut window), [Ask::Cancel]);
        let field = window.get_by_role(Role::PasswordInput);
        assert_eq!(field.value().as_deref().unwrap_or_default(), "", "forgotten");
    }
}

#[test]
fn a_wrong_password_is_told_and_without_a_keyring_it_is_said_how_long_it_lasts() {
    let wanted = SecretWanted {
        refused: Some("log-in refused for user op".to_owned()),
        keyring_problem: Some("there is no keyring on this computer".to_owned()),
        ..wanted()
    };
    let mut window = part(WIDTHS[0], at(Stage::AsksForSecret(wanted)));
    assert!(says(&window, "Log-in refused for user op."));
    assert!(says(&window, "There is no keyring on this computer."));
    assert!(says(&window, "once in each session"));
    assert!(window.query_by_role(Role::CheckBox).is_none());
    click(&mut window, "Cancel");
    assert_eq!(asked(&mut window), [Ask::Cancel]);
}

#[test]
fn the_operator_agrees_before_the_unit_s_tracking_ends() {
    for (busy, words) in
        [(Busy::Tracks, "Its tracking is stopped"), (Busy::MayTrack, "the antenna may move")]
    {
        let mut window = part(WIDTHS[0], at(Stage::AsksAboutTracking(busy)));
        assert!(says(&window, words));
        click(&mut window, "Continue (Enter)");
        assert_eq!(asked(&mut window), [Ask::AgreeToTracking]);
        click(&mut window, "No");
        assert_eq!(asked(&mut window), [Ask::Cancel]);
    }
}

#[test]
fn each_step_is_shown_and_can_be_cancelled_until_the_file_takes_its_place() {
    for width in WIDTHS {
        let mut window = part(width, working(UploadStep::Write));
        assert!(says(&window, "4 Write the new file beside it"));
        window.get_by_role(Role::ProgressIndicator);
        click(&mut window, "Cancel upload");
        assert_eq!(asked(&mut window), [Ask::Cancel]);
        assert!(is_disabled(&window, "Upload and verify"));

        let window = part(width, working(UploadStep::Replace));
        assert!(is_disabled(&window, "Cancel upload"));
        assert!(says(&window, "It can no longer be cancelled."));

        let window = part(width, at(Stage::Selecting(Box::new(uploaded()))));
        assert!(says(&window, "8 Tell the unit"));
        assert!(window.query_by_label_contains("Verified").is_none(), "not yet");
    }
}
