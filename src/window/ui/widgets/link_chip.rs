//! An antenna in the top bar: its link and its activity.

use egui::{
    Align2, Color32, FontId, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, pos2, vec2,
};

use super::paint;
use crate::ui::{
    icons::{self, Icon},
    text::{self, Weight},
    theme,
    tokens::Tokens,
};

const RADIUS: u8 = 6;
/// Size of the tag of automatic operation, points.
pub const TAG: Vec2 = vec2(38.0, 16.0);
pub const TWO_LINES_WIDTH: f32 = 162.0;
/// Word for an antenna with an active red alarm.
pub const ALARM: &str = "Alarm";

/// State of the link to a unit. Each state has its shape; all states without a reply share one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LinkGlyph {
    /// A link whose unit replies in time.
    Live,
    /// A link whose last reply is older than two poll periods.
    Late,
    /// An open link without a reply.
    Silent,
    /// A lost link.
    Lost,
    /// A link that is switched off.
    #[default]
    Off,
}

impl LinkGlyph {
    /// Returns shape and colour.
    pub fn look(self, t: &Tokens) -> (Icon, Color32) {
        match self {
            Self::Live => (Icon::Disc, t.ok),
            Self::Late => (Icon::HalfDisc, t.warn),
            Self::Silent | Self::Lost => (Icon::CrossedRing, t.bad),
            Self::Off => (Icon::OpenRing, t.t3),
        }
    }

    /// Returns the word for screen readers.
    pub fn word(self) -> &'static str {
        match self {
            Self::Live => "live",
            Self::Late => "late",
            Self::Silent => "silent",
            Self::Lost => "lost",
            Self::Off => "off",
        }
    }
}

/// Level of detail of a chip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChipForm {
    /// Name above activity and age.
    TwoLines,
    /// Name and age.
    OneLine,
    /// Only the name.
    Name,
}

#[derive(Debug, Clone, Copy, Default)]
pub struct ChipModel<'a> {
    pub name: &'a str,
    pub link: LinkGlyph,
    /// Activity in one or two words.
    pub activity: &'a str,
    /// Age of the last good reply with its unit, or empty.
    pub age: &'a str,
    /// `true` if the window shows the card of the antenna.
    pub selected: bool,
    /// `true` if the antenna is locked out for maintenance.
    pub maintenance: bool,
    /// State of automatic operation; `None` while it is off.
    pub automatic: Option<AutomaticModel<'a>>,
    /// Most severe active red alarm of the antenna, in words.
    pub alarm: Option<&'a str>,
}

/// State of automatic operation while it is not off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AutomaticModel<'a> {
    pub is_suspended: bool,
    /// Next step with its time, or the reason of a suspension.
    pub words: &'a str,
}

/// Returns an activity with the age of the last good reply, or the time without a reply.
pub fn with_age(activity: &str, age: &str, link: LinkGlyph) -> String {
    match link {
        _ if age.is_empty() => activity.to_owned(),
        LinkGlyph::Silent | LinkGlyph::Lost => format!("{activity} {age}"),
        LinkGlyph::Live | LinkGlyph::Late | LinkGlyph::Off => format!("{activity}, {}", ago(age)),
    }
}

fn ago(age: &str) -> String {
    if age.is_empty() { String::new() } else { format!("{age} ago") }
}

