//! Layout of the view in windows of every size.

use egui::{Rangef, Rect, pos2, vec2};

use super::{card, pass_header};
use crate::ui::{banner, sky_plot::LEGEND_FOOT, top_bar};

const LIST: f32 = 320.0;
const NARROW_LIST: f32 = 264.0;
/// Max width of the list, points; the sky plot always keeps its min width.
const MAX_LIST: f32 = 480.0;
const MIN_SKY: f32 = 480.0;
const STRIP: f32 = 208.0;
const SMALL_STRIP: f32 = 80.0;
const SKY_TIME: f32 = 32.0;
const SMALL_SKY_TIME: f32 = 28.0;
const PROFILE: f32 = 392.0;
/// Max size of the sky plot, points; the strip below gets the rest.
const MAX_SKY: f32 = 2.0 * (420.0 + 36.0);

/// Window width below which the list is a drawer, points.
const DRAWER_BELOW: f32 = 1200.0;
/// Min window width for thumbnails in the rows, points.
const THUMBNAILS_FROM: f32 = 1360.0;
/// Window height below which there is one short strip, points.
const TALL_FROM: f32 = 800.0;
/// Min window height for a strip with a lane for each antenna, points.
const HIGH_FROM: f32 = 1000.0;
const HIGH_STRIP: f32 = 272.0;
/// Max number of cards beside the card of the selected antenna.
pub(super) const SIDE_CARDS: usize = 2;
/// Min window widths for the first and the second card beside the selected antenna's, points.
const SIDE_CARDS_FROM: [f32; SIDE_CARDS] = [1800.0, 2400.0];

/// Returns how many cards fit beside the card of the selected antenna in a window of this width.
pub(in crate::ui) fn side_cards(window: f32) -> usize {
    SIDE_CARDS_FROM.iter().filter(|start| window >= **start).count()
}

/// Parts of the view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Areas {
    pub(super) header: Rect,
    pub(super) sky: Rect,
    /// Row below the plot with the time that the plot shows.
    pub(super) sky_time: Rect,
    pub(super) card: Rect,
    /// Cards of further antennas, at the right of the first.
    pub(super) side_cards: [Option<Rect>; SIDE_CARDS],
    /// Strip of the demo station, if it stands beside the card.
    pub(super) banner: Option<Rect>,
    pub(super) list: Option<Rect>,
    /// Min and max width of a list beside the plot, points; `None` for a drawer.
    pub(super) list_widths: Option<Rangef>,
    pub(super) timeline: Option<Rect>,
    pub(super) profile: Option<Rect>,
    pub(super) thumbnails: bool,
    pub(super) small: bool,
}

impl Areas {
    /// Lays out the parts of the view. `list_width` is the operator's choice, points.
    pub(super) fn new(
        window: Rect,
        rect: Rect,
        drawer_open: bool,
        has_banner: bool,
        antennas: usize,
        list_width: Option<f32>,
    ) -> Self {
        let small = window.width() < DRAWER_BELOW;
        let tall = window.height() >= TALL_FROM;
        let card_width = if small { card::SMALL_WIDTH } else { card::WIDTH };
        let count = side_cards(window.width()).min(antennas.saturating_sub(1));
        let last = rect.with_min_x(rect.right() - card_width);
        let card = last.translate(vec2(-card_width * count as f32, 0.0));
        let side_cards = std::array::from_fn(|index| {
            let place = card.translate(vec2(card_width * (index + 1) as f32, 0.0));
            (index < count).then_some(place)
        });
        let left = rect.with_max_x(card.left());
        let banner = (has_banner && window.height() < top_bar::SMALL_BELOW)
            .then(|| left.with_max_y(left.top() + banner::LOW_HEIGHT));
        let left = banner.map_or(left, |banner| left.with_min_y(banner.bottom()));

        let default = if window.width() >= THUMBNAILS_FROM { LIST } else { NARROW_LIST };
        let max = (left.width() - MIN_SKY).clamp(NARROW_LIST, MAX_LIST);
        let list_widths = Rangef::new(NARROW_LIST, max);
        let list_width = list_widths.clamp(list_width.unwrap_or(default));
        let thumbnails = list_width >= LIST;
        let header_height = if small { 44.0 } else { pass_header::HEIGHT };
        let requested = match window.height() {
            ..TALL_FROM => SMALL_STRIP,
            TALL_FROM..HIGH_FROM => STRIP,
            _ => HIGH_STRIP,
        };
        let room = left.height() - header_height;
        let sky_time = if tall { SKY_TIME } else { SMALL_SKY_TIME };
        let strip_height = requested.max(room - sky_time - MAX_SKY);
        let strip = left.with_min_y(left.bottom() - strip_height);
        let above = left.with_max_y(strip.top());

        let area = if small { above } else { above.with_min_x(above.left() + list_width) };
        let header = area.with_max_y(area.top() + header_height);
        let (sky, sky_time) =
            area.with_min_y(header.bottom()).split_top_bottom_at_y(area.bottom() - sky_time);
        let list = if small {
            // The drawer must not cover the card, STOP or the button of the legend.
            let drawer = Rect::from_min_size(
                pos2(sky.left(), sky.top()),
                vec2(NARROW_LIST + 8.0, sky.height() - LEGEND_FOOT),
            );
            drawer_open.then_some(drawer)
        } else {
            Some(above.with_max_x(above.left() + list_width))
        };
        let profile = tall.then(|| strip.with_min_x(strip.right() - PROFILE));
        let timeline = match profile {
            Some(profile) => strip.with_max_x(profile.left()),
            None => strip,
        };
        let timeline = Some(timeline);
        let list_widths = (!small).then_some(list_widths);
        Self {
            header,
            sky,
            sky_time,
            card,
            side_cards,
            banner,
            list,
            list_widths,
            timeline,
            profile,
            thumbnails,
            small,
        }
    }

