//! Offsets of a track as the card shows them.

use super::Locks;
use crate::{
    contract::antenna::AntennaModel,
    model::Model,
    station::OffsetsSubject,
    ui::{
        antenna_card::{OffsetsIn, OffsetsModel},
        state_sentence::short,
        words,
    },
};

/// Values that the section borrows.
pub(super) struct CardOffsets<'a> {
    /// Subjects that Azel can remember the offsets in force for, and whether that would be new.
    keep: Vec<(OffsetsSubject, &'a str, bool)>,
    /// Offsets on the unit, in words.
    on_unit: String,
    /// Offsets that are still on the unit although no track needs them, in words.
    left: Option<String>,
}

impl<'a> CardOffsets<'a> {
    pub(super) fn of(model: &Model, antenna: &'a AntennaModel) -> Self {
        let of_unit = antenna.snapshot.state.on_board.offsets.as_ref();
        Self {
            keep: kept(model, antenna),
            on_unit: words::offsets_on_unit(of_unit),
            left: left(antenna),
        }
    }

    pub(super) fn left(&self) -> Option<&str> {
        self.left.as_deref()
    }

    /// The offsets of the track that runs, from here or on board.
    pub(super) fn model<'b>(
        &'b self,
        antenna: &AntennaModel,
        locks: &Locks<'b>,
    ) -> Option<OffsetsModel<'b>> {
        let can = antenna.variant().capabilities;
        if !antenna.follows() {
            return self.on_unit(antenna, locks);
        }
        let track = antenna.snapshot.program_track.as_ref()?;
        Some(OffsetsModel {
            offsets: track.offsets,
            can_undo: track.can_undo,
            locked: locks.link,
            of: OffsetsIn::Azel {
                target_moves: track.target_moves,
                has_elevation: can.has_elevation(),
                keep: &self.keep,
            },
        })
    }

    fn on_unit<'b>(
        &'b self,
        antenna: &AntennaModel,
        locks: &Locks<'b>,
    ) -> Option<OffsetsModel<'b>> {
        antenna.variant().track_offsets.filter(|_| antenna.tracks())?;
        let snapshot = &antenna.snapshot;
        let added = snapshot.unit_offsets.as_ref();
        let unknown = snapshot.on_board.is_none().then_some(words::OFFSETS_NEED_ELEMENTS);
        Some(OffsetsModel {
            offsets: added.map(|unit| unit.offsets).unwrap_or_default(),
            can_undo: added.is_some_and(|unit| unit.can_undo),
            locked: locks.link.or(unknown),
            of: OffsetsIn::Unit {
                held: &self.on_unit,
                is_changing: added.is_some_and(|unit| unit.is_changing),
            },
        })
    }
}

fn kept<'a>(model: &Model, antenna: &'a AntennaModel) -> Vec<(OffsetsSubject, &'a str, bool)> {
    let Some(track) = &antenna.snapshot.program_track else { return Vec::new() };
    let of_satellite =
        track.catalog_number.map(|number| (OffsetsSubject::Satellite(number), short(&track.name)));
    let of_antenna = (OffsetsSubject::Antenna(antenna.id()), &*antenna.config.name);
    let each = of_satellite.into_iter().chain([of_antenna]);
    let differs = |of: OffsetsSubject| of.part(track.offsets) != model.station.kept_offsets(of);
    each.map(|(of, name)| (of, name, differs(of))).collect()
}

fn left(antenna: &AntennaModel) -> Option<String> {
    let unit = antenna.snapshot.unit_offsets.as_ref()?;
    let is_left = unit.left.is_some() && !unit.offsets.is_none() && !unit.is_changing;
    is_left.then(|| words::offsets(unit.offsets))
}
