//! The sky with the skyline and the keep-outs, to be drawn in.

use std::ops::Range;

use egui::{
    Align2, EventFilter, Key, Modifiers, PointerButton, Pos2, Rect, Response, Role, Sense, Shape,
    Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};

use super::{
    Chosen, HorizonState, Tool,
    draft::{Corner, Skies, ZoneDraft},
    edit::{self, place},
};
use crate::{
    app::{
        Model,
        antenna::AntennaModel,
        effects::{Effect, Toll},
    },
    astro::{Angle, AzEl, Zone},
    station::{Antenna, Mount},
    ui::{
        format,
        sky_plot::{
            KeepOutMark, Keyholes,
            geometry::{Dome, circle, dashed, outward},
            grid, keep_outs, legend, marks, mask,
        },
        text, theme,
        tokens::Tokens,
        widgets::paint,
    },
};

/// More points of a skyline are drawn without handles.
const MOST_HANDLES: usize = 120;
const HANDLE: f32 = 10.0;
const CHOSEN: f32 = 12.0;
const MIDDLE: f32 = 7.0;
const POINT: f32 = 6.0;
/// Height of a line of the legend.
const ROW: f32 = 17.0;
/// What the pointer takes hold of around a mark.
const GRIP: f32 = 16.0;

/// Shows the plot and takes what is drawn in it.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    skies: &mut Skies,
    state: &mut HorizonState,
) {
    if !crate::ui::sky_plot::geometry::usable(rect) {
        return;
    }
    let ui = &mut ui.new_child(egui::UiBuilder::new().id_salt("horizon plot").max_rect(rect));
    ui.shrink_clip_rect(rect);
    let t = theme::tokens(ui);
    // Beside a disc that is not as wide as the plot, the hint needs no line of its own.
    let hint_height = if rect.width() > rect.height() + 300.0 { 0.0 } else { 24.0 };
    let dome = Dome::fitted(rect.with_min_y(rect.top() + hint_height));
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let antenna = state.shown(model);

    let canvas = ui.interact(rect, ui.make_persistent_id("canvas"), Sense::click_and_drag());
    let name = "Horizon and keep-outs of the site";
    canvas.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, name));
    paint_sky(ui, rect, dome, model, skies, state, antenna);
    draw_on_canvas(ui, &canvas, dome, skies, state, antenna.map(|of| &of.config));
    match state.chosen {
        Chosen::Zone(index) => zone_handles(ui, dome, index, skies, state, t),
        Chosen::Skyline | Chosen::Sun => {}
    }
    if state.chosen == Chosen::Skyline || state.tool == Tool::Point {
        skyline_handles(ui, dome, skies, state, t);
    }
    continue_drag(ui, dome, skies, state);
    paint_drawing(ui, dome, state, t);

    let hint = match state.tool {
        Tool::Select => {
            "Drag a point, Shift keeps one axis, Alt a click on an edge adds one, Del removes."
        }
        Tool::Point => "Click where the sky begins; drag a point to move it, Del removes it.",
        Tool::Polygon => {
            "Click corner after corner; a double click, or one on the first corner, ends it."
        }
        Tool::Rectangle => "Draw from one corner to the other.",
    };
    let line = rect.with_max_y(rect.top() + 32.0).shrink2(vec2(16.0, 0.0));
    paint::text_in(
        ui,
        line.with_max_x(line.right() - 90.0),
        Align2::LEFT_CENTER,
        hint,
        text::small(),
        t.t3,
    );
    paint::text_in(ui, line, Align2::RIGHT_CENTER, "N up, E right", text::small(), t.t3);
    show_legend(ui, rect, dome, t);
}

