//! Connection of uploads with the sessions of the antennas.

use std::sync::Arc;

use super::{SessionRequest, UnitNow};
use crate::{
    contract::{
        automatic::Interruption,
        driver::Command,
        transfer::FileObject,
        uploads::{Ask, Stage},
    },
    engine::{Antenna, Engine, automatic::Operate, uploads::order::target},
};

impl Engine {
    pub(in crate::engine) fn ask_about_upload(&mut self, ask: Ask) {
        let (antennas, now, steady) = (&self.antennas, self.now, self.steady);
        let find = |name: &str| antennas.iter().find(|one| one.shown.config.name == name);
        let unit_of = |name: &str| UnitNow::new(find(name).map(|one| &one.shown), now, steady);
        let request = self.upload_runner.ask(ask, unit_of, &mut self.uploads);
        self.tell_unit(request);
    }

    pub(in crate::engine) fn poll_uploads(&mut self) {
        let antenna = self.upload_antenna().map(|antenna| &antenna.shown);
        let unit = UnitNow::new(antenna, self.now, self.steady);
        let was_open = self.uploads.stage.is_open();
        let request = self.upload_runner.poll(&unit, self.steady, &mut self.uploads);
        self.tell_unit(request);
        if was_open && let Stage::Proved(proved) = &self.uploads.stage {
            let objects = proved.uploaded.objects.clone();
            self.use_upload(&objects);
        }
        self.end_rule_upload();
    }

    /// Records a verified upload, and configures the antenna to track from its file. An antenna
    /// without a configured file keeps the unit's current file.
    fn use_upload(&mut self, objects: &[FileObject]) {
        let Some(config) = self.upload_antenna().map(|antenna| Arc::clone(&antenna.shown.config))
        else {
            return;
        };
        let Some(target) = self.upload_runner.order().map(target) else { return };
        let file = target.file.clone();
        self.note_upload(&config, target, objects);
        if config.connection.element_file().is_none_or(|configured| configured == file) {
            return;
        }
        let (id, mut config) = (config.id, config);
        if let Err(reason) = Arc::make_mut(&mut config).connection.use_element_file(&file) {
            tracing::error!(file, ?reason, "the element file cannot be set");
            return;
        }
        self.change_station(|station| {
            if let Some(configured) = station.antennas.iter_mut().find(|antenna| antenna.id == id) {
                configured.connection = config.connection.clone();
            }
        });
        let is_kept = self.station.antennas.contains(&*config);
        if let Some(antenna) = self.antennas.iter_mut().find(|one| one.shown.id() == id)
            && is_kept
        {
            antenna.shown.config = config;
        }
    }

    fn upload_antenna(&self) -> Option<&Antenna> {
        let name = &self.uploads.antenna;
        let is_it = |antenna: &&Antenna| {
            let shown = &antenna.shown;
            let id = self.rule_upload.as_ref().map(|upload| upload.antenna);
            shown.config.name == *name && id.is_none_or(|id| shown.id() == id)
        };
        self.antennas.iter().find(is_it)
    }

    fn tell_unit(&mut self, request: Option<SessionRequest>) {
        let Some(request) = request else { return };
        let name = &self.uploads.antenna;
        let place = self.antennas.iter().position(|one| one.shown.config.name == *name);
        let Some((place, antenna)) =
            place.and_then(|index| Some((index, self.antennas.get_mut(index)?)))
        else {
            let text = "the antenna is not in the station any more".to_owned();
            return self.upload_runner.not_selected(text, &mut self.uploads);
        };
        let commands = match request {
            SessionRequest::Rest => {
                // The operator has agreed to end the track.
                antenna.shown.operation.suspend(Interruption::ByHand, self.now);
                vec![Command::Standby, Command::AutoTrack(false)]
            }
            SessionRequest::Use(selection) => vec![selection.command()],
        };
        let number = self.number();
        let mut commands = commands.into_iter();
        let is_turned_away = commands.any(|command| {
            self.note_sent(place, &command);
            let antenna = self.antennas.get(place);
            antenna.is_none_or(|antenna| antenna.handle.send_as(command, number).is_err())
        });
        if is_turned_away {
            let text = "the session of the antenna is too busy to take it".to_owned();
            self.upload_runner.not_selected(text, &mut self.uploads);
        }
    }
}
