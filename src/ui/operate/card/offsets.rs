//! Offsets of a track as the card shows them.

use super::Locks;
use crate::{
    engine::antenna::AntennaModel,
    model::Model,
    station::OffsetsOf,
    ui::{
        antenna_card::{OffsetPad, OffsetsModel},
        state_sentence::short,
        words,
    },
};

/// What the section borrows.
pub(super) struct CardOffsets<'a> {
    /// What the offsets that are on can be remembered of, and whether that would be new.
    keep: Vec<(OffsetsOf, &'a str, bool)>,
    /// Those of the unit, in words.
    on_unit: String,
}

impl<'a> CardOffsets<'a> {
    pub(super) fn of(model: &Model, antenna: &'a AntennaModel) -> Self {
        let of_unit = antenna.snapshot.state.on_board.offsets.as_ref();
        Self { keep: kept(model, antenna), on_unit: words::offsets_on_unit(of_unit) }
    }

    /// The offsets of the track that runs, from here or on board.
    pub(super) fn model(&self, antenna: &AntennaModel, locks: &Locks) -> Option<OffsetsModel<'_>> {
        let can = antenna.variant().capabilities;
        if !antenna.follows() {
            let is_on_board = can.has_program && antenna.tracks();
            return is_on_board.then_some(OffsetsModel::OnUnit(&self.on_unit));
        }
        let track = antenna.snapshot.program_track.as_ref()?;
        Some(OffsetsModel::FromHere(OffsetPad {
            offsets: track.offsets,
            can_undo: track.can_undo,
            target_moves: track.target_moves,
            has_elevation: can.has_elevation(),
            locked: locks.link,
            keep: &self.keep,
        }))
    }
}

fn kept<'a>(model: &Model, antenna: &'a AntennaModel) -> Vec<(OffsetsOf, &'a str, bool)> {
    let Some(track) = &antenna.snapshot.program_track else { return Vec::new() };
    let of_satellite =
        track.catalog_number.map(|number| (OffsetsOf::Satellite(number), short(&track.name)));
    let of_antenna = (OffsetsOf::Antenna(antenna.id()), &*antenna.config.name);
    let each = of_satellite.into_iter().chain([of_antenna]);
    let differs = |of: OffsetsOf| of.part(track.offsets) != model.station.kept_offsets(of);
    each.map(|(of, name)| (of, name, differs(of))).collect()
}
