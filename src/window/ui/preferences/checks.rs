//! Checks that the settings must pass before Azel saves them.

use super::{draft::Draft, page::Page};
use crate::{
    contract::antenna::AntennaModel,
    model::Model,
    station::{Entered, Mount, Station},
    ui::{format, widgets::status_line::Tone},
};

/// Max difference between a travel and the travel of the unit that counts as equal, degrees.
const SAME_DEG: f64 = 0.5;

/// The result of the checks.
pub(super) struct Checks {
    /// Reason why saving has to wait.
    pub(super) busy: Option<String>,
    /// Problem of an antenna that would stand in a keep-out after the change; the operator has to
    /// hold the button to save.
    pub(super) barrier_problem: Option<String>,
    /// All checks in words, the most severe first.
    pub(super) lines: Vec<(Tone, String)>,
}

impl Checks {
    /// Checks the draft against the saved `station`; `after` is the station of the draft once every
    /// field is valid.
    pub(super) fn new(
        model: &Model,
        station: &Station,
        after: Option<&Station>,
        (draft, before): (&Draft, &Draft),
    ) -> Self {
        let busy = after.and_then(|after| busy(model, station, after));
        let barrier_problem = after.and_then(|after| barrier_problem(model, station, after));
        let mut lines = Vec::new();
        lines.extend(unusable(draft).map(|words| (Tone::Bad, words)));
        lines.extend(
            busy.iter().chain(&barrier_problem).map(|words| (Tone::Caution, words.clone())),
        );
        if let Some(after) = after.filter(|_| draft != before) {
            lines.extend(removed(model, after).map(|words| (Tone::Caution, words)));
            lines.extend(beyond_the_unit(model, after).map(|words| (Tone::Caution, words)));
            lines.extend(idle_rules(draft).map(|words| (Tone::Caution, words)));
            if busy.is_none() {
                lines.extend(changed(model, after).map(|words| (Tone::Good, words)));
            }
        }
        Self { busy, barrier_problem, lines }
    }
}

/// Describes the invalid fields, starting with the first one.
fn unusable(draft: &Draft) -> Option<String> {
    let pages = Page::all(draft).into_iter();
    let named: Vec<String> = pages
        .flat_map(|page| {
            let title = page.title(draft);
            let findings = draft.findings(page).into_iter();
            findings.map(move |finding| format!("{} in {title}", finding.label))
        })
        .collect();
    match &named[..] {
        [] => None,
        [only] => Some(format!("1 field is not valid: {only}. Nothing is saved until it is.")),
        [first, others @ ..] => Some(format!(
            "{} fields are not valid: {first} and others. Nothing is saved until they are.",
            others.len() + 1
        )),
    }
}

/// Describes the enabled rules that cannot act, starting with the first one.
fn idle_rules(draft: &Draft) -> Option<String> {
    let idle = draft.rules.idle(&draft.around_rules());
    let (number, reason) = idle.first()?;
    Some(match idle.len() {
        1 => format!("Rule {number} cannot act: {reason}."),
        many => format!("{many} rules cannot act: {number}, because {reason}, and others."),
    })
}

/// Returns the antennas that saving removes. Antennas of the demonstration do not count.
fn removed(model: &Model, after: &Station) -> impl Iterator<Item = String> {
    let is_kept = |id| after.antennas.iter().any(|antenna| antenna.id == id);
    let missing = model
        .antennas
        .iter()
        .filter(move |model_antenna| !model.demo && !is_kept(model_antenna.id()));
    missing.map(|model_antenna| {
        format!("{} is removed from the station with its settings.", model_antenna.config.name)
    })
}

/// Returns the antennas whose new travel exceeds the travel of their unit.
fn beyond_the_unit(model: &Model, after: &Station) -> impl Iterator<Item = String> {
    after.antennas.iter().filter_map(|antenna| {
        let model_antenna = model.antenna_of(antenna.id)?;
        if *model_antenna.config == *antenna || matches!(antenna.mount, Mount::Xy { .. }) {
            return None;
        }
        let pairs = antenna.mount.travel_deg().into_iter().zip(model_antenna.snapshot.state.travel_deg);
        let outside = pairs.zip(["azimuth", "elevation"]).find_map(|((typed, unit), axis)| {
            let unit = unit?;
            let is_beyond = typed.0 < unit.0 - SAME_DEG || typed.1 > unit.1 + SAME_DEG;
            is_beyond.then_some((axis, unit))
        });
        let (axis, (start, end)) = outside?;
        let [start_text, end_text] = [start, end].map(|deg| format::degrees(deg, 0));
        Some(format!(
            "{}: the unit itself turns its {axis} from {start_text} to {end_text} and stops there until that \
             is changed.",
            antenna.name
        ))
    })
}

/// Returns sentences for the antennas that saving connects or reconnects. None of these antennas
/// moves.
fn changed(model: &Model, after: &Station) -> impl Iterator<Item = String> {
    after.antennas.iter().filter_map(|antenna| {
        let name = &antenna.name;
        match model.antenna_of(antenna.id) {
            Some(model_antenna) if *model_antenna.config == *antenna => None,
            Some(_) => Some(format!("{name} does not move. Saving reconnects it.")),
            None => Some(format!("{name} is new. Saving connects it.")),
        }
    })
}

/// Returns the reason why `after` has to wait. It would interrupt a motion by changing or removing
/// an antenna, move the site during a track, or remove a keep-out while an antenna moves. A change
/// that only tightens bounds never waits.
fn busy(model: &Model, before: &Station, after: &Station) -> Option<String> {
    // The simulators of the demonstration end with the demonstration.
    let mut antennas =
        model.antennas.iter().filter(|model_antenna| !model.demo && model_antenna.is_busy());
    let loosened = before.loosened_in(after);
    antennas.find_map(|antenna| {
        let name = &antenna.config.name;
        if !after.antennas.contains(&antenna.config) {
            return Some(format!("{name} moves or tracks. Stop it, then save."));
        }
        if before.site != after.site {
            return Some(format!(
                "{name} moves or tracks. To change the site or its air, stop it, then save."
            ));
        }
        let loosened = loosened?;
        Some(format!("{name} moves or tracks. To loosen {loosened}, stop it, then save."))
    })
}

/// Returns a warning for an antenna that is inside a keep-out of `after`, but was not in `before`.
fn barrier_problem(model: &Model, before: &Station, after: &Station) -> Option<String> {
    let holds_in = |station: &Station, antenna: &AntennaModel| {
        let direction = antenna.snapshot.state.measured?.direction()?;
        let half_beam = antenna.config.beam_width() * 0.5;
        let mut hold = station.keep_outs.iter().filter(|keep_out| {
            keep_out.entered != Entered::Warn && keep_out.holds_for(&antenna.config.name)
        });
        let found = hold
            .find(|keep_out| keep_out.zone.clearance(direction) < keep_out.margin() + half_beam);
        found.map(|keep_out| keep_out.name.clone())
    };
    // The antennas of the demonstration end with the demonstration.
    model.antennas.iter().filter(|_| !model.demo).find_map(|antenna| {
        let zone = holds_in(after, antenna)?;
        let is_new = holds_in(before, antenna).as_ref() != Some(&zone);
        let name = &antenna.config.name;
        is_new.then(|| {
            format!(
                "{name} is inside \u{201c}{zone}\u{201d} now. It can be moved out by hand once \
                 you allow it."
            )
        })
    })
}
