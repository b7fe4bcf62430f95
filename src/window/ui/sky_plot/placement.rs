//! The placement of a label next to its mark.

use egui::{Pos2, Rect, Vec2, vec2};

/// Max growth of the covered share of a label before the label leaves its side of the mark.
const PATIENCE: f32 = 0.3;
/// Max covered share of a label before it moves to a free side.
const LITTLE: f32 = 0.02;

/// A side of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::ui) enum Side {
    East,
    West,
    North,
    South,
    NorthEast,
    SouthEast,
    NorthWest,
    SouthWest,
}

impl Side {
    /// All sides in the order in which the placement tries them.
    pub(in crate::ui) const ORDER: [Self; 8] = [
        Self::East,
        Self::West,
        Self::North,
        Self::South,
        Self::NorthEast,
        Self::SouthEast,
        Self::NorthWest,
        Self::SouthWest,
    ];

    /// Returns the direction on the screen, each component -1, 0 or 1.
    pub(in crate::ui) fn direction(self) -> Vec2 {
        match self {
            Self::East => vec2(1.0, 0.0),
            Self::West => vec2(-1.0, 0.0),
            Self::North => vec2(0.0, -1.0),
            Self::South => vec2(0.0, 1.0),
            Self::NorthEast => vec2(1.0, -1.0),
            Self::SouthEast => vec2(1.0, 1.0),
            Self::NorthWest => vec2(-1.0, -1.0),
            Self::SouthWest => vec2(-1.0, 1.0),
        }
    }

    /// Returns all sides, the nearest to a direction on the screen first. A direction without
    /// length returns [`Self::ORDER`].
    pub(in crate::ui) fn by_nearness(direction: Vec2) -> [Self; 8] {
        let target = direction.normalized();
        let difference = |side: &Self| 1.0 - side.direction().normalized().dot(target);
        let mut order = Self::ORDER;
        order.sort_by(|a, b| difference(a).total_cmp(&difference(b)));
        order
    }

    /// Returns the side nearest to a direction on the screen.
    pub(in crate::ui) fn nearest(direction: Vec2) -> Self {
        let [nearest, ..] = Self::by_nearness(direction);
        nearest
    }

    /// Returns the rectangle of a label of `size`, `clearance` points from its mark.
    pub(in crate::ui) fn rect(self, mark: Pos2, size: Vec2, clearance: f32) -> Rect {
        let direction = self.direction();
        let diagonal = direction.x != 0.0 && direction.y != 0.0;
        let reach = if diagonal { clearance * 0.7 } else { clearance };
        Rect::from_center_size(mark + direction * (size / 2.0 + Vec2::splat(reach)), size)
    }
}

/// The place of a label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::ui) struct Placement {
    pub(in crate::ui) side: Side,
    /// The rectangle of the text.
    pub(in crate::ui) rect: Rect,
    /// Covered share of the label, weighted by the marks below it; may exceed 1.
    pub(in crate::ui) covered: f32,
}

/// The place of a label in the previous frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::ui) struct Memory {
    pub(in crate::ui) side: Side,
    /// [`Placement::covered`] at the time when the side was chosen.
    pub(in crate::ui) covered: f32,
}

/// A box that labels should not cover.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::ui) struct Obstacle {
    pub(in crate::ui) rect: Rect,
    /// Cost of covering this box, as a multiple of the cost of a line.
    pub(in crate::ui) weight: f32,
}

/// Returns the share of `rect` that covers obstacles, each by its weight, or lies outside `bounds`.
/// The share may exceed 1.
pub(super) fn covered(rect: Rect, bounds: Rect, obstacles: &[Obstacle]) -> f32 {
    let area = rect.area().max(f32::EPSILON);
    let shared = |other: Rect| {
        let overlap = rect.intersect(other);
        if overlap.is_positive() { overlap.area() } else { 0.0 }
    };
    let overlap_weight: f32 = obstacles.iter().map(|other| other.weight * shared(other.rect)).sum();
    (overlap_weight + area - shared(bounds)) / area
}

