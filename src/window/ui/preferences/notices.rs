//! The page of notices through the desktop: notifications, sounds, quiet hours and reminders.

use std::{borrow::Cow, collections::BTreeSet};

use egui::Ui;

use super::{
    draft::Draft,
    fields::{Description, Placed, Typed, placed},
    form::{self, FocusTarget},
    search::Spot,
    section::{DraftSection, Finding},
};
use crate::{
    contract::CatalogState,
    desktop::Sound,
    device::settings::{Kind, Value},
    model::{Model, UiCommand},
    orbit::Elements,
    station::{HoursOfDay, Notices, Station, Tones, ranges},
    ui::{
        format,
        widgets::{
            check_box::CheckBox,
            status_line::{self, Tone},
        },
        words,
    },
};

/// Titles of the cards of the page.
const TELLING: &str = "Notifications and sounds";
const REMINDING: &str = "Reminders";

/// Labels of the choices of tones.
const TONES: [&str; 3] = [WARNINGS, CAUTIONS, BEFORE_PASSES];
const WARNINGS: &str = "Warnings";
const CAUTIONS: &str = "Cautions";
const BEFORE_PASSES: &str = "Reminders before passes";

/// Draft of the notices.
#[derive(PartialEq)]
pub(super) struct NoticesDraft {
    telling: Typed<Telling>,
    reminders: BTreeSet<u32>,
}

/// The notices. They keep their quiet hours while the operator has switched these off.
#[derive(Debug, Clone, PartialEq)]
struct Telling {
    notices: Notices,
    is_quiet: bool,
    hours: HoursOfDay,
}

impl NoticesDraft {
    pub(super) fn new(notices: &Notices) -> Self {
        let telling = Telling {
            notices: notices.clone(),
            is_quiet: notices.quiet.is_some(),
            hours: notices.quiet.unwrap_or(HoursOfDay::NIGHT),
        };
        Self { telling: Typed::new(telling, fields()), reminders: notices.reminders.clone() }
    }
}

impl DraftSection for NoticesDraft {
    /// Counts each reminder mark as one edit.
    fn edits(&self, before: &Draft) -> usize {
        let marked = self.reminders.symmetric_difference(&before.notices.reminders);
        self.telling.edited() + marked.count()
    }

    fn findings(&self, _: &Draft) -> Vec<Finding> {
        self.telling.findings_in(&self.telling.read().1)
    }

    fn labels(&self) -> Vec<(Cow<'static, str>, Spot)> {
        self.telling.used_labels()
    }

    fn write(&mut self, label: &str, text: String) {
        self.telling.type_in(label, text);
    }

    fn put_into(&self, _: &Draft, station: &mut Station) -> Option<()> {
        let Telling { notices, is_quiet, hours } = self.telling.valid()?;
        let quiet = is_quiet.then_some(hours);
        station.notices = Notices { quiet, reminders: self.reminders.clone(), ..notices };
        Some(())
    }
}

fn fields() -> Vec<Placed<Telling>> {
    let telling = [
        flag("Notifications", |telling| &mut telling.notices.notifications).described(
            "The desktop shows new alarms and reminders, and top-priority alarms \
                         even if this is off.",
        ),
        flag("Sounds", |telling| &mut telling.notices.sounds)
            .described("Top-priority alarms sound even if this is off."),
        tones(WARNINGS, |telling| &mut telling.notices.warning_tones)
            .described("Alarms about something that is wrong now."),
        tones(CAUTIONS, |telling| &mut telling.notices.caution_tones)
            .described("Alarms about something that was not done or will go wrong."),
        tones(BEFORE_PASSES, |telling| &mut telling.notices.reminder_tones),
        flag("Quiet hours", |telling| &mut telling.is_quiet).described(
            "No notifications or sounds then, except for top-priority alarms. The \
                         window shows all alarms.",
        ),
        Description::time("Quiet from", |telling: &mut Telling| &mut telling.hours.start)
            .when(|telling| telling.is_quiet),
        Description::time("Quiet to", |telling: &mut Telling| &mut telling.hours.end)
            .when(|telling| telling.is_quiet)
            .checked(|telling| {
                let HoursOfDay { start, end } = telling.hours;
                if start == end { Err("must differ from Quiet from") } else { Ok(()) }
            })
            .described("By the local time of this computer."),
    ];
    let before = Description::number(
        "Remind before AOS",
        ranges::REMINDER_MIN,
        "min",
        |telling: &mut Telling| Some(&mut telling.notices.reminder_min),
    );
    let mut fields = placed(TELLING, telling);
    fields.extend(placed(REMINDING, [before]));
    fields
}

fn tones(label: &'static str, place: fn(&mut Telling) -> &mut Tones) -> Description<Telling> {
    const WORDS: [(i64, &str); 3] = [(0, "Falling"), (1, "Rising"), (2, "None")];
    const VALUES: [Tones; 3] = [Tones::Falling, Tones::Rising, Tones::None];
    Description::choice(label, &WORDS, &VALUES, place)
        .when(|telling: &Telling| telling.notices.sounds)
}

