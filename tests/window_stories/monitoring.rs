//! The port for metrics, which the operator sets in Preferences.

use azel::{
    contract::control::PortState,
    model::View,
    station::{MetricsPort, Station},
};
use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    preferences::{form, saved, write},
    rig::{self, SIZES, Window, asked, says, settle},
    states,
};

/// Chooses `word` in the field `label`.
fn choose(window: &mut Window, label: &str, word: &str) {
    window.get_by_role_and_label(Role::RadioGroup, label).scroll_to_me();
    settle(window);
    let group = window.get_by_role_and_label(Role::RadioGroup, label).rect();
    let buttons = window.get_all_by_role_and_label(Role::RadioButton, word);
    let of_group = buttons.into_iter().find(|node| group.contains(node.rect().center()));
    of_group.expect("such a choice").click();
    settle(window);
}

fn save(window: &mut Window) -> Station {
    window.get_by_role_and_label(Role::Button, "Save and use").click();
    saved(asked(window))
}

#[test]
fn metrics_are_switched_on_for_this_computer_or_with_permission_for_the_network() {
    for size in SIZES {
        let mut window = form(size);
        choose(&mut window, "Metrics for Prometheus", "On");
        assert_eq!(save(&mut window).metrics, Some(MetricsPort::default()));

        let mut window = form(size);
        choose(&mut window, "Metrics for Prometheus", "On");
        write(&mut window, "Listen on", "everywhere");
        assert!(says(&window, "Listen on must be an address and a port, such as 127.0.0.1:9464."));
        write(&mut window, "Listen on", "0.0.0.0:9100");
        assert!(says(&window, "Open to the network must be on for this address"));
        choose(&mut window, "Open to the network", "On");
        let listen = "0.0.0.0:9100".parse().unwrap();
        let wanted = MetricsPort { listen, open_to_network: true };
        assert_eq!(save(&mut window).metrics, Some(wanted));
    }
}

#[test]
fn the_card_shows_the_port_or_the_reason_why_it_is_not_open() {
    for (state, words) in [
        (
            PortState::Listening("127.0.0.1:9464".parse().unwrap()),
            "Open at http://127.0.0.1:9464/metrics.",
        ),
        (
            PortState::Failed("Address already in use".to_owned()),
            "The port is not open: Address already in use. Azel tries again every 5 s",
        ),
    ] {
        let mut model = rig::model(states::holding());
        model.view = View::Preferences;
        model.shown_mut().metrics = state;
        let window = rig::window(rig::LARGE, model);
        assert!(says(&window, words), "{words}");
        let name = |node: &egui_kittest::Node<'_>| node.accesskit_node().label();
        assert!(
            window
                .query_all_by_role(Role::RadioGroup)
                .any(|node| { name(&node).is_some_and(|name| name == "Metrics for Prometheus") })
        );
    }
}
