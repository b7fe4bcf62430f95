//! Share of the next passes that an antenna tracks, with the saved and the edited settings.

use std::cmp::Ordering;

use egui::{Label, RichText, Ui};

use crate::{
    model::effects::{
        Effect,
        mounts::{Question, Tally},
    },
    ui::{format, preferences::preview, text, theme},
};

const EACH_ALONE: &str = "Each pass is judged alone: slews between passes belong to the Plan.";

/// Returns the most important number, for a fold.
pub(super) fn in_short(effect: &Effect<Question>) -> String {
    format!("{} of {} passes tracked in full", effect.after.whole, effect.ways.len())
}

/// Shows the numbers. A new antenna has no saved numbers.
pub(super) fn numbers(ui: &mut Ui, effect: Option<&Effect<Question>>, is_new: bool) {
    let t = theme::tokens(ui);
    ui.label(RichText::new("Favourites, next 48 h").font(text::body_medium()).color(t.t1));
    let Some(effect) = effect else {
        ui.label(RichText::new("Being worked out.").font(text::small()).color(t.t3));
        return;
    };
    let (old, new) = (&effect.before, &effect.after);
    preview::heads(ui);
    let count = |count: usize| count.to_string();
    let rows = [
        ("Tracked in full", count(old.whole), count(new.whole), new.whole.cmp(&old.whole)),
        ("Tracked in part", count(old.in_part), count(new.in_part), Ordering::Equal),
        ("Time lost", lost(old), lost(new), old.lost_s.total_cmp(&new.lost_s)),
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
        preview::cells(ui, label, (was, t.t2), (now, colour));
    }
}

/// Shows the change as a sentence.
pub(super) fn words(ui: &mut Ui, effect: &Effect<Question>, is_new: bool) {
    let t = theme::tokens(ui);
    let words = RichText::new(sentence(effect, is_new)).font(text::body()).color(t.t1);
    ui.add(Label::new(words).wrap());
    let words = RichText::new(EACH_ALONE).font(text::small()).color(t.t3);
    ui.add(Label::new(words).wrap());
}

fn lost(tally: &Tally) -> String {
    format::duration(tally.lost_s)
}

fn sentence(effect: &Effect<Question>, is_new: bool) -> String {
    let total = effect.ways.len();
    let (old, new) = (&effect.before, &effect.after);
    if total == 0 {
        return "No pass of a favourite in the next 48 h.".to_owned();
    }
    let now = format!("{} of {total} passes are tracked in full", new.whole);
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
