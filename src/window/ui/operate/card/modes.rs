//! Selector of the antenna's mode.

use egui::{Rect, Ui};

use super::{
    Card,
    track::{TrackState, track_selected},
};
use crate::{
    contract::{
        antenna::AntennaModel,
        driver::{Command, Intent, LinkState},
    },
    device::Capabilities,
    ui::widgets::segmented::{self, Segment},
};

/// All modes in the order of display.
const ALL: [Intent; 5] =
    [Intent::Standby, Intent::Manual, Intent::Position, Intent::Track, Intent::Park];

fn word(mode: Intent) -> &'static str {
    match mode {
        Intent::Standby => "Standby",
        Intent::Manual => "Manual",
        Intent::Position => "Position",
        Intent::Track => "Track",
        Intent::Park => "Park",
    }
}

/// Returns `true` for a mode that a controller with these capabilities offers.
pub(super) fn offers(capabilities: Capabilities, mode: Intent) -> bool {
    match mode {
        Intent::Standby | Intent::Manual => true,
        Intent::Position | Intent::Park => capabilities.takes_positions,
        Intent::Track => capabilities.has_program || capabilities.takes_positions,
    }
}

/// Shows the modes that the controller offers. A click requests the mode at once, except Park,
/// which takes a hold.
pub(super) fn show(ui: &Ui, rect: Rect, card: &mut Card<'_>, track: &mut TrackState) {
    let capabilities = card.antenna.variant().capabilities;
    let is_locked = card.model.replay.is_some();
    let modes: Vec<Intent> = ALL.into_iter().filter(|mode| offers(capabilities, *mode)).collect();
    let segments: Vec<(&str, Segment)> =
        modes.iter().map(|mode| (word(*mode), segment(card.antenna, is_locked, *mode))).collect();
    let clicked = segmented::show_commands(ui, "mode", rect, "Mode", &segments);
    let Some(mode) = clicked.and_then(|clicked| modes.get(clicked)) else { return };
    track.ask_to_park(*mode == Intent::Park);
    match mode {
        Intent::Standby => card.queue(Command::Standby),
        Intent::Manual => card.queue(Command::Manual),
        Intent::Position => card.queue(Command::Hold),
        Intent::Track => track_selected(card, false),
        Intent::Park => {}
    }
}

fn segment(antenna: &AntennaModel, is_locked: bool, mode: Intent) -> Segment {
    let snapshot = &antenna.snapshot;
    // The antenna tracks without a request from this console.
    let is_foreign = antenna.tracks_unasked();
    let current = if is_foreign { Intent::Track } else { snapshot.intent };
    if is_locked || snapshot.link == LinkState::Off {
        Segment::Locked(None)
    } else if mode != current {
        Segment::Free
    } else if snapshot.pending {
        Segment::Pending
    } else if is_foreign {
        Segment::Foreign
    } else {
        Segment::Chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::station::Antenna;

    #[test]
    fn a_mode_that_the_controller_cannot_take_is_left_out() {
        let genius = Antenna::genius("Mast", "").connection.variant().capabilities;
        let offered = |takes_positions, has_program| {
            let capabilities = Capabilities { takes_positions, has_program, ..genius };
            ALL.into_iter().filter(|mode| offers(capabilities, *mode)).map(word).collect::<Vec<_>>()
        };
        assert_eq!(offered(true, false), ["Standby", "Manual", "Position", "Track", "Park"]);
        assert_eq!(offered(false, true), ["Standby", "Manual", "Track"]);
        assert_eq!(offered(false, false), ["Standby", "Manual"]);
    }
}
