//! The placement of names above the bars.

use std::ops::RangeInclusive;

use egui::{Rect, vec2};

/// A requested place of a name, in two lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::ui) struct Wish {
    /// Room for the short name.
    pub short: Rect,
    /// Room for the full name.
    pub full: Rect,
}

/// Outcome of a request for a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::ui) enum Placed {
    /// No room for any name.
    Out,
    /// The short name and its place.
    Short(Rect),
    /// The full name and its place.
    Full(Rect),
}

/// Horizontal shifts of a short name to try, points, the best first.
const OFFSETS: [f32; 5] = [0.0, 3.0, -3.0, 6.0, -6.0];

/// Free room on both sides of a full name, points.
const AIR: f32 = 4.0;

/// Assigns the room above the bars. As many short names as possible come first, in the order of the
/// wishes, then full names where room remains. No name overlaps another name or an obstacle, and
/// none leaves `room`.
pub(in crate::ui) fn place(wishes: &[Wish], obstacles: &[Rect], room: Rect) -> Vec<Placed> {
    let mut in_the_way = Columns::new(room);
    for obstacle in obstacles {
        in_the_way.add(*obstacle);
    }
    let clear = |rect: Rect| in_the_way.leave(rect, None);
    let open = |rect: Rect| room.contains_rect(rect) && clear(rect);
    let mut columns = Columns::new(room);
    let mut placed: Vec<Placed> = Vec::with_capacity(wishes.len());
    for wish in wishes {
        let mut places = OFFSETS.iter().map(|step| wish.short.translate(vec2(*step, 0.0)));
        let place = places.find(|rect| open(*rect) && columns.leave(*rect, None));
        if let Some(place) = place {
            columns.add(place);
        }
        placed.push(place.map_or(Placed::Out, Placed::Short));
    }
    for (wish, one) in wishes.iter().zip(&mut placed) {
        let Placed::Short(short) = *one else { continue };
        let airy = wish.full.expand2(vec2(AIR, 0.0));
        if room.contains_rect(wish.full) && clear(airy) && columns.leave(airy, Some(short)) {
            columns.add(wish.full);
            *one = Placed::Full(wish.full);
        }
    }
    placed
}

/// Rectangles, sorted into columns of the room, so that the code compares only a few.
struct Columns {
    left: f32,
    columns: Vec<Vec<Rect>>,
}

impl Columns {
    const WIDTH: f32 = 32.0;

    fn new(room: Rect) -> Self {
        let count = (room.width() / Self::WIDTH).ceil().max(0.0) as usize + 1;
        Self { left: room.left(), columns: vec![Vec::new(); count] }
    }

    /// Returns the columns that `rect` touches. The first and the last column extend beyond the
    /// room.
    fn reached(&self, rect: Rect) -> RangeInclusive<usize> {
        let column = |x: f32| ((x - self.left) / Self::WIDTH).floor().max(0.0) as usize;
        let last = self.columns.len() - 1;
        column(rect.left()).min(last)..=column(rect.right()).min(last)
    }

    fn add(&mut self, rect: Rect) {
        let reached = self.reached(rect);
        for column in self.columns.get_mut(reached).into_iter().flatten() {
            column.push(rect);
        }
    }

    /// Returns `true` if no rectangle except `own` overlaps `rect`.
    fn leave(&self, rect: Rect, own: Option<Rect>) -> bool {
        let columns = self.columns.get(self.reached(rect)).into_iter().flatten();
        !columns.flatten().any(|other| Some(*other) != own && overlap(*other, rect))
    }
}

/// Returns `true` if two rectangles share an area; a common edge is no overlap.
fn overlap(a: Rect, b: Rect) -> bool {
    a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y
}

/// Shortens a name to two to five characters: "NOAA 20" to N20, "METOP-B" to MB, "TERRA" to TE.
/// Short words and digits stay whole, the M of "METEOR-M2" appears once, and text in brackets is
/// dropped.
pub(in crate::ui) fn short_name(name: &str) -> String {
    let before_brackets = name.split('(').next().unwrap_or(name);
    let words: Vec<&str> =
        before_brackets.split([' ', '-', '_']).filter(|word| !word.is_empty()).collect();
    match words.as_slice() {
        [] => name.chars().take(3).collect(),
        [word] if word.chars().count() <= 3 => (*word).to_owned(),
        [word] => {
            let figures = word.trim_start_matches(|sign: char| !sign.is_ascii_digit());
            let letters = if figures.is_empty() { 2 } else { 1 };
            word.chars().take(letters).chain(figures.chars().take(3)).collect()
        }
        several => {
            let followers = several.iter().skip(1).map(Some).chain([None]);
            let parts = several.iter().zip(followers).flat_map(|(word, follower)| {
                let whole = has_figure(word) || word.chars().count() <= 3;
                let said_again = follower.is_some_and(|follower| {
                    has_figure(follower) && follower.chars().next() == word.chars().next()
                });
                word.chars().take(match (whole, said_again) {
                    (true, _) => 4,
                    (false, true) => 0,
                    (false, false) => 1,
                })
            });
            parts.take(5).collect()
        }
    }
}

