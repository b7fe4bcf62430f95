//! The link test "Test from here" next to the forms of a unit's web and FTP sources.

mod reading;

use egui::{RichText, Sense, Spinner, TextEdit, Ui, vec2};

use super::{
    confirm::Question,
    dialogs::{self, Answer},
    text, theme,
    widgets::{
        button::{Button, SMALL_HEIGHT},
        drop_down::DropDown,
        status_line::{Tone, line},
    },
    words::{self, sentence},
};
use crate::{
    contract::{
        self,
        host_keys::DoubtfulKey,
        source_tests::{SourceOrder, TestAsk, TestStage, TestedSource},
        transfer::{FileProtocol, Peer},
    },
    model::{Model, UiCommand},
    secret::Secret,
};

/// A source as entered in a form.
#[derive(Debug, Clone, Copy)]
pub enum TypedSource<'a> {
    /// A web address.
    Web {
        /// Web address as set in the unit.
        url: &'a str,
    },
    /// A file on a server.
    Server {
        /// Host name or IP address.
        address: &'a str,
        /// TCP port.
        port: &'a str,
        user: &'a str,
        password: &'a str,
        file: &'a str,
        /// Name of the satellite in the file.
        satellite: &'a str,
    },
}

/// The operator's choices next to the form.
#[derive(Default)]
pub struct SourceTestState {
    /// Protocol; `None` for the protocol that the port implies.
    protocol: Option<FileProtocol>,
    /// Satellite to look for in a file from the web; `None` for the satellite in the unit.
    satellite: Option<String>,
    question: Option<Question>,
}

/// Draws the button and the outcome of the test over the whole width of `ui`. `antenna` is the
/// index of the antenna whose unit has the source.
pub fn show(
    ui: &mut Ui,
    model: &Model,
    antenna: usize,
    typed: TypedSource<'_>,
    state: &mut SourceTestState,
    commands: &mut Vec<UiCommand>,
) {
    let Some(antenna) = model.antennas.get(antenna) else { return };
    let current = antenna
        .snapshot
        .state
        .on_board
        .satellite
        .as_ref()
        .map(|held_satellite| held_satellite.name.as_str());
    let order = order(&antenna.config.name, typed, current.unwrap_or_default(), state);
    match typed {
        TypedSource::Web { .. } => satellite(ui, current, state),
        TypedSource::Server { .. } => protocol(ui, &mut state.protocol),
    }
    let tests = &model.source_tests;
    ui.horizontal_wrapped(|ui| {
        let can = order.is_ok() && !tests.stage.is_open();
        if ui.add_enabled(can, egui::Button::new("Test from here")).clicked()
            && let Ok(order) = &order
        {
            push(commands, TestAsk::Begin(Box::new(order.clone())));
        }
        if let Err(problem) = &order {
            let words = format!("Cannot be tested yet: {problem}.");
            ui.label(RichText::new(words).font(text::small()).color(theme::tokens(ui).warn));
        }
    });
    let is_ours = |tested: &SourceOrder| {
        tested.antenna == antenna.config.name
            && matches!(tested.source, TestedSource::Web { .. })
                == matches!(typed, TypedSource::Web { .. })
    };
    if let Some(tested) = tests.order.as_ref().filter(|tested| is_ours(tested)) {
        if order.as_ref() != Ok(tested) && !tests.stage.is_open() && tests.stage != TestStage::Idle
        {
            let words = "Tested before the fields above were changed.";
            ui.label(RichText::new(words).font(text::small()).color(theme::tokens(ui).warn));
        }
        outcome(ui, model, tested, state, commands);
    }
    Question::show(&mut state.question, ui, commands);
}

fn push(commands: &mut Vec<UiCommand>, ask: TestAsk) {
    commands.push(UiCommand::Station(contract::Command::TestSource(ask)));
}

