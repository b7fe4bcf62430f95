//! Where uploads meet the antennas' sessions.

use super::{Ask, Told, UnitNow};
use crate::{
    app::{App, antenna::AntennaModel},
    driver::Command,
};

impl App {
    pub(in crate::app) fn ask_about_upload(&mut self, ask: Ask) {
        let (antennas, now, steady) = (&self.model.antennas, self.model.now, self.model.steady);
        let find = |name: &str| antennas.iter().find(|one| one.config.name == name);
        let unit_of = |name: &str| UnitNow::of(find(name), now, steady);
        let told = self.uploads.ask(ask, unit_of, &mut self.model.uploads);
        self.tell_unit(told);
    }

    pub(in crate::app) fn poll_uploads(&mut self) {
        let unit = UnitNow::of(self.upload_antenna(), self.model.now, self.model.steady);
        let told = self.uploads.poll(&unit, self.model.steady, &mut self.model.uploads);
        self.tell_unit(told);
    }

    fn upload_antenna(&self) -> Option<&AntennaModel> {
        let name = &self.model.uploads.antenna;
        self.model.antennas.iter().find(|antenna| antenna.config.name == *name)
    }

    fn tell_unit(&mut self, told: Option<Told>) {
        let Some(told) = told else { return };
        let Some(antenna) = self.upload_antenna() else {
            let text = "the antenna is not in the station any more".to_owned();
            return self.uploads.not_selected(text, &mut self.model.uploads);
        };
        let commands = match told {
            Told::Rest => vec![Command::Standby, Command::AutoTrack(false)],
            Told::Use(selection) => vec![selection.command()],
        };
        if commands.into_iter().any(|command| antenna.handle.send(command).is_err()) {
            let text = "the session of the antenna is too busy to take it".to_owned();
            self.uploads.not_selected(text, &mut self.model.uploads);
        }
    }
}
