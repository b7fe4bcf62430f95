//! Sources of elements, one row each.

use std::sync::Arc;

use egui::{
    Align2, Color32, Popup, Rect, Role, ScrollArea, Sense, Stroke, StrokeKind, Ui, UiBuilder, pos2,
    vec2,
};

use super::{ElementsState, PADDING, source_password::SourcePassword, words};
use crate::{
    astro::time::seconds_between,
    contract::{self, CatalogState, passes::ListedSatellite},
    model::{Model, UiCommand},
    orbit::{BUNDLED_NEWEST, BUNDLED_SOURCE, RefreshHours, Source, SourcePlace, SourceReport},
    ui::{
        confirm::Question,
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::{button::Button, menu, paint, status_line::Tone},
    },
};

const BAR: f32 = 32.0;
const HEAD: f32 = 22.0;
const ROW: f32 = 25.0;
/// Offered intervals between two automatic requests, hours.
const REFRESH_HOURS: [u32; 5] = [2, 4, 6, 12, 24];
/// Max number of rows before the list scrolls.
const MAX_ROWS: usize = 7;
/// View height below which the sources stay folded until the operator opens them, points.
const FOLDED_BELOW: f32 = 760.0;
/// Table width that the column positions refer to, points.
const WIDTH: f32 = 1024.0;

/// Ends of the columns in a table of width [`WIDTH`], points.
const NAME: f32 = 38.0;
const WHERE: f32 = 196.0;
const PASSWORD: f32 = 288.0;
const STATE: f32 = 384.0;
const NEWEST: f32 = 670.0;
const OBJECTS: f32 = 744.0;
const IN_USE: f32 = 816.0;
const NEXT: f32 = 826.0;
const ASK: f32 = 940.0;
const REMOVE: f32 = 996.0;

/// Returns the height of the sources in a view of height `max_height`, points.
pub(super) fn height(model: &Model, state: &ElementsState, max_height: f32) -> f32 {
    if !is_open(state, max_height) {
        return BAR;
    }
    let rows = (model.sources.list.len() + 1).min(MAX_ROWS);
    BAR + HEAD + rows as f32 * ROW
}

fn is_open(state: &ElementsState, max_height: f32) -> bool {
    state.sources_are_open.unwrap_or(max_height >= FOLDED_BELOW)
}

/// Draws the sources into `rect`, in a view of height `max_height`.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    max_height: f32,
    model: &Model,
    state: &mut ElementsState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (bar, rest) = rect.split_top_bottom_at_y(rect.top() + BAR);
    let is_open = is_open(state, max_height);
    if show_bar(ui, bar, model, is_open) {
        state.sources_are_open = Some(!is_open);
    }
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    if !is_open {
        return;
    }
    let (head, body) = rest.split_top_bottom_at_y(rest.top() + HEAD);
    show_head(ui, head);
    ui.scope_builder(UiBuilder::new().id_salt("sources").max_rect(body), |ui| {
        ui.set_clip_rect(body.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        ScrollArea::vertical().id_salt("sources").auto_shrink(false).show(ui, |ui| {
            let in_use = in_use(model);
            for (index, source) in model.sources.list.iter().enumerate() {
                let (_, place) = ui.allocate_space(vec2(body.width(), ROW));
                let report = model.sources.reports.get(index);
                let row = Row { place, source, report, in_use: count(&in_use, &source.name) };
                row.show(ui, model, &mut state.source_password, question, commands);
            }
            let (_, place) = ui.allocate_space(vec2(body.width(), ROW));
            bundled(ui, place, count(&in_use, BUNDLED_SOURCE), model);
        });
    });
}

