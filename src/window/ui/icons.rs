//! Line icons on a grid of 20 by 20 with a stroke of 1.5.

mod pen;
mod shapes;

use egui::{Color32, Painter, Rect};

use pen::Pen;

/// Icons of the window, by their meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Icon {
    /// STOP, and alarms of the first priority.
    Octagon,
    /// Alarms.
    Bell,
    /// Caution, and alarms of the second priority.
    Warning,
    /// Good state.
    Check,
    /// Fault, or an impossible pass.
    Cross,
    /// Left-out pass, or an unknown value.
    Dash,
    /// Locked control, or a refusal for now.
    Lock,
    /// Menu below, or an open fold.
    ChevronDown,
    /// Menu beside, a closed fold, or a sent line.
    ChevronRight,
    /// Received line.
    ChevronLeft,
    /// View: Operate.
    CrossHair,
    /// View: Plan.
    Bars,
    /// View: Elements.
    Orbit,
    /// View: Antennas.
    Antenna,
    /// View: Console.
    Prompt,
    /// View: Record.
    Pulse,
    /// View: Map.
    Globe,
    /// View: Preferences.
    Sliders,
    /// Link: replies in time.
    Disc,
    /// Link: late replies.
    HalfDisc,
    /// Link: no replies.
    CrossedRing,
    /// Link: disconnected.
    OpenRing,
    /// Layers of the sky plot.
    Layers,
    /// A note or a legend.
    Info,
    /// The list of keys.
    Question,
    /// A search.
    Search,
    /// Typed value that is not sent yet.
    Pencil,
    /// Button that reveals hidden text.
    Eye,
    /// Time of a later event.
    Clock,
    /// A favourite.
    Star,
    /// Satellite that is no favourite.
    OpenStar,
    /// Button that adds something.
    Plus,
    /// A source: a server.
    Server,
    /// A source: a file.
    File,
    /// A source: a folder.
    Folder,
    /// A source: the elements that come with Azel.
    Package,
    /// Transfer to a unit.
    Upload,
    /// Export to a file.
    Download,
    /// Copy to the clipboard.
    Copy,
    /// Button that asks again.
    Refresh,
}

/// Paints an icon in one colour, scaled so that its grid fills `rect`.
pub fn paint(painter: &Painter, rect: Rect, icon: Icon, colour: Color32) {
    shapes::draw(&Pen::new(painter, rect, colour), icon);
}

/// Paints the logo in two colours: the bowl, and the feed that points at the satellite.
pub fn paint_sign(painter: &Painter, rect: Rect, bowl: Color32, feed: Color32) {
    shapes::bowl(&Pen::new(painter, rect, bowl));
    shapes::feed(&Pen::new(painter, rect, feed));
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Sense, vec2};

    const ALL: [Icon; 39] = [
        Icon::Octagon,
        Icon::Bell,
        Icon::Warning,
        Icon::Check,
        Icon::Cross,
        Icon::Dash,
        Icon::Lock,
        Icon::ChevronDown,
        Icon::ChevronRight,
        Icon::ChevronLeft,
        Icon::CrossHair,
        Icon::Orbit,
        Icon::Antenna,
        Icon::Prompt,
        Icon::Pulse,
        Icon::Globe,
        Icon::Sliders,
        Icon::Disc,
        Icon::HalfDisc,
        Icon::CrossedRing,
        Icon::OpenRing,
        Icon::Layers,
        Icon::Info,
        Icon::Question,
        Icon::Search,
        Icon::Pencil,
        Icon::Eye,
        Icon::Clock,
        Icon::Star,
        Icon::OpenStar,
        Icon::Plus,
        Icon::Server,
        Icon::File,
        Icon::Folder,
        Icon::Package,
        Icon::Upload,
        Icon::Download,
        Icon::Copy,
        Icon::Refresh,
    ];

    #[test]
    fn every_icon_paints_inside_its_square() {
        for icon in ALL {
            let mut harness =
                egui_kittest::Harness::builder().with_size([80.0, 80.0]).build_ui(move |ui| {
                    let (rect, _) = ui.allocate_exact_size(vec2(20.0, 20.0), Sense::hover());
                    let before = ui.painter().layer_id();
                    paint(ui.painter(), rect, icon, ui.visuals().text_color());
                    ui.ctx().graphics(|graphics| {
                        let list = graphics.get(before).expect("painted");
                        let mut count = 0;
                        for shape in list.all_entries() {
                            let bounds = shape.shape.visual_bounding_rect();
                            if bounds.is_positive() && bounds.width() < 60.0 {
                                count += 1;
                                assert!(
                                    rect.expand(1.0).contains_rect(bounds),
                                    "{icon:?} {bounds}"
                                );
                            }
                        }
                        assert!(count > 0, "{icon:?} paints nothing");
                    });
                });
            harness.run();
        }
    }
}