impl ChipModel<'_> {
    fn second_line(&self) -> String {
        let words = match (self.maintenance, self.alarm, self.link) {
            // The alarm takes the room of the age of a live reply.
            (true, _, _) | (false, Some(_), LinkGlyph::Live) => self.activity.to_owned(),
            (false, Some(_), LinkGlyph::Late) => format!("{} {}", self.activity, self.age),
            (false, _, _) => with_age(self.activity, self.age, self.link),
        };
        if self.alarm.is_some() { format!("{ALARM}: {words}") } else { words }
    }

    pub fn width(&self, ui: &Ui, form: ChipForm) -> f32 {
        let name = paint::text_width(ui, self.name, text::sized(13.0, Weight::SemiBold));
        match form {
            ChipForm::TwoLines => TWO_LINES_WIDTH,
            ChipForm::OneLine => {
                let age = paint::text_width(ui, &self.short_age(), text::small());
                let age = if self.maintenance { age.max(12.0) } else { age };
                let alarm = self.alarm_width(ui);
                (26.0 + name + self.tag_width() + alarm + 6.0 + age + 10.0).ceil()
            }
            ChipForm::Name => {
                let lock = if self.maintenance { 18.0 } else { 0.0 };
                (26.0 + name + self.tag_width() + self.alarm_width(ui) + 10.0 + lock).ceil()
            }
        }
    }

    /// Returns the width of the word of an alarm in one line, with the gap before it, points.
    fn alarm_width(&self, ui: &Ui) -> f32 {
        let width = || 6.0 + paint::text_width(ui, ALARM, alarm_font());
        self.alarm.map_or(0.0, |_| width())
    }

    /// Returns the width of the tag next to the name, with the gap before it, points.
    fn tag_width(&self) -> f32 {
        if self.automatic.is_some() { 6.0 + TAG.x } else { 0.0 }
    }

    /// Returns the age for a chip of one line; while the unit answers, the tag takes its place.
    fn short_age(&self) -> String {
        match (self.automatic, self.link) {
            (Some(_), LinkGlyph::Live) => String::new(),
            (None, LinkGlyph::Live)
            | (_, LinkGlyph::Late | LinkGlyph::Silent | LinkGlyph::Lost | LinkGlyph::Off) => {
                ago(self.age)
            }
        }
    }
}

fn alarm_font() -> FontId {
    text::sized(12.0, Weight::SemiBold)
}

pub fn show(ui: &Ui, rect: Rect, model: &ChipModel<'_>, form: ChipForm) -> Response {
    let t = theme::tokens(ui);
    let second = model.second_line();
    let response = ui.interact(rect, ui.make_persistent_id(("chip", model.name)), Sense::click());
    response.widget_info(|| {
        let automatic = match model.automatic {
            None => "",
            Some(AutomaticModel { is_suspended: false, .. }) => ", automatic operation",
            Some(AutomaticModel { is_suspended: true, .. }) => ", automatic operation suspended",
        };
        let name = format!("{}: {second}, link {}{automatic}", model.name, model.link.word());
        egui::WidgetInfo::selected(Role::Button, true, model.selected, name)
    });
    ui.painter().rect_filled(rect, RADIUS, if response.hovered() { t.bg3 } else { t.bg2 });
    let border = match (model.selected, model.alarm, model.maintenance) {
        (true, _, _) => t.sat,
        (false, Some(_), _) => t.bad,
        (false, None, true) => t.warn,
        (false, None, false) => t.line,
    };
    ui.painter().rect_stroke(rect, RADIUS, Stroke::new(1.0, border), StrokeKind::Inside);
    let (icon, colour) = model.link.look(t);
    let strong = text::sized(13.0, Weight::SemiBold);
    let centre = rect.center().y;
    if model.maintenance {
        let lock = if form == ChipForm::TwoLines {
            pos2(rect.right() - 12.0, centre - 7.0)
        } else {
            pos2(rect.right() - 13.0, centre)
        };
        icons::paint(ui.painter(), paint::square(lock, 12.0), Icon::Lock, t.warn);
    }
    if form == ChipForm::TwoLines {
        let glyph = paint::square(pos2(rect.left() + 18.0, centre), 14.0);
        icons::paint(ui.painter(), glyph, icon, colour);
        let room = rect.with_min_x(rect.left() + 34.0).with_max_x(rect.right() - 6.0);
        let lock = if model.maintenance { 14.0 } else { 0.0 };
        let mut first = room.translate(vec2(0.0, -7.0)).with_max_x(room.right() - lock);
        if let Some(automatic) = model.automatic {
            let min = pos2(first.right() - TAG.x, first.center().y - TAG.y / 2.0);
            automatic_tag(ui, Rect::from_min_size(min, TAG), automatic.is_suspended);
            first = first.with_max_x(min.x - 4.0);
        }
        paint::text_in(ui, first, Align2::LEFT_CENTER, model.name, strong, t.t1);
        let below = room.translate(vec2(0.0, 8.5));
        let (font, colour) =
            if model.alarm.is_some() { (alarm_font(), t.bad) } else { (text::small(), t.t2) };
        // Next to an alarm, the text shortens the age first, then the activity.
        let in_short = format!("{ALARM}: {}", model.activity);
        let shorter = [&*in_short, ALARM].into_iter().filter(|_| model.alarm.is_some());
        let painted = std::iter::once(&*second)
            .chain(shorter)
            .find(|words| paint::fits(ui, words, font.clone(), below))
            .unwrap_or(&second);
        paint::text_in(ui, below, Align2::LEFT_CENTER, painted, font, colour);
    } else {
        let glyph = paint::square(pos2(rect.left() + 14.0, centre), 13.0);
        icons::paint(ui.painter(), glyph, icon, colour);
        let room = rect.with_min_x(rect.left() + 26.0).with_max_x(rect.right() - 6.0);
        let name = paint::text_in(ui, room, Align2::LEFT_CENTER, model.name, strong, t.t1);
        let mut end = name.right();
        if let Some(automatic) = model.automatic {
            let min = pos2(end + 6.0, centre - TAG.y / 2.0);
            automatic_tag(ui, Rect::from_min_size(min, TAG), automatic.is_suspended);
            end = min.x + TAG.x;
        }
        if model.alarm.is_some() {
            let room = room.with_min_x(end + 6.0);
            let word = paint::text_in(ui, room, Align2::LEFT_CENTER, ALARM, alarm_font(), t.bad);
            end = word.right();
        }
        if form == ChipForm::OneLine && !model.maintenance {
            let (room, age) = (room.with_min_x(end + 6.0), model.short_age());
            paint::text_in(ui, room, Align2::LEFT_CENTER, &age, text::small(), t.t3);
        }
    }
    paint::focus_ring(ui, &response, RADIUS);
    let texts: Vec<&str> =
        model.alarm.into_iter().chain(model.automatic.map(|automatic| automatic.words)).collect();
    if texts.is_empty() { response } else { response.on_hover_text(texts.join("\n")) }
}