/// Draws the bar; returns `true` when the operator folds or unfolds the sources.
fn show_bar(ui: &Ui, rect: Rect, model: &Model, is_open: bool) -> bool {
    let t = theme::tokens(ui);
    let count = format::counted(model.sources.list.len() + 1, "source");
    let (tone, words) = worst(model);
    let name = format!("{count}: {words}");
    let response = paint::control(ui, "sources bar", rect, Role::Button, true, &name);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_expanded(is_open));
    ui.painter().rect_filled(rect, 0.0, if response.hovered() { t.bg3 } else { t.bg1 });
    let icon = if is_open { Icon::ChevronDown } else { Icon::ChevronRight };
    let position = pos2(rect.left() + PADDING + 4.0, rect.center().y);
    icons::paint(ui.painter(), paint::square(position, 12.0), icon, t.t2);
    let room = rect.with_min_x(position.x + 14.0).with_max_x(rect.right() - PADDING);
    let font = text::sized(13.0, Weight::SemiBold);
    let title = paint::text_in(ui, room, Align2::LEFT_CENTER, &count, font, t.t1);
    let (mark, colour) = look(tone, ui);
    let position = pos2(title.right() + 18.0, rect.center().y);
    if tone != Tone::Plain {
        icons::paint(ui.painter(), paint::square(position, 12.0), mark, colour);
    }
    let room =
        room.with_min_x(if tone == Tone::Plain { position.x - 6.0 } else { position.x + 10.0 });
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::small(), colour);
    paint::focus_ring(ui, &response, 0);
    response.clicked()
}

/// Returns the most severe state of the sources and of the elements in use.
fn worst(model: &Model) -> (Tone, String) {
    let sources = &model.sources;
    let bundled = state_of_bundled(model);
    let states: Vec<(Tone, &str)> = (sources.list.iter().enumerate())
        .map(|(index, source)| {
            let (tone, _) = words::state(source, sources.reports.get(index), model.now);
            (tone, source.name.as_str())
        })
        .collect();
    for tone in [Tone::Bad, Tone::Caution] {
        let names: Vec<&str> = states
            .iter()
            .filter(|(state_tone, _)| *state_tone == tone)
            .map(|(_, name)| *name)
            .collect();
        if !names.is_empty() {
            let words = if names.len() == 1 { "needs attention" } else { "need attention" };
            let attention = format!("{} {words}", format::list(&names));
            return match bundled {
                Some((Tone::Bad, state)) => (Tone::Bad, format!("{state} {attention}.")),
                Some((_, state)) => (tone, format!("{attention}. {state}")),
                None => (tone, attention),
            };
        }
    }
    let request = || (Tone::Plain, "A server is asked at most once every 2 h.".to_owned());
    bundled.unwrap_or_else(request)
}

/// Returns the state of the elements that come with Azel, by the favourites that use them; `None`
/// if none does. Without favourites, these elements are in use while no source holds any.
fn state_of_bundled(model: &Model) -> Option<(Tone, String)> {
    let in_use = "The elements that come with Azel are in use";
    let favourites = &model.pass_lists.favourites.satellites;
    if favourites.is_empty() {
        let is_alone = model.sources.reports.iter().all(|report| report.newest_epoch.is_none());
        return is_alone.then(|| (Tone::Plain, format!("{in_use}.")));
    }
    let CatalogState::Ready(catalog) = &model.catalog else { return None };
    let is_bundled = |listed: &&Arc<ListedSatellite>| {
        catalog.source_of(listed.elements.catalog_number()) == Some(BUNDLED_SOURCE)
    };
    let used: Vec<&Arc<ListedSatellite>> = favourites.iter().filter(is_bundled).collect();
    let all = favourites.len();
    let (in_use, joint) = match used.len() {
        0 => return None,
        some if some < all => (format!("{in_use} for {some} of {all} favourites"), ","),
        _ => (in_use.to_owned(), ":"),
    };
    for (tone, word) in [(Tone::Bad, "too old"), (Tone::Caution, "getting old")] {
        let is_so =
            |listed: &&&Arc<ListedSatellite>| words::age_tone(&listed.elements, model.now) == tone;
        let count = used.iter().filter(is_so).count();
        if count > 0 {
            let subset = if used.len() < all {
                format!("{count} of them")
            } else {
                format!("{count} of {all} favourites")
            };
            return Some((tone, format!("{in_use}{joint} {word} for {subset}.")));
        }
    }
    Some((Tone::Plain, format!("{in_use}.")))
}