    /// Returns the lines between the parts, 1 point wide.
    pub(super) fn dividers(&self) -> Vec<Rect> {
        let right_of = |rect: Rect| {
            Rect::from_min_max(pos2(rect.right() - 1.0, rect.top()), rect.right_bottom())
        };
        let top_of =
            |rect: Rect| Rect::from_min_max(rect.left_top(), pos2(rect.right(), rect.top() + 1.0));
        let below_header = Rect::from_min_max(
            pos2(self.header.left(), self.header.bottom() - 1.0),
            self.header.right_bottom(),
        );
        self.list
            .map(right_of)
            .into_iter()
            .chain(self.timeline.map(top_of))
            .chain(self.profile.map(top_of))
            .chain(self.profile.and(self.timeline).map(right_of))
            .chain([below_header])
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn areas(width: f32, height: f32) -> Areas {
        with_list(width, height, None)
    }

    fn with_list(width: f32, height: f32, list: Option<f32>) -> Areas {
        let window = Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height));
        let (bar, rail) =
            (if height < 800.0 { 48.0 } else { 56.0 }, if width < 1200.0 { 48.0 } else { 72.0 });
        Areas::new(window, window.with_min_x(rail).with_min_y(bar), false, false, 3, list)
    }

    #[test]
    fn the_reference_window_has_the_reference_places() {
        let areas = areas(1440.0, 900.0);
        let rect = |x: f32, y: f32, w: f32, h: f32| Rect::from_min_size(pos2(x, y), vec2(w, h));
        assert_eq!(areas.list, Some(rect(72.0, 56.0, 320.0, 636.0)));
        assert_eq!(areas.header, rect(392.0, 56.0, 704.0, 56.0));
        assert_eq!(areas.sky, rect(392.0, 112.0, 704.0, 548.0));
        assert_eq!(areas.sky_time, rect(392.0, 660.0, 704.0, 32.0));
        assert_eq!(areas.card, rect(1096.0, 56.0, 344.0, 844.0));
        assert_eq!(areas.timeline, Some(rect(72.0, 692.0, 632.0, 208.0)));
        assert_eq!(areas.profile, Some(rect(704.0, 692.0, 392.0, 208.0)));
    }

    #[test]
    fn the_smallest_window_keeps_card_plot_and_one_strip() {
        let areas = areas(1024.0, 640.0);
        assert!(areas.small && areas.list.is_none() && areas.profile.is_none());
        assert_eq!(areas.card.size(), vec2(304.0, 592.0));
        assert_eq!(areas.timeline.map(|strip| strip.size()), Some(vec2(672.0, 80.0)));
        assert_eq!(areas.sky.size(), vec2(672.0, 440.0));
    }

    #[test]
    fn a_list_that_was_drawn_leaves_the_plot_its_room() {
        for (window, drawn, requested) in [
            (1440.0, 400.0, 400.0),
            (1440.0, 10.0, 264.0),
            (1440.0, 9000.0, 480.0),
            (1200.0, 9000.0, 304.0),
        ] {
            let areas = with_list(window, 900.0, Some(drawn));
            let list = areas.list.unwrap();
            assert!((list.width() - requested).abs() < 1e-3, "{drawn}: {list}");
            assert!(areas.sky.width() >= MIN_SKY && areas.sky.left() >= list.right());
            assert_eq!(areas.thumbnails, requested >= LIST);
        }
    }

    #[test]
    fn a_wide_window_has_more_cards_and_a_high_one_lanes_for_all() {
        for (width, height, count) in [(1920.0, 1080.0, 1), (2560.0, 1440.0, 2), (1800.0, 900.0, 1)]
        {
            let areas = areas(width, height);
            let mut right = areas.card.right();
            for place in areas.side_cards.into_iter().flatten() {
                assert_eq!(areas.card.size(), place.size());
                assert!((right - place.left()).abs() < 1e-3);
                right = place.right();
            }
            assert!((right - width).abs() < 1e-3);
            assert_eq!(areas.side_cards.iter().flatten().count(), count);
            assert!(areas.sky.right() <= areas.card.left() && areas.sky.width() >= MIN_SKY);
            let strip = areas.timeline.unwrap().height();
            assert_eq!(strip > STRIP, height >= HIGH_FROM, "{strip}");
        }
        assert_eq!(areas(1799.0, 1080.0).side_cards, [None; SIDE_CARDS]);
    }

    #[test]
    fn a_tall_window_gives_the_rest_to_the_strip() {
        let areas = areas(2560.0, 1440.0);
        assert!((areas.sky.height() - MAX_SKY).abs() < 1.0);
        assert!(areas.timeline.is_some_and(|strip| strip.height() > STRIP));
    }
}
