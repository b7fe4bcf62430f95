//! Passes and look angles are saved to files for other programs.

use azel::{
    desktop::file_dialog::NoDialog,
    engine::passes::PredictedPass,
    model::{
        UiCommand,
        export::{Export, SavedFile},
    },
    plan::pass_export::{LookFormat, PassFormat},
};
use egui::Role;
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::{self, NOAA_20, SIZES, Window, asked, says, settle},
    states,
};

fn choose(window: &mut Window, form: &str) -> Vec<UiCommand> {
    asked(window);
    window.get_by_role_and_label(Role::Button, "Save passes to a file").click();
    settle(window);
    window.get_by_label(form).click();
    asked(window)
}

#[test]
fn the_listed_passes_and_the_selected_one_are_saved() {
    for size in SIZES {
        let model = rig::model(states::holding());
        let listed: Vec<_> = model.upcoming().iter().map(PredictedPass::key).collect();
        let of_noaa_20 = model.pass_of(NOAA_20).map(PredictedPass::key).unwrap();
        let mut window = rig::window(size, model);
        if size == rig::SMALL {
            window.get_by_label("Passes").click();
            settle(&mut window);
        }
        let saved = choose(&mut window, "Listed passes as iCalendar…");
        let wanted = Export::Passes { keys: listed.into(), format: PassFormat::Ics };
        assert_eq!(saved, [UiCommand::Save(wanted)]);
        let saved = choose(&mut window, "Az/el of the selected pass as CSV…");
        let wanted = Export::Looks { pass: of_noaa_20, format: LookFormat::Csv };
        assert_eq!(saved, [UiCommand::Save(wanted)]);
    }
}

#[test]
fn only_the_found_passes_are_saved_while_the_list_is_filtered() {
    let mut window = rig::window(rig::LARGE, rig::model(states::holding()));
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::F);
    settle(&mut window);
    window.event(egui::Event::Text("43013".to_owned()));
    settle(&mut window);
    let saved = choose(&mut window, "Listed passes as CSV…");
    let [UiCommand::Save(Export::Passes { keys, .. })] = &saved[..] else { panic!("{saved:?}") };
    assert!(!keys.is_empty() && keys.iter().all(|(number, _)| *number == NOAA_20), "{keys:?}");
}

#[test]
fn what_came_of_it_is_told_over_the_views_until_it_is_closed() {
    let mut window = rig::window(rig::LARGE, rig::model(states::holding()));
    let tell = |window: &mut Window, result| {
        window.state_mut().views.file_saved(result);
        settle(window);
    };
    let saved = |path: &str, left_out| Ok(SavedFile { path: path.into(), left_out });
    tell(&mut window, saved("/home/operator/passes.csv", 0));
    assert!(says(&window, "Saved: /home/operator/passes.csv"));
    window.get_by_label("Close the note of the file").click();
    settle(&mut window);
    assert!(!says(&window, "Saved: "));
    tell(&mut window, saved("/home/operator/own.tle", 3));
    assert!(says(&window, "Saved without 3 objects that a TLE cannot hold: /home/"));
    tell(&mut window, Err(NoDialog.to_string()));
    assert!(says(&window, "Nothing was saved: this desktop shows no file dialogs"));
    window.state_mut().views.no_dialog(NoDialog);
    settle(&mut window);
    assert!(says(&window, "This desktop shows no file dialogs") && says(&window, "dropped"));
}