/// Paints the tag of automatic operation, dashed while it is suspended.
pub fn automatic_tag(ui: &Ui, rect: Rect, is_suspended: bool) {
    let t = theme::tokens(ui);
    let colour = if is_suspended { t.warn } else { t.t2 };
    if is_suspended {
        paint::dashed_border(ui, rect, 3.0, Stroke::new(1.0, colour));
    } else {
        ui.painter().rect_stroke(rect, 3.0, Stroke::new(1.0, colour), StrokeKind::Inside);
    }
    let font = text::sized(11.0, Weight::Medium);
    paint::text(ui, rect.center(), Align2::CENTER_CENTER, "AUTO", font, colour);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn the_line_of_an_alarm_is_never_cut() {
        for (link, activity, age) in [
            (LinkGlyph::Late, "Late", "4.3 s"),
            (LinkGlyph::Late, "Late", "119 s"),
            (LinkGlyph::Silent, "No reply", "35 s"),
            (LinkGlyph::Lost, "No reply", "23 h 59 min"),
            (LinkGlyph::Off, "Not connected", ""),
            (LinkGlyph::Live, "Tracking", "0.2 s"),
        ] {
            let window = testing::window([300.0, 80.0], (), move |ui, ()| {
                let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(TWO_LINES_WIDTH, 40.0));
                let alarm = Some("RC2000C does not reply");
                let model = ChipModel {
                    name: "RC2000C",
                    link,
                    activity,
                    age,
                    alarm,
                    ..ChipModel::default()
                };
                show(ui, rect, &model, ChipForm::TwoLines);
            });
            let texts = window.output().shapes.iter().filter_map(|clipped| match &clipped.shape {
                egui::Shape::Text(text) => Some(&text.galley),
                _ => None,
            });
            assert!(
                texts.clone().count() == 2 && texts.clone().all(|galley| !galley.elided),
                "{age}"
            );
        }
    }

    #[test]
    fn the_chip_says_what_its_shape_shows() {
        let mut window = testing::window([300.0, 80.0], 0, |ui, clicks| {
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(144.0, 40.0));
            let model = ChipModel {
                name: "RC2000C",
                link: LinkGlyph::Lost,
                activity: "No reply",
                age: "14 s",
                ..ChipModel::default()
            };
            if show(ui, rect, &model, ChipForm::TwoLines).clicked() {
                *clicks += 1;
            }
        });
        window.get_by_label("RC2000C: No reply 14 s, link lost").click();
        window.run();
        assert_eq!(*window.state(), 1);
    }
}
