//! State of an antenna between passes: its place, and the time at which it sets out to the next
//! pass.

use jiff::Timestamp;

use crate::{
    astro::time::add_seconds,
    plan::schedule::{Entry, sun_is},
    station::{Antenna, AutomationRule, BetweenPasses, RuleAction, Station},
};

/// Max time by which Azel sends an antenna to a pass earlier than necessary, seconds.
pub const LEAD_S: f64 = 60.0;

/// Returns the state of the antenna between passes at `time`, by its settings and by the rules of
/// the station.
pub fn between_passes(station: &Station, antenna: &Antenna, time: Timestamp) -> BetweenPasses {
    let mut rules = station.rules.iter().filter(|rule| rule.is_for(antenna.id)).peekable();
    // Compute the Sun only if a rule may need it.
    if rules.peek().is_none() {
        return antenna.automatic.between_passes;
    }
    let sun = sun_is(station, time);
    // A rule about a satellite or a group does not apply between passes.
    let mut holding = rules.filter(|rule| rule.subject.is_none() && rule.holds_at(time, sun));
    match holding.next() {
        Some(AutomationRule { action: RuleAction::Park, .. }) => BetweenPasses::Park,
        _ => antenna.automatic.between_passes,
    }
}

/// Returns the min time left after a pass for parking, both ways, seconds.
pub fn parks_within_s(antenna: &Antenna) -> f64 {
    antenna.longest_slew_s() + LEAD_S
}

/// Returns the latest time at which an antenna sets out to an entry.
pub fn sets_out(entry: &Entry, plan: BetweenPasses) -> Timestamp {
    let before_s = match plan {
        // The antenna sets out as soon as the previous pass is over.
        BetweenPasses::Wait => entry.slew_s + entry.set_up_s + entry.spare_s.unwrap_or_default(),
        BetweenPasses::Stay | BetweenPasses::Park => {
            let lead_s = entry.spare_s.unwrap_or(LEAD_S).clamp(0.0, LEAD_S);
            entry.slew_s + entry.set_up_s + lead_s
        }
    };
    add_seconds(entry.start, -before_s)
}