fn paint_sky(
    ui: &Ui,
    rect: Rect,
    dome: Dome,
    model: &Model,
    skies: &Skies,
    state: &mut HorizonState,
    antenna: Option<&AntennaModel>,
) {
    let t = theme::tokens(ui);
    let painter = ui.painter();
    grid::disc(painter, dome, t);
    let mask = skies.read_mask().ok().flatten();
    if let Some(mask) = &mask {
        mask::paint(painter, dome, mask, t);
    }
    grid::rings(painter, dome, t);
    let config = antenna.map(|antenna| &antenna.config);
    let minimum_deg = config.map_or(0.0, |config| config.limits.minimum_elevation_deg);
    grid::rim(painter, dome, Angle::from_degrees(minimum_deg), t);
    let chosen = match state.chosen {
        Chosen::Zone(index) => skies.zones.get(index),
        Chosen::Skyline | Chosen::Sun => None,
    };
    let name = chosen.map(|zone| zone.name.trim());
    let shown_effect = model.effects.effect.as_ref().filter(|_| state.shows_passes);
    if let Some(effect) = shown_effect {
        passes(ui, dome, effect, name, t);
    }
    if let Some(config) = config {
        travel(ui, dome, config, t);
    }
    let half_beam = config.map_or(Angle::ZERO, |config| config.beam_width() * 0.5);
    let shown: Vec<(&ZoneDraft, Zone)> = skies
        .zones
        .iter()
        .enumerate()
        .filter(|(index, zone)| state.chosen == Chosen::Zone(*index) || holds_for(zone, config))
        .filter_map(|(_, zone)| Some((zone, zone.zone().ok()?)))
        .collect();
    let marks: Vec<KeepOutMark<'_>> = shown
        .iter()
        .map(|(draft, zone)| KeepOutMark {
            name: draft.name.trim(),
            zone,
            margin: half_beam + Angle::from_degrees(draft.margin.kept()),
        })
        .collect();
    keep_outs::paint(painter, dome, &marks, t);
    if let Some(effect) = shown_effect {
        blocked(ui, dome, effect, name, t);
    }
    keep_outs::words(painter, dome, &marks, t);
    for zone in skies.zones.iter().filter(|zone| zone.zone().is_err()) {
        let corners = zone.corners_deg();
        let path: Vec<Pos2> =
            corners.iter().chain(corners.first()).map(|at| place(dome, *at)).collect();
        painter.extend(dashed(&path, 4.0, 3.0, Stroke::new(1.5, t.bad)));
    }
    sun(ui, rect, dome, model, skies, state, t);
    if let Some(antenna) = antenna
        && let Some(direction) = antenna.snapshot.state.measured.and_then(|of| of.direction())
        && let Some(at) = dome.visible(direction)
    {
        marks::measured(painter, at, 0.75, t);
        let words = format!(
            "{}\n{}, {}",
            antenna.config.name,
            format::degrees(direction.azimuth_deg(), 1),
            format::degrees(direction.elevation_deg(), 1)
        );
        label(ui, at + vec2(24.0, 8.0), Align2::LEFT_TOP, &words, t.t1, t);
    }
}

fn holds_for(zone: &ZoneDraft, antenna: Option<&Antenna>) -> bool {
    match (&zone.antenna, antenna) {
        (Some(name), Some(antenna)) => Antenna::same_name(name, &antenna.name),
        _ => true,
    }
}

/// What the keep-out of this name does to the passes.
fn toll_of<'a>(effect: &'a Effect, name: Option<&str>) -> Option<&'a Toll> {
    let keep_outs = &effect.question.after.keep_outs;
    let place = keep_outs.iter().position(|of| Some(&*of.name) == name)?;
    effect.after.of_each.get(place)
}

fn path(dome: Dome, effect: &Effect, way: usize, samples: Option<Range<usize>>) -> Vec<Pos2> {
    let Some(way) = effect.ways.get(way) else { return Vec::new() };
    let samples = samples.map_or(Some(way.samples.as_slice()), |range| way.samples.get(range));
    dome.path(samples.into_iter().flatten().map(|sample| sample.direction))
}

