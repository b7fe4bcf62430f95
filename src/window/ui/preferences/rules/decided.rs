//! The passes of the next 48 h that each edited rule decides.

use std::sync::Arc;

use jiff::Timestamp;

use crate::{
    contract::passes::PredictedPass,
    model::Model,
    plan::schedule::{deciding_rule, sun_is},
    station::{AntennaId, Station},
};

const AHEAD_H: u32 = 48;
/// Time for which the evaluated passes stay valid, seconds.
const KEPT_S: i64 = 30;

/// A pass that a rule decides.
pub(super) struct DecidedPass {
    /// Catalog number of the satellite.
    pub(super) satellite: u32,
    pub(super) aos: Timestamp,
    pub(super) max_elevation_deg: f64,
    /// Antennas for which the rule decides the pass.
    pub(super) antennas: Vec<AntennaId>,
}

/// The decided passes, by index of the rule in `station`.
pub(super) struct Decided {
    station: Station,
    passes: Arc<Vec<PredictedPass>>,
    time: Timestamp,
    of_rules: Vec<Vec<DecidedPass>>,
}

impl Decided {
    pub(super) fn new(station: Station, model: &Model) -> Self {
        let list = &model.pass_lists.favourites;
        let mut of_rules: Vec<Vec<DecidedPass>> = station.rules.iter().map(|_| vec![]).collect();
        for predicted in list.upcoming_within(model.now, AHEAD_H).iter() {
            let (number, pass) = (predicted.number(), &predicted.pass);
            let moment = (pass.tca.time, sun_is(&station, pass.tca.time));
            for antenna in &station.antennas {
                let rule = deciding_rule(&station, number, moment, antenna.id);
                let Some(of_rule) = rule.and_then(|rule| of_rules.get_mut(rule)) else { continue };
                match of_rule.last_mut() {
                    Some(last) if last.satellite == number && last.aos == pass.aos.time => {
                        last.antennas.push(antenna.id);
                    }
                    _ => of_rule.push(DecidedPass {
                        satellite: number,
                        aos: pass.aos.time,
                        max_elevation_deg: pass.tca.direction.elevation_deg(),
                        antennas: vec![antenna.id],
                    }),
                }
            }
        }
        Self { station, passes: Arc::clone(&list.passes), time: model.now, of_rules }
    }

    pub(super) fn is_of(&self, station: &Station, model: &Model) -> bool {
        let age_s = (model.now.as_second() - self.time.as_second()).abs();
        self.station == *station
            && age_s < KEPT_S
            && Arc::ptr_eq(&self.passes, &model.pass_lists.favourites.passes)
    }

    /// Returns the passes that the rule at this index decides, by AOS.
    pub(super) fn rule(&self, place: usize) -> &[DecidedPass] {
        self.of_rules.get(place).map(Vec::as_slice).unwrap_or_default()
    }
}
