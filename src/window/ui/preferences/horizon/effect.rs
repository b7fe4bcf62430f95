//! Words the effect of the edits on the predicted passes, in two lines.

use crate::{
    model::effects::{
        Effect,
        obstacles::{Obstacles, Question, Tally},
    },
    ui::format,
};

/// Returns two lines: the effect of the selected keep-out or of all, and the total as edited and as
/// saved.
pub(super) fn lines(effect: &Effect<Question>, zone: Option<&str>) -> [String; 2] {
    let total = effect.ways.len();
    if total == 0 {
        return ["No pass of a favourite in the next 48 h.".to_owned(), String::new()];
    }
    let toll = |tally: &Tally, obstacles: &Obstacles| {
        let place =
            obstacles.keep_outs.iter().position(|keep_out| Some(&*keep_out.name) == zone)?;
        tally.of_each.get(place).map(|toll| (toll.passes, toll.time_s))
    };
    let after = toll(&effect.after, &effect.question.after);
    let (subject, (passes, time_s)) = if let (Some(name), Some(toll)) = (zone, after) {
        (format!("{name} blocks"), toll)
    } else {
        let sun = if effect.after.of_sun.is_some() { " and the Sun" } else { "" };
        (format!("Keep-outs{sun} block"), (effect.after.touched, effect.after.lost_s))
    };
    let blocks = match passes {
        0 => format!("{subject} none of the {total} passes in the next 48 h."),
        1 => format!(
            "{subject} part of 1 of the {total} passes in the next 48 h, {}.",
            format::duration(time_s)
        ),
        _ => format!(
            "{subject} part of {passes} of the {total} passes in the next 48 h, about {} each.",
            format::duration(time_s / passes as f64)
        ),
    };
    let impossible = match effect.after.impossible {
        0 if passes == 0 => String::new(),
        0 => " None becomes impossible.".to_owned(),
        1 => " 1 becomes impossible.".to_owned(),
        many => format!(" {many} become impossible."),
    };
    let (old, new) = (&effect.before, &effect.after);
    let before = if (old.touched, old.masked, old.impossible)
        == (new.touched, new.masked, new.impossible)
        && (old.lost_s - new.lost_s).abs() < 0.5
    {
        let skyline = match new.masked {
            0 => "no pass, before or after saving".to_owned(),
            1 => "1 pass, before and after saving".to_owned(),
            many => format!("{many} passes, before and after saving"),
        };
        format!("The skyline cuts {skyline}.")
    } else {
        format!("As edited, {}. As saved, {}.", in_all(new), in_all(old))
    };
    [blocks + &impossible, before]
}

/// Describes the passes that all keep-outs and the skyline block or cut.
fn in_all(tally: &Tally) -> String {
    let plural = if tally.touched == 1 { "" } else { "es" };
    format!(
        "{} pass{plural} blocked for {} in all and {} cut by the skyline",
        tally.touched,
        format::duration(tally.lost_s),
        tally.masked
    )
}
