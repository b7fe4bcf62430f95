//! Table of the barriers, and the form of the selected barrier.

use egui::{
    Align2, Color32, FontId, Frame, Margin, Rect, Role, ScrollArea, Sense, TextEdit, Ui, UiBuilder,
    WidgetInfo, vec2,
};

use super::{
    Chosen, HorizonState,
    draft::{Cell, Skies, ZoneDraft},
    edit, skyline,
};
use crate::{
    contract::antenna::AntennaModel,
    model::Model,
    station::{Entered, Mount},
    ui::{
        format,
        icons::{self, Icon},
        text, theme,
        tokens::Tokens,
        widgets::{
            button::{self, Button, SMALL_HEIGHT},
            check_box::CheckBox,
            form::{self, Mark},
            input::Input,
            list, paint, segmented,
        },
        words,
    },
};

const PADDING: f32 = 16.0;
const ROW: f32 = 25.0;
const FIELD: f32 = 28.0;
const LABEL: f32 = 112.0;
/// Distances of the right ends of the number columns from the right edge of the table, points.
const COLUMNS: [f32; 3] = [146.0, 76.0, 0.0];
const WHOLE_SITE: &str = "Whole site";

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    antennas: &[String],
    skies: &mut Skies,
    state: &mut HorizonState,
) {
    let inner = rect.shrink2(vec2(PADDING, 0.0)).with_min_y(rect.top() + 8.0);
    // The margin leaves room for the scroll bar next to the numbers.
    let (inner, width) = (inner.with_max_x(rect.right() - 2.0), inner.width());
    let builder = UiBuilder::new().id_salt("horizon pane").max_rect(inner);
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(rect);
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_max_width(width);
            table(ui, model, skies, state);
            ui.add_space(12.0);
            match state.chosen {
                Chosen::Skyline => {
                    skyline::form(ui, skies);
                    skyline::record(ui, model, skies, state);
                }
                Chosen::Zone(index) => zone(ui, model, antennas, index, skies, state),
                Chosen::Sun => sun(ui, skies),
            }
            paint::follow_focus(ui);
            ui.add_space(12.0);
        });
    });
}

fn row(ui: &mut Ui, height: f32) -> Rect {
    ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover()).0
}

