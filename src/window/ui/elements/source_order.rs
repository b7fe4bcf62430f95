//! Sources of the selected object: the source in use, the next source, and the menu that sets the
//! order.

use egui::{Align2, Popup, Rect, Role, Stroke, StrokeKind, Ui, pos2};

use super::words;
use crate::{
    contract::Command,
    model::{Model, UiCommand},
    orbit::{BUNDLED_SOURCE, Catalog, SOURCE_LAG},
    ui::{
        icons::{self, Icon},
        text, theme,
        widgets::{menu, paint},
    },
};

/// Shows the line in the facts of the object.
pub(super) fn show(
    ui: &Ui,
    line: Rect,
    model: &Model,
    catalog: &Catalog,
    number: u32,
    lock: Option<&str>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let order = order(model, number);
    let lags = lags(catalog, number, order);
    let value = value(catalog, number, order);
    let lock = lock.or_else(|| words::sources_lock(model));
    let spoken = format!("Sources: {value}");
    let place = line.expand2(egui::vec2(4.0, 0.0));
    let salt = "order of sources";
    let response = paint::control(ui, salt, place, Role::ComboBox, lock.is_none(), &spoken);
    if response.hovered() && lock.is_none() {
        ui.painter().rect_stroke(place, 4, Stroke::new(1.0, t.edge), StrokeKind::Inside);
    }
    let label = paint::text_in(ui, line, Align2::LEFT_CENTER, "Sources", text::small(), t.t2);
    let position = pos2(line.right() - 5.0, line.center().y);
    let colour = if lock.is_none() { t.t2 } else { t.t3 };
    icons::paint(ui.painter(), paint::square(position, 10.0), Icon::ChevronDown, colour);
    let room = line.with_min_x(label.right() + 24.0).with_max_x(position.x - 8.0);
    let colour = if lags.is_some() { t.warn } else { t.t1 };
    let drawn = paint::text_in(ui, room, Align2::RIGHT_CENTER, &value, text::small(), colour);
    if lags.is_some() {
        let position = pos2(drawn.left() - 11.0, drawn.center().y);
        icons::paint(ui.painter(), paint::square(position, 12.0), Icon::Warning, t.warn);
    }
    paint::focus_ring(ui, &response, 4);
    let hint = lock.map_or_else(|| lags.unwrap_or_else(|| rule(order)), str::to_owned);
    let response = if paint::fits(ui, &value, text::small(), room) {
        response.on_hover_text(hint)
    } else {
        response.on_hover_text(format!("{spoken}\n{hint}"))
    };
    menu::show(&response, Popup::menu(&response).accessible_name("Order of sources"), |ui| {
        let newest = egui::Button::selectable(order.is_empty(), "Newest of all sources");
        if ui.add(newest).clicked() && !order.is_empty() {
            commands.push(set(number, Vec::new()));
        }
        for source in &model.sources.list {
            let name = &source.name;
            let is_first = order.first() == Some(name);
            let entry = egui::Button::selectable(is_first, format!("{name} first"));
            if ui.add(entry).clicked() && !is_first {
                let others = order.iter().filter(|other| *other != name);
                commands.push(set(number, std::iter::once(name).chain(others).cloned().collect()));
            }
        }
    });
}

fn set(satellite: u32, sources: Vec<String>) -> UiCommand {
    UiCommand::Station(Command::SetSourceOrder { satellite, sources })
}

fn order(model: &Model, number: u32) -> &[String] {
    let favourite = model.station.favourites.get(number);
    favourite.map(|favourite| favourite.sources.as_slice()).unwrap_or_default()
}

/// Describes the order, or the sources whose newest elements are in use.
fn value(catalog: &Catalog, number: u32, order: &[String]) -> String {
    if order.is_empty() {
        let sources: Vec<&str> = catalog.groups_of(number).collect();
        return match &sources[..] {
            [only] => (*only).to_owned(),
            all => format!("newest of {}", all.join(", ")),
        };
    }
    format!("{}, then the newest", order.join(", then "))
}

/// Returns the reason why the first source of the order is not in use, if it is not.
fn lags(catalog: &Catalog, number: u32, order: &[String]) -> Option<String> {
    let first = order.first()?;
    let in_use = catalog.source_of(number).unwrap_or(BUNDLED_SOURCE);
    if in_use == first {
        return None;
    }
    let reason = if catalog.is_chosen(number) {
        "You chose the set in use yourself, which comes before the order.".to_owned()
    } else if catalog.groups_of(number).any(|group| group == first) {
        format!("The elements of {first} are more than {} older than the newest.", lag())
    } else {
        format!("{first} has no elements of this satellite.")
    };
    Some(format!("{reason} In use: {in_use}."))
}

fn rule(order: &[String]) -> String {
    if order.is_empty() {
        return "Azel uses the newest elements. Choose a source to prefer it.".to_owned();
    }
    format!(
        "Azel uses the first source whose elements are at most {} older than the newest.",
        lag()
    )
}

fn lag() -> String {
    format!("{} days", SOURCE_LAG.as_hours() / 24)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::{bundled, read_elements, write_omm_json};

    const ISS: u32 = 25_544;

    /// Returns a catalog with a set of the ISS from each source, which prefers `own`.
    fn catalog(own_epoch: &str, has_choice: bool) -> Catalog {
        let mut text = Vec::new();
        write_omm_json([bundled().unwrap().get(ISS).unwrap()], &mut text).unwrap();
        let mut catalog = Catalog::default();
        catalog.set_orders([(ISS, vec!["own".to_owned()])].into());
        for (source, epoch) in [("web", "2026-08-14T00:00:00"), ("own", own_epoch)] {
            let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
            list[0]["EPOCH"] = epoch.into();
            catalog.merge(read_elements(&list.to_string()), source);
        }
        catalog.apply_orders(|_| has_choice);
        catalog
    }

    #[test]
    fn a_source_that_is_not_in_use_has_its_true_reason() {
        for (own_epoch, has_choice, reason) in [
            ("2026-08-13T00:00:00", false, None),
            ("2026-08-13T00:00:00", true, Some("You chose the set in use yourself")),
            ("2026-08-10T00:00:00", false, Some("The elements of own are more than 3 days older")),
        ] {
            let lags = lags(&catalog(own_epoch, has_choice), ISS, &["own".to_owned()]);
            assert_eq!(lags.is_some(), reason.is_some(), "{lags:?}");
            if let Some((lags, reason)) = lags.zip(reason) {
                assert!(lags.starts_with(reason) && lags.ends_with("In use: web."), "{lags}");
            }
        }
    }
}