/// All passes, those that the chosen keep-out touches above the others.
fn passes(ui: &Ui, dome: Dome, effect: &Effect, chosen: Option<&str>, t: &Tokens) {
    let toll = toll_of(effect, chosen);
    let touched =
        |way: usize| toll.is_some_and(|toll| toll.blocked.iter().any(|(of, _)| *of == way));
    for is_touched in [false, true] {
        let colour = if is_touched { t.other } else { t.grid };
        for way in (0..effect.ways.len()).filter(|way| touched(*way) == is_touched) {
            let line = path(dome, effect, way, None);
            ui.painter().add(Shape::line(line, Stroke::new(1.0, colour)));
        }
    }
}

/// The parts of passes that the chosen keep-out blocks.
fn blocked(ui: &Ui, dome: Dome, effect: &Effect, chosen: Option<&str>, t: &Tokens) {
    let parts = toll_of(effect, chosen).map(|toll| toll.blocked.iter());
    for (way, samples) in parts.into_iter().flatten() {
        let line = path(dome, effect, *way, Some(samples.clone()));
        ui.painter().add(Shape::line(line, Stroke::new(1.5, t.warn)));
    }
}

/// Where the axes end.
fn travel(ui: &Ui, dome: Dome, config: &Antenna, t: &Tokens) {
    let painter = ui.painter();
    if let Some(holes) = Keyholes::of(&config.mount) {
        grid::keyholes(painter, dome, &holes, t);
    }
    let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_from_deg, .. } = config.mount
    else {
        return;
    };
    if elevation_from_deg > 0.0 {
        let ring = dome.circle(dome.ring(elevation_from_deg as f32));
        painter.extend(dashed(&ring, 1.5, 4.0, Stroke::new(1.25, t.warn)));
    }
    if azimuth_to_deg - azimuth_from_deg < 360.0 {
        for end_deg in [azimuth_from_deg, azimuth_to_deg] {
            let azimuth = end_deg.to_radians() as f32;
            let spoke = [dome.at(azimuth, 87.0), dome.at(azimuth, 0.0)];
            painter.extend(dashed(&spoke, 1.5, 4.0, Stroke::new(1.25, t.warn)));
        }
    }
    for end_deg in [azimuth_from_deg, azimuth_to_deg] {
        let towards = outward(end_deg.to_radians() as f32);
        let foot = dome.centre + towards * dome.radius;
        let stroke = Stroke::new(3.0, t.bad);
        painter.line_segment([foot - towards * 12.0, foot + towards * 13.0], stroke);
        let across = towards.rot90() * 7.0;
        painter.line_segment([foot - across, foot + across], stroke);
    }
}

fn sun(
    ui: &Ui,
    rect: Rect,
    dome: Dome,
    model: &Model,
    skies: &Skies,
    state: &mut HorizonState,
    t: &Tokens,
) {
    let way = state.sun_way(model.station.site, model.now);
    let path = dome.path(way.iter().copied());
    // The way sets and rises: no line across the sky from the one to the other.
    for part in path.chunk_by(|a, b| a.distance(*b) < dome.radius / 4.0) {
        ui.painter().extend(dashed(part, 1.5, 4.0, Stroke::new(1.0, t.sun)));
    }
    let Some(direction) = model.sky.sun.filter(|sun| sun.elevation_deg() > 0.0) else { return };
    let Some(at) = dome.visible(direction) else { return };
    marks::sun(ui.painter(), at, t);
    let Some(avoidance) = skies.sun.kept() else { return };
    let radius = Angle::from_degrees(avoidance.radius_deg);
    let ring: Vec<Pos2> = around(direction, radius).filter_map(|of| dome.point(of)).collect();
    ui.painter().extend(dashed(&ring, 4.0, 3.0, Stroke::new(1.25, t.sun)));
    let words = format!("Sun {}", format::degrees(avoidance.radius_deg, 1));
    let beside = at + vec2(dome.length(radius).max(10.0) + 6.0, 0.0);
    if rect.contains(beside) {
        label(ui, beside, Align2::LEFT_CENTER, &words, t.sun, t);
    }
}