fn table(ui: &mut Ui, model: &Model, skies: &mut Skies, state: &mut HorizonState) {
    let t = theme::tokens(ui);
    let head = row(ui, 32.0);
    paint::text_in(ui, head, Align2::LEFT_CENTER, "Zones", text::value(), t.t1);
    let add = Button::normal("Add zone");
    let widths = [add.width(ui)];
    let [place] = button::row_before(&mut head.right_center(), SMALL_HEIGHT, widths);
    if add.show(ui, "add zone", place).clicked() {
        let name = skies.free_name("Keep-out");
        skies.zones.push(ZoneDraft::added(name, &edit::FIRST_BOX));
        state.choose(Chosen::Zone(skies.zones.len().saturating_sub(1)));
    }
    let names = row(ui, 20.0);
    let cells = ["Name", "Kind", "Points", "Margin", "Blocks"];
    line(ui, names, cells.map(|cell| (cell.to_owned(), t.t3)), &text::caption());

    let effect = model.obstacle_effects.effect.as_ref();
    let masked = effect.map_or_else(dash, |effect| effect.after.masked.to_string());
    let points = skies.skyline().len();
    let skyline = [
        "Skyline".to_owned(),
        "Horizon mask".to_owned(),
        if points == 0 { dash() } else { points.to_string() },
        dash(),
        masked,
    ];
    choice(ui, skyline, Chosen::Skyline, "", state, t);
    for index in 0..skies.zones.len() {
        let Some(zone) = skies.zones.get(index) else { continue };
        let toll = effect.and_then(|effect| {
            let keep_outs = &effect.question.after.keep_outs;
            let place = keep_outs.iter().position(|keep_out| keep_out.name == zone.name.trim())?;
            effect.after.of_each.get(place)
        });
        let kind = match zone.entered {
            Entered::Hard => "Keep-out, hard",
            Entered::Warn => "Keep-out, warns",
            Entered::GoRound => "Keep-out, go round",
        };
        let cells = [
            zone.name.clone(),
            kind.to_owned(),
            zone.corners.len().to_string(),
            format::degrees(zone.margin.saved(), 1),
            toll.map_or_else(dash, |toll| toll.passes.to_string()),
        ];
        choice(ui, cells, Chosen::Zone(index), &zone.reason, state, t);
    }
    let kind = match skies.sun.saved() {
        Some(sun) => format!("Keep away, {}", format::degrees(sun.radius_deg, 1)),
        None => "Keep away, off".to_owned(),
    };
    let toll = effect.filter(|_| skies.sun.is_on).and_then(|effect| effect.after.of_sun.as_ref());
    let touched = toll.map_or_else(dash, |toll| toll.passes.to_string());
    choice(ui, ["Sun".to_owned(), kind, dash(), dash(), touched], Chosen::Sun, "", state, t);
    if let Some(antenna) = state.shown(model) {
        let (name, words) = match antenna.config.mount {
            Mount::Xy { travel_from_deg, travel_to_deg, .. } => {
                ("X/Y travel", format!("{travel_from_deg}° to {travel_to_deg}°"))
            }
            Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } => {
                ("Azimuth travel", format!("{azimuth_from_deg}° to {azimuth_to_deg}°"))
            }
        };
        let rect = row(ui, ROW);
        let cells =
            [name.to_owned(), words.replace('-', "−"), String::new(), String::new(), String::new()];
        line(ui, rect, cells.map(|cell| (cell, t.t2)), &text::small());
        let width = paint::text_width(ui, name, text::small());
        let lock = paint::square(rect.left_center() + vec2(width + 14.0, 0.0), 12.0);
        icons::paint(ui.painter(), lock, Icon::Lock, t.t3);
    }
}

fn dash() -> String {
    "–".to_owned()
}

/// Draws a selectable row.
fn choice(
    ui: &mut Ui,
    cells: [String; 5],
    chosen: Chosen,
    reason: &str,
    state: &mut HorizonState,
    t: &Tokens,
) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
    let response =
        if reason.is_empty() { response } else { response.on_hover_text(reason.to_owned()) };
    let is_chosen = state.chosen == chosen;
    let [name, kind, points, margin, blocks] = &cells;
    let words = format!("{name}, {kind}, {points} points, margin {margin}, blocks {blocks}");
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_chosen, &words));
    let ground = rect.expand2(vec2(PADDING, 0.0));
    list::paint_ground(ui, ground, is_chosen, response.hovered());
    list::paint_divider(ui, ground);
    let colours = [t.t1, t.t2, t.t1, t.t1, t.t1];
    let font = if is_chosen { text::small_strong() } else { text::small() };
    let mut colours = colours.into_iter();
    line(ui, rect, cells.map(|cell| (cell, colours.next().unwrap_or(t.t1))), &font);
    paint::focus_ring(ui, &response, 0);
    if response.clicked() {
        state.choose(chosen);
    }
}

/// Draws a line with two columns of words and three of numbers.
fn line(ui: &Ui, rect: Rect, cells: [(String, Color32); 5], font: &FontId) {
    let [name, kind, numbers @ ..] = cells;
    let half = rect.left() + rect.width() * 0.32;
    let first = rect.with_max_x(half - 8.0);
    paint::text_in(ui, first, Align2::LEFT_CENTER, &name.0, font.clone(), name.1);
    let second = rect.with_min_x(half).with_max_x(rect.right() - 190.0);
    paint::text_in(ui, second, Align2::LEFT_CENTER, &kind.0, font.clone(), kind.1);
    for ((words, colour), end) in numbers.into_iter().zip(COLUMNS) {
        let cell = rect.with_max_x(rect.right() - end).with_min_x(rect.right() - end - 66.0);
        paint::text_in(ui, cell, Align2::RIGHT_CENTER, &words, font.clone(), colour);
    }
}

