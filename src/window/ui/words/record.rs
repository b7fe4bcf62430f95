//! Words for the recorded passes: their quality, and the causes of their errors.

use jiff::Timestamp;

use crate::{
    contract::{
        alarms::AlarmChange,
        record::{
            ExplainedPasses, ListedKind, OpenedPass, RecordedPass, RecordedReport, TrackedBy,
        },
    },
    model::correction::CorrectionMethod,
    plan::pass_report::{
        Axis, Cause, Explained, Explanation, LossCause, LostStretch, PassReport, PassVerdict,
    },
    ui::format,
};

/// Max time without positions that a list leaves out, seconds.
const UNTOLD_S: f64 = 10.0;

/// Names the kind of track that led the antenna.
pub fn tracked_by(way: TrackedBy) -> &'static str {
    match way {
        TrackedBy::ProgramTrack => "program track",
        TrackedBy::OnBoard => "on-board tracking",
        TrackedBy::Elsewhere => "tracked by the unit, not by Azel",
    }
}

pub const NOT_TRACKED: &str = "Not tracked";

/// Names a kind of passes, as a choice of the list.
pub fn listed_kind(kind: ListedKind) -> &'static str {
    match kind {
        ListedKind::Tracked(pass_verdict) => verdict(pass_verdict),
        ListedKind::NotTracked => NOT_TRACKED,
    }
}

/// Names a verdict, as a choice of the list.
pub fn verdict(verdict: PassVerdict) -> &'static str {
    match verdict {
        PassVerdict::Good => "Good",
        PassVerdict::Fair => "Fair",
        PassVerdict::Poor => "Poor",
    }
}

/// Returns the share within half the beamwidth and the worst error, for a row. For a good pass,
/// only the part within reach of the mount counts. The share of the whole pass would look like a
/// failure next to its tick.
pub fn in_short(report: &PassReport) -> String {
    let lost_s = |is_meant: &dyn Fn(LossCause) -> bool| -> f64 {
        let intended = report.losses.iter().filter(|lost| is_meant(lost.cause));
        intended.map(LostStretch::seconds).sum()
    };
    let of_mount_s = lost_s(&LossCause::is_of_mount);
    if let (PassVerdict::Good, Some(worst)) = (report.verdict, &report.worst)
        && of_mount_s > 0.0
    {
        let reached_s = report.counted_s - of_mount_s;
        let lost_s = lost_s(&|cause| !cause.is_of_mount());
        let [reached, inside_text] = [reached_s, reached_s - lost_s].map(format::duration);
        let inside_text = if inside_text == reached {
            format!("all {reached}")
        } else {
            format!("{inside_text} of {reached}")
        };
        let worst = format::degrees(worst.error.off_deg, 2);
        return format!("{inside_text} within reach, worst {worst}");
    }
    let share = share(report.share());
    let not_known_s = report.counted_s - report.known_s;
    match &report.worst {
        None => "No position was measured".to_owned(),
        Some(_) if not_known_s > UNTOLD_S => {
            format!("{share} in beam, {} not known", format::duration(not_known_s))
        }
        Some(worst) => {
            format!("{share} in beam, worst {}", format::degrees(worst.error.off_deg, 2))
        }
    }
}

/// Formats a share of the whole in per cent. Only the whole is 100 %.
fn share(share: f64) -> String {
    let per_cent = (share * 1000.0).floor() / 10.0;
    let decimals = usize::from(per_cent < 100.0);
    format!("{} %", format::number(per_cent, decimals))
}

/// Returns the cause of the longest loss. If that loss only says that the antenna was off its
/// satellite, returns the cause of the error. `None` for a good pass.
pub fn cause_in_short(pass: &RecordedPass) -> Option<String> {
    let report = &pass.report.report;
    let by_length = |a: &&LostStretch, b: &&LostStretch| a.seconds().total_cmp(&b.seconds());
    if report.verdict == PassVerdict::Good {
        return None;
    }
    let lost = report.losses.iter().max_by(by_length);
    // These losses only say when the antenna was off its satellite; a cause of the error says why.
    let is_off = |lost: &LostStretch| {
        use LossCause::{EarlyEnd, LateStart, OutsideBeam};
        matches!(lost.cause, LateStart | EarlyEnd | OutsideBeam)
    };
    if let Some(best) = pass.report.causes.first()
        && lost.is_none_or(is_off)
    {
        // Two causes with their sizes are longer than a row.
        let words = if best.partner.is_some() { names(best) } else { causes(best) };
        return Some(words + &or_alike(&pass.report.causes));
    }
    let lost = lost.filter(|lost| lost.cause != LossCause::OutsideBeam);
    let words = lost.map(|lost| (loss(lost.cause), format::duration(lost.seconds())));
    Some(words.map_or("Not explained".to_owned(), |(word, lasts)| format!("{word} {lasts}")))
}

