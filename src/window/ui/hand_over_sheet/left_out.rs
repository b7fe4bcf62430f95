//! Passes that the schedule leaves out: the reason, and the price of taking them.

use jiff::Timestamp;

use maud::{Markup, html};

use super::HandOverSheet;
use crate::{
    plan::schedule::{LeftOut, LeftOutReason},
    ui::{
        format,
        page::{SECTION_HEAD_MM, section},
        words,
    },
};

/// Heights of the column names, of a row and of the line that counts the rest, millimetres; equal
/// to the values in the style sheet.
const HEADS_MM: f64 = 3.0;
const ROW_MM: f64 = 6.0;
const MORE_MM: f64 = 3.0;
/// Max number of times written out for a group.
const TIMES: usize = 3;

/// Left-out passes in groups of one satellite and one reason.
pub(super) struct List {
    /// Groups, the most important first.
    groups: Vec<Group>,
    passes: usize,
}

struct Group {
    name: String,
    priority: u8,
    /// Flag: another pass is in the way, not a rule or the mount.
    is_conflict: bool,
    aos: Vec<Timestamp>,
    max_elevation: String,
    reason: String,
    price: String,
}

impl List {
    pub(super) fn new(sheet: &HandOverSheet<'_>) -> Self {
        let passes = sheet.left_out();
        let mut groups: Vec<Group> = Vec::new();
        for left in &passes {
            let found = group(sheet, left);
            let is_same = |one: &&mut Group| {
                (&one.name, &one.reason, &one.price) == (&found.name, &found.reason, &found.price)
            };
            match groups.iter_mut().find(is_same) {
                Some(same) => {
                    same.aos.extend(found.aos);
                    same.max_elevation.clear();
                }
                None => groups.push(found),
            }
        }
        groups.sort_by_key(|one| (!one.is_conflict, one.priority, one.aos.first().copied()));
        Self { groups, passes: passes.len() }
    }

    /// Returns the height of the part with the groups that fit in `room_mm`, millimetres.
    pub(super) fn height_mm(&self, room_mm: f64) -> f64 {
        let shown = self.fitting(room_mm).len();
        let more_mm = if shown < self.groups.len() { MORE_MM } else { 0.0 };
        let heads_mm = if self.passes > 0 { HEADS_MM } else { 0.0 };
        SECTION_HEAD_MM + heads_mm + ROW_MM * shown as f64 + more_mm
    }

    fn fitting(&self, room_mm: f64) -> &[Group] {
        let rows = (room_mm - SECTION_HEAD_MM - HEADS_MM - MORE_MM) / ROW_MM;
        self.groups.get(..rows.max(0.0) as usize).unwrap_or(&self.groups)
    }

    pub(super) fn html(&self, room_mm: f64) -> Markup {
        let shown = self.fitting(room_mm);
        let remark = match self.passes {
            0 => "No pass is left out".to_owned(),
            1 => "1 pass".to_owned(),
            passes => format!("{passes} passes, those that lost to others first"),
        };
        let heads = ["AOS", "Satellite", "Prio", "Max", "Why", "Cost of taking it by hand"];
        let more: usize = self.groups.iter().skip(shown.len()).map(|group| group.aos.len()).sum();
        let content = html! {
            ul {
                @if self.passes > 0 {
                    li.heads { @for head in heads { span { (head) } } }
                }
                @for group in shown { (group.html()) }
                @if more > 0 { li.more { "and " (more) " more in the list" } }
            }
        };
        section("left-out", "Left out", &remark, &content)
    }
}

fn group(sheet: &HandOverSheet<'_>, left: &LeftOut) -> Group {
    let number = left.pass.satellite;
    let reason = words::schedule::left_out_reason(
        words::schedule::Names {
            pass: &|(number, _)| sheet.name(number),
            antenna: &|id| sheet.antenna(id),
        },
        &left.reason,
    );
    let costs = sheet.price(left).map_or_else(String::new, |price| {
        let given_up = match &price.entries[..] {
            [] => "Nothing".to_owned(),
            [one] => sheet.named_pass(one.pass),
            [first, rest @ ..] => {
                format!("{} and {} more", sheet.named_pass(first.pass), rest.len())
            }
        };
        format!("{given_up} on {}", sheet.antenna(price.antenna))
    });
    let max = sheet.pass(left.pass).map(|pass| pass.max_elevation().degrees());
    let against_others = matches!(
        left.reason,
        LeftOutReason::Overlaps(_)
            | LeftOutReason::SlewTooShort(_)
            | LeftOutReason::TooFar
            | LeftOutReason::UnderWay
            | LeftOutReason::NotFound
            | LeftOutReason::MaxPerDay(_)
    );
    Group {
        name: sheet.name(number),
        priority: sheet.station.priority(number).unwrap_or_default().number(),
        is_conflict: against_others,
        aos: vec![left.pass.aos],
        max_elevation: max.map(|deg| format::degrees(deg, 0)).unwrap_or_default(),
        reason,
        price: costs,
    }
}

impl Group {
    fn html(&self) -> Markup {
        html! {
            li {
                span { (self.times()) }
                span.bold { (self.name) }
                span { (self.priority) }
                span.number { (self.max_elevation) }
                span.words { (self.reason) }
                span.words { (self.price) }
            }
        }
    }

    fn times(&self) -> String {
        if let [one] = self.aos[..] {
            return format::second_of_day(one);
        }
        let times = self.aos.iter().take(TIMES).map(|time| format::minute_of_day(*time));
        let mut times: Vec<String> = times.collect();
        let more = self.aos.len().saturating_sub(TIMES);
        times.extend((more > 0).then(|| format!("+{more}")));
        times.join(" ")
    }
}