fn look(tone: Tone, ui: &Ui) -> (Icon, Color32) {
    let t = theme::tokens(ui);
    match tone {
        Tone::Good => (Icon::Check, t.ok),
        Tone::Caution => (Icon::Warning, t.warn),
        Tone::Bad => (Icon::Cross, t.bad),
        Tone::Plain | Tone::Now => (Icon::Dash, t.t2),
    }
}

/// Returns the part of a row between two ends of the layout.
fn segment(row: Rect, start: f32, end: f32) -> Rect {
    let scale = row.width() / WIDTH;
    row.with_min_x(row.left() + start * scale).with_max_x(row.left() + end * scale)
}

fn show_head(ui: &Ui, rect: Rect) {
    let t = theme::tokens(ui);
    let head = |words, start, end, anchor| {
        paint::text_in(ui, segment(rect, start, end), anchor, words, text::caption(), t.t3);
    };
    head("Name", NAME, WHERE, Align2::LEFT_CENTER);
    head("Where", WHERE, STATE, Align2::LEFT_CENTER);
    head("Last fetch", STATE, NEWEST - 124.0, Align2::LEFT_CENTER);
    head("Newest set", NEWEST - 124.0, NEWEST, Align2::RIGHT_CENTER);
    head("Objects", OBJECTS - 76.0, OBJECTS, Align2::RIGHT_CENTER);
    head("In use", IN_USE - 50.0, IN_USE, Align2::RIGHT_CENTER);
    head("Next", NEXT, ASK, Align2::LEFT_CENTER);
}

fn in_use(model: &Model) -> Vec<(&str, usize)> {
    match &model.catalog {
        CatalogState::Ready(catalog) => catalog.in_use(),
        CatalogState::Loading | CatalogState::Failed => Vec::new(),
    }
}

fn count(in_use: &[(&str, usize)], name: &str) -> usize {
    in_use.iter().find(|(subject, _)| *subject == name).map_or(0, |(_, count)| *count)
}

struct Row<'a> {
    place: Rect,
    source: &'a Source,
    report: Option<&'a SourceReport>,
    in_use: usize,
}