/// Returns the reason why a stretch was lost, in the words of a list.
pub fn loss(cause: LossCause) -> &'static str {
    match cause {
        LossCause::NotMeasured => "No positions",
        LossCause::LinkLost => "Link lost",
        LossCause::ProgramEnded => "Azel ended",
        LossCause::OutOfReach => "Out of the mount's reach",
        LossCause::Keyhole => "Keyhole",
        LossCause::RateOfMount => "Mount too slow",
        LossCause::Slew => "Azimuth unwrap",
        LossCause::LateStart => "Late start",
        LossCause::EarlyEnd => "Early end",
        LossCause::Stopped => "Stopped",
        LossCause::NoEffect => "No effect",
        LossCause::GivenUp => "Given up",
        LossCause::ForeignHands => "Uncommanded motion",
        LossCause::Forbidden => "Stopped at a barrier",
        LossCause::NotCommanded => "Not commanded",
        LossCause::OutsideBeam => "Pointing error",
    }
}

/// Returns the word before an alarm that changed; `None` for a new alarm.
pub fn alarm_change(change: AlarmChange) -> Option<&'static str> {
    match change {
        AlarmChange::Came => None,
        AlarmChange::Acknowledged => Some("Acknowledged"),
        AlarmChange::Shelved => Some("Shelved"),
        AlarmChange::Over => Some("Over"),
    }
}

/// Returns the name of a cause in a table.
pub fn cause(cause: &Cause) -> &'static str {
    match cause {
        Cause::Late { .. } => "Time offset",
        Cause::AzimuthOffset { .. } => "Azimuth offset",
        Cause::ElevationOffset { .. } => "Elevation offset",
        Cause::Tilt { .. } => "Mount tilt",
        Cause::AzimuthScale { .. } => "Azimuth scale",
        Cause::ElevationScale { .. } => "Elevation scale",
        Cause::OtherElements { .. } => "Other elements",
        Cause::Refraction => "No refraction",
        Cause::OtherSite { .. } => "Other site",
        Cause::SlowDrives { axis: None, .. } => "Slow drives",
        Cause::SlowDrives { axis: Some(Axis::Azimuth), .. } => "Slow azimuth",
        Cause::SlowDrives { axis: Some(Axis::Elevation), .. } => "Slow elevation",
        Cause::SlowDrives { axis: Some(Axis::X), .. } => "Slow X",
        Cause::SlowDrives { axis: Some(Axis::Y), .. } => "Slow Y",
        Cause::Stuck { axis: None, .. } => "Both axes stuck",
        Cause::Stuck { axis: Some(Axis::Azimuth), .. } => "Azimuth stuck",
        Cause::Stuck { axis: Some(Axis::Elevation), .. } => "Elevation stuck",
        Cause::Stuck { axis: Some(Axis::X), .. } => "X stuck",
        Cause::Stuck { axis: Some(Axis::Y), .. } => "Y stuck",
    }
}

/// Returns the name of a cause that acts together with the cause above it.
pub fn second_cause(second: &Cause) -> String {
    format!("with {}", inside_sentence(cause(second)))
}

/// Returns the number of positions that the causes were fitted to.
pub fn fitted_to(points: usize) -> String {
    format!("fitted to {points} points")
}

/// Returns the best-fitting size of a cause.
pub fn size(cause: &Cause) -> String {
    let deg = |value: f64| format!("{}°", format::signed(value, 2));
    match cause {
        Cause::Late { late_s } => format!("{} s", format::signed(*late_s, 2)),
        Cause::AzimuthOffset { offset_deg } | Cause::ElevationOffset { offset_deg } => {
            deg(*offset_deg)
        }
        Cause::Tilt { north_deg, east_deg } => {
            format!("{} north, {} east", deg(*north_deg), deg(*east_deg))
        }
        Cause::AzimuthScale { per_mille } | Cause::ElevationScale { per_mille } => {
            format!("{} %", format::signed(per_mille / 10.0, 2))
        }
        Cause::OtherElements { epoch } => format!("of {}", format::copied(*epoch)),
        Cause::Refraction => "by the unit".to_owned(),
        Cause::OtherSite { north_km, east_km } => {
            let km = |value: f64| format!("{} km", format::signed(value, 1));
            format!("{} north, {} east", km(*north_km), km(*east_km))
        }
        Cause::SlowDrives { rate_deg_s, .. } => format!("{}°/s", format::number(*rate_deg_s, 2)),
        Cause::Stuck { start, .. } => format!("since {}", format::copied(*start)),
    }
}

