//! Actions for the marked objects.

use egui::{Align2, Rect, Ui, vec2};

use super::{
    ElementsState, PADDING, copy, table,
    words::{self, Form},
};
use crate::{
    contract::{self, CatalogState},
    model::{Model, UiCommand},
    station::Priority,
    ui::{
        icons::Icon,
        replay,
        text::{self, Weight},
        theme,
        upload::Choice,
        widgets::{
            button::{self, Button, SMALL_HEIGHT},
            drop_down::DropDown,
            paint,
        },
    },
};

pub(super) const HEIGHT: f32 = 40.0;

/// Draws the bar. `lock` is the reason why favourites may not change now.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    lock: Option<&'static str>,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bgsel);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.sat));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let marked = state.selection.chosen();
    let favourites = &model.station.favourites;
    let are_all = marked.iter().all(|number| favourites.contains(*number));
    let word = if are_all { "Unfavourite" } else { "Favourite" };
    let star = Button::normal(word).icon(if are_all { Icon::OpenStar } else { Icon::Star });
    let star = star.locked_by(lock);
    let priorities = DropDown {
        button: Button::normal("Priority").locked_by(lock),
        salt: "priority of marked",
        name: "Priority of the marked",
    };
    let upload = Button::normal("Upload…").icon(Icon::Upload).locked_by(replay::lock(model));
    let forms =
        DropDown { button: Button::normal("Copy"), salt: "copy marked", name: "Copy the marked" };
    let clear = Button::quiet("Clear");
    let can_upload = model.antenna().is_some_and(|antenna| antenna.spec().element_files.is_some());
    let mut right = inner.right_center();
    let widths = [forms.width(ui), clear.width(ui)];
    let [forms_at, clear_at] = button::row_before(&mut right, SMALL_HEIGHT, widths);
    let upload_at =
        can_upload.then(|| button::row_before(&mut right, SMALL_HEIGHT, [upload.width(ui)]));
    let widths = [star.width(ui), priorities.width(ui)];
    let [star_at, priorities_at] = button::row_before(&mut right, SMALL_HEIGHT, widths);
    if star.show(ui, "star marked", star_at).clicked() {
        table::favour(marked.clone(), !are_all, commands);
    }
    priorities.show(ui, priorities_at, |ui| {
        for priority in Priority::ALL {
            let word = words::priority(priority);
            if ui.button(word).clicked() {
                let numbers = marked.clone();
                let command = contract::Command::SetPriority { numbers, priority };
                commands.push(UiCommand::Station(command));
            }
        }
    });
    if let Some([upload_at]) = upload_at
        && upload.show(ui, "upload marked", upload_at).clicked()
    {
        state.upload(Choice::These(marked.clone()));
    }
    forms.show(ui, forms_at, |ui| {
        for (word, form) in [("As TLE", Form::Tle), ("As OMM, JSON", Form::Omm)] {
            if ui.button(word).clicked() {
                copy(ui, model, &marked, form);
            }
        }
    });
    if clear.show(ui, "clear marks", clear_at).clicked() {
        state.selection.unmark_all();
    }
    let room = inner.with_max_x(right.x);
    let count = format!("{} selected", words::plain(marked.len()));
    let font = text::sized(13.0, Weight::SemiBold);
    let first = paint::text_in(ui, room, Align2::LEFT_CENTER, &count, font, t.t1);
    let old = match &model.catalog {
        CatalogState::Ready(catalog) => {
            let sets = marked.iter().filter_map(|number| catalog.get(*number));
            sets.filter(|elements| words::is_old(elements, model.now)).count()
        }
        CatalogState::Loading | CatalogState::Failed => 0,
    };
    let more = words::marked(old, lock);
    let room = room.with_min_x(first.right() + 12.0);
    paint::text_in(ui, room, Align2::LEFT_CENTER, &more, text::small(), t.t2);
    let spoken = format!("{count}. {more}");
    let named = paint::name_text(ui, "marked", first.union(room), spoken.trim());
    if !paint::fits(ui, &more, text::small(), room) {
        named.on_hover_text(spoken.trim());
    }
}