/// Draws a labelled row of the form; `field` gets the space after the label.
fn labelled(ui: &mut Ui, label: &str, field: impl FnOnce(&mut Ui, Rect)) {
    let t = theme::tokens(ui);
    let rect = row(ui, FIELD + 4.0);
    let words = rect.with_max_x(rect.left() + LABEL);
    paint::text_in(ui, words, Align2::LEFT_CENTER, label, text::small(), t.t2);
    field(ui, rect.with_min_x(rect.left() + LABEL).shrink2(vec2(0.0, 3.0)));
}

/// Draws a number field with a border for its state, and takes the number if it is valid.
fn cell(ui: &mut Ui, rect: Rect, name: &str, cell: &mut Cell, t: &Tokens) -> bool {
    let border = cell.state().0.border(t);
    let changed = Input { rect, name, border }.text(ui, &mut cell.entry.text, false);
    if changed {
        cell.take();
    }
    changed
}

/// Returns the parts of the margin, in short and in sentences.
fn margin_sum(antenna: Option<&AntennaModel>, own_deg: f64) -> (String, String) {
    let own = format::degrees(own_deg, 1);
    let Some(antenna) = antenna else { return (format!("°   {own}"), String::new()) };
    let half_deg = antenna.config.beam_width_deg / 2.0;
    let stopping_way = antenna.snapshot.stopping_way;
    let fastest_deg_s = antenna.config.limits.maximum_rate_deg_s;
    let overshoot = format::degrees(stopping_way.overrun_s * fastest_deg_s, 1);
    let words =
        format!("°   beam {} + overshoot {overshoot} + {own}", format::degrees(half_deg, 2));
    let description = format!(
        "An antenna at rest is kept {} away: half the beamwidth plus your margin. A moving one is \
         stopped earlier, by the angle that it coasts after STOP: {overshoot} at full speed. {}",
        format::degrees(half_deg + own_deg, 2),
        words::stopping_way(stopping_way)
    );
    (words, description)
}