/// Describes causes that act together, with their sizes.
pub fn causes(explanation: &Explanation) -> String {
    combined(explanation.causes().map(cause_with_size))
}

fn cause_with_size(one: &Cause) -> String {
    match one {
        Cause::Late { late_s } if *late_s < 0.0 => {
            format!("Antenna {} s early", format::number(-late_s, 2))
        }
        Cause::Late { late_s } => format!("Antenna {} s late", format::number(*late_s, 2)),
        one => format!("{} {}", cause(one), size(one)),
    }
}

/// Returns a cause as the subject of a sentence.
fn cause_as_subject(cause: &Cause) -> String {
    let deg = |value: f64| format!("{}°", format::signed(value, 2));
    match cause {
        Cause::Late { late_s } if *late_s < 0.0 => {
            format!("The antenna was {} s early", format::number(-late_s, 2))
        }
        Cause::Late { late_s } => {
            format!("The antenna was {} s late", format::number(*late_s, 2))
        }
        Cause::AzimuthOffset { offset_deg } => {
            format!("The azimuth was off by {}", deg(*offset_deg))
        }
        Cause::ElevationOffset { offset_deg } => {
            format!("The elevation was off by {}", deg(*offset_deg))
        }
        Cause::Tilt { .. } => format!("The mount is tilted by {}", size(cause)),
        Cause::AzimuthScale { .. } => format!("The azimuth scale is off by {}", size(cause)),
        Cause::ElevationScale { .. } => format!("The elevation scale is off by {}", size(cause)),
        Cause::OtherElements { epoch } => {
            format!("The antenna followed older elements, of {}", format::copied(*epoch))
        }
        Cause::Refraction => "The unit left refraction out".to_owned(),
        Cause::OtherSite { .. } => {
            format!("The unit computes for another site, {}", size(cause))
        }
        Cause::SlowDrives { axis: None, .. } => {
            format!("The drives turn no faster than {}", size(cause))
        }
        Cause::SlowDrives { axis: Some(axis), .. } => {
            format!("{} turns no faster than {}", axis_as_subject(*axis), size(cause))
        }
        Cause::Stuck { axis: None, .. } => format!("Both axes stand {}", size(cause)),
        Cause::Stuck { axis: Some(axis), .. } => {
            format!("{} stands {}", axis_as_subject(*axis), size(cause))
        }
    }
}

fn axis_as_subject(axis: Axis) -> &'static str {
    match axis {
        Axis::Azimuth => "The azimuth",
        Axis::Elevation => "The elevation",
        Axis::X => "X",
        Axis::Y => "Y",
    }
}

/// Joins causes that act together.
fn combined(causes: impl Iterator<Item = String>) -> String {
    let mut whole = String::new();
    for cause in causes {
        if whole.is_empty() {
            whole = cause;
        } else {
            whole += " and ";
            whole += &inside_sentence(&cause);
        }
    }
    whole
}

/// Returns the begin of a sentence in the form for the middle of one. The letter of an axis stays a
/// capital.
fn inside_sentence(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next();
    let is_axis = letters.clone().next().is_none_or(|second| !second.is_alphabetic());
    match first {
        Some(first) if !is_axis => first.to_lowercase().chain(letters).collect(),
        Some(_) | None => words.to_owned(),
    }
}

/// Returns the share of the error that these causes explain, as words after the causes.
fn explains(explanation: &Explanation) -> String {
    let share = whole_share(explanation.share);
    if explanation.partner.is_some() {
        format!("together they explain {share}")
    } else {
        format!("that explains {share}")
    }
}

/// Describes the cause of the error of a current pass; `None` without a cause.
pub fn explained(explained: &Explained, now: Timestamp) -> Option<String> {
    let error = format::degrees(explained.error_deg, 2);
    match &explained.causes[..] {
        [] => None,
        [only] => {
            let causes = combined(only.causes().map(|cause| cause_now(cause, now)));
            Some(format!("{causes}: {} of the rms error of {error}.", explains(only)))
        }
        several => Some(format!("The rms error of {error} may come from {}.", one_of(several))),
    }
}

