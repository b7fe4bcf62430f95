//! Line icons, painted on a grid of 20 by 20 with a stroke of 1.5.

mod pen;
mod shapes;

use egui::{Color32, Painter, Rect};

use pen::Pen;

/// Every icon of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Icon {
    /// STOP, and alarms of the first priority.
    Octagon,
    /// Alarms.
    Bell,
    /// Caution, and alarms of the second priority.
    Warning,
    /// Good.
    Check,
    /// Impossible, fault.
    Cross,
    /// Left out, unknown.
    Dash,
    /// Refused for now.
    Lock,
    /// Opens below; an open fold.
    ChevronDown,
    /// Opens beside; a closed fold; sent.
    ChevronRight,
    /// Received.
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
    /// Link: late.
    HalfDisc,
    /// Link: lost.
    CrossedRing,
    /// Link: switched off.
    OpenRing,
    /// Layers of the sky plot.
    Layers,
    /// A note or a legend.
    Info,
    /// The list of keys.
    Question,
    /// A search.
    Search,
    /// Typed and not sent yet.
    Pencil,
    /// Shows what is hidden.
    Eye,
    /// Put off until a time.
    Clock,
    /// A favourite.
    Star,
    /// No favourite.
    OpenStar,
    /// Adds something.
    Plus,
    /// A source: a server.
    Server,
    /// A source: a file.
    File,
    /// A source: a folder.
    Folder,
    /// A source: what comes with the program.
    Package,
    /// To a unit.
    Upload,
    /// To a file.
    Download,
    /// To the clipboard.
    Copy,
    /// Asks again.
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
