//! The list of the pages with their numbers of edits. Search results replace the list.

use egui::{
    Align2, Color32, Frame, Key, Margin, Modifiers, Rect, Role, ScrollArea, Sense, Stroke,
    StrokeKind, TextEdit, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use jiff::Timestamp;

use super::{
    PADDING, Places, PreferencesState,
    draft::Draft,
    fields::Counts,
    file_block,
    form::FocusTarget,
    page::Page,
    search::{Found, Search, Spot, find},
};
use crate::{
    controller::SPECS,
    model::{Model, UiCommand},
    ui::{
        bar,
        icons::{self, Icon},
        text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            drop_down::DropDown,
            input::focus_to_replace,
            link_chip::LinkGlyph,
            list, paint,
        },
    },
};

pub(super) const WIDTH: f32 = 232.0;
pub(super) const SMALL_WIDTH: f32 = 160.0;
const ROW: f32 = 34.0;
const ANTENNA: f32 = 30.0;
const RESULT: f32 = 42.0;
const FIELD: f32 = 32.0;

/// Shows the list and changes the current page.
pub(super) fn show(
    ui: &mut Ui,
    places: &Places,
    model: &Model,
    (draft, before): (&mut Draft, &Draft),
    state: &mut PreferencesState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let rect = places.list;
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().vline(rect.right() - 0.5, rect.y_range(), (1.0, t.line));
    let (title, below) = rect.split_top_bottom_at_y(rect.top() + places.head);
    ui.painter().hline(title.x_range(), title.bottom() - 0.5, (1.0, t.line));
    let words = title.shrink2(vec2(PADDING, 0.0));
    if model.demo {
        // In the demonstration, all pages edit the new station. The other views show the demo
        // station.
        let (above, below) = words.shrink2(vec2(0.0, 4.0)).split_top_bottom_at_fraction(0.5);
        paint::text_in(ui, above, Align2::LEFT_CENTER, "Preferences", text::value(), t.t1);
        let name = "of your new station";
        paint::text_in(ui, below, Align2::LEFT_CENTER, name, text::small(), t.t2);
        paint::name_text(ui, "preferences of", words, &format!("Preferences {name}"));
    } else {
        paint::text_in(ui, words, Align2::LEFT_CENTER, "Preferences", text::value(), t.t1);
    }
    let field = below.with_max_y(below.top() + FIELD + 16.0).shrink(8.0);
    let takes_keys = search_field(ui, field, &mut state.search);
    let file = below.with_min_y(below.bottom() - file_block::height(below.width()));
    file_block::show(ui, file.with_max_x(file.right() - 1.0), model, commands);
    let rows = below.with_min_y(field.bottom() + 8.0).with_max_y(file.top());
    let rows = rows.with_max_x(below.right() - 1.0);
    let builder = UiBuilder::new().id_salt("pages").max_rect(rows);
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(rows.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            if state.search.text.trim().is_empty() {
                pages(ui, model, draft, before, state);
            } else {
                results(ui, draft, takes_keys, state);
            }
        });
    });
}

/// Shows the search field. Returns `true` while the field takes the keys.
fn search_field(ui: &mut Ui, rect: Rect, search: &mut Search) -> bool {
    let t = theme::tokens(ui);
    let frame = Frame::new()
        .fill(t.field)
        .stroke(Stroke::new(1.0, t.edge))
        .corner_radius(4)
        .inner_margin(Margin { left: 26, right: 24, top: 0, bottom: 0 });
    let id = ui.make_persistent_id("search of settings");
    let edit = TextEdit::singleline(&mut search.text)
        .id(id)
        .frame(frame)
        .font(text::body())
        .hint_text("Find a setting")
        .align(Align2::LEFT_CENTER)
        .min_size(rect.size())
        .desired_width(rect.width());
    let response = ui.place(rect, edit).accessible_name("Find a setting");
    let response = response.on_hover_text("Ctrl F");
    let glass = paint::square(pos2(rect.left() + 14.0, rect.center().y), 14.0);
    icons::paint(ui.painter(), glass, Icon::Search, t.t3);
    paint::focus_ring(ui, &response, 4);
    if std::mem::take(&mut search.wants_focus) {
        focus_to_replace(ui, &response, &search.text);
    }
    if response.changed() {
        search.chosen = 0;
    }
    // Enter ends the input in the same frame.
    let takes_keys = response.has_focus() || response.lost_focus();
    if search.text.is_empty() {
        return takes_keys;
    }
    let cross = paint::square(pos2(rect.right() - 14.0, rect.center().y), 20.0);
    let name = "Clear the search";
    let clear = paint::control(ui, "clear search", cross, Role::Button, true, name);
    icons::paint(ui.painter(), cross.shrink(4.0), Icon::Cross, t.t2);
    paint::focus_ring(ui, &clear, 3);
    if clear.clicked() {
        search.text.clear();
    }
    takes_keys
}

