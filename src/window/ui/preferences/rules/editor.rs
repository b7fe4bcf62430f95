//! The form of the chosen rule, which ends with the rule as one sentence, and the passes that it
//! decides.

use egui::{Frame, Label, Margin, RichText, Sense, Ui, vec2};

use super::{
    RulesState, Shown,
    cannot_act::{CannotAct, RuleContext},
    draft::{ACTION_LABEL, DraftSubject, RuleDraft, RulesDraft, WHEN},
};
use crate::{
    model::Model,
    ui::{
        format,
        object_search::ObjectSearch,
        preferences::{FormState, form, picker},
        text, theme,
        widgets::{
            button::Button,
            drop_down::DropDown,
            form::ROW,
            paint, segmented,
            status_line::{self, Tone},
        },
        words,
    },
};

/// Max number of listed passes.
const LISTED: usize = 10;

pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    shown: &Shown,
    (rules, before): (&mut RulesDraft, &RulesDraft),
    context: &RuleContext<'_>,
    state: &mut FormState,
) {
    let title = match shown.number {
        Some(number) => format!("Rule {number}"),
        None => "Rule that is removed".to_owned(),
    };
    form::card(ui, &title, |ui| {
        buttons(ui, shown, rules, &mut state.rules);
        let Some(rule) = rules.get_mut(shown.index) else { return };
        let was = rule.was_in(before);
        let is_other_antenna = was.is_some_and(|was| was.antenna != rule.antenna);
        let is_of_others = was.is_some_and(|was| was.subject != rule.subject);
        ui.add_enabled_ui(!rule.is_removed, |ui| {
            let reason = shown.hindrance.as_ref().map(|(reason, _)| *reason);
            antenna(ui, rule, context, (reason, is_other_antenna));
            let search = &mut state.rules.search;
            satellites(ui, model, rule, context, (reason, is_of_others), search);
            let standings = rule.typed.read().1;
            for section in [WHEN, ACTION_LABEL] {
                let typed = (&mut rule.typed, &*standings);
                form::rows(ui, "rule", typed, section, &mut state.focus_target);
            }
        });
        ui.add_space(4.0);
        sentence(ui, shown);
    });
}

fn buttons(ui: &mut Ui, shown: &Shown, rules: &mut RulesDraft, state: &mut RulesState) {
    let (index, last) = (shown.index, rules.all().len().saturating_sub(1));
    let is_removed = shown.number.is_none();
    ui.horizontal(|ui| {
        for (word, end) in
            [("Move up", index.saturating_sub(1)), ("Move down", (index + 1).min(last))]
        {
            if ui.add_enabled(end != index, egui::Button::new(word)).clicked() {
                rules.reorder(index, end);
                state.chosen = end;
            }
        }
        if ui.add_enabled(!is_removed, egui::Button::new("Duplicate")).clicked()
            && let Some(copy) = rules.duplicate(index)
        {
            state.choose(copy);
        }
        let word = if is_removed { "Undo: keep it" } else { "Remove rule" };
        if ui.button(word).clicked()
            && let Some(rule) = rules.get_mut(index)
        {
            rule.is_removed = !rule.is_removed;
        }
    });
    ui.add_space(4.0);
}

fn antenna(
    ui: &mut Ui,
    rule: &mut RuleDraft,
    context: &RuleContext<'_>,
    (reason, is_edited): (Option<CannotAct>, bool),
) {
    let wrong = (reason == Some(CannotAct::NoAntenna)).then_some("Is removed");
    form::custom_row(ui, ("rule", "Antenna"), wrong, is_edited, |ui| {
        let chosen = rule.antenna.map_or("All", |id| context.antenna(id).unwrap_or("Removed"));
        drop_down(ui, "antenna", chosen, &format!("Antenna, {chosen}"), |ui| {
            ui.selectable_value(&mut rule.antenna, None, "All");
            for (id, name) in &context.antennas {
                ui.selectable_value(&mut rule.antenna, Some(*id), name);
            }
        });
    });
}

fn drop_down(
    ui: &mut Ui,
    salt: &'static str,
    chosen: &str,
    name: &str,
    list: impl FnOnce(&mut Ui),
) {
    const MIN_WIDTH: f32 = 160.0;
    let drop_down = DropDown { button: Button::normal(chosen), salt, name };
    let size = vec2(drop_down.width(ui).max(MIN_WIDTH), ROW);
    let (place, _) = ui.allocate_exact_size(size, Sense::hover());
    drop_down.show(ui, place, list);
}

