//! Where uploads meet the antennas' sessions.

use super::{Ask, Selection, UnitNow};
use crate::app::{App, antenna::AntennaModel};

impl App {
    pub(in crate::app) fn ask_about_upload(&mut self, ask: Ask) {
        let (antennas, now) = (&self.model.antennas, self.model.now);
        let find = |name: &str| antennas.iter().find(|one| one.config.name == name);
        let unit_of = |name: &str| UnitNow::of(find(name), now);
        let selection = self.uploads.ask(ask, unit_of, &mut self.model.uploads);
        self.select(selection);
    }

    pub(in crate::app) fn poll_uploads(&mut self) {
        let unit = UnitNow::of(self.upload_antenna(), self.model.now);
        let selection = self.uploads.poll(&unit, self.model.steady, &mut self.model.uploads);
        self.select(selection);
    }

    fn upload_antenna(&self) -> Option<&AntennaModel> {
        let name = &self.model.uploads.antenna;
        self.model.antennas.iter().find(|antenna| antenna.config.name == *name)
    }

    fn select(&mut self, selection: Option<Selection>) {
        let Some(selection) = selection else { return };
        let Some(antenna) = self.upload_antenna() else {
            let text = "the antenna is not in the station any more".to_owned();
            return self.uploads.not_selected(text, &mut self.model.uploads);
        };
        if antenna.handle.send(selection.command()).is_err() {
            let text = "the session of the antenna is too busy to take it".to_owned();
            self.uploads.not_selected(text, &mut self.model.uploads);
        }
    }
}
