//! Reading of keep-outs and Sun avoidance. An unreadable entry does not apply, and the operator
//! must know: this is worse than a setting at its default.

use toml::Value;

use super::{NoteReason, TableFields};
use crate::station::{Antenna, Entered, KeepOut, SunAvoidance, ranges};

impl TableFields<'_> {
    /// Reads the keep-outs. Replaces a wrong value with a stricter one, and omits a keep-out
    /// without usable corners with a note.
    pub(super) fn keep_outs(&mut self, antennas: &[Antenna]) -> Vec<KeepOut> {
        let tables = match self.table.remove("keep_out") {
            None => return Vec::new(),
            Some(Value::Array(tables)) => tables,
            Some(_) => {
                self.does_not_hold("keep_out", "keep_out", "must be a list of tables");
                return Vec::new();
            }
        };
        let mut keep_outs: Vec<KeepOut> = Vec::new();
        for (index, value) in tables.into_iter().enumerate() {
            let place = format!("keep_out[{index}]");
            let Value::Table(mut table) = value else {
                self.does_not_hold(&place, &place, "must be a table");
                self.leave_out(&place);
                continue;
            };
            let path = format!("{place}.");
            let mut fields = TableFields::new(&mut table, path);
            let others: Vec<&str> = keep_outs.iter().map(|other| &*other.name).collect();
            let name = fields.keep_out_name(index + 1, &others);
            let keep_out = fields.keep_out(name.clone(), antennas);
            fields.name_the_unknown();
            self.note_all_of(fields);
            let keep_out = keep_out.and_then(|keep_out| {
                let before = keep_outs.iter().map(|other| other.zone.corners().len());
                let excess = KeepOut::excess(before, keep_out.zone.corners().len());
                excess.map_or(Ok(keep_out), Err)
            });
            match keep_out {
                Ok(keep_out) => keep_outs.push(keep_out),
                Err(reason) => {
                    self.does_not_hold(&place, &name, reason);
                    self.leave_out(&place);
                }
            }
        }
        keep_outs
    }

    fn does_not_hold(&mut self, place: &str, name: &str, reason: impl Into<String>) {
        self.note(place, NoteReason::DoesNotHold { name: name.to_owned(), reason: reason.into() });
    }

    fn keep_out_name(&mut self, number: usize, others: &[&str]) -> String {
        let typed = self.text("name", &format!("Keep-out {number}"));
        let name = Antenna::free_name(&typed, others);
        if name != typed {
            let reason = format!("another keep-out has it too, this one is called {name}");
            self.invalid("name", reason);
        }
        name
    }

    fn keep_out(&mut self, name: String, antennas: &[Antenna]) -> Result<KeepOut, String> {
        let entered =
            [("hard", Entered::Hard), ("warn", Entered::Warn), ("go_round", Entered::GoRound)];
        let entered = self.one_of("entered", &entered, Entered::Hard);
        let reason = self.text("reason", "");
        let antenna = self.antenna_of_keep_out(antennas);
        let margin_deg = self.margin_deg();
        let corners = self.table.remove("corners").ok_or("it has no corners")?;
        let corners: Vec<(f64, f64)> = corners
            .try_into()
            .map_err(|_| "corners must be a list of pairs of azimuth and elevation".to_owned())?;
        let zone = KeepOut::zone_of(&corners).map_err(|error| error.to_string())?;
        Ok(KeepOut { name, reason, entered, antenna, margin_deg, zone })
    }

    /// Reads the margin. A margin that is too large becomes the max, not the default.
    fn margin_deg(&mut self) -> f64 {
        let written = self.table.get("margin_deg").and_then(|value| {
            value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
        });
        let is_too_large = written.is_some_and(|margin| margin > *ranges::MARGIN_DEG.end());
        let default =
            if is_too_large { *ranges::MARGIN_DEG.end() } else { KeepOut::DEFAULT_MARGIN_DEG };
        self.number("margin_deg", &ranges::MARGIN_DEG, default)
    }

    /// Reads the antenna of a keep-out. With an unknown antenna, the keep-out applies to the whole
    /// site.
    fn antenna_of_keep_out(&mut self, antennas: &[Antenna]) -> Option<String> {
        let value = self.table.remove("antenna")?;
        let found = value.as_str().and_then(|name| {
            antennas.iter().find(|antenna| Antenna::same_name(&antenna.name, name))
        });
        if found.is_none() {
            self.invalid("antenna", "no antenna has this name, the keep-out holds for all");
        }
        found.map(|antenna| antenna.name.clone())
    }

    pub(super) fn sun_avoidance(&mut self) -> Option<SunAvoidance> {
        const KEY: &str = "sun_avoidance";
        const NAME: &str = "Sun avoidance";
        if !self.table.get(KEY)?.is_table() {
            self.table.remove(KEY);
            self.does_not_hold(KEY, NAME, "must be a table");
            return None;
        }
        let (radius_deg, ahead_min) = self.inner(KEY, |sun| {
            let radius_deg = sun.number("radius_deg", &ranges::SUN_RADIUS_DEG, f64::NAN);
            let default = SunAvoidance::DEFAULT_AHEAD_MIN;
            (radius_deg, sun.number("ahead_min", &ranges::SUN_AHEAD_MIN, default))
        });
        if radius_deg.is_nan() {
            self.does_not_hold(KEY, NAME, "it has no radius that can be used");
            return None;
        }
        Some(SunAvoidance { radius_deg, ahead_min })
    }
}
