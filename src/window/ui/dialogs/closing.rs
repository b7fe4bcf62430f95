//! Dialog that asks what happens to moving antennas when the window closes.

use egui::{Button, RichText, Ui, vec2};

use crate::{
    contract::{
        self,
        antenna::{AntennaModel, Stake},
        closing::{CloseCondition, CloseHow},
    },
    model::{Model, UiCommand},
    ui::{
        format, text, theme,
        widgets::{
            modal::modal,
            status_line::{Tone, line},
        },
        words,
    },
};

const WIDTH: f32 = 440.0;

/// Content of the question, besides the antennas.
#[derive(Debug, Clone, Default)]
pub struct ClosingDialog {
    /// Other losses, as sentences.
    pub lost: Vec<String>,
}

/// Returns sentences about the ongoing activities of the antennas.
pub fn stakes(model: &Model) -> Vec<String> {
    let announcement = |antenna: &AntennaModel| {
        antenna.stake().map(|stake| words::stake(&antenna.config.name, &stake))
    };
    model.antennas.iter().filter_map(announcement).collect()
}

impl ClosingDialog {
    /// Shows the question until the operator answers. Esc or a click outside keeps the window open.
    pub fn show(dialog: &mut Option<Self>, ui: &Ui, model: &Model, commands: &mut Vec<UiCommand>) {
        let Some(open) = dialog else { return };
        let modal = modal(ui, "closing").show(ui.ctx(), |ui| {
            ui.set_width(WIDTH);
            ui.label(RichText::new(title(model)).font(text::value()));
            for words in stakes(model) {
                line(ui, Tone::Caution, &words);
            }
            for words in &open.lost {
                line(ui, Tone::Plain, words);
            }
            ui.add_space(4.0);
            let mut answer = None;
            let verb = if model.stations.next.is_some() { "Change" } else { "Close" };
            for (rest, description, choice) in answers(model) {
                if answer_key(ui, &format!("{verb} {rest}"), &description) {
                    answer = Some(Some(choice));
                }
            }
            if answer_key(ui, "Stay", "Nothing is sent; everything stays as it is.") {
                answer = Some(None);
            }
            answer
        });
        match modal.inner {
            Some(answer) => commands.extend(
                answer.map(|choice| UiCommand::Station(contract::Command::CloseAfter(choice))),
            ),
            None if modal.should_close() => {}
            None => return,
        }
        *dialog = None;
    }
}

fn title(model: &Model) -> String {
    model
        .stations
        .next
        .as_ref()
        .map_or("Close Azel?".to_owned(), |next| format!("Change to {next}?"))
}

/// Returns the offered answers with the effect of each.
fn answers(model: &Model) -> Vec<(&'static str, String, CloseHow)> {
    let staked = || model.antennas.iter().filter_map(|antenna| Some((antenna, antenna.stake()?)));
    let names = |listed: Vec<&str>| format::list(&listed);
    let all = names(staked().map(|(antenna, _)| antenna.config.name.as_str()).collect());
    let mut answers = vec![("and hold", format!("STOP goes to {all} first."), CloseHow::Hold)];
    let parked: Vec<&str> = staked()
        .filter(|(antenna, _)| antenna.can_park())
        .map(|(antenna, _)| antenna.config.name.as_str())
        .collect();
    if !parked.is_empty() {
        let description =
            format!("{} to the park position; everything else is kept until then.", names(parked));
        answers.push(("and park", description, CloseHow::Park));
    }
    let on_board = |stake: &Stake| matches!(stake, Stake::OnBoard(_));
    let left: Vec<&str> = staked()
        .filter(|(_, stake)| on_board(stake))
        .map(|(antenna, _)| antenna.config.name.as_str())
        .collect();
    if !left.is_empty() {
        let others = staked().any(|(_, stake)| !on_board(&stake));
        let others = if others { " STOP goes to the others first." } else { "" };
        let description =
            format!("{} left tracking, with nobody watching here.{others}", names(left));
        answers.push(("and let it finish", description, CloseHow::Leave));
    }
    answers
}

fn answer_key(ui: &mut Ui, word: &str, description: &str) -> bool {
    let t = theme::tokens(ui);
    ui.horizontal(|ui| {
        let button = Button::new(word).min_size(vec2(168.0, 28.0));
        let response = ui.add(button);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(description));
        let words = RichText::new(description).font(text::small()).color(t.t2);
        ui.add(egui::Label::new(words).wrap());
        response.clicked()
    })
    .inner
}

/// Shows the conditions that the window waits for before it closes.
pub fn waiting(ui: &Ui, model: &Model, commands: &mut Vec<UiCommand>) {
    let Some(closing) = &model.closing else { return };
    let names = |condition: CloseCondition| -> Vec<&str> {
        let waits = closing.waits_for.iter().filter(|(_, awaited)| *awaited == condition);
        waits.filter_map(|(id, _)| Some(model.antenna_of(*id)?.config.name.as_str())).collect()
    };
    let modal = modal(ui, "closing waits").show(ui.ctx(), |ui| {
        ui.set_width(WIDTH);
        let next = model.stations.next.as_ref();
        let title = next.map_or("Azel closes".to_owned(), |next| format!("Azel changes to {next}"));
        ui.label(RichText::new(title).font(text::value()));
        for (condition, words) in [
            (CloseCondition::Still, "once it is known to be at rest"),
            (CloseCondition::Parked, "once it is parked"),
        ] {
            let names = names(condition);
            if !names.is_empty() {
                line(ui, Tone::Now, &format!("{}: {words}.", format::list(&names)));
            }
        }
        ui.add_space(4.0);
        ui.button("Stay").clicked()
    });
    if modal.inner || modal.should_close() {
        commands.push(UiCommand::Station(contract::Command::StayOpen));
    }
}