/// A circle on the sphere.
fn around(middle: AzEl, radius: Angle) -> impl Iterator<Item = AzEl> {
    let ahead = middle.to_enu();
    let quarter = Angle::from_degrees(90.0);
    let up = AzEl { elevation: middle.elevation + quarter, ..middle }.to_enu();
    let side = up.cross(ahead);
    let (sin, cos) = radius.radians().sin_cos();
    (0..=72_u8).map(move |step| {
        let (s, c) = (f64::from(step) * 5.0).to_radians().sin_cos();
        AzEl::from_enu(ahead * cos + (up * c + side * s) * sin)
    })
}

/// What a click or a drag on the sky itself does.
fn draw_on_canvas(
    ui: &Ui,
    canvas: &Response,
    dome: Dome,
    skies: &mut Skies,
    state: &mut HorizonState,
    antenna: Option<&Antenna>,
) {
    let Some(at) = canvas.interact_pointer_pos() else { return };
    let is_alt = ui.input(|input| input.modifiers.alt);
    let coarse = state.snaps;
    let direction = edit::snapped(edit::under(dome, at, 180.0), coarse);
    match state.tool {
        Tool::Select if canvas.clicked() => {
            if let (Chosen::Zone(index), true) = (state.chosen, is_alt)
                && let Some(zone) = skies.zones.get_mut(index)
                && let Some(edge) = zone.nearest_edge(dome, at)
                && let Some(added) = zone.split(edge)
            {
                let near = zone.corners.get(edge).map_or(180.0, |of| of.azimuth.kept());
                zone.put(added, edit::snapped(edit::under(dome, at, near), coarse));
                state.corner = Some(added);
                return;
            }
            let (azimuth_deg, elevation_deg) = edit::under(dome, at, 180.0);
            let direction = AzEl::from_degrees(azimuth_deg, elevation_deg);
            if let Some(found) = skies.zone_at(direction, |zone| holds_for(zone, antenna)) {
                state.choose(Chosen::Zone(found));
            }
        }
        Tool::Point if canvas.clicked() => {
            let mut points = skies.skyline();
            points.push(direction);
            if skies.set_skyline(points) {
                state.choose(Chosen::Skyline);
            }
        }
        Tool::Polygon => {
            let is_round = state.drawing.len() >= edit::FEWEST
                && state.drawing.first().is_some_and(|of| place(dome, *of).distance(at) < HANDLE);
            if canvas.double_clicked() || (canvas.clicked() && is_round) {
                let corners = std::mem::take(&mut state.drawing);
                add_zone(skies, state, &corners);
            } else if canvas.clicked() {
                let near = state.drawing.last().map_or(180.0, |last| last.0);
                state.drawing.push(edit::snapped(edit::under(dome, at, near), coarse));
                // Both clicks of a double click fall on one place.
                state.drawing.dedup();
            }
        }
        Tool::Rectangle => {
            if canvas.drag_started() {
                let press = ui.input(|input| input.pointer.press_origin()).unwrap_or(at);
                let from = edit::snapped(edit::under(dome, press, 180.0), coarse);
                state.drawing = vec![from, from];
            }
            if let Some(from) = state.drawing.first().copied() {
                let to = edit::snapped(edit::under(dome, at, from.0), coarse);
                state.drawing = vec![from, to];
                if canvas.drag_stopped() {
                    state.drawing.clear();
                    if let Some(corners) = edit::rectangle(from, to) {
                        add_zone(skies, state, &corners);
                    }
                }
            }
        }
        Tool::Select | Tool::Point => {}
    }
}

