//! Where uploads meet the antennas' sessions.

use super::{Ask, Selection, UnitNow};
use crate::app::{App, antenna::AntennaModel};

impl App {
    pub(in crate::app) fn ask_about_upload(&mut self, ask: Ask) {
        let antennas = &self.model.antennas;
        let unit_of = |name: &str| UnitNow::of(antennas.iter().find(|one| one.config.name == name));
        let selection = self.uploads.ask(ask, unit_of, &mut self.model.uploads);
        self.select(selection);
    }

    pub(in crate::app) fn poll_uploads(&mut self) {
        let unit = UnitNow::of(self.upload_antenna());
        let selection = self.uploads.poll(&unit, self.model.steady, &mut self.model.uploads);
        self.select(selection);
    }

    fn upload_antenna(&self) -> Option<&AntennaModel> {
        let name = &self.model.uploads.antenna;
        self.model.antennas.iter().find(|antenna| antenna.config.name == *name)
    }

    fn select(&mut self, selection: Option<Selection>) {
        let Some(_selection) = selection else { return };
        self.uploads.not_selected("seam".to_owned(), &mut self.model.uploads);
    }
}
