//! Bounds of an antenna: minimum elevation, keep-outs and the Sun.
//!
//! A direction has a *clearance* from each barrier: the angle to its edge, negative inside. The
//! clearance changes by no more than the direction does. So a check of the middle of a range of
//! axis angles either settles the whole range or shows that its halves need checks.
//!
//! With a pointing model or with axis offsets, a position of the axes has two directions: by the
//! axes, and by the beam. The smaller clearance counts.

mod aim;
mod blocks;
mod min_clearance;
mod near;
mod sun;
mod sweep;
mod way_out;

use glam::{DQuat, DVec3};
use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use smol_str::SmolStr;

use crate::{
    astro::{Angle, AzEl, PointingModel, Site},
    station::{Antenna, Entered, KeepOut, Mount, Station, SunAvoidance},
};
use aim::{Aim, AimVectors};
pub use blocks::Budget;
use blocks::Reached;
use near::{BarrierName, Clear, Near};
use sun::SunAhead;
pub use sweep::Sweep;

/// Max depth of a motion beyond an edge, degrees; the margins of keep-outs and of the Sun are
/// widened by the same angle.
pub(super) const FINEST_DEG: f64 = 0.05;

/// Single bound: minimum elevation, a keep-out or the Sun.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Barrier {
    /// Minimum elevation of the antenna.
    MinimumElevation,
    /// Keep-out with this name.
    KeepOut(SmolStr),
    /// Surroundings of the Sun.
    Sun,
    /// Unknown bounds, because Azel could not read this setting of the station file.
    Unread(SmolStr),
}

/// Barrier, and the clearance of a direction from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    pub barrier: Barrier,
    /// Clearance angle, negative inside.
    pub angle: Angle,
    /// `true` for a warning to the operator only: the barrier neither refuses nor stops motion.
    pub warns_only: bool,
}

/// Position of the axes relative to a barrier that refuses motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Standing {
    Outside,
    MayBeInside,
    /// Unsettled position: the search exhausted its budget first.
    Unsettled,
}

/// Barriers of one antenna: minimum elevation, keep-outs and the Sun.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    site: Site,
    mount: Mount,
    has_elevation: bool,
    /// Pointing model; `None` for an antenna whose axes read the direction of the beam.
    model: Option<PointingModel>,
    /// Minimum elevation; `None` for an antenna without an elevation axis.
    minimum_elevation: Option<Angle>,
    /// Keep-outs of the antenna, each with its whole margin.
    keep_outs: Vec<(KeepOut, Angle)>,
    sun: Option<SunAvoidance>,
    /// Place of an unreadable setting, which makes the bounds unknown.
    unread: Option<SmolStr>,
}

impl Bounds {
    pub fn new(station: &Station, antenna: &Antenna) -> Self {
        let finest = Angle::from_degrees(FINEST_DEG);
        let half_beam = antenna.beam_width() * 0.5;
        let holds = station.keep_outs.iter().filter(|zone| zone.holds_for(&antenna.name));
        let unread = station.unread.iter().find(|unread| unread.concerns(antenna.id));
        let has_elevation = antenna.connection.variant().capabilities.has_elevation();
        let minimum = Angle::from_degrees(antenna.limits.minimum_elevation_deg);
        Self {
            site: station.site,
            mount: antenna.mount,
            has_elevation,
            model: Some(antenna.track_model()).filter(|model| !model.is_none()),
            minimum_elevation: has_elevation.then_some(minimum),
            keep_outs: holds
                // The edge of the beam must stay outside, not only its middle.
                .map(|zone| (zone.clone(), half_beam + zone.margin() + finest))
                .collect(),
            sun: station.sun_avoidance,
            unread: unread.map(|unread| SmolStr::new(&unread.place)),
        }
    }

    /// Returns the place in the station file of an unreadable safety setting. The bounds are
    /// unknown until the setting is repaired.
    pub fn unread(&self) -> Option<&SmolStr> {
        self.unread.as_ref()
    }

    /// Returns the bounds of an antenna without a station: only its minimum elevation.
    pub fn of_antenna(antenna: &Antenna) -> Self {
        Self::new(&Station::default(), antenna)
    }