/// A new keep-out of at least three corners, chosen at once.
fn add_zone(skies: &mut Skies, state: &mut HorizonState, corners: &[(f64, f64)]) {
    if corners.len() < edit::FEWEST {
        return;
    }
    let name = skies.free_name("Keep-out");
    skies.zones.push(ZoneDraft::added(name, corners));
    state.choose(Chosen::Zone(skies.zones.len().saturating_sub(1)));
    state.tool = Tool::Select;
}

fn zone_handles(
    ui: &mut Ui,
    dome: Dome,
    index: usize,
    skies: &mut Skies,
    state: &mut HorizonState,
    t: &Tokens,
) {
    let Some(zone) = skies.zones.get_mut(index) else { return };
    for corner in 0..zone.corners.len() {
        let Some(middle) = zone.middle(corner) else { continue };
        let at = place(dome, middle);
        let name = format!("Middle of edge {} of {}", corner + 1, zone.name.trim());
        let response = handle(ui, ("middle", corner), at, &name);
        ui.painter().circle(at, MIDDLE / 2.0, t.bg0, Stroke::new(1.25, t.sat));
        if response.drag_started()
            && let Some(added) = zone.split(corner)
        {
            state.begin_drag(added, zone.corners.get(added).map(Corner::at));
            break;
        }
    }
    let count = zone.corners.len();
    let mut removed = None;
    let mut added = None;
    for number in 0..count {
        let Some(corner) = zone.corners.get(number) else { continue };
        let (azimuth_deg, elevation_deg) = corner.at();
        let at = place(dome, (azimuth_deg, elevation_deg));
        let words = direction((azimuth_deg, elevation_deg));
        let name = format!("Corner {} of {}, {words}", number + 1, zone.name.trim());
        let response = handle(ui, ("corner", number), at, &name);
        let is_chosen = state.corner == Some(number);
        if is_chosen {
            ui.painter().rect_filled(paint::square(at, CHOSEN), 0.0, t.sat);
            let side =
                if at.x > dome.centre.x { Align2::RIGHT_BOTTOM } else { Align2::LEFT_BOTTOM };
            let off = vec2(if at.x > dome.centre.x { -12.0 } else { 12.0 }, -6.0);
            let words = format!("{words}\npoint {} of {count}", number + 1);
            label(ui, at + off, side, &words, t.sat, t);
        } else {
            let stroke = Stroke::new(1.5, t.sat);
            ui.painter().rect(paint::square(at, HANDLE), 0.0, t.bg0, stroke, StrokeKind::Inside);
        }
        paint::focus_ring(ui, &response, 2);
        if response.clicked() || response.drag_started() {
            state.corner = Some(number);
            response.request_focus();
        }
        if response.drag_started() {
            state.begin_drag(number, Some((azimuth_deg, elevation_deg)));
        }
        if response.has_focus() {
            state.corner = Some(number);
            let (step, keys) = keys(ui, &response);
            if let Some((right, up)) = step
                && let Some(corner) = zone.corners.get_mut(number)
            {
                corner.azimuth.set(azimuth_deg + right);
                corner.elevation.set(elevation_deg + up);
            }
            removed = removed.or(keys.removes.then_some(number));
            added = added.or(keys.adds.then_some(number));
        }
    }
    if let Some(corner) = removed
        && zone.remove(corner)
    {
        state.corner = Some(corner.min(zone.corners.len().saturating_sub(1)));
    }
    if let Some(corner) = added.and_then(|corner| zone.split(corner)) {
        state.corner = Some(corner);
    }
}