/// Lists causes that the positions cannot distinguish.
fn one_of(alike: &[Explanation]) -> String {
    let mut names: Vec<String> =
        alike.iter().map(|explanation| inside_sentence(&names(explanation))).collect();
    let last = names.pop().unwrap_or_default();
    if names.is_empty() { last } else { format!("{} or {last}", names.join(", ")) }
}

/// Returns a cause of a current pass as the subject of a sentence.
fn cause_now(cause: &Cause, now: Timestamp) -> String {
    let deg = |value: f64| format!("{}°", format::signed(value, 2));
    match cause {
        Cause::Late { late_s } => {
            let way = if *late_s < 0.0 { "early" } else { "late" };
            format!("The antenna is {} s {way}", format::number(late_s.abs(), 2))
        }
        Cause::AzimuthOffset { offset_deg } => {
            format!("The azimuth is off by {}", deg(*offset_deg))
        }
        Cause::ElevationOffset { offset_deg } => {
            format!("The elevation is off by {}", deg(*offset_deg))
        }
        Cause::Stuck { start, axis } => {
            let start_text = format::moment(*start, now);
            match axis {
                None => format!("Both axes stand since {start_text}"),
                Some(axis) => format!("{} stands since {start_text}", axis_as_subject(*axis)),
            }
        }
        cause => cause_as_subject(cause),
    }
}

/// Returns the report in one line: the share within the beam, the worst error, its cause, and other
/// losses.
pub fn verdict_sentence(pass: &RecordedReport, now: Timestamp) -> String {
    let report = &pass.report;
    let Some(worst) = &report.worst else {
        return "No position was measured in this pass.".to_owned();
    };
    let inside_text = format!(
        "Within half the beamwidth for {} of {}, worst {} at {}.",
        share(report.share()),
        format::duration(report.counted_s),
        format::degrees(worst.error.off_deg, 2),
        format::moment(worst.time, now),
    );
    let explained = match &pass.causes[..] {
        [] => None,
        [only] => {
            let causes = combined(only.causes().map(cause_as_subject));
            Some(format!(" {causes}; {} of the error.", explains(only)))
        }
        several => Some(format!(" The error may come from {}.", one_of(several))),
    };
    inside_text + &explained.unwrap_or_default() + &losses_sentence(&report.losses)
}

fn losses_sentence(losses: &[LostStretch]) -> String {
    if losses.is_empty() {
        return " Nothing was lost.".to_owned();
    }
    let mut causes: Vec<(LossCause, f64)> = Vec::new();
    for lost in losses {
        match causes.iter_mut().find(|(cause, _)| *cause == lost.cause) {
            Some((_, seconds)) => *seconds += lost.seconds(),
            None => causes.push((lost.cause, lost.seconds())),
        }
    }
    let texts = causes.into_iter().enumerate().map(|(place, (cause, seconds))| {
        let lost = if place == 0 { " lost" } else { "" };
        format!("{}{lost} {}", format::duration(seconds), loss_in_sentence(cause))
    });
    format!(" {}.", format::list(&texts.collect::<Vec<_>>()))
}

fn loss_in_sentence(cause: LossCause) -> &'static str {
    match cause {
        LossCause::NotMeasured => "for lack of positions",
        LossCause::LinkLost => "while the link was lost",
        LossCause::ProgramEnded => "after Azel ended",
        LossCause::OutOfReach => "out of the mount's reach",
        LossCause::Keyhole => "in a keyhole of the mount",
        LossCause::RateOfMount => "where the mount is too slow",
        LossCause::Slew => "at the azimuth unwrap",
        LossCause::LateStart => "before the antenna arrived",
        LossCause::EarlyEnd => "after the antenna had left the satellite",
        LossCause::Stopped => "after the antenna was stopped",
        LossCause::NoEffect => "after an axis had not turned as commanded",
        LossCause::GivenUp => "after Azel had given up the pass",
        LossCause::ForeignHands => "after the antenna had turned without a command",
        LossCause::Forbidden => "after Azel had stopped the antenna at a barrier",
        LossCause::NotCommanded => "while the antenna was not commanded to track it",
        LossCause::OutsideBeam => "to pointing errors",
    }
}

/// Formats the share that a cause explains, without decimals.
pub fn whole_share(share: f64) -> String {
    format!("{} %", format::number((share * 100.0).floor(), 0))
}