    pub fn mount(&self) -> Mount {
        self.mount
    }

    /// Returns the direction of the axes at `axes_deg`, degrees as the mount counts.
    pub fn direction(&self, axes_deg: [f64; 2]) -> AzEl {
        self.mount.direction(axes_deg)
    }

    pub fn at_time(&self, utc: Timestamp) -> BoundsAt<'_> {
        let minimum_elevation = self.minimum_elevation;
        BoundsAt {
            bounds: self,
            minimum_elevation,
            sun: self.sun.map(|sun| SunAhead::new(self.site, sun, utc)),
            model: self.model,
            to_sky: None,
            budget: None,
        }
    }

    /// Returns `true` if any keep-out or the Sun refuses motion.
    pub fn forbid_anything(&self) -> bool {
        self.sun.is_some() || self.keep_outs.iter().any(|(zone, _)| zone.entered != Entered::Warn)
    }

    /// Returns `true` if any keep-out permits a detour.
    pub(super) fn has_way_round(&self) -> bool {
        self.keep_outs.iter().any(|(zone, _)| zone.entered == Entered::GoRound)
    }

    /// Returns `true` if the antenna, with its axes at `axes_deg`, points into a keep-out with a
    /// detour, or less than `room_deg` outside its margin.
    pub(super) fn is_gone_round(&self, axes_deg: [f64; 2], room_deg: f64) -> bool {
        let (aim, room) = (self.aim(axes_deg), Angle::from_degrees(room_deg));
        let mut rounded =
            self.keep_outs.iter().filter(|(keep_out, _)| keep_out.entered == Entered::GoRound);
        rounded.any(|(keep_out, margin)| {
            let (zone, near) = (&keep_out.zone, *margin + room);
            let is_near = |point: DVec3| {
                zone.clearance_lower_bound(point) < near && zone.clearance_of(point) < near
            };
            aim.directions().map(AzEl::to_enu).any(is_near)
        })
    }
}

/// [`Bounds`] at one time, for many checks.
#[derive(Debug, Clone)]
pub struct BoundsAt<'a> {
    bounds: &'a Bounds,
    minimum_elevation: Option<Angle>,
    sun: Option<SunAhead>,
    model: Option<PointingModel>,
    /// Rotation from the modelled beam direction to the true one on the sky, while axis offsets
    /// correct errors of the mount.
    to_sky: Option<DQuat>,
    /// Shared budget; `None` if each check may examine as many edges as a single one.
    budget: Option<&'a Budget>,
}

impl<'a> BoundsAt<'a> {
    /// Limits the check to `budget`, which several checks share.
    #[must_use]
    pub fn with_budget(self, budget: Option<&'a Budget>) -> Self {
        Self { budget, ..self }
    }

    /// Limits several checks to `budget`, unless they already share one.
    fn sharing<'b>(&'b self, budget: &'b Budget) -> BoundsAt<'b> {
        BoundsAt { budget: Some(self.budget.unwrap_or(budget)), ..self.clone() }
    }

    /// Returns the smallest clearance from every barrier among the positions in `place`. It is
    /// exact for a single position, otherwise from samples, and negative if [`Self::blocks`] finds
    /// a way in.
    pub fn min_clearances(&self, place: Sweep) -> Vec<Clearance> {
        let within_deg = place.sampled_within_deg() * self.max_beam_turn();
        let clearances = self.each_in(place).into_iter().enumerate();
        let shared = Budget::default();
        let sharing = self.sharing(&shared);
        clearances
            .map(|(index, (barrier, angle, warns_only))| {
                // Samples may miss a barrier between them, so search a near barrier by halves.
                let may_hide = (0.0..within_deg).contains(&angle.degrees());
                let hides = may_hide && sharing.blocks_from(place, Some(index)).is_some();
                let angle = if hides { Angle::from_degrees(-FINEST_DEG) } else { angle };
                Clearance { barrier: barrier.clone_of(), angle, warns_only }
            })
            .collect()
    }