fn flag(label: &'static str, place: fn(&mut Telling) -> &mut bool) -> Description<Telling> {
    Description::new(
        label,
        Kind::Flag,
        move |telling| Some(Value::Flag(*place(telling))),
        move |telling, value| {
            if let Value::Flag(on) = value {
                *place(telling) = on;
            }
            Ok(())
        },
    )
}

/// Cards of the page with the numbers of their rows.
pub(super) const CARDS: [usize; 3] = [14, 4, 8];

pub(super) fn card_of(
    ui: &mut Ui,
    card: usize,
    model: &Model,
    draft: &mut Draft,
    focus_target: &mut FocusTarget,
    commands: &mut Vec<UiCommand>,
) {
    match card {
        0 => telling(ui, model, draft, focus_target, commands),
        1 => never_silenced(ui),
        _ => reminders(ui, model, draft, focus_target),
    }
}

fn telling(
    ui: &mut Ui,
    model: &Model,
    draft: &mut Draft,
    focus_target: &mut FocusTarget,
    commands: &mut Vec<UiCommand>,
) {
    let telling = &mut draft.notices.telling;
    let mut standings = telling.read().1;
    let has_player = model.outlets.has_player();
    if !has_player {
        for (field, standing) in telling.fields.iter().zip(&mut standings) {
            standing.is_used &= !TONES.contains(&&*field.description.label);
        }
    }
    form::section(ui, "telling", (telling, &standings), TELLING, focus_target, |ui| {
        for missing in words::missing_outlets(&model.outlets) {
            match missing.raw {
                Some(raw) => {
                    let tip = format!("The system answered: {raw}");
                    status_line::line_with_tip(ui, Tone::Caution, &missing.words, &tip);
                }
                None => status_line::line(ui, Tone::Caution, &missing.words),
            }
        }
        if !has_player {
            return;
        }
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            for (word, sound) in
                [("Try falling tones", Sound::Falling), ("Try rising tones", Sound::Rising)]
            {
                if ui.button(word).clicked() {
                    commands.push(UiCommand::TryNotice(sound));
                }
            }
        });
    });
}

fn never_silenced(ui: &mut Ui) {
    form::card(ui, "Never silenced", |ui| {
        form::remark(
            ui,
            "Top-priority alarms are shown and sounded at any hour, whatever is set here: a STOP \
             that is not confirmed or not yet sent, an antenna that points where it must not, a \
             motion stopped by the dead-man timer, a unit that moves although it reports that it \
             is at rest.",
        );
    });
}

fn reminders(ui: &mut Ui, model: &Model, draft: &mut Draft, focus_target: &mut FocusTarget) {
    let favourites = draft.satellites.favourites();
    let NoticesDraft { telling, reminders } = &mut draft.notices;
    let standings = telling.read().1;
    form::section(ui, "reminding", (telling, &standings), REMINDING, focus_target, |ui| {
        form::remark(
            ui,
            "For the passes of the favourites marked here. An alarm is raised if no antenna is on \
             its way 30 s before AOS.",
        );
        ui.add_space(4.0);
        for number in &favourites {
            let mut is_marked = reminders.contains(number);
            ui.horizontal(|ui| {
                let name = name(model, *number);
                if ui.add(CheckBox::new(&mut is_marked, &name)).changed() {
                    if is_marked {
                        reminders.insert(*number);
                    } else {
                        reminders.remove(number);
                    }
                }
                form::remark(ui, &next_aos(model, *number));
            });
        }
        if favourites.is_empty() {
            form::remark(ui, "There are no favourites. Add some in Satellites and priorities.");
        }
    });
}

fn name(model: &Model, number: u32) -> String {
    let elements = match &model.catalog {
        CatalogState::Ready(catalog) => catalog.get(number),
        CatalogState::Loading | CatalogState::Failed => None,
    };
    match elements.map(Elements::name) {
        Some(name) if !name.is_empty() => format!("{name}, {number}"),
        _ => number.to_string(),
    }
}

/// Returns the next AOS of a favourite.
fn next_aos(model: &Model, number: u32) -> String {
    let passes = model.pass_lists.favourites.upcoming(model.now);
    let mut of_this = passes.iter().filter(|predicted| predicted.number() == number).peekable();
    if of_this.peek().is_some_and(|predicted| predicted.is_always_up()) {
        return "always up, has no AOS".to_owned();
    }
    let next = of_this.find(|predicted| predicted.pass.aos.time > model.now);
    next.map_or_else(
        || "no pass is listed".to_owned(),
        |predicted| format!("next AOS {}", format::moment(predicted.pass.aos.time, model.now)),
    )
}