fn results(ui: &mut Ui, draft: &Draft, takes_keys: bool, state: &mut PreferencesState) {
    let t = theme::tokens(ui);
    let found = find(&state.search.text, draft);
    if found.is_empty() {
        let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
        let room = row.shrink2(vec2(PADDING, 0.0));
        let words = "No setting has that name.";
        paint::text_in(ui, room, Align2::LEFT_CENTER, words, text::small(), t.t2);
        paint::name_text(ui, "no result", room, words);
        return;
    }
    let last = found.len() - 1;
    let (up, down, enter) = ui.input_mut(|input| {
        let mut pressed = |key| takes_keys && input.consume_key(Modifiers::NONE, key);
        (pressed(Key::ArrowUp), pressed(Key::ArrowDown), pressed(Key::Enter))
    });
    let search = &mut state.search;
    search.chosen = search.chosen.saturating_sub(usize::from(up));
    search.chosen = (search.chosen + usize::from(down)).min(last);
    let mut accepted = found.get(search.chosen).filter(|_| enter).cloned();
    for (index, result) in found.into_iter().enumerate() {
        let title = result.page.title(draft);
        let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), RESULT), Sense::hover());
        let is_chosen = index == state.search.chosen;
        let name = format!("{}, {title}", result.label);
        let response = line(ui, ("result", index), row, Role::ListBoxOption, is_chosen, &name);
        let room = row.shrink2(vec2(PADDING, 4.0));
        let (above, below) = room.split_top_bottom_at_fraction(0.5);
        paint::text_in(ui, above, Align2::LEFT_CENTER, &result.label, text::body(), t.t1);
        paint::text_in(ui, below, Align2::LEFT_CENTER, &title, text::small(), t.t3);
        if response.on_hover_text(&name).clicked() {
            accepted = Some(result);
        }
    }
    if let Some(found) = accepted {
        go_to(found, state);
    }
}

fn go_to(found: Found, state: &mut PreferencesState) {
    let Found { page, label, spot } = found;
    state.page = page;
    state.search.text.clear();
    match spot {
        Spot::Field => state.form.focus_target = FocusTarget::new(label),
        Spot::Horizon(chosen) => state.horizon.open(chosen),
        Spot::Page => {}
    }
}

fn pages(
    ui: &mut Ui,
    model: &Model,
    draft: &mut Draft,
    before: &Draft,
    state: &mut PreferencesState,
) {
    let mut is_headed = false;
    for page in Page::all(draft) {
        let is_after_antennas = page == Page::Satellites;
        if !is_headed && (matches!(page, Page::Antenna(_)) || is_after_antennas) {
            is_headed = true;
            if let Some(added) = antennas_head(ui, draft, model.now) {
                state.page = added;
            }
            if is_after_antennas {
                no_antenna(ui);
            }
        }
        if page_row(ui, page, model, draft, before, state.page == page) {
            state.page = page;
        }
    }
}

fn no_antenna(ui: &mut Ui) {
    let t = theme::tokens(ui);
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let room = row.shrink2(vec2(PADDING, 0.0));
    let words = "No antenna yet. Add one.";
    paint::paragraph_in(ui, room, words, text::small(), t.t2);
    paint::name_text(ui, "no antenna", room, words);
}

