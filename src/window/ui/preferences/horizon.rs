//! The page of the horizon and the keep-outs: obstructions of the sky, and directions in which the
//! antenna must not point.

pub(super) mod draft;
mod edit;
mod effect;
mod history;
mod pane;
mod plot;
mod skyline;

use egui::{Align2, Key, Modifiers, Rect, Ui, vec2};
use jiff::Timestamp;

use self::{draft::Skies, history::History, skyline::Recording};
use crate::{
    astro::{Angle, AzEl, Site, sun_moon, time::add_seconds},
    contract::antenna::AntennaModel,
    model::{
        Model, UiCommand,
        effects::obstacles::{Obstacles, Question},
    },
    station::{Mount, Station},
    ui::{
        format,
        icons::{self, Icon},
        text, theme,
        widgets::{
            button::{self, Button, HEIGHT as BUTTON, SMALL_HEIGHT},
            check_box::{self, CheckBox},
            paint, segmented,
        },
    },
};

/// Width from which the title is as large as the titles of the other pages, points.
const TITLE_FROM: f32 = 260.0;
/// Width from which plot and table stand side by side, points.
const BESIDE_FROM: f32 = 1000.0;
const PANE: f32 = 472.0;
const BAR: f32 = 56.0;
const TOOLS: f32 = 40.0;
/// Width of the tabs, points.
const TABS: f32 = 130.0;
const EFFECT: f32 = 72.0;
const PADDING: f32 = 16.0;
/// Interval between the points of the Sun's path, seconds.
const SUN_STEP_S: f64 = 600.0;

/// The item selected for editing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Chosen {
    #[default]
    Skyline,
    /// Index of a keep-out.
    Zone(usize),
    /// Avoidance of the Sun.
    Sun,
}

/// Pointer tool of the plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Tool {
    #[default]
    Select,
    Point,
    Polygon,
    Rectangle,
}

/// The visible tab where plot and table do not both fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Tab {
    #[default]
    Plot,
    Table,
}

type SunWay = (Site, i64, Vec<AzEl>);

/// Selection, drawing and undo history of the page.
pub(super) struct HorizonState {
    chosen: Chosen,
    /// Selected corner of the keep-out or point of the skyline.
    corner: Option<usize>,
    tool: Tool,
    tab: Tab,
    snaps: bool,
    shows_passes: bool,
    /// Corners of the keep-out that the operator is drawing.
    drawing: Vec<(f64, f64)>,
    /// Corner that the operator drags, and its original position.
    drag: Option<(usize, (f64, f64))>,
    antenna: Option<usize>,
    history: History,
    sun: Option<SunWay>,
    recording: Option<Recording>,
    /// Path of a mask file while the operator enters it.
    import: Option<String>,
    answer: Option<Result<String, String>>,
}

impl Default for HorizonState {
    fn default() -> Self {
        Self {
            chosen: Chosen::default(),
            corner: None,
            tool: Tool::default(),
            tab: Tab::default(),
            snaps: true,
            shows_passes: true,
            drawing: Vec::new(),
            drag: None,
            antenna: None,
            history: History::default(),
            sun: None,
            recording: None,
            import: None,
            answer: None,
        }
    }
}

impl HorizonState {
    fn choose(&mut self, chosen: Chosen) {
        if self.chosen != chosen {
            self.chosen = chosen;
            self.corner = None;
        }
    }

    /// Selects an item and shows its form.
    pub(super) fn open(&mut self, chosen: Chosen) {
        self.choose(chosen);
        self.tab = Tab::Table;
    }

    fn begin_drag(&mut self, index: usize, start: Option<(f64, f64)>) {
        self.corner = Some(index);
        self.drag = start.map(|start| (index, start));
    }

