//! The set-up of a station in four steps, during the demonstration. Azel writes nothing before the
//! last step.

mod antennas;
mod draft;
mod elements;
mod end;
mod frame;
mod satellites;
mod site;
mod so_far;
mod steps;
mod words;

use egui::{Key, Modifiers, Rect, RichText, ScrollArea, Sense, Ui, UiBuilder};
use jiff::Timestamp;

pub use self::steps::Step;
use self::{
    draft::SetupDraft,
    steps::{Passed, Progress},
};
use super::{object_search::ObjectSearch, text, theme, widgets::paint};
use crate::{
    contract,
    model::{Model, UiCommand},
};

/// View width below which the steps are a strip and the right panel is folded, points.
const NARROW_BELOW: f32 = 1200.0;
const PADDING: f32 = 24.0;

/// Entered values, and the current step.
#[derive(Default)]
pub struct SetupState {
    step: Step,
    progress: Progress,
    draft: Option<SetupDraft>,
    satellites: ObjectSearch,
    add: super::elements::AddState,
    /// Reason why Azel could not save the station.
    problem: Option<String>,
    /// `true` if the head of the step should get the keyboard focus.
    wants_focus: bool,
}

impl SetupState {
    /// Returns `true` if closing would lose entered values.
    pub fn is_edited(&self) -> bool {
        self.draft.as_ref().is_some_and(SetupDraft::is_edited) || self.add.is_edited()
    }

    /// Takes the outcome of saving a station; a success resets the set-up.
    pub fn saved(&mut self, result: &Result<Timestamp, String>) {
        match result {
            Ok(_) => *self = Self::default(),
            Err(reason) => self.problem = Some(reason.clone()),
        }
    }

    fn show_step(&mut self, step: Step) {
        self.step = step;
        self.problem = None;
        self.wants_focus = true;
    }

    /// Returns the outcome of a step. The antennas are not done while the link of one antenna is
    /// untested.
    fn passed(&self, step: Step, draft: &SetupDraft, model: &Model) -> Passed {
        match self.progress.outcome(step) {
            Passed::Done if step == Step::Antennas && draft.has_untested(model) => Passed::NotYet,
            passed => passed,
        }
    }

    /// Returns the reason why the operator cannot continue from the current step.
    fn hindrance(&self, draft: &SetupDraft, model: &Model) -> Option<String> {
        match self.step {
            Step::Site | Step::Antennas | Step::Satellites | Step::End => {
                draft.hindrance(self.step, model)
            }
            Step::Elements => self.unadded(model),
        }
    }

    /// Returns the reason why Azel cannot add the source entered in the current step.
    fn unadded(&self, model: &Model) -> Option<String> {
        if self.step != Step::Elements {
            return None;
        }
        let reason = self.add.typed(&model.sources)?.err()?;
        Some(format!("This source is not added yet: {reason}."))
    }

    /// Adds the source entered in the current step. Returns `true` if there is one.
    fn add_typed(&mut self, model: &Model, commands: &mut Vec<UiCommand>) -> bool {
        if self.step == Step::Elements
            && let Some(Ok(source)) = self.add.typed(&model.sources)
        {
            self.add.add(source, commands);
            return true;
        }
        false
    }

    /// Shows another step. Adds an entered source first; an invalid source keeps the current step.
    fn choose(&mut self, step: Step, model: &Model, commands: &mut Vec<UiCommand>) {
        if step == self.step || self.unadded(model).is_some() {
            return;
        }
        if self.add_typed(model, commands) {
            self.progress.done(self.step);
        }
        self.show_step(step);
    }

    /// Completes the step unless a reason prevents it. Adds an entered source first.
    fn go_on(&mut self, draft: &SetupDraft, model: &Model, commands: &mut Vec<UiCommand>) {
        if self.hindrance(draft, model).is_some() {
            return;
        }
        self.add_typed(model, commands);
        if let Some(next) = self.step.next() {
            self.progress.done(self.step);
            self.show_step(next);
        } else {
            let station = draft.station().map(Box::new);
            let save = station.map(contract::Command::SaveStation);
            commands.extend(save.map(UiCommand::Station));
        }
    }

    fn skip(&mut self, draft: &mut SetupDraft) {
        if let Some(next) = self.step.next() {
            if self.step == Step::Site {
                draft.skip_site();
            }
            self.progress.skipped(self.step);
            self.show_step(next);
        }
    }

