//! Size of the record of three antennas. Azel asks each five times a second, and one tracks all its
//! passes. `AZEL_HOURS=24 TMPDIR=/dev/shm cargo test --test azel rehearsed::size -- --nocapture`
//! measures a day in some 20 minutes.

use std::time::Instant;

use azel::{astro::time::add_seconds, record::RowKind, station::PollRates};
use rusqlite::Connection;

use super::{
    recorded::{path_in, rows_in},
    scene::{Scene, set_automatic},
};
use crate::common::units::{self, measured, start, until};

const RATES: PollRates = PollRates { idle_hz: 5.0, moving_hz: 5.0 };
const PARTS: u32 = 24;
/// Max size of the record of a day, bytes.
const MOST: f64 = 1e9;

#[tokio::test(start_paused = true)]
async fn the_record_of_a_day_fits_on_a_small_disk() {
    let hours: f64 = std::env::var("AZEL_HOURS").map_or(0.1, |text| text.parse().unwrap());
    let mut station = units::station();
    station.antennas.iter_mut().for_each(|antenna| antenna.poll = RATES);
    let begun = Instant::now();
    let scene = Scene::recorded(start(), &station);
    let client = scene.client();
    for name in ["Mast", "Horn"] {
        measured(&client, name).await;
    }
    let dish = measured(&client, "Dish").await;
    set_automatic(&client, dish, true).await;
    // A single wait may not last a day, so wait in parts.
    for part in 1..=PARTS {
        let end = add_seconds(start(), hours * 3600.0 * f64::from(part) / f64::from(PARTS));
        until("the end", || (client.now().utc > end).then_some(())).await;
    }
    drop(client);
    let ended = scene.ended().await;
    let file = path_in(ended.path());
    let bytes = file.metadata().unwrap().len() as f64;
    let db = Connection::open(&file).unwrap();
    let count = |table: &str| -> i64 {
        db.query_row(&format!("SELECT count(*) FROM {table}"), [], |row| row.get(0)).unwrap()
    };
    let mut sizes =
        db.prepare("SELECT name, sum(pgsize) FROM dbstat GROUP BY name ORDER BY 2 DESC").unwrap();
    let sizes = sizes.query_map([], |row| Ok((row.get(0)?, row.get(1)?))).unwrap();
    let sizes: Vec<(String, f64)> = sizes.map(Result::unwrap).take(6).collect();
    println!(
        "{hours} h: {:.1} MB in {:.0} s; {} positions, {} lines, {} passes",
        bytes / 1e6,
        begun.elapsed().as_secs_f64(),
        count("position"),
        count("frame"),
        rows_in(ended.path(), RowKind::Pass).len()
    );
    for (name, bytes) in sizes {
        println!("{name}: {:.1} MB", bytes / 1e6);
    }
    assert!(count("position") as f64 > 0.9 * 3.0 * 5.0 * 3600.0 * hours);
    assert!(bytes * 24.0 / hours < MOST);
}