    /// Returns for each barrier, in the order of [`Self::clearances`], whether all samples of
    /// `place` are inside.
    pub fn holds_all_of(&self, place: Sweep) -> Vec<bool> {
        let mut samples = place.samples().map(|sample| self.aim(sample));
        let first = samples.next().into_iter().flat_map(|aim| self.named_clearances(aim));
        let mut is_inside: Vec<_> = first.map(|(_, angle, _)| angle < Angle::ZERO).collect();
        for aim in samples {
            if !is_inside.contains(&true) {
                break;
            }
            for (is_inside, barrier) in is_inside.iter_mut().zip(self.barriers(aim)) {
                *is_inside = *is_inside && barrier.angle_below(Angle::ZERO).is_some();
            }
        }
        is_inside
    }

    /// Returns the clearance from every barrier for axes that count `direction`.
    pub fn clearances(&self, direction: AzEl) -> Vec<Clearance> {
        let named_clearances = self.named_clearances(self.aim_at(direction));
        named_clearances
            .map(|(barrier, angle, warns_only)| Clearance {
                barrier: barrier.clone_of(),
                angle,
                warns_only,
            })
            .collect()
    }

    /// Returns the nearest barrier that refuses motion, for axes that count `direction`; `None`
    /// without such a barrier.
    pub fn nearest(&self, direction: AzEl) -> Option<Clearance> {
        let mut nearest: Option<(BarrierName<'_>, Angle)> = None;
        for barrier in self.barriers(self.aim_at(direction)).filter(|barrier| !barrier.warns_only) {
            let min = nearest.map_or(Angle::from_degrees(f64::INFINITY), |(_, min)| min);
            if let Some(angle) = barrier.angle_below(min) {
                nearest = Some((barrier.name, angle));
            }
        }
        let (name, angle) = nearest?;
        Some(Clearance { barrier: name.clone_of(), angle, warns_only: false })
    }

    /// Returns the keep-out, or the surroundings of the Sun, that contains the antenna with axes
    /// that count `direction`.
    pub fn forbids(&self, direction: AzEl) -> Option<Barrier> {
        let entered = self.barriers(self.aim_at(direction)).filter_map(|barrier| {
            let angle = barrier.angle_below(Angle::ZERO).filter(|_| !barrier.warns_only)?;
            let barrier = barrier.name.clone_of();
            Some(Clearance { barrier, angle, warns_only: false })
        });
        deepest(entered.collect())
    }

    /// Returns the keep-out, or the surroundings of the Sun, that may contain the antenna within
    /// `place`.
    pub fn may_forbid(&self, place: Sweep) -> Option<Barrier> {
        deepest(self.min_clearances(place))
    }

    /// Returns the first barrier that refuses motion and may contain the axes in `place`.
    pub fn may_be_inside(&self, place: Sweep) -> Option<Barrier> {
        let pairs = self.barriers(self.aim(place.middle())).zip(self.stands(place));
        pairs
            .filter(|(_, stands)| *stands != Standing::Outside)
            .map(|(barrier, _)| barrier.name.clone_of())
            .next()
    }

    /// Removes the minimum elevation, for a unit that enforces its own.
    #[must_use]
    pub fn above_the_floor(self) -> Self {
        Self { minimum_elevation: None, ..self }
    }

    /// Lowers the minimum elevation by this angle.
    #[must_use]
    pub fn with_floor_lower_by(self, dip: Angle) -> Self {
        let minimum_elevation = self.minimum_elevation.map(|minimum| minimum - dip);
        Self { minimum_elevation, ..self }
    }

    /// Rotates the modelled beam by `to_sky`, if set.
    #[must_use]
    pub fn turned_by(self, to_sky: Option<DQuat>) -> Self {
        Self { to_sky, ..self }
    }

    /// Removes the model, for a direction that is already on the sky.
    #[must_use]
    pub fn without_model(self) -> Self {
        Self { model: None, ..self }
    }

    /// Returns the max angle by which the beam turns for each degree of an axis.
    pub(super) fn max_beam_turn(&self) -> f64 {
        self.model.map_or(1.0, |model| model.max_beam_turn())
    }

    /// Returns the bounds without the barriers that may contain the axes. Keeps a barrier if the
    /// search ended before it settled the position.
    pub fn without_entered(&self, place: Sweep) -> Bounds {
        let mut standings = self.stands(place).into_iter();
        let mut is_kept = || standings.next() != Some(Standing::MayBeInside);
        let mut rest = self.bounds.clone();
        rest.minimum_elevation = self.minimum_elevation.filter(|_| is_kept());
        rest.keep_outs.retain(|_| is_kept());
        rest.sun = rest.sun.filter(|_| is_kept());
        rest
    }

    /// Returns the position of the axes relative to each barrier, in the order of
    /// [`Self::clearances`]. The axes may be anywhere in `place`.
    fn stands(&self, place: Sweep) -> Vec<Standing> {
        let is_one = place.radius_deg() <= 0.0;
        let shared = Budget::default();
        let sharing = self.sharing(&shared);
        let numbered = self.barriers(self.aim(place.middle())).enumerate();
        numbered
            .map(|(index, barrier)| {
                if barrier.warns_only {
                    Standing::Outside
                } else if is_one {
                    let entered = barrier.angle_below(Angle::ZERO);
                    entered.map_or(Standing::Outside, |_| Standing::MayBeInside)
                } else {
                    match sharing.blocks_from(place, Some(index)) {
                        None => Standing::Outside,
                        Some(Reached { is_settled: true, .. }) => Standing::MayBeInside,
                        Some(Reached { is_settled: false, .. }) => Standing::Unsettled,
                    }
                }
            })
            .collect()
    }

    /// Returns the first barrier that the axes may enter within `sweep`, and a direction inside it.
    /// From below the minimum elevation, no motion may lead lower than `start` may be.
    pub fn blocks(&self, sweep: Sweep, start: Sweep) -> Option<(Barrier, AzEl)> {
        let lowest = self.lowest(start).elevation;
        if self.minimum_elevation.is_some_and(|minimum| lowest < minimum) {
            let minimum_elevation = Some(lowest);
            return Self { minimum_elevation, ..self.clone() }.blocks_all(sweep);
        }
        self.blocks_all(sweep)
    }

    fn blocks_all(&self, sweep: Sweep) -> Option<(Barrier, AzEl)> {
        self.blocks_from(sweep, None).map(|reached| (reached.barrier, reached.direction))
    }

    /// Does the same as [`Self::blocks`] for an unknown position within `start`: any descent counts
    /// as a descent below the minimum elevation if it may lead there.
    pub fn blocks_unseen(&self, sweep: Sweep, start: Sweep) -> Option<(Barrier, AzEl)> {
        if self.lowest(sweep).elevation < self.lowest(start).elevation {
            self.blocks_all(sweep)
        } else {
            self.blocks(sweep, start)
        }
    }

    /// Returns `true` if `sweep` leads below the minimum elevation, or lower than a `start` that is
    /// already below it.
    pub fn leads_below_the_floor(&self, sweep: Sweep, start: Sweep) -> bool {
        let lowest = self.lowest(sweep).elevation;
        let is_below = |minimum: Angle| lowest.degrees() < minimum.degrees() - FINEST_DEG;
        self.minimum_elevation.is_some_and(is_below) && is_below(self.lowest(start).elevation)
    }

    /// Returns the lowest corner of `place`, which is the lowest of all its positions.
    fn lowest(&self, place: Sweep) -> AzEl {
        let corners = place.corners().map(|corner| self.bounds.direction(corner));
        corners.into_iter().fold(AzEl::from_degrees(0.0, 90.0), |lowest, corner| {
            if corner.elevation < lowest.elevation { corner } else { lowest }
        })
    }

    /// Returns `true` if the antenna, with its axes at `axes_deg`, is `room_deg` outside every
    /// barrier that refuses motion. The minimum elevation needs no room.
    pub(super) fn has_room(&self, axes_deg: [f64; 2], room_deg: f64) -> bool {
        self.has_room_at(self.aim(axes_deg), room_deg)
    }

    fn has_room_at(&self, aim: Aim, room_deg: f64) -> bool {
        self.barriers(aim).all(|barrier| {
            let room_deg = match barrier.name {
                BarrierName::MinimumElevation => -FINEST_DEG,
                BarrierName::KeepOut(_) | BarrierName::Sun => room_deg,
            };
            barrier.warns_only || barrier.angle_below(Angle::from_degrees(room_deg)).is_none()
        })
    }

    /// Returns the same as [`Self::named_clearances`], with the smallest clearance among the
    /// positions in `place`, from samples.
    fn each_in(&self, place: Sweep) -> Vec<(BarrierName<'_>, Angle, bool)> {
        let barriers: Vec<_> = self.barriers(self.aim(place.middle())).collect();
        let groups: Vec<_> = (0..barriers.len()).map(Some).collect();
        let mut minima = vec![Angle::from_degrees(f64::INFINITY); barriers.len()];
        self.lower_to_min(place, &groups, &mut minima);
        let pairs = barriers.iter().zip(minima);
        pairs.map(|(barrier, min)| (barrier.name, min, barrier.warns_only)).collect()
    }

    fn named_clearances(&self, aim: Aim) -> impl Iterator<Item = (BarrierName<'_>, Angle, bool)> {
        self.barriers(aim).map(|barrier| (barrier.name, barrier.angle(), barrier.warns_only))
    }

    fn barriers(&self, aim: Aim) -> impl Iterator<Item = Near<'_>> {
        let vectors = aim.to_enu();
        (0..self.number()).filter_map(move |index| self.barrier(index, aim, vectors))
    }