impl Row<'_> {
    fn show(
        &self,
        ui: &mut Ui,
        model: &Model,
        password: &mut SourcePassword,
        question: &mut Option<Question>,
        commands: &mut Vec<UiCommand>,
    ) {
        let (now, source, report) = (model.now, self.source, self.report);
        let icon = match source.place {
            SourcePlace::Web(_) | SourcePlace::SpaceTrack(_) => Icon::Server,
            SourcePlace::File(_) => Icon::File,
            SourcePlace::Folder(_) => Icon::Folder,
        };
        let sentences = words::sentences(source, report, now);
        let sentences: Vec<String> = sentences.into_iter().map(|(_, words)| words).collect();
        let spoken = format!("{}, {}. {}", source.name, words::place(source), sentences.join(" "));
        let cells = Cells {
            icon,
            name: &source.name,
            place: &words::place(source),
            place_end: if has_password(source) { PASSWORD } else { STATE },
            state: words::state(source, report, now),
            newest: report.and_then(|report| report.newest_epoch),
            objects: report.map_or(0, SourceReport::objects),
            in_use: self.in_use,
            next: &words::next(source, report, now),
            is_due: words::is_due(source, report, now),
        };
        let label = cells.show(ui, self.place, &source.name, &spoken, model);
        label.on_hover_text(format!("{}\n{}", words::place(source), sentences.join("\n")));
        if has_password(source) {
            self.password(ui, words::sources_lock(model), password);
        }
        self.buttons(ui, model, question, commands);
    }

    /// Shows the button that opens the dialog for the password.
    fn password(&self, ui: &Ui, lock: Option<&str>, password: &mut SourcePassword) {
        let room = segment(self.place, PASSWORD, STATE - 8.0);
        let place = Rect::from_center_size(room.center(), vec2(room.width(), 20.0));
        let spoken = format!("Password of {}", self.source.name);
        if small_button(ui, place, lock, "Password", &spoken) {
            password.open(self.source);
        }
    }

    fn buttons(
        &self,
        ui: &Ui,
        model: &Model,
        question: &mut Option<Question>,
        commands: &mut Vec<UiCommand>,
    ) {
        let name = &self.source.name;
        let lock = words::sources_lock(model);
        let is_free = lock.is_none();
        let scale = self.place.width() / WIDTH;
        let rect = |x: f32, width: f32| {
            let min = pos2(self.place.left() + x * scale, self.place.center().y - 10.0);
            Rect::from_min_size(min, vec2(width, 20.0))
        };
        if self.source.place.is_server() {
            self.refresh(ui, lock, commands);
        }
        let (word, spoken) = match self.source.place {
            SourcePlace::Web(_) | SourcePlace::SpaceTrack(_) => ("Fetch", format!("Fetch {name}")),
            SourcePlace::File(_) | SourcePlace::Folder(_) => ("Read", format!("Read {name} again")),
        };
        let pause = words::pause(self.report, model.now);
        let fetch_lock = lock.or(pause.as_deref());
        if small_button(ui, rect(ASK, 48.0), fetch_lock, word, &spoken) {
            let again = words::ask_again(name, self.report, model.now);
            let forced = again.is_some();
            let command = UiCommand::Station(contract::Command::RefreshSources {
                names: vec![name.clone()],
                forced,
            });
            match again {
                Some(text) => *question = Some(Question { text, yes: "Fetch", command }),
                None => commands.push(command),
            }
        }
        let place = rect(REMOVE, 20.0);
        let spoken = format!("Remove {name}");
        let response = paint::control(ui, ("remove", name), place, Role::Button, is_free, &spoken);
        let t = theme::tokens(ui);
        let colour = if response.hovered() && is_free { t.t1 } else { t.t3 };
        icons::paint(ui.painter(), paint::square(place.center(), 12.0), Icon::Cross, colour);
        paint::focus_ring(ui, &response, 3);
        if response.on_hover_text(lock.unwrap_or(&spoken)).clicked() {
            *question = Some(Question {
                text: format!("Remove the source {name}? Its elements will no longer be used."),
                yes: "Remove",
                command: UiCommand::Station(contract::Command::RemoveSource(name.clone())),
            });
        }
    }
}

impl Row<'_> {
    /// Shows the time of the next request to the server. A click on it offers regular requests.
    fn refresh(&self, ui: &Ui, lock: Option<&str>, commands: &mut Vec<UiCommand>) {
        let Source { name, refresh, .. } = self.source;
        let place = segment(self.place, NEXT - 4.0, ASK - 4.0).shrink2(vec2(0.0, 2.0));
        let spoken = format!("Refresh of {name}: {}", words::refresh(*refresh));
        let is_free = lock.is_none();
        let response =
            paint::control(ui, ("refresh", name), place, Role::ComboBox, is_free, &spoken);
        let t = theme::tokens(ui);
        if response.hovered() && is_free {
            let stroke = Stroke::new(1.0, t.edge);
            ui.painter().rect_stroke(place, 4, stroke, StrokeKind::Inside);
        }
        let position = pos2(place.right() - 8.0, place.center().y);
        let colour = if is_free { t.t2 } else { t.t3 };
        icons::paint(ui.painter(), paint::square(position, 10.0), Icon::ChevronDown, colour);
        paint::focus_ring(ui, &response, 4);
        let response = match lock {
            Some(reason) => response.on_hover_text(reason),
            None => response,
        };
        menu::show(&response, Popup::menu(&response).accessible_name(&spoken), |ui| {
            let hours = REFRESH_HOURS.map(|hours| Some(RefreshHours::from(hours)));
            for hours in [None].into_iter().chain(hours) {
                let choice = egui::Button::selectable(hours == *refresh, words::refresh(hours));
                if ui.add(choice).clicked() && hours != *refresh {
                    let command = contract::Command::SetRefresh { name: name.clone(), hours };
                    commands.push(UiCommand::Station(command));
                }
            }
        });
    }
}