fn satellites(
    ui: &mut Ui,
    model: &Model,
    rule: &mut RuleDraft,
    context: &RuleContext<'_>,
    (reason, is_edited): (Option<CannotAct>, bool),
    search: &mut ObjectSearch,
) {
    const KINDS: [(&str, u8); 3] = [("All", 0), ("One", 1), ("Group", 2)];
    const WIDTH: f32 = 160.0;
    let wrong = match reason {
        Some(CannotAct::NoSatellite) => Some("Choose one"),
        Some(CannotAct::NoGroup) => Some("Choose a group"),
        _ => None,
    };
    form::custom_row(ui, ("rule", "Satellites"), wrong, is_edited, |ui| {
        ui.vertical(|ui| {
            let present = match rule.subject {
                DraftSubject::All => 0,
                DraftSubject::Satellite(_) => 1,
                DraftSubject::Group(_) => 2,
            };
            let mut kind = present;
            let (place, _) = ui.allocate_exact_size(vec2(WIDTH, ROW), Sense::hover());
            segmented::choose(ui, "of", place, "Satellites", &KINDS, &mut kind);
            match kind {
                _ if kind == present => {}
                0 => rule.subject = DraftSubject::All,
                1 => rule.subject = DraftSubject::Satellite(None),
                _ => rule.subject = DraftSubject::Group(None),
            }
            match rule.subject {
                DraftSubject::All => {}
                DraftSubject::Satellite(number) => {
                    if let Some(number) = number {
                        let name = words::satellite(model, number);
                        let words = format!("{name}, {number}");
                        ui.label(RichText::new(words).font(text::body_medium()));
                    }
                    let numbers: Vec<u32> = number.into_iter().collect();
                    let found = picker::show(ui, model, &context.favourites, &numbers, search);
                    if found.is_some() {
                        rule.subject = DraftSubject::Satellite(found);
                    }
                }
                DraftSubject::Group(group) => choose_group(ui, group, rule, context),
            }
        });
    });
}

fn choose_group(
    ui: &mut Ui,
    group: Option<usize>,
    rule: &mut RuleDraft,
    context: &RuleContext<'_>,
) {
    if context.satellites.remaining().next().is_none() {
        let words = "There are no groups. Add one in Satellites and priorities.";
        ui.label(RichText::new(words).font(text::small()).color(theme::tokens(ui).warn));
        return;
    }
    let chosen = group.and_then(|group| context.group(group));
    let chosen = chosen.unwrap_or_else(|| "Choose a group".to_owned());
    drop_down(ui, "group", &chosen, &format!("Group, {chosen}"), |ui| {
        for (index, group) in context.satellites.remaining() {
            ui.selectable_value(&mut rule.subject, DraftSubject::Group(Some(index)), group.title());
        }
    });
}

/// Shows the rule as one sentence, and the reason why it cannot act.
fn sentence(ui: &mut Ui, shown: &Shown) {
    let t = theme::tokens(ui);
    let frame = Frame::new().fill(t.bg2).corner_radius(6).inner_margin(Margin::symmetric(12, 8));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        let words = RichText::new(&shown.sentence).font(text::body()).color(t.t1);
        ui.add(Label::new(words).wrap());
        if let Some((reason, words)) = &shown.hindrance {
            let tone = if reason.is_wrong() { Tone::Bad } else { Tone::Caution };
            status_line::line(ui, tone, &format!("It cannot act: {words}."));
        }
    });
}

/// Shows the passes of the next 48 h that the rule decides.
pub(super) fn decided(
    ui: &mut Ui,
    model: &Model,
    shown: &Shown,
    context: &RuleContext<'_>,
    state: &RulesState,
) {
    form::card(ui, "Passes it decides, next 48 h", |ui| {
        let passes = shown.decided(state);
        let words = match passes {
            None => "Not known while a field is not valid, or the rule is removed.",
            Some([]) if !shown.is_on => "None: the rule is off.",
            Some([]) => "None.",
            Some(_) => "Sun and hours are those at TCA, the middle of the pass.",
        };
        status_line::line(ui, Tone::Plain, words);
        let passes = passes.unwrap_or_default();
        for pass in passes.iter().take(LISTED) {
            let name = |id| context.antenna(id).map(str::to_owned);
            let antennas: Vec<String> = pass.antennas.iter().copied().filter_map(name).collect();
            let words = [
                format::moment(pass.aos, model.now),
                words::satellite(model, pass.satellite),
                format::degrees(pass.max_elevation_deg, 0),
                antennas.join(", "),
            ];
            line(ui, &words);
        }
        if passes.len() > LISTED {
            status_line::line(ui, Tone::Plain, &format!("And {} more.", passes.len() - LISTED));
        }
    });
}

fn line(ui: &mut Ui, words: &[String; 4]) {
    const SHARES: [f32; 4] = [0.27, 0.31, 0.12, 0.3];
    let t = theme::tokens(ui);
    let (row, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let mut left = row.left();
    for (index, (words, share)) in words.iter().zip(SHARES).enumerate() {
        let right = left + row.width() * share;
        let place = row.with_min_x(left).with_max_x(right - 8.0);
        let (anchor, ink) = match index {
            1 => (egui::Align2::LEFT_CENTER, t.t1),
            2 => (egui::Align2::RIGHT_CENTER, t.t2),
            _ => (egui::Align2::LEFT_CENTER, t.t2),
        };
        paint::text_in(ui, place, anchor, words, text::small(), ink);
        left = right + if index == 2 { 8.0 } else { 0.0 };
    }
    let spoken = words.join(", ");
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &spoken));
}
