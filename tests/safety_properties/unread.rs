//! Station files with damage to one entry that safety depends on.

use azel::{
    contract::driver::Command,
    controller::SPECS,
    plan::Bounds,
    station::{self, SunAvoidance},
};
use toml::{Table, Value};

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    scene::Scene,
    unit::Word,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

/// Draws a value that is invalid as a number, text or list of an entry.
fn odd(dice: &mut Dice) -> Value {
    let nested = Value::Table(Table::from_iter([("a".to_owned(), Value::Integer(1))]));
    let values = [
        Value::String("five".to_owned()),
        Value::Float(f64::NAN),
        Value::Float(f64::INFINITY),
        Value::Float(-1e9),
        Value::Integer(i64::MAX),
        Value::Boolean(true),
        // An empty list would be a valid list of keep-outs.
        Value::Array(vec![Value::Integer(1)]),
        nested,
    ];
    values[dice.below(values.len())].clone()
}

/// Returns the key with a typing error.
fn mistyped(dice: &mut Dice, key: &str) -> String {
    let mut letters: Vec<char> = key.chars().collect();
    let at = dice.below(letters.len() - 1);
    match dice.below(4) {
        0 => drop(letters.remove(at)),
        1 => letters.insert(at, letters[at]),
        2 if letters[at] != letters[at + 1] => letters.swap(at, at + 1),
        _ => letters.push('s'),
    }
    letters.into_iter().collect()
}

/// Damages an entry of `table`, or its name. Returns a description of the damage.
fn damage(dice: &mut Dice, table: &mut Table, keys: &[&str]) -> String {
    let key = keys[dice.below(keys.len())];
    let value = table.remove(key).unwrap_or_else(|| panic!("no {key} in {table}"));
    if dice.chance(0.4) {
        let wrong = mistyped(dice, key);
        table.insert(wrong.clone(), value);
        return format!("{key} is called {wrong}");
    }
    let odd = odd(dice);
    let text = format!("{key} = {odd}");
    table.insert(key.to_owned(), odd);
    text
}

fn inner<'a>(table: &'a mut Table, key: &str) -> &'a mut Table {
    match table.get_mut(key) {
        Some(Value::Table(table)) => table,
        Some(Value::Array(tables)) => tables[0].as_table_mut().unwrap(),
        other => panic!("{key}: {other:?}"),
    }
}

/// Damages one entry that safety depends on. Returns a description of the damage.
fn damage_one(dice: &mut Dice, station: &mut Table) -> String {
    match dice.below(6) {
        0 => damage(dice, station, &["keep_out", "sun_avoidance", "site"]),
        1 => damage(dice, inner(station, "keep_out"), &["corners", "margin_deg"]),
        2 => damage(dice, inner(station, "sun_avoidance"), &["radius_deg", "ahead_min"]),
        3 => damage(dice, inner(station, "site"), &["latitude_deg", "longitude_deg"]),
        4 => {
            let keys = ["minimum_elevation_deg", "maximum_rate_deg_s", "maximum_step_deg"];
            damage(dice, inner(inner(station, "antenna"), "limits"), &keys)
        }
        _ => damage(dice, inner(station, "antenna"), &["limits", "mount", "beam_width_deg"]),
    }
}

/// Returns the world as Azel reads it from a damaged station file, and the damage. `None` if the
/// antenna is gone.
fn damaged(dice: &mut Dice, mut world: World) -> Option<(World, String)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    world.station.sun_avoidance = Some(SunAvoidance { radius_deg: 5.0, ahead_min: 10.0 });
    let address = if world.make.waits_for_word { "/dev/ttyS0" } else { "unit:4001" };
    address.clone_into(&mut world.antenna.connection.address);
    world.station.antennas = vec![world.antenna.clone()];
    station::save(&world.station, &path, SPECS).unwrap();
    let mut table: Table = toml::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let damage = damage_one(dice, &mut table);
    std::fs::write(&path, toml::to_string(&table).unwrap()).unwrap();
    let loaded = station::load(&path, SPECS).unwrap();
    assert!(!loaded.notes.is_empty(), "unnoticed: {damage}");
    world.station = loaded.station;
    world.antenna = world.station.antennas.first()?.clone();
    world.bounds = Bounds::new(&world.station, &world.antenna);
    Some((world, damage))
}

async fn cannot_be_read(mut dice: Dice) {
    let wish = Wish { keep_outs: 1, overflight: Overhead::Satellite, ..Wish::default() };
    let world = loop {
        let world = World::random(&mut dice, &wish);
        if !world.station.keep_outs.is_empty() {
            break world;
        }
    };
    let Some((world, damage)) = damaged(&mut dice, world) else { return };
    let mut scene = Scene::start(world, &mut dice).await;
    let mut judge = Judge::new(&scene, damage);
    // The damage may concern the mount. Nothing moves before the operator's permission.
    judge.is_lost = true;
    let began = azel::clock::Instant::now();
    for _ in 0..3 {
        let deed = Deed::any(&mut dice, &scene.world);
        deed.begin(&mut scene, &mut judge).await;
        deed.go_on(&mut scene, &judge, dice.between(0.5, 3.0)).await;
        deed.let_go(&scene);
    }
    let words = scene.world.words_since(began);
    let moved = words.iter().any(|(_, word)| *word == Word::Motion);
    assert!(!moved, "moves: {judge}\n{words:?}\n{}", scene.report());
    // With the operator's permission, the antenna moves slowly by hand.
    scene.send(Command::AllowWayOut);
    scene.send(Command::Manual);
    let axis = dice.below(2);
    let mut rates_deg_s = [0.0; 2];
    rates_deg_s[axis] = scene.world.antenna.limits.maximum_rate_deg_s * dice.between(0.05, 0.24);
    Deed::Jog(rates_deg_s).go_on(&mut scene, &judge, 2.0).await;
    scene.send(Command::EndJog);
    judge.stop(&mut scene, 12.0).await;
}

#[test]
fn any_safety_setting_that_cannot_be_read_forbids_motion() {
    for_each_case("a safety setting is damaged", 40, cannot_be_read);
}