    /// Returns the antenna whose beam and travel the plot shows. `None` in the demonstration, since
    /// the page then edits a new station.
    fn shown<'a>(&self, model: &'a Model) -> Option<&'a AntennaModel> {
        let place = self.antenna.unwrap_or(model.selected_antenna);
        model.antennas.get(place).filter(|_| !model.demo)
    }

    /// Clears the history, because its steps belong to an old draft.
    pub(super) fn forget(&mut self) {
        self.history = History::default();
        self.recording = None;
    }

    /// Takes the result of reading or writing a mask file.
    pub(super) fn exchanged(&mut self, result: Result<String, String>) {
        if result.is_ok() {
            self.import = None;
        }
        self.answer = Some(result);
    }

    /// Returns the path of the Sun over the site from midnight to midnight UTC.
    fn sun_way(&mut self, site: Site, now: Timestamp) -> &[AzEl] {
        const DAY_S: i64 = 86_400;
        let day = now.as_second().div_euclid(DAY_S);
        let is_known = self
            .sun
            .as_ref()
            .is_some_and(|(current_site, on, _)| (*current_site, *on) == (site, day));
        if !is_known {
            let midnight = Timestamp::from_second(day * DAY_S).unwrap_or(now);
            let direction = |step: u16| {
                sun_moon::sun(site, add_seconds(midnight, f64::from(step) * SUN_STEP_S))
            };
            self.sun = Some((site, day, (0..=144).map(direction).collect()));
        }
        self.sun.as_ref().map(|(.., way)| &way[..]).unwrap_or_default()
    }
}

/// Shows the page in `rect`.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    (station, antennas): (&Station, &[String]),
    skies: &mut Skies,
    state: &mut HorizonState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    if let Chosen::Zone(index) = state.chosen
        && index >= skies.zones.len()
    {
        state.choose(Chosen::Skyline);
    }
    take_keys(ui, skies, state);
    let is_wide = rect.width() >= BESIDE_FROM;
    let (bar, rest) = rect.split_top_bottom_at_y(rect.top() + BAR);
    ui.painter().rect_filled(bar, 0.0, t.bg1);
    ui.painter().hline(bar.x_range(), bar.bottom() - 0.5, (1.0, t.line));
    view_bar(ui, bar, is_wide, model, skies, state, commands);
    let import = state.import.is_some() || state.answer.is_some();
    let (import, rest) = rest.split_top_bottom_at_y(rest.top() + if import { TOOLS } else { 0.0 });
    skyline::exchange(ui, import, state, commands);
    let effect_height = if is_wide { EFFECT } else { 32.0 };
    let (left, pane) = if is_wide {
        rest.split_left_right_at_x(rest.right() - PANE.min(rest.width() * 0.45))
    } else {
        let (above, below) = rest.split_top_bottom_at_y(rest.bottom() - effect_height);
        effect_lines(ui, below, model, skies, state);
        match state.tab {
            Tab::Plot => (above, Rect::NOTHING),
            Tab::Table => (Rect::NOTHING, above),
        }
    };
    if left.is_positive() {
        let (tools, below) = left.split_top_bottom_at_y(left.top() + TOOLS);
        tool_bar(ui, tools, skies, state);
        let plot = if is_wide {
            let (plot, effect) = below.split_top_bottom_at_y(below.bottom() - effect_height);
            effect_lines(ui, effect, model, skies, state);
            plot
        } else {
            below
        };
        plot::show(ui, plot, model, skies, state);
    }
    if pane.is_positive() {
        ui.painter().rect_filled(pane, 0.0, t.bg1);
        ui.painter().vline(pane.left() + 0.5, pane.y_range(), (1.0, t.line));
        pane::show(ui, pane, model, antennas, skies, state);
    }
    ask_for_effect(ui, model, station, skies, state, commands);
    let is_held = ui.input(|input| input.pointer.any_down());
    if !is_held && !ui.text_edit_focused() {
        state.history.settle(skies);
    }
}

fn take_keys(ui: &Ui, skies: &mut Skies, state: &mut HorizonState) {
    if ui.text_edit_focused() {
        return;
    }
    let redo = Modifiers::COMMAND | Modifiers::SHIFT;
    let (undoes, redoes) = ui.input_mut(|input| {
        let redoes =
            input.consume_key(redo, Key::Z) || input.consume_key(Modifiers::COMMAND, Key::Y);
        (!redoes && input.consume_key(Modifiers::COMMAND, Key::Z), redoes)
    });
    if undoes {
        state.history.undo(skies);
    }
    if redoes {
        state.history.redo(skies);
    }
    if undoes || redoes {
        (state.drag, state.corner) = (None, None);
    }
}

