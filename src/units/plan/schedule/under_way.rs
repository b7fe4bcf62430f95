//! Pass that an antenna already tracks or waits for, as an entry that a schedule keeps.

use jiff::Timestamp;

use super::{
    Candidate, Choice, Entry, PlannedAntenna,
    solve::PassPart,
    way::{Span, Verdict, Way, at_ms, ms},
};
use crate::station::ChooseBy;

impl Candidate {
    /// Returns the rest of this pass at `now` for an antenna that tracks it, or waits for it to
    /// begin. Returns `None` if the pass is over, if the antenna takes no passes, or if it cannot
    /// take this one.
    pub fn under_way(
        &self,
        antenna: &PlannedAntenna,
        choose_by: ChooseBy,
        now: Timestamp,
    ) -> Option<Entry> {
        let option = self.options.iter().find(|(id, _)| *id == antenna.id);
        let (_, Choice::Judged(Verdict::Possible(ways))) = option? else { return None };
        let now_ms = ms(now);
        let away_deg = |way: &&Way| {
            antenna.stands_deg.map_or(0.0, |stands_deg| {
                let pairs = stands_deg.into_iter().zip(way.axes_deg(now_ms));
                pairs.map(|(stands, target)| (stands - target).abs()).fold(0.0, f64::max)
            })
        };
        // The axis positions show on which turn they follow the pass.
        let way = ways.iter().min_by(|a, b| away_deg(a).total_cmp(&away_deg(b)))?;
        let Span { from_ms, to_ms } = way.span();
        let rest = Span { from_ms: from_ms.max(now_ms), to_ms };
        if antenna.off_reason.is_some() || rest.length_ms() <= 0 {
            return None;
        }
        Some(self.fixed(antenna, choose_by, way, rest))
    }

    /// Returns the rest of this pass for an antenna that was taking it and has stopped. The antenna
    /// sets out as soon as it is free. Returns `None` if it cannot arrive before the end, or if its
    /// position is unknown.
    pub fn resumed(&self, antenna: &PlannedAntenna, choose_by: ChooseBy) -> Option<Entry> {
        let option = self.options.iter().find(|(id, _)| *id == antenna.id);
        let (_, Choice::Judged(Verdict::Possible(ways))) = option? else { return None };
        // The operator or a rule may have refused the pass since.
        if antenna.off_reason.is_some() || self.refusal.is_some() {
            return None;
        }
        let (stands_deg, ready_ms) = (antenna.stands_deg?, antenna.ready_ms());
        let met = |way| Some((way, antenna.met_ms(way, stands_deg, ready_ms)?));
        let (way, (met_ms, leg_ms)) =
            ways.iter().filter_map(met).min_by_key(|(_, (met_ms, _))| *met_ms)?;
        let rest = Span { from_ms: met_ms, to_ms: way.span().to_ms };
        let entry = self.fixed(antenna, choose_by, way, rest);
        let slew_s = leg_ms as f64 / 1000.0;
        Some(Entry { slew_s, set_up_s: antenna.set_up_s, ..entry })
    }

    fn fixed(&self, antenna: &PlannedAntenna, choose_by: ChooseBy, way: &Way, rest: Span) -> Entry {
        let counted_ms = way.counted_ms(rest);
        Entry {
            pass: self.key,
            antenna: antenna.id,
            class: self.class(choose_by),
            start: at_ms(rest.from_ms),
            end: at_ms(rest.to_ms),
            late_s: (rest.from_ms - way.span().from_ms) as f64 / 1000.0,
            early_s: 0.0,
            counted_s: counted_ms as f64 / 1000.0,
            worth: self.worth(choose_by, counted_ms, PassPart::Alone),
            lost: way.lost,
            axes_deg: [way.axes_deg(rest.from_ms), way.axes_deg(rest.to_ms)],
            after: None,
            slew_s: 0.0,
            set_up_s: 0.0,
            spare_s: None,
            shared_with: None,
            is_fixed: true,
        }
    }
}
