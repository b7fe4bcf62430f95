//! Price of a pass that the schedule leaves out, compared with the changes when the pass is taken.

use std::sync::Arc;

use azel::{
    contract::{Command, passes::PassListKey, schedule::Planned},
    engine::Client,
    plan::schedule::{Change, Changed, LeftOutReason, Refusal, Rule},
    station::{PassLimits, Station, Take},
};

use super::scene::Scene;
use crate::common::units::{measured, start, station, until};

/// Number of left-out passes that the test checks.
const LOOKED_AT: usize = 6;

async fn planned(client: &Client, after: u64) -> Arc<Planned> {
    until("a schedule", || {
        let planned = Arc::clone(&client.snapshot().schedule);
        (planned.made_at.is_some() && planned.revision > after).then_some(planned)
    })
    .await
}

fn choose(client: &Client, pass: PassListKey, take: Option<Take>) {
    let list = &client.snapshot().pass_lists.favourites;
    let tca = list.passes.iter().find(|of| of.key() == pass).unwrap().pass.tca.time;
    let _ = client.send(Command::ChoosePass { satellite: pass.0, tca, take });
}

/// Returns each change as text, without the figures that change as time passes.
fn in_short(changes: &[Change]) -> Vec<String> {
    let short = changes.iter().map(|change| match change.changed {
        Changed::Cut { late_s, early_s } => {
            format!("{:?} cut by {:.0} and {:.0} s", change.pass, late_s, early_s)
        }
        changed => format!("{:?} {changed:?}", change.pass),
    });
    let mut short: Vec<String> = short.collect();
    short.sort();
    short
}

#[tokio::test(start_paused = true)]
async fn the_price_of_a_pass_is_what_changes_when_it_is_always_taken() {
    let mut station = station();
    // One satellite has a limit that leaves out its passes.
    let limited = station.favourites.numbers()[0];
    let limits = PassLimits { min_max_elevation_deg: Some(89.9), ..PassLimits::default() };
    station.favourites.set_limits(limited, limits);
    check(&station).await;
}

async fn check(station: &Station) {
    let scene = Scene::new(start(), station);
    let client = scene.client();
    for name in ["Dish", "Mast", "Horn"] {
        measured(&client, name).await;
    }
    let mut now = planned(&client, 0).await;
    let (mut priced, mut by_rule) = (0, 0);
    let mut seen: Vec<PassListKey> = Vec::new();
    while seen.len() < LOOKED_AT {
        let is_rule = |why: &LeftOutReason| {
            matches!(why, LeftOutReason::Refused(Refusal::Rule(Rule::MinElevation { .. })))
        };
        // Azel plans again once it knows the positions of the antennas.
        now = planned(&client, now.revision - 1).await;
        let mut left_out: Vec<_> = now.schedule.left_out.iter().collect();
        left_out.sort_by_key(|left| !is_rule(&left.reason) || by_rule > 1);
        let keys = left_out.iter().map(|left| ((left.pass.satellite, left.pass.aos), &left.reason));
        let Some((pass, why)) = keys.into_iter().find(|(pass, _)| !seen.contains(pass)) else {
            break;
        };
        seen.push(pass);
        let why = why.clone();
        let mut asked = 0;
        let (was, swap) = until("the price", || {
            let snapshot = client.snapshot();
            let revision = snapshot.schedule.revision;
            // A new request makes Azel compute the price for the new schedule.
            if asked != revision {
                asked = revision;
                let _ = client.send(Command::PriceSwap(pass));
            }
            let swap = snapshot.swap.clone()?;
            (swap.pass == pass && swap.revision == revision).then_some((revision, swap))
        })
        .await;
        choose(&client, pass, Some(Take::Always));
        let made = planned(&client, was).await;
        let key = |of: &azel::plan::schedule::Entry| (of.pass.satellite, of.pass.aos);
        let is_taken = made.schedule.entries.iter().any(|entry| key(entry) == pass);
        assert_eq!(swap.changes.is_some(), is_taken, "{pass:?} {why:?}");
        if let Some(changes) = &swap.changes {
            assert_eq!(in_short(changes), in_short(&made.changes), "{pass:?} {why:?}");
            priced += 1;
            by_rule += usize::from(is_rule(&why));
        }
        choose(&client, pass, None);
        now = planned(&client, made.revision).await;
    }
    println!("{priced} prices of {} passes, {by_rule} beyond a limit", seen.len());
    assert!(priced > 2 && by_rule > 0, "{priced} {by_rule}");
}
