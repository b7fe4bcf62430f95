//! Strip that marks the demo station, a replay or an unread station file, or gives the reason why a
//! replay ended.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{
    replay, text, theme,
    widgets::{
        button::{Button, SMALL_HEIGHT},
        paint,
    },
};
use crate::{
    contract::CatalogState,
    model::{Model, UiCommand, View},
    orbit::BUNDLED_SOURCE,
};

/// Height of the strip, points.
pub const HEIGHT: f32 = 32.0;

/// Returns the height of the strip for `model` in a window of normal height, points.
pub fn height(model: &Model) -> f32 {
    if has_replay(model) { replay::HEIGHT } else { HEIGHT }
}

fn has_replay(model: &Model) -> bool {
    model.replay.is_some() || model.replay_end.is_some()
}

/// Height of the strip in a low window, points. The text is shorter there and its button follows
/// it, so the strip looks the same in narrow and wide views.
pub const LOW_HEIGHT: f32 = 28.0;
const PADDING: f32 = 16.0;

/// Room of the strip. The room outlives the demonstration until another view opens: otherwise every
/// control would move under the pointer.
#[derive(Debug, Default)]
pub struct BannerRoom {
    kept_for: Option<View>,
}

impl BannerRoom {
    /// Returns `true` if the view of `model` shows the strip or keeps its room.
    pub fn is_taken(&mut self, model: &Model) -> bool {
        if model.demo {
            self.kept_for = Some(model.view);
        } else if self.kept_for != Some(model.view) {
            self.kept_for = None;
        }
        self.kept_for.is_some() || model.station_unread || has_replay(model)
    }
}

/// Shows the strip; after the demonstration the strip names the station in use.
pub fn show(ui: &mut Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    if let Some(replayed) = &model.replay {
        return replay::show(ui, rect, model, replayed, commands);
    }
    if let Some(reason) = &model.replay_end {
        return replay::show_end(ui, rect, reason, model.now, commands);
    }
    let t = theme::tokens(ui);
    let whole = rect.shrink2(vec2(PADDING, 0.0));
    if model.station_unread {
        ui.painter().rect_filled(rect, 0.0, t.warnbg);
        let is_low = rect.height() < HEIGHT;
        let words = if is_low {
            "The station file could not be read: no antenna, and not your site."
        } else {
            "The station file could not be read: no antenna is connected, and site and satellites \
             are not yours. Mend the file and start Azel again."
        };
        paint::text_in(ui, whole, Align2::LEFT_CENTER, words, text::body(), t.warn);
        paint::name_text(ui, "unread station", whole, words);
        return;
    }
    if !model.demo {
        ui.painter().rect_filled(rect, 0.0, t.bg1);
        let words = format!("The demo has ended. {} is now in use.", model.station.name);
        paint::text_in(ui, whole, Align2::LEFT_CENTER, &words, text::body(), t.t2);
        paint::name_text(ui, "after the demo", whole, &words);
        return;
    }
    ui.painter().rect_filled(rect, 0.0, t.warnbg);
    let (word, view) = match model.view {
        View::Setup => ("Stay in the demo", View::Operate),
        _ => ("Set up your station", View::Setup),
    };
    let is_low = rect.height() < HEIGHT;
    let words = match &model.catalog {
        _ if model.view == View::Setup => {
            "Demo station: the antennas are simulated, no real antenna moves. It keeps running \
             while you set up yours."
                .to_owned()
        }
        CatalogState::Loading => "Demo station: reading the elements.".to_owned(),
        CatalogState::Failed => "Demo station: the elements could not be read.".to_owned(),
        CatalogState::Ready(_) if is_low => {
            "Demo station: the antennas are simulated, no real antenna moves.".to_owned()
        }
        CatalogState::Ready(_) => {
            let elements = if model.sources.list.is_empty() {
                format!(" Elements: {BUNDLED_SOURCE}.")
            } else {
                String::new()
            };
            format!("Demo station: the antennas are simulated, no real antenna moves.{elements}")
        }
    };
    let button = Button::normal(word);
    let size = vec2(button.width(ui), SMALL_HEIGHT);
    let room = whole.with_max_x(whole.right() - size.x - 8.0);
    let drawn = paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::body(), t.warn);
    paint::name_text(ui, "demo banner", room, &words);
    let left = if is_low { drawn.right() + PADDING } else { whole.right() - size.x };
    let middle = pos2(left + size.x / 2.0, rect.center().y);
    let place = Rect::from_center_size(middle, size);
    if button.show(ui, "set up", place).clicked() {
        commands.push(UiCommand::Show(view));
    }
}
