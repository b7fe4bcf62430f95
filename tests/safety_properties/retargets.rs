//! Program tracks that get another target or other offsets while the axes are still on their way.

use azel::{
    astro::{Angle, AzEl, Offset},
    contract::driver::{Command, OffsetChange},
    plan::{ProgramTrack, Target},
};

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    scene::Scene,
    world::{Wish, World},
};
use crate::common::dice::Dice;

async fn is_retargeted(mut dice: Dice) {
    let wish = Wish { keep_outs: 2 + dice.below(4), ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    let mut judge = Judge::new(&scene, scene.world.make.name.to_owned());
    let mut at = AzEl::from_degrees(dice.between(0.0, 360.0), dice.between(15.0, 80.0));
    for _ in 0..6 {
        let here = scene.world.direction();
        let (az_deg, el_deg) = (dice.between(0.0, 360.0), dice.between(15.0, 80.0));
        let any = AzEl::from_degrees(az_deg, el_deg);
        // The new target may keep one axis at its current position or at its previous target.
        at = match dice.below(4) {
            0 => AzEl { azimuth: here.azimuth, ..any },
            1 => AzEl { elevation: here.elevation, ..any },
            2 => AzEl { azimuth: at.azimuth, ..any },
            _ => any,
        };
        if dice.chance(0.3) {
            let change =
                OffsetChange::Step(Offset::Elevation(Angle::from_degrees(dice.between(-5.0, 5.0))));
            judge.case = format!("{} {change:?}", scene.world.make.name);
            scene.send(Command::Offset(change));
        } else {
            let track = ProgramTrack::new(Target::Fixed(at), scene.world.station.site, Vec::new());
            judge.case = format!("{} {at:?}", scene.world.make.name);
            scene.send(Command::ProgramTrack(Box::new(track)));
        }
        let deed = Deed::Point(at.azimuth_deg(), at.elevation_deg());
        deed.go_on(&mut scene, &judge, dice.between(0.3, 12.0)).await;
    }
    judge.stop(&mut scene, 12.0).await;
}

#[test]
fn any_other_target_on_the_way_leads_into_no_keep_out() {
    for_each_case("targets change on the way", 25, is_retargeted);
}
