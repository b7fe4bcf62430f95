//! The band that shows a lock-out for maintenance.

use egui::{Align2, Stroke, StrokeKind, Ui, pos2};

use super::Cursor;
use crate::{
    contract::antenna::AntennaModel,
    ui::{
        dialogs::MaintenanceDialog,
        icons::{self, Icon},
        text, theme,
        widgets::{
            button::{self, Button},
            paint,
        },
    },
};

/// Shows the band below the sentence, with the button that opens the dialog to end the lock-out.
pub(super) fn show_band(
    ui: &Ui,
    cursor: &mut Cursor,
    antenna: &AntennaModel,
    maintenance: &mut Option<MaintenanceDialog>,
) {
    let Some(lock_out) = &antenna.snapshot.lock_out else { return };
    let t = theme::tokens(ui);
    let rect = cursor.take(button::HEIGHT);
    ui.painter().rect(rect, 5.0, t.warnbg, Stroke::new(1.0, t.warn), StrokeKind::Inside);
    let glyph = paint::square(pos2(rect.left() + 16.0, rect.center().y), 15.0);
    icons::paint(ui.painter(), glyph, Icon::Lock, t.warn);
    let button = Button::quiet("Remove…");
    let key = rect.shrink(4.0).with_min_x(rect.right() - 4.0 - button.width(ui));
    let state = if antenna.snapshot.locking { "Being locked out" } else { "In maintenance" };
    let words = format!("{state} by {}", lock_out.operator);
    let room = rect.with_min_x(rect.left() + 30.0).with_max_x(key.left() - 6.0);
    paint::named_text_in(
        ui,
        "lock-out",
        room,
        Align2::LEFT_CENTER,
        &words,
        text::body_medium(),
        t.warn,
    );
    if button.show(ui, "take off", key).clicked() {
        *maintenance = Some(MaintenanceDialog::default());
    }
    cursor.skip(6.0);
}
