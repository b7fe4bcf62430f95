//! The set-up step for the antennas, with a card for each.

use egui::{
    Align, Layout, Response, RichText, Role, Sense, Ui, WidgetInfo, style::ScrollAnimation, vec2,
};
use jiff::Timestamp;

use super::draft::SetupDraft;
use crate::{
    contract,
    contract::link_tests::LinkTestStage,
    controller::SPECS,
    model::{Model, UiCommand},
    station::{Antenna, AntennaId},
    ui::{
        icons::Icon,
        preferences::{
            antenna_fields::UPKEEP,
            connection_fields::{ADDRESS, CONNECTION},
            form,
        },
        text, theme,
        widgets::{
            button::Button,
            card,
            form::{GAP, LABEL},
            input::focus_to_replace,
            status_line::{Tone, line},
        },
        words,
    },
};

const CARD: f32 = 638.0;
const HEIGHT: f32 = 28.0;

pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    draft: &mut SetupDraft,
    wants_focus: &mut bool,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    draft.typed_address = None;
    let mut removed = None;
    for index in 0..draft.form.antennas.len() {
        card::show(ui, CARD, |ui| {
            if one(ui, model, draft, index, wants_focus, commands) {
                removed = Some(index);
            }
        });
    }
    if let Some(index) = removed {
        draft.form.antennas.remove(index);
    }
    let word = if draft.form.antennas.is_empty() { "Add an antenna" } else { "Add another" };
    ui.label(RichText::new(word).font(text::value()));
    ui.horizontal_wrapped(|ui| {
        for spec in SPECS {
            let button = Button::normal(spec.short_name).icon(Icon::Plus);
            let name = format!("Add {}", spec.name);
            if named(ui, button, ("add", spec.key), true, &name).on_hover_text(&name).clicked() {
                draft.form.add_antenna(spec, model.now);
                draft.wants_address = draft.form.antennas.last().map(|typed| typed.before().id);
            }
        }
        if draft.form.antennas.is_empty() {
            let words = "or none: Azel then predicts passes only.";
            ui.label(RichText::new(words).font(text::small()).color(t.t3));
        }
    });
    let (mut silent, mut faulty) = (Vec::new(), Vec::new());
    for index in 0..draft.form.antennas.len() {
        let Some(test) = draft.form.test(index, model) else { continue };
        let name = draft.antenna_name(index);
        match words::link_test_state(Some(test)).0 {
            Tone::Good | Tone::Plain | Tone::Now => {}
            Tone::Caution | Tone::Bad if words::link_test_reached(test) => faulty.push(name),
            Tone::Caution | Tone::Bad => silent.push(name),
        }
    }
    for (names, next_words) in [
        (silent, "Azel tries again once you finish."),
        (faulty, "Follow the advice above before you use it."),
    ] {
        if !names.is_empty() {
            ui.add_space(4.0);
            let names = crate::ui::format::list(&names);
            line(ui, Tone::Caution, &format!("{names}: you can continue. {next_words}"));
        }
    }
}

/// Draws a card. Returns `true` when the operator removes the antenna.
fn one(
    ui: &mut Ui,
    model: &Model,
    draft: &mut SetupDraft,
    index: usize,
    wants_focus: &mut bool,
    commands: &mut Vec<UiCommand>,
) -> bool {
    let t = theme::tokens(ui);
    let name = draft.antenna_name(index);
    let (antenna, standings) = (draft.form.antenna(index), draft.form.antenna_standings(index));
    let test = draft.form.test(index, model);
    let Some(typed) = draft.form.antennas.get_mut(index) else { return false };
    let (id, spec) = (typed.before().id, typed.before().connection.spec());
    let (tone, state) = words::link_test_state(test);
    ui.horizontal(|ui| {
        ui.label(RichText::new(&name).font(text::value()).color(t.t1));
        ui.label(RichText::new(spec.name).font(text::small()).color(t.t2));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let colour = match tone {
                Tone::Good => t.ok,
                Tone::Caution => t.warn,
                Tone::Bad => t.bad,
                Tone::Plain | Tone::Now => t.t3,
            };
            ui.label(RichText::new(state).font(text::body_medium()).color(colour));
        });
    });
    ui.add_space(4.0);
    let is_here = |section: &str| [CONNECTION, UPKEEP].contains(&section);
    let count = typed.fields.iter().take_while(|field| is_here(field.section)).count();
    let fields = typed.fields.get_mut(..count).unwrap_or_default();
    let responses = form::fields(ui, &format!("set-up {index}"), fields, &standings);
    if let (Some(response), Some(field)) = (responses.first(), fields.first())
        && std::mem::take(wants_focus)
    {
        focus_to_replace(ui, response, &field.entry.text);
    }
    if draft.wants_address == Some(id)
        && let (Some(response), Some(field)) = (responses.get(ADDRESS), fields.get(ADDRESS))
    {
        focus_to_replace(ui, response, &field.entry.text);
        draft.wants_address = None;
    }
    if responses.get(ADDRESS).is_some_and(Response::has_focus) {
        draft.typed_address = Some(id);
    }
    ui.add_space(4.0);
    let is_removed = ui
        .horizontal(|ui| {
            ui.add_space(LABEL + GAP);
            let word = if test.is_some() { "Test again" } else { "Test link" };
            let can = antenna.is_some();
            let (button, spoken) = (Button::normal(word).locked(!can), format!("{word} of {name}"));
            if named(ui, button, ("test", id.0), can, &spoken).clicked()
                && let Some(antenna) = &antenna
            {
                commands.push(test_of(antenna));
            }
            let remove = format!("Remove {name}");
            named(ui, Button::quiet("Remove"), ("remove", id.0), true, &remove).clicked()
        })
        .inner;
    let top = ui.min_rect().bottom();
    let outcome = test.map(|test| words::link_test(test, model.demo, model.now));
    for (tone, words) in outcome.unwrap_or_default() {
        line(ui, tone, &words);
    }
    if let Some(LinkTestStage::Done { time, .. }) = test.map(|test| &test.stage)
        && is_news(ui, id, *time)
    {
        // The answer may lie below the visible part and may contain an important warning.
        let answer = ui.min_rect().with_min_y(top);
        ui.scroll_to_rect_animation(answer, None, ScrollAnimation::none());
    }
    is_removed
}

/// Returns the command that tests the link of an antenna.
pub(super) fn test_of(antenna: &Antenna) -> UiCommand {
    UiCommand::Station(contract::Command::TestLink(Box::new(antenna.clone())))
}

/// Returns `true` once for each outcome of a test.
fn is_news(ui: &Ui, antenna: AntennaId, time: Timestamp) -> bool {
    let id = ui.make_persistent_id(("outcome in sight", antenna.0));
    ui.data_mut(|data| {
        let before = data.get_temp::<Timestamp>(id);
        data.insert_temp(id, time);
        before != Some(time)
    })
}

/// Draws a button with a longer accessible name. The button keeps the focus when other buttons
/// appear or disappear before it.
fn named(
    ui: &mut Ui,
    button: Button<'_>,
    salt: impl egui::AsIdSalt,
    enabled: bool,
    name: &str,
) -> Response {
    let (place, _) = ui.allocate_exact_size(vec2(button.width(ui), HEIGHT), Sense::hover());
    let response = button.show(ui, salt, place);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
    response
}