fn zone(
    ui: &mut Ui,
    model: &Model,
    antennas: &[String],
    index: usize,
    skies: &mut Skies,
    state: &mut HorizonState,
) {
    let t = theme::tokens(ui);
    let problem = skies.problem_of(index, antennas);
    let copy_name = skies.zones.get(index).map(|zone| skies.free_name(zone.name.trim()));
    let Some(zone) = skies.zones.get_mut(index) else { return };
    let head = row(ui, 32.0);
    let edits = zone.edits();
    let title = zone.name.trim().to_owned();
    let place = paint::text_in(
        ui,
        head.with_max_x(head.right() - 160.0),
        Align2::LEFT_CENTER,
        &title,
        text::value(),
        t.t1,
    );
    let tag = if zone.is_new() {
        "new".to_owned()
    } else if edits == 0 {
        String::new()
    } else if edits == 1 {
        "1 edit".to_owned()
    } else {
        format!("{edits} edits")
    };
    let position = place.right_center() + vec2(12.0, 0.0);
    paint::text(ui, position, Align2::LEFT_CENTER, tag, text::caption(), t.sat);
    let (delete, copy) = (Button::quiet("Delete"), Button::normal("Copy"));
    let widths = [copy.width(ui), delete.width(ui)];
    let [copying, deleting] = button::row_before(&mut head.right_center(), SMALL_HEIGHT, widths);
    let is_copied = copy.show(ui, "copy zone", copying).clicked();
    let is_deleted = delete.show(ui, "delete zone", deleting).clicked();

    labelled(ui, "Name", |ui, place| {
        let border = problem.is_some().then_some(t.bad).filter(|_| zone.name.trim().is_empty());
        let rect = place.with_max_x(place.left() + 176.0);
        Input { rect, name: "Name of the keep-out", border }.text(ui, &mut zone.name, false);
    });
    labelled(ui, "Holds for", |ui, place| {
        let mut offered = vec![WHOLE_SITE];
        offered.extend(antennas.iter().map(String::as_str));
        let chosen = zone.antenna.clone().unwrap_or_else(|| WHOLE_SITE.to_owned());
        let rect = place.with_max_x(place.left() + 176.0);
        let input = Input { rect, name: "Holds for", border: None };
        if let Some(other) = input.choice(ui, &chosen, &offered) {
            zone.antenna = Some(other).filter(|name| name != WHOLE_SITE);
        }
    });
    labelled(ui, "Reason", |ui, place| {
        let input = Input { rect: place, name: "Reason of the keep-out", border: None };
        input.text(ui, &mut zone.reason, false);
    });
    labelled(ui, "Safety margin", |ui, place| {
        let rect = place.with_max_x(place.left() + 72.0);
        cell(ui, rect, "Safety margin", &mut zone.margin, t);
        let background = place.with_min_x(rect.right() + 8.0);
        if let Some(reason) = zone.margin.problem() {
            return form::state(ui, "margin", background, Mark::Invalid, [&reason, &reason]);
        }
        let (words, description) = margin_sum(state.shown(model), zone.margin.saved());
        paint::text_in(ui, background, Align2::LEFT_CENTER, &words, text::small(), t.t3);
        paint::name_text(ui, "margin sum", background, &words).on_hover_text(description);
    });
    labelled(ui, "When entered", |ui, place| {
        let all = [
            ("Refuse, STOP", Entered::Hard),
            ("Warn only", Entered::Warn),
            ("Go round", Entered::GoRound),
        ];
        let rect = place.with_max_x(place.right().min(place.left() + 300.0));
        segmented::choose(ui, "when entered", rect, "When entered", &all, &mut zone.entered);
    });
    if let Some(problem) = problem {
        let rect = row(ui, FIELD);
        form::state(ui, "zone problem", rect, Mark::Invalid, [&problem, &problem]);
    }
    points(ui, zone, state, t);
    if is_copied && let Some(copy) = copy_name.map(|name| zone.copied(name)) {
        skies.zones.push(copy);
        state.choose(Chosen::Zone(skies.zones.len().saturating_sub(1)));
    } else if is_deleted {
        skies.zones.remove(index);
        state.choose(Chosen::Skyline);
    }
}

