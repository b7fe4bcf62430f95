//! How much of the next passes an antenna tracks, as saved and as edited.

use std::cmp::Ordering;

use egui::{Align2, Color32, Label, Rect, RichText, Sense, Ui, pos2, vec2};

use crate::{
    model::effects::{
        Effect,
        mounts::{Question, Tally},
    },
    ui::{format, text, theme, tokens::Tokens, widgets::paint},
};

const ROW: f32 = 22.0;
/// Width of each of the two columns of numbers.
const NUMBER: f32 = 64.0;

/// The most important number, for a fold.
pub(super) fn in_short(effect: &Effect<Question>) -> String {
    format!("{} of {} passes tracked whole", effect.after.whole, effect.ways.len())
}

/// Shows the numbers. An antenna that is new has none as saved.
pub(super) fn numbers(ui: &mut Ui, effect: Option<&Effect<Question>>, is_new: bool) {
    let t = theme::tokens(ui);
    ui.label(RichText::new("Favourites, next 48 h").font(text::body_medium()).color(t.t1));
    let Some(effect) = effect else {
        ui.label(RichText::new("Being worked out.").font(text::small()).color(t.t3));
        return;
    };
    let (old, new) = (&effect.before, &effect.after);
    cells(ui, "", ("was".to_owned(), t.t3), ("new".to_owned(), t.t3), false);
    let count = |count: usize| count.to_string();
    let rows = [
        ("Tracked whole", count(old.whole), count(new.whole), new.whole.cmp(&old.whole)),
        ("Tracked in part", count(old.in_part), count(new.in_part), Ordering::Equal),
        ("Time lost in these", lost(old), lost(new), old.lost_s.total_cmp(&new.lost_s)),
        ("Not tracked", count(old.not), count(new.not), old.not.cmp(&new.not)),
    ];
    for (label, was, now, gain) in rows {
        let colour = match gain {
            _ if is_new || was == now => t.t1,
            Ordering::Greater => t.ok,
            Ordering::Less => t.bad,
            Ordering::Equal => t.sat,
        };
        let was = if is_new { "–".to_owned() } else { was };
        cells(ui, label, (was, t.t2), (now, colour), true);
    }
}

/// Says in a sentence what changes.
pub(super) fn words(ui: &mut Ui, effect: &Effect<Question>, is_new: bool) {
    let t = theme::tokens(ui);
    let words = RichText::new(sentence(effect, is_new)).font(text::body()).color(t.t1);
    ui.add(Label::new(words).wrap());
}

fn lost(tally: &Tally) -> String {
    format::duration(tally.lost_s)
}

/// A row with both numbers.
fn cells(ui: &mut Ui, label: &str, was: (String, Color32), new: (String, Color32), is_named: bool) {
    let t: &Tokens = theme::tokens(ui);
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    if is_named {
        ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
    }
    paint::text_in(ui, row, Align2::LEFT_CENTER, label, text::small(), t.t2);
    let mut right = row.right();
    let fonts = [text::small_strong(), text::small()];
    let said = format!("{label}: was {}, new {}", was.0, new.0);
    for ((words, colour), font) in [new, was].into_iter().zip(fonts) {
        let cell = Rect::from_min_max(pos2(right - NUMBER, row.top()), pos2(right, row.bottom()));
        paint::text_in(ui, cell, Align2::RIGHT_CENTER, &words, font, colour);
        right -= NUMBER;
    }
    if is_named {
        paint::name_text(ui, ("tracked", label), row, &said);
    }
}

fn sentence(effect: &Effect<Question>, is_new: bool) -> String {
    let of = effect.ways.len();
    let (old, new) = (&effect.before, &effect.after);
    if of == 0 {
        return "No pass of a favourite in the next 48 h.".to_owned();
    }
    let now = format!("{} of {of} passes are tracked whole", new.whole);
    let passes = |count| if count == 1 { "1 pass".to_owned() } else { format!("{count} passes") };
    let gained_s = old.lost_s - new.lost_s;
    match new.whole.cmp(&old.whole) {
        _ if is_new => format!("{now}."),
        Ordering::Greater => {
            format!("{now}, {} more than as saved.", passes(new.whole - old.whole))
        }
        Ordering::Less => format!("{now}, {} fewer than as saved.", passes(old.whole - new.whole)),
        Ordering::Equal if gained_s.abs() >= 0.5 => {
            let word = if gained_s > 0.0 { "less" } else { "more" };
            format!("{now} as before, and {} {word} is lost.", format::duration(gained_s))
        }
        Ordering::Equal => format!("{now}, as before."),
    }
}
