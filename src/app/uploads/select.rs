//! Tells a unit to use a file that was put on it.

use jiff::Timestamp;

use crate::{
    app::antenna::AntennaModel,
    driver::files::{FileObject, Uploaded},
};

/// Why the operator has to agree before a unit is told to use a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Busy {
    /// It tracks, which will end.
    Tracks,
    /// Its auto-track is on: it may begin to track the satellite by itself.
    MayTrack,
}

impl Busy {
    /// What the unit of `antenna` is about.
    fn of(antenna: &AntennaModel) -> Option<Self> {
        let program = antenna.snapshot.state.program?;
        if program.enabled {
            return Some(Self::Tracks);
        }
        (program.auto == Some(true)).then_some(Self::MayTrack)
    }
}

/// How the unit of an antenna is.
#[derive(Debug, Clone, Default)]
pub(in crate::app) struct UnitNow {
    /// Why the operator has to agree before it is told to use a file.
    pub(super) busy: Option<Busy>,
    /// The catalogue number of the satellite that it holds.
    pub(super) held: Option<u32>,
    /// The ticket of the last selection that is over, when that was, and how it
    /// ended.
    pub(super) answer: Option<(u64, Timestamp, Result<(), String>)>,
}

impl UnitNow {
    /// As the session of `antenna` knows it.
    pub(in crate::app) fn of(antenna: Option<&AntennaModel>) -> Self {
        let Some(antenna) = antenna else { return Self::default() };
        let state = &antenna.snapshot.state;
        Self {
            busy: Busy::of(antenna),
            held: state.satrak.satellite.as_ref().map(|held| held.catalog_number),
            answer: None,
        }
    }
}

/// A satellite of a file that a unit is to use.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::app) struct Selection {
    /// Told again with the outcome.
    pub(super) ticket: u64,
    /// The file.
    pub(super) file: String,
    /// The satellite.
    pub(super) satellite: FileObject,
}

/// The satellite to use out of `uploaded`: the `wanted` one, or the one that
/// the unit holds, or the first.
pub(super) fn pick(
    uploaded: &Uploaded,
    wanted: Option<u32>,
    held: Option<u32>,
) -> Option<&FileObject> {
    let objects = &uploaded.objects;
    let find = |number: u32| objects.iter().find(|object| object.catalog_number == number);
    wanted.and_then(find).or_else(|| held.and_then(find)).or(objects.first())
}