/// Texts of a row for any source.
struct Cells<'a> {
    icon: Icon,
    name: &'a str,
    place: &'a str,
    /// End of the place in the layout, points.
    place_end: f32,
    state: (Tone, String),
    newest: Option<jiff::Timestamp>,
    objects: usize,
    in_use: usize,
    next: &'a str,
    is_due: bool,
}

impl Cells<'_> {
    fn show(&self, ui: &Ui, row: Rect, salt: &str, spoken: &str, model: &Model) -> egui::Response {
        let t = theme::tokens(ui);
        ui.painter().hline(row.x_range(), row.bottom() - 0.5, (1.0, t.line));
        let rect = paint::square(pos2(row.left() + PADDING + 7.0, row.center().y), 14.0);
        icons::paint(ui.painter(), rect, self.icon, t.t2);
        let left = |start, end, words: &str, font, colour| {
            let room = segment(row, start, end - 8.0);
            paint::text_in(ui, room, Align2::LEFT_CENTER, words, font, colour)
        };
        let right = |end: f32, words: &str, colour| {
            let room = segment(row, end - 84.0, end);
            paint::text_in(ui, room, Align2::RIGHT_CENTER, words, text::small(), colour)
        };
        left(NAME, WHERE, self.name, text::body_medium(), t.t1);
        left(WHERE, self.place_end, self.place, text::small(), t.t2);
        let (tone, words) = &self.state;
        let (mark, colour) = look(*tone, ui);
        let position = segment(row, STATE, WIDTH).left() + 6.0;
        icons::paint(
            ui.painter(),
            paint::square(pos2(position, row.center().y), 12.0),
            mark,
            colour,
        );
        let colour = if *tone == Tone::Good { t.t1 } else { colour };
        left(STATE + 18.0, NEWEST - 84.0, words, text::small(), colour);
        if let Some(newest) = self.newest {
            let age_s = seconds_between(newest, model.now);
            let colour = if age_s > crate::ui::words::OLD_ELEMENTS_S { t.warn } else { t.t1 };
            right(NEWEST, &words::age(age_s), colour);
        }
        right(OBJECTS, &format::number(self.objects as f64, 0), t.t1);
        let colour = if self.in_use == 0 { t.t3 } else { t.t1 };
        right(IN_USE, &format::number(self.in_use as f64, 0), colour);
        let colour = if self.is_due { t.sat } else { t.t2 };
        left(NEXT, ASK, self.next, text::small(), colour);
        let words = row.with_max_x(segment(row, 0.0, ASK).right());
        let response = ui.interact(words, ui.make_persistent_id(("source", salt)), Sense::hover());
        response.widget_info(|| egui::WidgetInfo::labeled(Role::Label, true, spoken));
        response
    }
}

fn bundled(ui: &Ui, row: Rect, in_use: usize, model: &Model) {
    let objects = match &model.catalog {
        CatalogState::Ready(catalog) => {
            count(&catalog.groups().collect::<Vec<_>>(), BUNDLED_SOURCE)
        }
        CatalogState::Loading | CatalogState::Failed => 0,
    };
    let cells = Cells {
        icon: Icon::Package,
        name: BUNDLED_SOURCE,
        place: "comes with Azel",
        place_end: STATE,
        state: (Tone::Plain, "not fetched".to_owned()),
        newest: Some(BUNDLED_NEWEST),
        objects,
        in_use,
        next: "never",
        is_due: false,
    };
    let spoken = format!("{BUNDLED_SOURCE}, comes with Azel, {}", words::objects(objects));
    cells.show(ui, row, BUNDLED_SOURCE, &spoken, model);
}

/// Returns `true` if the server of the source takes a password.
fn has_password(source: &Source) -> bool {
    matches!(source.place, SourcePlace::SpaceTrack(_))
}

fn small_button(ui: &Ui, place: Rect, lock: Option<&str>, word: &str, name: &str) -> bool {
    let response = Button::normal(word).locked_by(lock).show(ui, name, place);
    response.widget_info(|| egui::WidgetInfo::labeled(Role::Button, lock.is_none(), name));
    response.clicked()
}