    fn number(&self) -> usize {
        usize::from(self.minimum_elevation.is_some())
            + self.bounds.keep_outs.len()
            + usize::from(self.sun.is_some())
    }

    /// Returns the barrier at `index`: first the minimum elevation, then the keep-outs, then the
    /// Sun.
    fn barrier(&self, index: usize, aim: Aim, vectors: AimVectors) -> Option<Near<'_>> {
        let zone_index = match self.minimum_elevation {
            Some(minimum) if index == 0 => {
                let angle = Clear::Known(aim.axes.elevation - minimum);
                return Some(Near {
                    name: BarrierName::MinimumElevation,
                    warns_only: false,
                    angle,
                });
            }
            Some(_) => index - 1,
            None => index,
        };
        if let Some((zone, margin)) = self.bounds.keep_outs.get(zone_index) {
            return Some(Near {
                name: BarrierName::KeepOut(&zone.name),
                warns_only: zone.entered == Entered::Warn,
                angle: Clear::OfZone { zone: &zone.zone, margin: *margin, vectors },
            });
        }
        let sun = self.sun.as_ref().filter(|_| index < self.number())?;
        Some(Near {
            name: BarrierName::Sun,
            warns_only: false,
            angle: Clear::OfSun { sun, vectors },
        })
    }
}