/// Describes the effect of accepting a correction. `is_best` is `true` for the best explanation.
pub fn correction(method: &CorrectionMethod, is_best: bool) -> String {
    let key = if is_best { " (C)" } else { "" };
    match method {
        CorrectionMethod::Settings { values, has_time, .. } => {
            let values = if values.len() == 1 { "value" } else { "values" };
            let sign = if *has_time {
                " The manual does not say whether a larger time is ahead or behind: if the next \
                 pass is worse, change its sign."
            } else {
                ""
            };
            format!(
                "Enters the {values} in the settings of the unit{key}. Nothing is sent until you \
                 apply it there.{sign}"
            )
        }
        CorrectionMethod::Remembered(offsets) => {
            format!("Asks whether to remember {} for this antenna{key}", super::offsets(*offsets))
        }
    }
}

/// Returns the reason why there is no correction for the best explanation.
pub fn no_correction(best: Option<&Explanation>) -> String {
    best.map_or("Nothing to apply: the error of this pass is not explained.".to_owned(), |best| {
        let cause = names(best);
        format!("Nothing to apply: no setting or offset corrects \u{201c}{cause}\u{201d}, or one does already.")
    })
}

/// Describes the explanation of this pass together with earlier ones; `None` if there are no
/// earlier passes.
pub fn explained_together(explained: &ExplainedPasses, pass: &RecordedPass) -> Option<String> {
    let start_text =
        explained.start.map(|start| format!(" from {}", format::date(start))).unwrap_or_default();
    let (passes, antenna) = (explained.passes, &pass.antenna_name);
    let last = format!("The {passes} passes of {antenna}{start_text} up to this one, together");
    let Some(best) = explained.explanations.first() else {
        return (explained.passes > 1).then(|| format!("{last}: no cause explains their error."));
    };
    let causes = causes(best);
    let alike: Vec<String> = explained.explanations.iter().skip(1).map(names).collect();
    let open = match &alike[..] {
        [] => String::new(),
        alike => format!(" They cannot tell this from {}.", format::list(alike)),
    };
    let explains = explains(best);
    (explained.passes > 1).then(|| format!("{last}: {causes}; {explains} of their error.{open}"))
}

/// Returns the reason why the table of causes of a pass is empty.
pub fn not_explained(opened: &OpenedPass) -> &'static str {
    if opened.pass.report.report.verdict == PassVerdict::Good {
        return "A good pass: there is nothing to explain";
    }
    none_explains(!opened.track.is_empty())
}

/// Returns the sentence for a pass without any known cause.
pub fn none_explains(is_measured: bool) -> &'static str {
    if is_measured {
        "Not explained: no single cause or pair leaves only noise"
    } else {
        "Nothing was measured"
    }
}

/// Joins the names of causes that act together.
fn names(explanation: &Explanation) -> String {
    combined(explanation.causes().map(|one| cause(one).to_owned()))
}

/// Returns the names of the best explanation and of others that the data cannot rule out, each
/// once.
fn names_alike(explanations: &[Explanation]) -> Vec<String> {
    let mut sentences: Vec<String> = explanations.first().map(names).into_iter().collect();
    for alike in explanations.iter().map(names) {
        if !sentences.contains(&alike) {
            sentences.push(alike);
        }
    }
    sentences
}

/// Describes causes that the data cannot distinguish, as a sentence; `None` if there is only one.
pub fn alike(explanations: &[Explanation]) -> Option<String> {
    let sentences = names_alike(explanations);
    let alike = || explanations.iter().flat_map(Explanation::causes);
    let has = |is_so: fn(&Cause) -> bool| alike().any(is_so);
    let tells = if has(|cause| matches!(cause, Cause::SlowDrives { .. } | Cause::Stuck { .. })) {
        "A slower pass"
    } else if has(|cause| matches!(cause, Cause::Late { .. }))
        && has(|cause| matches!(cause, Cause::OtherElements { .. }))
    {
        "The clock of the unit, or a pass of another satellite,"
    } else {
        "A pass in another part of the sky"
    };
    (sentences.len() > 1).then(|| {
        let texts = format::list(&sentences);
        format!("This pass cannot tell these apart: {texts}. {tells} can.")
    })
}

