//! Intake of files held over the window and of dropped, pasted or chosen elements: the content of
//! each, and the choice to keep it.

use std::path::{Path, PathBuf};

use egui::{Align2, Event, Key, Popup, Rect, Shape, Stroke, Ui, pos2, vec2};

use super::{ElementsState, PADDING, words};
use crate::{
    contract,
    contract::sources::check_source,
    model::{
        Model, UiCommand,
        intake::{Counts, Intake, Judged, Offer},
    },
    orbit::{Source, SourcePlace},
    ui::{
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
        words::sentence,
    },
};

const ROW: f32 = 30.0;
const LINE: f32 = 18.0;
/// Max width of the card, points.
const WIDEST: f32 = 900.0;
const CHOICES: f32 = 260.0;

/// Takes files held over the window or dropped, and pasted text. Esc, which also sends STOP, closes
/// the card if nothing is open above it.
pub(super) fn take(
    ui: &Ui,
    model: &Model,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    let (hovered, dropped, pasted) = ui.input(|input| {
        let hovered = input.raw.hovered_files.iter().filter_map(|file| file.path.clone());
        let dropped = input.raw.dropped_files.iter().map(|file| file.path().to_path_buf());
        let pasted = input.events.iter().find_map(|event| match event {
            Event::Paste(text) => Some(text.as_str().into()),
            _ => None,
        });
        (hovered.collect::<Vec<_>>(), dropped.collect::<Vec<_>>(), pasted)
    });
    let files = |paths: &[PathBuf]| paths.iter().cloned().map(Offer::File).collect();
    let is_open = model.intake.as_ref().is_some_and(|intake| intake.is_dropped);
    if !dropped.is_empty() {
        commands.push(UiCommand::OfferElements { offers: files(&dropped), is_dropped: true });
    } else if let Some(text) = pasted.filter(|_| !ui.text_edit_focused()) {
        let offers = vec![Offer::Text(text)];
        commands.push(UiCommand::OfferElements { offers, is_dropped: true });
    } else if hovered != state.hovered && !is_open {
        commands.push(if hovered.is_empty() {
            UiCommand::LeaveElements
        } else {
            UiCommand::OfferElements { offers: files(&hovered), is_dropped: false }
        });
    }
    state.hovered = hovered;
    let is_above =
        || Popup::is_any_open(ui) || ui.memory(|memory| memory.top_modal_layer().is_some());
    if is_open && ui.input(|input| input.key_pressed(Key::Escape)) && !is_above() {
        commands.push(UiCommand::LeaveElements);
    }
}

/// Draws the card into the main part of the view.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    intake: &Intake,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let field = rect.shrink(PADDING);
    let judged = intake.judged.as_deref();
    let is_useless = judged.is_some_and(|all| !all.iter().any(Judged::is_usable));
    let border = if is_useless { t.bad } else { t.sat };
    dashes(ui, field, Stroke::new(2.0, border));
    let count = format::counted(intake.offers.len(), "file");
    let title = match (is_useless, intake.is_dropped) {
        (true, _) => "None of these files holds elements".to_owned(),
        (false, false) => format!("Release to read {count}"),
        (false, true) => "What should be imported?".to_owned(),
    };
    let more = if intake.is_dropped {
        "Keep a file as a source, to be read again whenever you ask, or take what it holds now. \
         Nothing changes before that."
    } else {
        "Then you choose for each. Nothing changes before that. Move the files out of the window \
         to cancel."
    };
    let icon = paint::square(pos2(field.center().x, field.top() + 56.0), 34.0);
    icons::paint(ui.painter(), icon, Icon::Orbit, border);
    let line = |y: f32| {
        Rect::from_x_y_ranges(
            field.x_range().shrink(PADDING),
            field.top() + y..=field.top() + y + 26.0,
        )
    };
    let font = text::sized(18.0, Weight::SemiBold);
    paint::text_in(ui, line(84.0), Align2::CENTER_CENTER, &title, font, t.t1);
    paint::text_in(ui, line(112.0), Align2::CENTER_CENTER, more, text::small(), t.t2);
    paint::name_text(ui, "intake", line(84.0), &format!("{title}. {more}"));
    let width = (field.width() - 4.0 * PADDING).min(WIDEST);
    let left = field.center().x - width / 2.0;
    let mut y = field.top() + 152.0;
    for (index, offer) in intake.offers.iter().enumerate() {
        let found = judged.and_then(|all| all.get(index));
        let refused = match found {
            Some(Judged::Elements(counts)) => counts.refused.len(),
            _ => 0,
        };
        let height = ROW + refused as f32 * LINE;
        let row = Rect::from_min_size(pos2(left, y), vec2(width, height));
        if row.bottom() > field.bottom() - 2.0 * ROW {
            break;
        }
        let shown = Shown { model, index, offer, found, can_choose: intake.is_dropped };
        shown.show(ui, row, state, commands);
        y = row.bottom();
    }
    if intake.is_dropped {
        let cancel = Button::normal("Close");
        let size = vec2(cancel.width(ui), SMALL_HEIGHT);
        let position = pos2(left + width - size.x, y + 12.0);
        if cancel.show(ui, "close intake", Rect::from_min_size(position, size)).clicked() {
            state.shown.clear();
            commands.push(UiCommand::LeaveElements);
        }
    }
}