    fn go_back(&mut self) {
        if let Some(before) = self.step.before() {
            self.show_step(before);
        }
    }
}

/// Draws the view. `takes_keys` is `true` if nothing covers the view.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    takes_keys: bool,
    state: &mut SetupState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let mut draft = state.draft.take().unwrap_or_else(|| {
        state.wants_focus = true;
        SetupDraft::new(model.station_to_edit())
    });
    let head = ui.make_persistent_id("head of the step");
    if takes_keys {
        take_keys(ui, model, head, &draft, state, commands);
    }
    let shown = state.step;
    let panels = frame::split(rect);
    if let Some(step) = frame::show_steps(ui, &panels, model, &draft, state) {
        state.choose(step, model, commands);
    }
    if let Some(right) = panels.right {
        so_far::show(ui, right, model, &draft, state.progress);
    }
    let (body, foot) = panels.middle;
    // The scroll bar uses the right margin.
    let inner = body.with_min_x(body.left() + PADDING).with_max_x(body.right() - 4.0);
    let builder = UiBuilder::new().id_salt(("step", shown)).max_rect(inner);
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(body.intersect(ui.clip_rect()));
        ScrollArea::vertical().id_salt(("step", shown)).auto_shrink(false).show(ui, |ui| {
            ui.add_space(16.0);
            show_head(ui, head, shown);
            ui.add_space(8.0);
            match shown {
                Step::Site => site::show(ui, model, &mut draft, &mut state.wants_focus),
                Step::Antennas => {
                    antennas::show(ui, model, &mut draft, &mut state.wants_focus, commands);
                }
                Step::Satellites => {
                    let (search, wants_focus) = (&mut state.satellites, &mut state.wants_focus);
                    satellites::show(ui, model, &mut draft, search, wants_focus);
                }
                Step::Elements => elements::show(ui, model, &draft, &mut state.add, commands),
                Step::End => end::show(ui, model, &draft, state),
            }
            paint::follow_focus(ui);
            ui.add_space(16.0);
        });
    });
    if std::mem::take(&mut state.wants_focus) {
        ui.memory_mut(|memory| memory.request_focus(head));
    }
    frame::show_foot(ui, foot, model, &mut draft, state, commands);
    state.draft = Some(draft);
}

/// Shows the head of the step. The head has the focus if no field has it, so that Tab continues
/// from there. Tab never reaches the head itself.
fn show_head(ui: &mut Ui, id: egui::Id, step: Step) {
    let t = theme::tokens(ui);
    let (title, description) = step.title();
    let galley = ui.painter().layout_no_wrap(title.to_owned(), text::title(), t.t1);
    let (place, _) = ui.allocate_exact_size(galley.size(), Sense::hover());
    ui.painter().galley(place.min, galley, t.t1);
    let has_focus = ui.memory(|memory| memory.has_focus(id));
    let sense = if has_focus { Sense::focusable_noninteractive() } else { Sense::hover() };
    let response = ui.interact(place, id, sense);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Heading, true, title));
    let paragraph = RichText::new(description).font(text::body()).color(t.t2);
    ui.add(egui::Label::new(paragraph).wrap());
}

fn take_keys(
    ui: &Ui,
    model: &Model,
    head: egui::Id,
    draft: &SetupDraft,
    state: &mut SetupState,
    commands: &mut Vec<UiCommand>,
) {
    if ui.input_mut(|input| input.consume_key(Modifiers::ALT, Key::ArrowLeft)) {
        state.go_back();
        return;
    }
    // The last step saves the station, so only its button completes it.
    if state.step != Step::End
        && ui.input_mut(|input| input.consume_key(Modifiers::ALT, Key::ArrowRight))
    {
        state.go_on(draft, model, commands);
        return;
    }
    // Enter on a button presses the button. In a search or in the form of a source, Enter belongs
    // to that form.
    let focused = ui.memory(egui::Memory::focused);
    let is_free = focused.is_none_or(|id| id == head);
    let is_for_step = match state.step {
        Step::Site | Step::Antennas => true,
        Step::Satellites => state.satellites.typed.trim().is_empty(),
        Step::Elements => state.add.is_empty(),
        Step::End => false,
    };
    let ends_typing = ui.text_edit_focused() && is_for_step;
    let enter = |ui: &Ui| ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
    if (is_free || ends_typing) && enter(ui) {
        let is_tested = state.step == Step::Antennas && draft.test_typed(model, commands);
        if !is_tested {
            state.go_on(draft, model, commands);
        }
    }
}