fn view_bar(
    ui: &mut Ui,
    bar: Rect,
    is_wide: bool,
    model: &Model,
    skies: &mut Skies,
    state: &mut HorizonState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let record = Button::normal(if is_wide { "Record the skyline" } else { "Record" });
    let import = Button::normal("Import");
    let export = Button::normal("Export").locked(skies.skyline().is_empty());
    let mut right = bar.right_center() - vec2(PADDING, 0.0);
    let widths = [record, import, export].map(|button| button.width(ui));
    let [record_at, import_at, export_at] = button::row_before(&mut right, BUTTON, widths);
    let tabs_at = (!is_wide).then(|| button::row_before(&mut right, BUTTON, [TABS]));
    let shown = state.antenna.unwrap_or(model.selected_antenna);
    if model.antennas.len() > 1 && !model.demo {
        let antennas = model.antennas.iter().zip(0..);
        let names: Vec<(&str, usize)> =
            antennas.map(|(antenna, index)| (antenna.config.name.as_str(), index)).collect();
        let requested: f32 = names
            .iter()
            .map(|(name, _)| paint::text_width(ui, name, text::body_medium()) + 28.0)
            .sum();
        let width = requested.min(right.x - bar.left() - 240.0).max(60.0);
        let [room] = button::row_before(&mut right, BUTTON, [width]);
        let mut index = shown;
        if segmented::choose(ui, "horizon antenna", room, "Antenna", &names, &mut index) {
            state.antenna = Some(index);
        }
    }
    if let Some([place]) = tabs_at {
        let tabs = [("Plot", Tab::Plot), ("Table", Tab::Table)];
        segmented::choose(ui, "horizon tab", place, "Shown", &tabs, &mut state.tab);
    }
    if record.show(ui, "record", record_at).clicked() && state.recording.is_none() {
        state.recording = Some(Recording::new(&skies.mask));
        state.choose(Chosen::Skyline);
        state.tab = Tab::Table;
    }
    if import.show(ui, "import", import_at).clicked() {
        state.answer = None;
        state.import = if state.import.is_some() { None } else { Some(String::new()) };
    }
    if export.show(ui, "export", export_at).clicked() {
        let mask = skies.read_mask().ok().flatten();
        commands.extend(mask.map(|mask| UiCommand::ExportMask(Box::new(mask))));
    }
    let words = bar.with_max_x(right.x).shrink2(vec2(PADDING, 8.0));
    let (above, below) = words.split_top_bottom_at_fraction(0.5);
    // The title is as large as on other pages where it fits.
    let font = if above.width() < TITLE_FROM { text::value() } else { text::title() };
    paint::text_in(ui, above, Align2::LEFT_CENTER, "Horizon and keep-outs", font, t.t1);
    let subject = state.shown(model).map_or_else(
        || "No antenna yet".to_owned(),
        |antenna| {
            let mount = match antenna.config.mount {
                Mount::Xy { .. } => "X/Y",
                Mount::AzEl { .. } => "az/el",
            };
            let beam = format::degrees(antenna.config.beam_width_deg, 2);
            format!("Shown: {}, {mount}, beam {beam}", antenna.config.name)
        },
    );
    paint::text_in(ui, below, Align2::LEFT_CENTER, &subject, text::small(), t.t2);
}