fn skyline_handles(
    ui: &mut Ui,
    dome: Dome,
    skies: &mut Skies,
    state: &mut HorizonState,
    t: &Tokens,
) {
    let mut points = skies.skyline();
    if points.len() > MOST_HANDLES {
        return;
    }
    let mut changed = None;
    for (index, point) in points.iter().enumerate() {
        let at = place(dome, *point);
        let name = format!("Skyline point {}, {}", index + 1, direction(*point));
        let response = handle(ui, ("skyline", index), at, &name);
        let is_chosen = state.corner == Some(index);
        let fill = if is_chosen { t.sat } else { t.bg0 };
        let stroke = Stroke::new(1.5, if is_chosen { t.sat } else { t.t2 });
        ui.painter().circle(at, POINT / 2.0, fill, stroke);
        paint::focus_ring(ui, &response, 2);
        if response.clicked() || response.drag_started() {
            state.corner = Some(index);
            response.request_focus();
        }
        if response.drag_started() {
            state.begin_drag(index, Some(*point));
        }
        if response.has_focus() {
            let (step, keys) = keys(ui, &response);
            let moved = step.map(|(right, up)| Some((point.0 + right, point.1 + up)));
            changed = changed.or(moved.or(keys.removes.then_some(None)).map(|to| (index, to)));
        }
    }
    if let Some((index, to)) = changed {
        match to {
            Some(to) => {
                if let Some(point) = points.get_mut(index) {
                    *point = to;
                }
            }
            None => {
                points.remove(index);
            }
        }
        skies.set_skyline(points);
    }
}

/// A mark that can be dragged, clicked and reached with Tab.
fn handle(ui: &Ui, salt: (&str, usize), at: Pos2, name: &str) -> Response {
    let rect = paint::square(at, GRIP);
    let response = ui.interact(rect, ui.make_persistent_id(salt), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    response
}

struct Keys {
    removes: bool,
    adds: bool,
}

/// The step of an arrow key in degrees, and what else is asked for.
fn keys(ui: &Ui, response: &Response) -> (Option<(f64, f64)>, Keys) {
    let filter =
        EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    ui.input_mut(|input| {
        let mut step = None;
        for (modifiers, by) in
            [(Modifiers::NONE, 0.5), (Modifiers::SHIFT, 5.0), (Modifiers::COMMAND, 0.1)]
        {
            for (key, right, up) in [
                (Key::ArrowLeft, -1.0, 0.0),
                (Key::ArrowRight, 1.0, 0.0),
                (Key::ArrowUp, 0.0, 1.0),
                (Key::ArrowDown, 0.0, -1.0),
            ] {
                if input.modifiers.matches_exact(modifiers) && input.consume_key(modifiers, key) {
                    step = Some((right * by, up * by));
                }
            }
        }
        let keys = Keys {
            removes: input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace),
            adds: input.key_pressed(Key::Insert),
        };
        (step, keys)
    })
}

/// Moves what is being dragged to the pointer.
fn continue_drag(ui: &Ui, dome: Dome, skies: &mut Skies, state: &mut HorizonState) {
    let Some((index, from)) = state.drag else { return };
    let (at, is_down, shift) = ui.input(|input| {
        let pointer = &input.pointer;
        (pointer.interact_pos(), pointer.button_down(PointerButton::Primary), input.modifiers.shift)
    });
    if !is_down {
        state.drag = None;
        return;
    }
    let Some(at) = at else { return };
    let near = match state.chosen {
        Chosen::Zone(zone) => {
            let zone = skies.zones.get(zone);
            zone.and_then(|of| of.corners.get(index)).map_or(from.0, |of| of.azimuth.kept())
        }
        Chosen::Skyline | Chosen::Sun => from.0,
    };
    let mut to = edit::snapped(edit::under(dome, at, near), state.snaps);
    if shift {
        to = edit::along_one_axis(from, to);
    }
    match state.chosen {
        Chosen::Zone(zone) => {
            if let Some(zone) = skies.zones.get_mut(zone) {
                zone.put(index, to);
            }
        }
        Chosen::Skyline | Chosen::Sun => {
            let mut points = skies.skyline();
            if let Some(point) = points.get_mut(index) {
                *point = to;
            }
            if skies.set_skyline(points) {
                // They stay in the order of their azimuths.
                let azimuth_deg = to.0.rem_euclid(360.0);
                let place = skies.skyline().iter().position(|of| (of.0 - azimuth_deg).abs() < 1e-9);
                state.drag = place.map(|place| (place, from));
                state.corner = place;
            }
        }
    }
}