fn dashes(ui: &Ui, rect: Rect, stroke: Stroke) {
    let corners = [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()];
    let path: Vec<_> = corners.into_iter().chain([rect.left_top()]).collect();
    ui.painter().extend(Shape::dashed_line(&path, stroke, 6.0, 4.0));
}

/// Offer with its judgement, as the card shows it.
struct Shown<'a> {
    model: &'a Model,
    index: usize,
    offer: &'a Offer,
    found: Option<&'a Judged>,
    can_choose: bool,
}

impl Shown<'_> {
    fn show(&self, ui: &Ui, rect: Rect, state: &mut ElementsState, commands: &mut Vec<UiCommand>) {
        let t = theme::tokens(ui);
        let row = rect.with_max_y(rect.top() + ROW);
        ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
        let name = self.offer.name();
        let room = row.with_min_x(row.left() + 22.0).with_max_x(row.left() + 220.0);
        let area = paint::square(pos2(row.left() + 8.0, row.center().y), 14.0);
        icons::paint(ui.painter(), area, Icon::File, t.t2);
        paint::text_in(ui, room, Align2::LEFT_CENTER, &name, text::body_medium(), t.t1);
        let (icon, colour, words) = match self.found {
            None => (None, t.t2, "is being read".to_owned()),
            Some(Judged::Unreadable(reason)) => {
                (Some(Icon::Cross), t.bad, sentence(&format!("it cannot be read: {reason}")))
            }
            Some(Judged::Nothing(nothing)) => {
                (Some(Icon::Cross), t.bad, format!("Left out: {nothing}."))
            }
            Some(found @ Judged::Elements(counts)) => {
                let icon = if found.is_usable() { Icon::Check } else { Icon::Cross };
                let colour = if found.is_usable() { t.t1 } else { t.bad };
                (Some(icon), colour, holds(counts))
            }
        };
        if let Some(icon) = icon {
            let colour = if icon == Icon::Check { t.ok } else { t.bad };
            let area = paint::square(pos2(row.left() + 240.0, row.center().y), 12.0);
            icons::paint(ui.painter(), area, icon, colour);
        }
        let right = if self.can_choose { row.right() - CHOICES } else { row.right() };
        let room = row.with_min_x(row.left() + 254.0).with_max_x(right);
        paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::small(), colour);
        let spoken = format!("{name}: {words}");
        paint::name_text(ui, ("offer", self.index), row.with_max_x(right), &spoken)
            .on_hover_text(&spoken);
        self.refused(ui, rect);
        if self.can_choose && self.found.is_some_and(Judged::is_usable) {
            self.choices(ui, row, state, commands);
        }
    }

    /// Shows the first refused records, with place and reason.
    fn refused(&self, ui: &Ui, rect: Rect) {
        let Some(Judged::Elements(counts)) = self.found else { return };
        let t = theme::tokens(ui);
        for (line, refusal) in counts.refused.iter().enumerate() {
            let min = pos2(rect.left() + 254.0, rect.top() + ROW - 4.0 + line as f32 * LINE);
            let room = Rect::from_min_max(min, pos2(rect.right(), min.y + LINE));
            let object = refusal.object.as_deref().unwrap_or("unnamed object");
            let words = format!("line {}: {object}: {}", refusal.line, refusal.reason);
            paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::small(), t.warn);
            paint::name_text(ui, ("refused offer", self.index, line), room, &words);
        }
    }

    fn choices(
        &self,
        ui: &Ui,
        row: Rect,
        state: &mut ElementsState,
        commands: &mut Vec<UiCommand>,
    ) {
        let t = theme::tokens(ui);
        let mut right = row.right();
        if state.shown.contains(&self.index) {
            let room = row.with_min_x(right - CHOICES);
            paint::text_in(ui, room, Align2::RIGHT_CENTER, "taken", text::small(), t.ok);
            return;
        }
        let lock = words::sources_lock(self.model);
        let name = self.offer.name();
        let mut button = |word: &str| {
            let button = Button::normal(word).locked_by(lock);
            let width = button.width(ui);
            let min = pos2(right - width, row.center().y - SMALL_HEIGHT / 2.0);
            right = min.x - 8.0;
            let place = Rect::from_min_size(min, vec2(width, SMALL_HEIGHT));
            let response = button.show(ui, (word, self.index), place);
            let spoken = format!("{word}: {name}");
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Button, lock.is_none(), &spoken)
            });
            response.clicked()
        };
        let source = free_name(self.offer, self.model);
        if button("Read once") {
            let offer = match self.offer {
                Offer::File(path) => crate::contract::sources::Copied::File(path.clone()),
                Offer::Text(text) => crate::contract::sources::Copied::Text(text.to_string()),
            };
            let command = contract::Command::CopyElements { name: source.clone(), origin: offer };
            commands.push(UiCommand::Station(command));
            state.shown.push(self.index);
        }
        if let Offer::File(path) = self.offer
            && button("Keep as source")
        {
            let place = SourcePlace::File(path.clone());
            let source = Source { name: source, place, refresh: None };
            commands.push(UiCommand::Station(contract::Command::AddSource(source)));
            state.shown.push(self.index);
        }
    }
}

