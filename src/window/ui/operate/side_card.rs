//! Card of one more antenna beside the selected antenna's card, in a wide window.

use super::card::CardState;
use crate::{
    contract::antenna::AntennaModel,
    model::{Model, UiCommand},
    station::AntennaId,
};

/// Antenna of the card, with the state of the card.
#[derive(Default)]
pub(super) struct SideCard {
    /// Previously selected antenna, on the first of these cards.
    before: Option<AntennaId>,
    shown: Option<AntennaId>,
    card: CardState,
}

impl SideCard {
    /// Notes that the operator selected another antenna; `before` was selected until now.
    pub(super) fn turn_to(&mut self, before: Option<AntennaId>) {
        self.before = before;
    }

    /// Returns the antenna of the card: the previously selected one, else the next of the station
    /// that no card shows yet.
    pub(super) fn antenna<'a>(
        &mut self,
        model: &'a Model,
        shown: &[AntennaId],
        commands: &mut Vec<UiCommand>,
    ) -> Option<&'a AntennaModel> {
        let is_other = |model_antenna: &&AntennaModel| !shown.contains(&model_antenna.id());
        let before = self.before.and_then(|id| model.antenna_of(id)).filter(is_other);
        let next_antennas = model.antennas.iter().skip(model.selected_antenna);
        let antenna = before.or_else(|| next_antennas.chain(&model.antennas).find(is_other));
        let id = antenna.map(AntennaModel::id);
        if self.shown != id {
            self.leave(commands);
            self.card.change_antenna();
            self.shown = id;
        }
        antenna
    }

    pub(super) fn card(&mut self) -> &mut CardState {
        &mut self.card
    }

    /// Releases a key that the operator holds on the card.
    pub(super) fn leave(&mut self, commands: &mut Vec<UiCommand>) {
        self.card.hide(self.shown, commands);
    }
}
