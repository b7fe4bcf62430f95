//! The passes that are left out: why, and what would be given up for them.

use jiff::Timestamp;

use super::HandOverSheet;
use crate::{
    plan::schedule::{LeftOut, Why},
    ui::{
        format,
        sheet::{
            CAPTION, LEFT, RIGHT, SECTION_HEAD, SMALL, section,
            svg::{Anchor, Svg, wrapped},
        },
        words,
    },
};

const HEAD: f64 = 9.0;
const LINE: f64 = 8.0;
/// Space below the last line of a row.
const BELOW: f64 = 2.0;
/// Times of a group that are written out.
const TIMES: usize = 3;
/// Left edges of the columns, and where the last one ends.
const COLUMNS: [f64; 7] = [LEFT, 110.0, 196.0, 212.0, 238.0, 444.0, RIGHT];
const SPACE: f64 = 5.0;

/// The passes in groups of one satellite and one reason.
pub(super) struct List {
    /// The most important first.
    groups: Vec<Group>,
    passes: usize,
}

struct Group {
    name: String,
    priority: u8,
    /// In the way is another pass, not a rule or the mount.
    is_conflict: bool,
    aos: Vec<Timestamp>,
    max_elevation: String,
    reason: Vec<String>,
    price: Vec<String>,
}

impl List {
    pub(super) fn of(sheet: &HandOverSheet<'_>) -> Self {
        let passes = sheet.left_out();
        let mut groups: Vec<Group> = Vec::new();
        for left in &passes {
            let found = group(sheet, left);
            let is_same = |it: &&mut Group| {
                (&it.name, &it.reason, &it.price) == (&found.name, &found.reason, &found.price)
            };
            match groups.iter_mut().find(is_same) {
                Some(same) => {
                    same.aos.extend(found.aos);
                    same.max_elevation.clear();
                }
                None => groups.push(found),
            }
        }
        groups.sort_by_key(|it| (!it.is_conflict, it.priority, it.aos.first().copied()));
        Self { groups, passes: passes.len() }
    }

    /// Height of as much as fits in `room`.
    pub(super) fn height(&self, room: f64) -> f64 {
        let rows: f64 = self.fitting(room).iter().map(Group::height).sum();
        let foot = if self.fitting(room).len() < self.groups.len() { LINE } else { 0.0 };
        SECTION_HEAD + HEAD + rows + foot
    }

    fn fitting(&self, room: f64) -> &[Group] {
        let mut left = room - SECTION_HEAD - HEAD - LINE;
        let fits = |group: &&Group| {
            left -= group.height();
            left >= 0.0
        };
        let count = self.groups.iter().take_while(fits).count();
        self.groups.get(..count).unwrap_or_default()
    }

    /// Returns where the list ends.
    pub(super) fn draw(&self, svg: &mut Svg, y: f64, room: f64) -> f64 {
        let shown = self.fitting(room);
        let said = match self.passes {
            0 => "No pass is left out".to_owned(),
            1 => "1 pass".to_owned(),
            passes => format!("{passes} passes, those that lost to others first"),
        };
        let mut at = section(svg, y, "Left out", &said);
        if self.passes == 0 {
            return at;
        }
        let heads = ["AOS", "Satellite", "Prio", "Max", "Why", "Cost of taking it by hand"];
        let edges = COLUMNS.iter().zip(COLUMNS.iter().skip(1));
        for (word, (x, end)) in heads.into_iter().zip(edges) {
            svg.text([*x, at + 5.5], end - x, CAPTION, word);
        }
        at += HEAD;
        for group in shown {
            group.draw(svg, at);
            at += group.height();
        }
        let more: usize = self.groups.iter().skip(shown.len()).map(|group| group.aos.len()).sum();
        if more > 0 {
            let words = format!("and {more} more in the list");
            svg.text([LEFT, at + 6.0], RIGHT - LEFT, SMALL.bold(), &words);
            at += LINE;
        }
        at
    }
}

fn group(sheet: &HandOverSheet<'_>, left: &LeftOut) -> Group {
    let [.., why, price, right] = COLUMNS;
    let number = left.pass.satellite;
    let reason = words::schedule::why(
        words::schedule::Names {
            pass: &|(number, _)| sheet.name(number),
            antenna: &|id| sheet.antenna(id).to_owned(),
        },
        &left.why,
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
        left.why,
        Why::Overlaps(_)
            | Why::SlewTooShort(_)
            | Why::TooFar
            | Why::UnderWay
            | Why::NotFound
            | Why::MaxPerDay(_)
    );
    Group {
        name: sheet.name(number),
        priority: sheet.station.priority(number).unwrap_or_default().number(),
        is_conflict: against_others,
        aos: vec![left.pass.aos],
        max_elevation: max.map(|deg| format::degrees(deg, 0)).unwrap_or_default(),
        reason: wrapped(&reason, price - why - SPACE, SMALL, 2),
        price: wrapped(&costs, right - price, SMALL, 2),
    }
}

impl Group {
    fn height(&self) -> f64 {
        LINE * self.reason.len().max(self.price.len()) as f64 + BELOW
    }

    fn draw(&self, svg: &mut Svg, y: f64) {
        let [aos, name, priority, max, why, price, right] = COLUMNS;
        let line = y + 6.5;
        svg.text([aos, line], name - aos - SPACE, SMALL, &self.times());
        svg.name([name, line], priority - name - SPACE, SMALL.bold(), &self.name);
        svg.text([priority, line], max - priority, SMALL, &self.priority.to_string());
        let end = SMALL.anchored(Anchor::End);
        svg.text([why - SPACE - 4.0, line], why - max, end, &self.max_elevation);
        for (x, end, lines) in [(why, price - SPACE, &self.reason), (price, right, &self.price)] {
            for (words, index) in lines.iter().zip(0..) {
                svg.text([x, line + LINE * f64::from(index)], end - x, SMALL, words);
            }
        }
        let bottom = y + self.height() - 0.5;
        svg.line([LEFT, bottom], [RIGHT, bottom], 0.15);
    }

    fn times(&self) -> String {
        if let [one] = self.aos[..] {
            return format::second_of_day(one);
        }
        let times = self.aos.iter().take(TIMES).map(|at| format::minute_of_day(*at));
        let mut times: Vec<String> = times.collect();
        let more = self.aos.len().saturating_sub(TIMES);
        times.extend((more > 0).then(|| format!("+{more}")));
        times.join(" ")
    }
}