/// Returns a name that no source has yet.
fn free_name(offer: &Offer, model: &Model) -> String {
    let stem = match offer {
        Offer::File(path) => path.file_stem().map(|stem| stem.to_string_lossy().into_owned()),
        Offer::Text(_) => None,
    };
    let stem = stem.unwrap_or_else(|| {
        format!("pasted {} {}", format::day(model.now), format::minute_of_day(model.now))
    });
    let is_free = |name: &str| {
        let place = SourcePlace::File(Path::new("/").join("any"));
        let source = Source { name: name.to_owned(), place, refresh: None };
        check_source(&source, &model.sources.list).is_ok()
    };
    let mut names = (2..).map(|count| format!("{stem} {count}"));
    if is_free(&stem) { stem } else { names.find(|name| is_free(name)).unwrap_or(stem) }
}

/// Describes the contents of an offer, compared with the elements in use.
fn holds(counts: &Counts) -> String {
    let parts = [
        (counts.new, "new"),
        (counts.newer, "newer than in use"),
        (counts.same, "the same"),
        (counts.older, "older"),
        (counts.all_refused, "refused"),
    ];
    let parts = parts.into_iter().filter(|(count, _)| *count > 0);
    let parts = parts.map(|(count, subject)| format!("{} {subject}", words::plain(count)));
    let all = [words::objects(counts.objects())].into_iter().chain(parts);
    all.collect::<Vec<_>>().join(", ")
}