/// Returns the keep-out or the Sun with the deepest entry.
fn deepest(clearances: Vec<Clearance>) -> Option<Barrier> {
    let entered = clearances.into_iter().filter(|clearance| {
        !clearance.warns_only
            && clearance.angle < Angle::ZERO
            && clearance.barrier != Barrier::MinimumElevation
    });
    entered
        .min_by(|a, b| a.angle.degrees().total_cmp(&b.angle.degrees()))
        .map(|clearance| clearance.barrier)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::astro::Zone;

    fn keep_out(corners_deg: &[(f64, f64)]) -> KeepOut {
        KeepOut {
            name: "mast".to_owned(),
            reason: String::new(),
            entered: Entered::Hard,
            antenna: None,
            margin_deg: 1.0,
            zone: KeepOut::zone_of(corners_deg).unwrap(),
        }
    }

    fn bounds(keep_outs: Vec<KeepOut>) -> Bounds {
        let antenna = Antenna::genius("Yagi", "memory:1");
        let station = Station { keep_outs, ..Station::default() };
        Bounds::new(&station, &antenna)
    }

    fn noon() -> Timestamp {
        "2026-08-12T10:00:00Z".parse().unwrap()
    }

    fn high() -> Sweep {
        Sweep::at_position([0.0, 89.0])
    }

    #[test]
    fn from_below_the_minimum_elevation_nothing_leads_lower() {
        let bounds = bounds(Vec::new());
        let start_deg = [10.0, -3.0];
        let way = |to_deg| {
            bounds
                .at_time(noon())
                .blocks(Sweep::new(start_deg, to_deg), Sweep::at_position(start_deg))
        };
        assert_eq!(way([90.0, 30.0]), None);
        assert_eq!(way([90.0, -4.0]).map(|(barrier, _)| barrier), Some(Barrier::MinimumElevation));
    }

    fn mast() -> KeepOut {
        keep_out(&[(100.0, -5.0), (120.0, -5.0), (120.0, 40.0), (100.0, 40.0)])
    }

    #[test]
    fn a_way_round_a_corner_is_free_and_the_box_of_both_axes_is_not() {
        let bounds = bounds(vec![mast()]);
        let free =
            |start, end| bounds.at_time(noon()).blocks(Sweep::new(start, end), high()).is_none();
        let (first, last) = ([60.0, 20.0], [160.0, 70.0]);
        assert!(!free(first, last), "both axes at once may sweep through");
        assert!(free(first, [60.0, 70.0]) && free([60.0, 70.0], last), "elevation first");
        assert!(!free(first, [160.0, 20.0]), "azimuth first");
    }

    #[test]
    fn a_keep_out_of_one_antenna_holds_for_no_other() {
        let other = KeepOut { antenna: Some("Dish".to_owned()), ..mast() };
        let boxed = Sweep([(110.0, 110.0), (20.0, 20.0)]);
        assert_eq!(bounds(vec![other]).at_time(noon()).blocks(boxed, high()), None);
        let (barrier, _) = bounds(vec![mast()]).at_time(noon()).blocks(boxed, high()).unwrap();
        assert_eq!(barrier, Barrier::KeepOut("mast".into()));
        let warns = KeepOut { entered: Entered::Warn, ..mast() };
        assert_eq!(
            bounds(vec![warns]).at_time(noon()).blocks(boxed, high()),
            None,
            "told, not refused"
        );
    }

    proptest! {
        /// A sweep that counts as free contains no blocked direction. A sweep along an edge counts
        /// as blocked if the search exhausts its budget first.
        #[test]
        fn a_free_sweep_is_free_everywhere(
            az in 0.0..360.0, el in 5.0..90.0, daz in 0.0..90.0, del in 0.0..40.0,
            corner_az in 0.0..330.0, corner_el in 0.0..50.0, width in 3.0..60.0,
            height in 3.0..30.0, part in proptest::collection::vec((0.0..1.0, 0.0..1.0), 20),
        ) {
            let zone = Zone::new(vec![
                AzEl::from_degrees(corner_az, corner_el),
                AzEl::from_degrees(corner_az + width, corner_el),
                AzEl::from_degrees(corner_az + width, corner_el + height),
                AzEl::from_degrees(corner_az, corner_el + height),
            ]);
            prop_assume!(zone.is_ok());
            let zone = KeepOut { zone: zone.unwrap(), ..mast() };
            let bounds = bounds(vec![zone]);
            let end: [f64; 2] = [az + daz, f64::min(el + del, 90.0)];
            let (now, sweep) = (bounds.at_time(noon()), Sweep::new([az, el], end));
            if let Some((_, direction)) = &now.blocks(sweep, high()) {
                let nearest = now.nearest(*direction).unwrap();
                let is_settled = now.blocks_from(sweep, None).is_some_and(|reached| reached.is_settled);
                prop_assert!(!is_settled || nearest.angle.degrees() < 0.0, "{nearest:?}");
            } else {
                for (a, b) in part {
                    let axes = [az + a * daz, el + b * (end[1] - el)];
                    let nearest = now.nearest(bounds.direction(axes)).unwrap();
                    prop_assert!(nearest.angle.degrees() > -FINEST_DEG - 1e-6, "{axes:?} {nearest:?}");
                }
            }
        }
    }
}