/// Returns words for other possible explanations, to append to the best one; empty without others.
fn or_alike(explanations: &[Explanation]) -> String {
    let others = names_alike(explanations).into_iter().skip(1);
    let others: Vec<String> = others.map(|name| inside_sentence(&name)).collect();
    match &others[..] {
        [] => String::new(),
        [one] if explanations.iter().all(|explanation| explanation.partner.is_none()) => {
            format!(" or {one}")
        }
        [_] => " or another".to_owned(),
        several => format!(" or {} others", several.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::time::add_seconds,
        plan::pass_report::{PointingError, WorstError},
    };

    fn explanation(cause: Cause) -> Explanation {
        Explanation { cause, partner: None, left_deg: 0.03, share: 0.97 }
    }

    #[test]
    fn of_a_good_pass_only_what_the_mount_could_reach_counts() {
        let error = |off_deg| PointingError {
            off_deg,
            azimuth_deg: 0.0,
            elevation_deg: 0.0,
            along_deg: 0.0,
            across_deg: 0.0,
        };
        let time = |seconds: f64| add_seconds(Timestamp::UNIX_EPOCH, seconds);
        let lost =
            |from_s, until_s, cause| LostStretch { start: time(from_s), end: time(until_s), cause };
        let report = |verdict, in_beam_s, losses| PassReport {
            verdict,
            counted_s: 600.0,
            known_s: 600.0,
            in_beam_s,
            rms: Some(error(0.1)),
            worst: Some(WorstError { time: time(10.0), error: error(0.124) }),
            losses,
        };
        let out_of_reach = lost(298.0, 600.0, LossCause::OutOfReach);
        let good = report(PassVerdict::Good, 298.0, vec![out_of_reach]);
        assert_eq!(in_short(&good), "all 4:58 within reach, worst 0.12°");
        let late = lost(0.0, 1.2, LossCause::LateStart);
        let good = report(PassVerdict::Good, 296.8, vec![late, out_of_reach]);
        assert_eq!(in_short(&good), "4:57 of 4:58 within reach, worst 0.12°");
        let poor = report(
            PassVerdict::Poor,
            100.0,
            vec![lost(0.0, 198.0, LossCause::LateStart), out_of_reach],
        );
        assert_eq!(in_short(&poor), "16.6 % in beam, worst 0.12°");
        assert_eq!(
            in_short(&report(PassVerdict::Good, 600.0, vec![])),
            "100 % in beam, worst 0.12°"
        );
    }

    #[test]
    fn what_the_positions_leave_open_is_told_with_what_would_tell_it() {
        let late = explanation(Cause::Late { late_s: 0.4 });
        let set = explanation(Cause::OtherElements { epoch: Timestamp::UNIX_EPOCH });
        let slow = explanation(Cause::SlowDrives { rate_deg_s: 1.5, axis: None });
        let azimuth = explanation(Cause::AzimuthOffset { offset_deg: 0.3 });
        let text = |explanations: &[Explanation]| alike(explanations).unwrap_or_default();
        assert_eq!(text(&[late]), "");
        assert_eq!(or_alike(&[late]), "");
        assert_eq!(
            text(&[late, set]),
            "This pass cannot tell these apart: Time offset and Other elements. The clock of the \
             unit, or a pass of another satellite, can."
        );
        assert_eq!(or_alike(&[late, set]), " or other elements");
        assert!(text(&[late, slow]).ends_with("A slower pass can."));
        assert!(text(&[late, azimuth]).ends_with("A pass in another part of the sky can."));
        assert_eq!(or_alike(&[late, set, azimuth]), " or 2 others");
        let shared = |causes: &[Explanation]| {
            let causes = causes.to_vec();
            explained(&Explained { causes, error_deg: 0.5 }, Timestamp::UNIX_EPOCH)
        };
        assert_eq!(shared(&[]), None);
        assert_eq!(
            shared(&[late]).as_deref(),
            Some("The antenna is 0.40 s late: that explains 97 % of the rms error of 0.50°.")
        );
        assert_eq!(
            shared(&[late, set, azimuth]).as_deref(),
            Some(
                "The rms error of 0.50° may come from time offset, other elements or azimuth offset."
            )
        );
        let y = Cause::Stuck { start: Timestamp::UNIX_EPOCH, axis: Some(Axis::Y) };
        assert_eq!(cause(&y), "Y stuck");
        assert_eq!(second_cause(&y), "with Y stuck");
        let combined = Explanation { partner: Some(y), ..explanation(Cause::Refraction) };
        assert_eq!(
            shared(&[combined]).as_deref(),
            Some(
                "The unit left refraction out and Y stands since 00:00:00Z: together they explain 97 % of \
                 the rms error of 0.50°."
            )
        );
        assert_eq!(
            shared(&[late, explanation(y)]).as_deref(),
            Some("The rms error of 0.50° may come from time offset or Y stuck.")
        );
    }
}