fn order(
    antenna: &str,
    typed: TypedSource<'_>,
    current: &str,
    state: &SourceTestState,
) -> Result<SourceOrder, &'static str> {
    let present = |typed: &str, problem| {
        let typed = typed.trim();
        if typed.is_empty() { Err(problem) } else { Ok(typed.to_owned()) }
    };
    let (source, satellite) = match typed {
        TypedSource::Web { url } => {
            let url = present(url, "the address is missing")?;
            (TestedSource::Web { url }, state.satellite.as_deref().unwrap_or(current))
        }
        TypedSource::Server { address, port, user, password, file, satellite } => {
            let host = present(address, "the address is missing")?;
            let port: u16 = port.trim().parse().map_err(|_| "the port is not a number")?;
            let source = TestedSource::Server {
                peer: Peer { host, port },
                protocol: state.protocol.unwrap_or_else(|| FileProtocol::of_port(port)),
                user: user.trim().to_owned(),
                password: Secret::new(password),
                file: present(file, "the file is missing")?,
            };
            (source, satellite)
        }
    };
    let satellite = present(satellite, "the name of the satellite is missing")?;
    Ok(SourceOrder { antenna: antenna.to_owned(), source, satellite })
}

fn satellite(ui: &mut Ui, current: Option<&str>, state: &mut SourceTestState) {
    let t = theme::tokens(ui);
    ui.horizontal(|ui| {
        let label = ui.label(RichText::new("Look for").font(text::body()).color(t.t2)).id;
        let mut typed = state.satellite.clone().unwrap_or_else(|| current.unwrap_or("").to_owned());
        let hint = RichText::new("name of the satellite").color(t.t3);
        let edit = TextEdit::singleline(&mut typed).id_salt("look for").hint_text(hint);
        let edit = ui.add(edit.desired_width(ui.available_width().min(240.0)));
        if edit.labelled_by(label).changed() {
            state.satellite = Some(typed);
        }
    });
}

fn protocol(ui: &mut Ui, chosen: &mut Option<FileProtocol>) {
    let word = |protocol: Option<FileProtocol>| match protocol {
        None => "Set by the port",
        Some(FileProtocol::Ftp) => "FTP",
        Some(FileProtocol::FtpTls) => "FTP with TLS",
        Some(FileProtocol::Sftp) => "SFTP",
    };
    let name = format!("Protocol of the test, {}", word(*chosen));
    let button = Button::normal(word(*chosen));
    let protocols = DropDown { button, salt: "protocol", name: &name };
    let size = vec2(protocols.width(ui), SMALL_HEIGHT);
    let (place, _) = ui.allocate_exact_size(size, Sense::hover());
    protocols.show(ui, place, |ui| {
        for protocol in
            [None, Some(FileProtocol::Ftp), Some(FileProtocol::FtpTls), Some(FileProtocol::Sftp)]
        {
            ui.selectable_value(chosen, protocol, word(protocol));
        }
    });
}

fn outcome(
    ui: &mut Ui,
    model: &Model,
    tested: &SourceOrder,
    state: &mut SourceTestState,
    commands: &mut Vec<UiCommand>,
) {
    match &model.source_tests.stage {
        TestStage::Idle => {}
        TestStage::Working => {
            ui.horizontal(|ui| {
                ui.add(Spinner::new().size(14.0));
                ui.label(RichText::new("Being fetched.").font(text::body()));
                if ui.button("Cancel test").clicked() {
                    push(commands, TestAsk::Cancel);
                }
            });
        }
        TestStage::AsksAboutHostKey(key) => match dialogs::host_key(ui, key) {
            Some(Answer::Yes) => push(commands, TestAsk::TrustHostKey),
            Some(Answer::No) => push(commands, TestAsk::Cancel),
            None => {}
        },
        TestStage::Seen { view, time, old_algorithms } => {
            reading::show(ui, view, &tested.satellite, *time, model.now);
            if let Some(words) = words::old_algorithms(old_algorithms) {
                line(ui, Tone::Caution, &words);
            }
        }
        TestStage::Failed { changed_key: Some(key), .. } => forget(ui, key, &mut state.question),
        TestStage::Failed { text, changed_key: None } => {
            line(ui, Tone::Bad, &sentence(text));
        }
    }
}

fn forget(ui: &mut Ui, key: &DoubtfulKey, question: &mut Option<Question>) {
    dialogs::changed_key(
        ui,
        key,
        UiCommand::Station(contract::Command::TestSource(TestAsk::ForgetHostKey)),
        question,
    );
}