fn has_figure(word: &str) -> bool {
    word.contains(|sign: char| sign.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    const ROOM: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(200.0, 40.0) };

    fn wish(middle: f32, y: f32) -> Wish {
        let rect = |width| Rect::from_center_size(pos2(middle, y), vec2(width, 12.0));
        Wish { short: rect(20.0), full: rect(50.0) }
    }

    fn short(middle: f32, y: f32) -> Placed {
        Placed::Short(wish(middle, y).short)
    }

    fn full(middle: f32, y: f32) -> Placed {
        Placed::Full(wish(middle, y).full)
    }

    #[test]
    fn names_apart_are_both_written_in_full() {
        let placed = place(&[wish(40.0, 10.0), wish(120.0, 10.0)], &[], ROOM);
        assert_eq!(placed, [full(40.0, 10.0), full(120.0, 10.0)]);
    }

    #[test]
    fn near_names_are_short_and_the_later_of_two_that_collide_is_left_out() {
        let placed = place(&[wish(60.0, 10.0), wish(72.0, 10.0), wish(85.0, 10.0)], &[], ROOM);
        assert_eq!(placed, [short(60.0, 10.0), Placed::Out, short(85.0, 10.0)]);
        let above = place(&[wish(60.0, 10.0), wish(66.0, 30.0)], &[], ROOM);
        assert_eq!(above, [full(60.0, 10.0), full(66.0, 30.0)]);
    }

    #[test]
    fn a_name_steps_aside_a_little() {
        let placed = place(&[wish(60.0, 10.0), wish(75.0, 10.0)], &[], ROOM);
        assert_eq!(placed, [short(60.0, 10.0), short(81.0, 10.0)]);
    }

    #[test]
    fn names_keep_off_obstacles_and_borders() {
        let bar = Rect::from_min_max(pos2(80.0, 0.0), pos2(90.0, 40.0));
        assert_eq!(place(&[wish(85.0, 10.0)], &[bar], ROOM), [Placed::Out]);
        assert_eq!(place(&[wish(60.0, 10.0)], &[bar], ROOM), [short(60.0, 10.0)]);
        assert_eq!(place(&[wish(2.0, 10.0)], &[], ROOM), [Placed::Out]);
        assert_eq!(place(&[wish(100.0, 3.0)], &[], ROOM), [Placed::Out]);
        assert_eq!(place(&[wish(15.0, 10.0)], &[], ROOM), [short(15.0, 10.0)]);
    }

    #[test]
    fn no_two_of_many_names_overlap_and_whoever_is_out_had_no_room() {
        let room = Rect::from_min_max(pos2(100.0, 0.0), pos2(1100.0, 300.0));
        let mut state = 7_u32;
        let mut drawn = |max: f32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32 * max
        };
        let wishes: Vec<Wish> =
            (0..400).map(|_| wish(100.0 + drawn(1000.0), drawn(300.0))).collect();
        let bars: Vec<Rect> = (0..60)
            .map(|_| {
                Rect::from_min_size(pos2(drawn(1100.0), drawn(300.0)), vec2(drawn(200.0), 3.0))
            })
            .collect();
        let placed = place(&wishes, &bars, room);
        let rects: Vec<Option<Rect>> = placed
            .iter()
            .map(|one| match one {
                Placed::Out => None,
                Placed::Short(rect) | Placed::Full(rect) => Some(*rect),
            })
            .collect();
        for (index, rect) in rects.iter().enumerate() {
            let others = rects.iter().enumerate().filter(|(other, _)| *other != index);
            let mut others = others.filter_map(|(_, other)| *other).chain(bars.iter().copied());
            if let Some(rect) = rect {
                assert!(
                    room.contains_rect(*rect)
                        && !others.any(|rect_of_other| overlap(rect_of_other, *rect))
                );
            } else {
                let short = wishes[index].short;
                assert!(
                    !room.contains_rect(short)
                        || others.any(|rect_of_other| overlap(rect_of_other, short))
                );
            }
        }
        let count =
            |is_counted: fn(&Placed) -> bool| placed.iter().filter(|one| is_counted(one)).count();
        let counts = [
            count(|one| matches!(one, Placed::Full(_))),
            count(|one| matches!(one, Placed::Short(_))),
            count(|one| matches!(one, Placed::Out)),
        ];
        assert!(counts.iter().all(|count| *count > 10), "{counts:?}");
    }

    #[test]
    fn short_names() {
        for (name, short) in [
            ("NOAA 20", "N20"),
            ("METOP-B", "MB"),
            ("FENGYUN 3E", "F3E"),
            ("SENTINEL-6", "S6"),
            ("METEOR-M2 4", "M24"),
            ("SUOMI NPP", "SNPP"),
            ("NOAA 11", "N11"),
            ("TERRA", "TE"),
            ("LANDSAT9", "L9"),
            ("SWOT", "SW"),
            ("ISS (ZARYA)", "ISS"),
            ("", ""),
        ] {
            assert_eq!(short_name(name), short, "{name}");
        }
    }
}