/// Shows the heading of the antennas with the button that adds one. Returns the page of a new
/// antenna.
fn antennas_head(ui: &mut Ui, draft: &mut Draft, now: Timestamp) -> Option<Page> {
    let t = theme::tokens(ui);
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let room = row.shrink2(vec2(PADDING, 0.0));
    paint::text_in(ui, room, Align2::LEFT_CENTER, "Antennas", text::small(), t.t3);
    let button = Button::normal("Add");
    let add = DropDown { button, salt: "add antenna", name: "Add an antenna" };
    let width = add.width(ui);
    let right = row.right() - 12.0;
    let place = Rect::from_center_size(
        pos2(right - width / 2.0, row.center().y),
        vec2(width, SMALL_HEIGHT),
    );
    let mut added = None;
    add.show(ui, place, |ui| {
        for spec in SPECS {
            if ui.button(format!("Add {}", spec.name)).clicked() {
                added = Some(draft.add_antenna(spec, now));
            }
        }
    });
    added.map(Page::Antenna)
}

fn page_row(
    ui: &mut Ui,
    page: Page,
    model: &Model,
    draft: &Draft,
    before: &Draft,
    is_chosen: bool,
) -> bool {
    let t = theme::tokens(ui);
    let title = page.title(draft);
    let height = if matches!(page, Page::Antenna(_)) { ANTENNA } else { ROW };
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let response = line(ui, ("page", &title), row, Role::RadioButton, is_chosen, &title);
    let mut room = row.with_min_x(row.left() + PADDING).with_max_x(row.right() - 12.0);
    let mut colour = t.t1;
    if let Page::Antenna(id) = page {
        let indent = if row.width() < WIDTH - 8.0 { 4.0 } else { 20.0 };
        let glyph =
            model.antenna_of(id).map_or(LinkGlyph::Off, |antenna| bar::glyph(model, antenna));
        let (icon, ink) = glyph.look(t);
        let position = pos2(room.left() + indent + 6.0, room.center().y);
        icons::paint(ui.painter(), paint::square(position, 12.0), icon, ink);
        room = room.with_min_x(position.x + 14.0);
        if draft.index(id).is_some_and(|index| draft.is_removed(index)) {
            colour = t.t3;
        }
    }
    let counts = page.counts(draft, before);
    room = room.with_max_x(tags(ui, room, &title, counts) - 4.0);
    let font = if is_chosen { text::body_medium() } else { text::body() };
    paint::paragraph_in(ui, room, &title, font, colour);
    response.clicked()
}

/// Draws a selectable row with its background.
fn line(
    ui: &Ui,
    salt: impl egui::AsIdSalt,
    row: Rect,
    role: Role,
    is_chosen: bool,
    name: &str,
) -> egui::Response {
    let response = paint::control(ui, salt, row, role, true, name);
    response.widget_info(|| WidgetInfo::selected(role, true, is_chosen, name));
    list::paint_ground(ui, row, is_chosen, response.hovered());
    paint::focus_ring(ui, &response, 0);
    response
}

/// Draws the numbers of edited and invalid fields at the right end of a row. Returns their left
/// end.
fn tags(ui: &Ui, room: Rect, title: &str, counts: Counts) -> f32 {
    let t = theme::tokens(ui);
    let mut right = room.right();
    let mut sentences = Vec::new();
    for (number, colour, word) in
        [(counts.edited, t.sat, "edited"), (counts.wrong, t.bad, "not valid")]
    {
        if number > 0 {
            right = tag(ui, pos2(right, room.center().y), number, colour) - 4.0;
            sentences.push(format!("{number} {word}"));
        }
    }
    if !sentences.is_empty() {
        let place = room.with_min_x(right);
        paint::name_text(ui, ("tags", title), place, &format!("{title}: {}", sentences.join(", ")));
    }
    right
}

fn tag(ui: &Ui, right: egui::Pos2, number: usize, colour: Color32) -> f32 {
    let words = number.to_string();
    let width = (paint::text_width(ui, &words, text::small_strong()) + 10.0).max(19.0);
    let rect = Rect::from_min_max(right - vec2(width, 9.0), right + vec2(0.0, 9.0));
    ui.painter().rect_stroke(rect, 3, Stroke::new(1.0, colour), StrokeKind::Inside);
    paint::text_in(ui, rect, Align2::CENTER_CENTER, &words, text::small_strong(), colour);
    rect.left()
}