fn paint_drawing(ui: &Ui, dome: Dome, state: &HorizonState, t: &Tokens) {
    let corners = match (state.tool, &state.drawing[..]) {
        (Tool::Rectangle, [from, to]) => edit::rectangle(*from, *to).map(Vec::from),
        (Tool::Polygon, corners) => Some(corners.to_vec()),
        _ => None,
    };
    let mut path: Vec<Pos2> = corners.iter().flatten().map(|corner| place(dome, *corner)).collect();
    if state.tool == Tool::Rectangle {
        path.extend(path.first().copied());
    }
    for at in &path {
        let stroke = Stroke::new(1.5, t.sat);
        ui.painter().rect(paint::square(*at, HANDLE), 0.0, t.bg0, stroke, StrokeKind::Inside);
    }
    ui.painter().extend(dashed(&path, 4.0, 3.0, Stroke::new(1.5, t.sat)));
}

/// Words on a ground of their own.
fn label(ui: &Ui, at: Pos2, anchor: Align2, words: &str, colour: egui::Color32, t: &Tokens) {
    let galley = ui.painter().layout_no_wrap(words.to_owned(), text::small(), colour);
    let place = anchor.anchor_size(at, galley.size());
    ui.painter().rect_filled(place.expand(2.0), 0.0, t.sky);
    ui.painter().galley(place.min, galley, colour);
}

/// A direction in words.
pub(super) fn direction((azimuth_deg, elevation_deg): (f64, f64)) -> String {
    let azimuth = format::degrees(azimuth_deg, 1);
    format!("{azimuth}, {}", format::degrees(elevation_deg, 1))
}

fn show_legend(ui: &Ui, rect: Rect, dome: Dome, t: &Tokens) {
    type Sample = fn(&egui::Painter, Pos2, &Tokens);
    let rows: [(&str, Sample); 6] = [
        ("Horizon mask", legend::mask),
        ("Keep-out", legend::keep_out),
        ("Safety margin", legend::margin),
        ("End of travel", |painter, at, t| {
            let line = [at - vec2(10.0, 0.0), at + vec2(10.0, 0.0)];
            painter.extend(dashed(&line, 1.5, 4.0, Stroke::new(1.25, t.warn)));
        }),
        ("Sun avoidance", |painter, at, t| {
            painter.extend(dashed(&circle(at, 6.0), 3.0, 2.0, Stroke::new(1.25, t.sun)));
        }),
        ("Blocked part of a pass", |painter, at, t| {
            let line = [at - vec2(10.0, 0.0), at + vec2(10.0, 0.0)];
            painter.line_segment(line, Stroke::new(1.5, t.warn));
        }),
    ];
    let corner = rect.left_bottom() + vec2(12.0, -6.0 - ROW * rows.len() as f32);
    let row = |index: usize, name: &str| {
        let width = paint::text_width(ui, name, text::small()) + 30.0;
        Rect::from_min_size(corner + vec2(0.0, ROW * index as f32), vec2(width, ROW))
    };
    let is_over = |(index, (name, _)): (usize, &(&str, Sample))| {
        row(index, name).clamp(dome.centre).distance(dome.centre) < dome.radius + 4.0
    };
    if rows.iter().enumerate().any(is_over) {
        return;
    }
    for (index, (name, sample)) in rows.into_iter().enumerate() {
        let middle = corner + vec2(10.0, ROW * (index as f32 + 0.5));
        sample(ui.painter(), middle, t);
        let beside = middle + vec2(20.0, 0.0);
        ui.painter().text(beside, Align2::LEFT_CENTER, name, text::small(), t.t2);
    }
}