fn points(ui: &mut Ui, zone: &mut ZoneDraft, state: &mut HorizonState, t: &Tokens) {
    ui.add_space(8.0);
    let head = row(ui, 28.0);
    paint::text_in(ui, head, Align2::LEFT_CENTER, "Points", text::body_medium(), t.t1);
    let (add, remove) = (Button::normal("Add"), Button::quiet("Remove"));
    let can_remove = state.corner.is_some() && zone.corners.len() > edit::MIN_CORNERS;
    let remove = remove.locked(!can_remove);
    let widths = [add.width(ui), remove.width(ui)];
    let [adding, removing] = button::row_before(&mut head.right_center(), SMALL_HEIGHT, widths);
    let is_added = add.show(ui, "add corner", adding).clicked();
    let is_removed = remove.show(ui, "remove corner", removing).clicked();
    let names = row(ui, 20.0);
    let columns = |rect: Rect| {
        let left = rect.left();
        (
            rect.with_max_x(left + 24.0),
            rect.with_min_x(left + 36.0).with_max_x(left + 112.0),
            rect.with_min_x(left + 128.0).with_max_x(left + 204.0),
            rect.with_min_x(left + 216.0),
        )
    };
    let (number, azimuth, elevation, background) = columns(names);
    for (rect, words) in
        [(number, "#"), (azimuth, "Azimuth °"), (elevation, "Elevation °"), (background, "State")]
    {
        paint::text_in(ui, rect, Align2::LEFT_CENTER, words, text::caption(), t.t3);
    }
    for (index, corner) in zone.corners.iter_mut().enumerate() {
        let rect = row(ui, FIELD + 1.0);
        let is_chosen = state.corner == Some(index);
        if is_chosen {
            ui.painter().rect_filled(rect.expand2(vec2(PADDING, 0.0)), 0.0, t.bgsel);
        }
        let (number, azimuth, elevation, background) = columns(rect);
        let place = index + 1;
        let salt = ("choose corner", index);
        let choosing =
            paint::control(ui, salt, number, Role::Button, true, &format!("Corner {place}"));
        let words = place.to_string();
        paint::text_in(ui, number, Align2::LEFT_CENTER, &words, text::small(), t.t2);
        paint::focus_ring(ui, &choosing, 2);
        let inset = |rect: Rect| rect.shrink2(vec2(0.0, 2.5));
        let name = format!("Azimuth of corner {place}");
        let one = cell(ui, inset(azimuth), &name, &mut corner.azimuth, t);
        let name = format!("Elevation of corner {place}");
        let other = cell(ui, inset(elevation), &name, &mut corner.elevation, t);
        if one || other || choosing.clicked() {
            state.corner = Some(index);
        }
        let (mark, words) = corner.state();
        form::state(ui, ("corner", index), background, mark, [&words, &words]);
    }
    let corner = state.corner.unwrap_or(zone.corners.len().saturating_sub(1));
    if is_added {
        state.corner = zone.split(corner).or(state.corner);
    } else if is_removed && zone.remove(corner) {
        state.corner = None;
    }
}

fn sun(ui: &mut Ui, skies: &mut Skies) {
    let t = theme::tokens(ui);
    let head = row(ui, 32.0);
    paint::text_in(ui, head, Align2::LEFT_CENTER, "Sun", text::value(), t.t1);
    ui.add(CheckBox::new(&mut skies.sun.is_on, "Keep antennas away from the Sun"));
    ui.add_space(4.0);
    if !skies.sun.is_on {
        return;
    }
    for (label, unit, field) in
        [("Radius", "°", &mut skies.sun.radius), ("Time ahead", "min", &mut skies.sun.ahead)]
    {
        labelled(ui, label, |ui, place| {
            let rect = place.with_max_x(place.left() + 72.0);
            let name = format!("{label} of the Sun avoidance");
            cell(ui, rect, &name, field, t);
            let background = place.with_min_x(rect.right() + 8.0);
            let unit_place = background.with_max_x(background.left() + 28.0);
            paint::text_in(ui, unit_place, Align2::LEFT_CENTER, unit, text::small(), t.t3);
            let background = background.with_min_x(background.left() + 36.0);
            let (mark, words) = field.state();
            form::state(ui, label, background, mark, [&words, &words]);
        });
    }
}

/// Draws a multi-line text field in the style of a field.
pub(super) fn lines(ui: &mut Ui, name: &str, hint: &str, typed: &mut String, is_wrong: bool) {
    let t = theme::tokens(ui);
    let border = if is_wrong { (2.0, t.bad) } else { (1.0, t.edge) };
    let frame = Frame::new().fill(t.field).stroke(border).corner_radius(4);
    let field = frame.inner_margin(Margin::symmetric(2, 2)).show(ui, |ui| {
        ScrollArea::vertical().id_salt(name).max_height(260.0).show(ui, |ui| {
            let edit = TextEdit::multiline(typed)
                .frame(Frame::new().inner_margin(Margin::symmetric(6, 4)))
                .font(text::small())
                .hint_text(hint)
                .desired_rows(8)
                .desired_width(f32::INFINITY);
            ui.add(edit).accessible_name(name).has_focus()
        })
    });
    if field.inner.inner {
        paint::ring_around(ui, field.response.rect, 4);
    }
}
