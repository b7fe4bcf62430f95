//! Service functions, which are locked: they misalign the antenna or move it.

use egui::{Align2, Sense, Ui, vec2};

use super::{CardEffects, fields, subtitle};
use crate::ui::{
    antennas::{form::Form, row, section::Section, unit::ShownUnit},
    format,
    icons::{self, Icon},
    text, theme,
    widgets::{
        button::{Button, SMALL_HEIGHT},
        paint,
    },
};

const DESCRIPTION: &str = "A wrong value here can make the antenna point wrongly, or move. To unlock for \
                     10 minutes, type the station name while the antenna is at rest.";

pub(in crate::ui::antennas) fn show(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    section: &Section,
    effects: &mut CardEffects<'_>,
) {
    let t = theme::tokens(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 24.0), Sense::hover());
    let lock = paint::square(rect.left_center() + vec2(8.0, 0.0), 16.0);
    let title = section.title;
    if form.unlock.is_none() {
        icons::paint(ui.painter(), lock, Icon::Lock, t.t2);
    } else {
        icons::paint(ui.painter(), lock, Icon::Warning, t.warn);
    }
    let area = rect.with_min_x(rect.left() + 24.0);
    paint::text_in(ui, area, Align2::LEFT_CENTER, title, text::value(), t.t1);
    paint::name_text(ui, "service title", area, title);
    let button = Button::normal(if form.unlock.is_some() { "Lock" } else { "Unlock" });
    let place = rect.with_min_x(rect.right() - button.width(ui));
    let place = place.with_max_y(place.top() + SMALL_HEIGHT);
    if let Some(unlock) = form.unlock {
        let left = format!("Open, locks in {}", format::duration(unlock.left(unit).as_secs_f64()));
        let room = area.with_max_x(place.left() - 8.0);
        paint::text_in(ui, room, Align2::RIGHT_CENTER, &left, text::small(), t.warn);
        paint::name_text(ui, "countdown", room, &left);
    }
    if button.show(ui, "unlock", place).clicked() && form.unlock.take().is_none() {
        *effects.unlock = true;
    }
    ui.add_space(4.0);
    row::note(ui, None, DESCRIPTION, t.t2);
    row::head(ui);
    for key in section.keys {
        let own_title = unit.description(key).map_or("", |group| group.title);
        if own_title != title {
            subtitle(ui, own_title);
        }
        fields(ui, unit, form, key, |_| true);
    }
}