fn tool_bar(ui: &mut Ui, bar: Rect, skies: &mut Skies, state: &mut HorizonState) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(bar, 0.0, t.bg2);
    let row = bar.shrink2(vec2(PADDING, 8.0));
    let tools = [
        ("Select", Tool::Select),
        ("Horizon point", Tool::Point),
        ("Polygon", Tool::Polygon),
        ("Rectangle", Tool::Rectangle),
    ];
    let place = row.with_max_x(row.left() + 304.0_f32.min(row.width() * 0.6));
    if segmented::choose(ui, "horizon tool", place, "Tool", &tools, &mut state.tool) {
        state.drawing.clear();
    }
    let undo = Button::normal("Undo").locked(!state.history.can_undo());
    let undoing = row.with_min_x(row.right() - undo.width(ui));
    let undoing = Rect::from_center_size(undoing.center(), vec2(undoing.width(), SMALL_HEIGHT));
    let mut left = place.right() + 12.0;
    for (on, word) in
        [(&mut state.snaps, "Snap 0.5°"), (&mut state.shows_passes, "Passes in the next 48 h")]
    {
        let width = paint::text_width(ui, word, text::body()) + check_box::WIDTH + 14.0;
        if left + width < undoing.left() {
            let rect = row.with_min_x(left).with_max_x(left + width);
            ui.place(rect, CheckBox::new(on, word));
        }
        left += width;
    }
    if undo.show(ui, "undo", undoing).clicked() {
        state.history.undo(skies);
        state.corner = None;
    }
}

fn effect_lines(ui: &Ui, rect: Rect, model: &Model, skies: &Skies, state: &HorizonState) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg2);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let zone = match state.chosen {
        Chosen::Zone(index) => skies.zones.get(index).map(|zone| zone.name.trim()),
        Chosen::Skyline | Chosen::Sun => None,
    };
    let lines = match &model.obstacle_effects.effect {
        Some(effect) => effect::lines(effect, zone),
        None => ["Being worked out.".to_owned(), String::new()],
    };
    let inner = rect.shrink2(vec2(PADDING, 6.0));
    if rect.height() < EFFECT {
        paint::text_in(ui, inner, Align2::LEFT_CENTER, &lines.join(" "), text::small(), t.t1);
    } else {
        let icon = paint::square(inner.left_top() + vec2(7.0, 9.0), 14.0);
        icons::paint(ui.painter(), icon, Icon::Eye, t.sat);
        let head = inner.with_max_y(inner.top() + 18.0).with_min_x(inner.left() + 24.0);
        let title = "Effect on the next 48 h";
        paint::text_in(ui, head, Align2::LEFT_CENTER, title, text::body_medium(), t.t1);
        for (line, colour, offset) in
            lines.iter().zip([t.t1, t.t2]).zip([20.0, 40.0]).map(|((a, b), c)| (a, b, c))
        {
            let row =
                Rect::from_min_size(head.left_top() + vec2(0.0, offset), vec2(head.width(), 18.0));
            paint::text_in(ui, row, Align2::LEFT_CENTER, line, text::small(), colour);
        }
    }
    paint::name_text(ui, "effect", rect, &lines.join(" ")).on_hover_text(lines.join("\n"));
}

/// Asks for the effect of the draft, unless the last question was the same.
fn ask_for_effect(
    ui: &Ui,
    model: &Model,
    station: &Station,
    skies: &Skies,
    state: &HorizonState,
    commands: &mut Vec<UiCommand>,
) {
    let config = state.shown(model).map(|antenna| &antenna.config);
    let question = Question {
        before: Obstacles {
            mask: station.horizon_mask.clone(),
            keep_outs: station.keep_outs.clone(),
            sun: station.sun_avoidance,
        },
        after: Obstacles {
            mask: skies.read_mask().unwrap_or_else(|_| station.horizon_mask.clone()),
            keep_outs: skies.zones.iter().filter_map(draft::ZoneDraft::keep_out).collect(),
            sun: skies.sun.saved(),
        },
        antenna: config.map(|config| config.name.clone()),
        half_beam: config.map_or(Angle::ZERO, |config| config.beam_width() * 0.5),
        site: station.site,
    };
    if model.obstacle_effects.requested() != Some(&question) {
        ui.ctx().request_repaint_after_for(crate::model::effects::DEBOUNCE, egui::ViewportId::ROOT);
        commands.push(UiCommand::ShowEffects(Box::new(question)));
    }
}