/// Chooses the first free side in the given order, otherwise the least covered side. A label stays
/// on its side until clearly more of it is covered than at first. If another side is free, the
/// label leaves when more than a small part is covered. Returns `None` if `order` is empty.
pub(in crate::ui) fn place(
    mark: Pos2,
    size: Vec2,
    clearance: f32,
    order: &[Side],
    bounds: Rect,
    obstacles: &[Obstacle],
    before: Option<Memory>,
) -> Option<Placement> {
    // No label reaches farther, so only the obstacles near the mark have to be checked.
    let reach = Rect::from_center_size(mark, 2.0 * (size + Vec2::splat(clearance)));
    let is_near = |other: &&Obstacle| other.rect.intersects(reach);
    let near: Vec<Obstacle> = obstacles.iter().filter(is_near).copied().collect();
    let on = |side: Side| {
        let rect = side.rect(mark, size, clearance);
        Placement { side, rect, covered: covered(rect, bounds, &near) }
    };
    // The first of equal sides wins, so `order` decides between free sides.
    let best = order
        .iter()
        .map(|side| on(*side))
        .reduce(|best, next| if next.covered + 1e-3 < best.covered { next } else { best })?;
    let previous = before.filter(|memory| order.contains(&memory.side)).filter(|memory| {
        let now = on(memory.side).covered;
        now <= memory.covered + PATIENCE && (now <= LITTLE || best.covered > 1e-3)
    });
    Some(previous.map_or(best, |memory| on(memory.side)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    const BOUNDS: Rect = Rect { min: Pos2::ZERO, max: pos2(400.0, 400.0) };
    const SIZE: Vec2 = vec2(60.0, 14.0);
    const MARK: Pos2 = pos2(200.0, 200.0);

    fn placed(reserved: &[Rect], before: Option<Memory>) -> Placement {
        place(MARK, SIZE, 8.0, &Side::ORDER, BOUNDS, &lines(reserved), before).unwrap()
    }

    fn lines(rects: &[Rect]) -> Vec<Obstacle> {
        rects.iter().map(|rect| Obstacle { rect: *rect, weight: 1.0 }).collect()
    }

    #[test]
    fn a_label_covers_a_line_rather_than_a_little_of_a_mark() {
        let part = |side: Side, share: f32| {
            let rect = side.rect(MARK, SIZE, 8.0);
            Rect::from_min_size(rect.min, vec2(rect.width() * share, rect.height()))
        };
        let line = Obstacle { rect: part(Side::South, 0.6), weight: 1.0 };
        let side = |weight: f32| {
            let over_north = Obstacle { rect: part(Side::North, 0.3), weight };
            let sides = [Side::North, Side::South];
            place(MARK, SIZE, 8.0, &sides, BOUNDS, &[over_north, line], None).unwrap().side
        };
        assert_eq!(side(1.0), Side::North);
        assert_eq!(side(4.0), Side::South);
    }

    #[test]
    fn the_first_free_side_is_taken() {
        let mut reserved = Vec::new();
        for side in Side::ORDER {
            let here = placed(&reserved, None);
            assert_eq!(here.side, side);
            assert!(here.covered < 1e-6);
            // The rectangle is smaller than the label, so that it does not reach its neighbours.
            reserved.push(Rect::from_center_size(here.rect.center(), vec2(8.0, 4.0)));
        }
        assert!(placed(&reserved, None).covered > 0.0);
    }

    #[test]
    fn the_least_covered_side_is_taken_when_none_is_free() {
        let mut reserved = vec![BOUNDS];
        let south = Side::South.rect(MARK, SIZE, 8.0);
        reserved.extend([Rect::from_min_max(BOUNDS.min, pos2(400.0, south.top()))]);
        assert!((placed(&reserved, None).covered - 1.0).abs() < 1e-6);
        let reserved = [
            Rect::from_min_max(BOUNDS.min, pos2(400.0, south.top() + 3.0)),
            Rect::from_min_max(pos2(0.0, south.bottom()), BOUNDS.max),
        ];
        assert_eq!(placed(&reserved, None).side, Side::South);
    }

    #[test]
    fn a_label_at_the_edge_turns_inwards() {
        let at_edge = |mark| place(mark, SIZE, 8.0, &Side::ORDER, BOUNDS, &[], None).unwrap();
        assert_eq!(at_edge(pos2(390.0, 200.0)).side, Side::West);
        assert_eq!(at_edge(pos2(20.0, 200.0)).side, Side::East);
        assert!(BOUNDS.contains_rect(at_edge(pos2(390.0, 395.0)).rect));
    }

    #[test]
    fn a_label_does_not_jump_for_a_small_overlap() {
        let west = Memory { side: Side::West, covered: 0.0 };
        assert_eq!(placed(&[], Some(west)).side, Side::West);
        let rect = Side::West.rect(MARK, SIZE, 8.0);
        let overlap =
            |share: f32| [Rect::from_min_size(rect.min, vec2(rect.width() * share, rect.height()))];
        assert_eq!(placed(&overlap(0.02), Some(west)).side, Side::West);
        assert_eq!(placed(&overlap(0.15), Some(west)).side, Side::East, "a free side");
        let with_all = |share: f32| {
            let others = Side::ORDER.into_iter().filter(|side| *side != Side::West);
            let little = |side: Side| {
                Rect::from_center_size(side.rect(MARK, SIZE, 8.0).center(), vec2(4.0, 4.0))
            };
            [overlap(share).to_vec(), others.map(little).collect()].concat()
        };
        assert_eq!(placed(&with_all(0.25), Some(west)).side, Side::West);
        assert_ne!(placed(&with_all(0.35), Some(west)).side, Side::West);
        let used_to_it = Memory { side: Side::West, covered: 0.2 };
        assert_eq!(placed(&with_all(0.35), Some(used_to_it)).side, Side::West);
    }

    #[test]
    fn the_nearest_side_of_a_direction() {
        assert_eq!(Side::nearest(vec2(3.0, 0.2)), Side::East);
        assert_eq!(Side::nearest(vec2(-1.0, 0.9)), Side::SouthWest);
        assert_eq!(Side::nearest(vec2(0.1, -1.0)), Side::North);
        assert_eq!(Side::by_nearness(Vec2::ZERO), Side::ORDER);
        assert_eq!(Side::by_nearness(vec2(0.3, 1.0)).last(), Some(&Side::North));
    }
}
