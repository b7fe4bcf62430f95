//! Random sequences of commands and faults.

use proptest::prelude::*;

use super::*;
use crate::protocol::rc2000c::{Address, Decoder, Frame, Reply, checksum};
use crate::sim::harness::Unit;

/// Commands with an effect, without address and checksum.
const COMMANDS: [&str; 22] = [
    "0",
    "1",
    "2 SBS 6     ",
    "2HGSTAR 3   ",
    "2VANIK E2   ",
    "2 0003001830",
    "2 0363000030",
    "2 0200001000",
    "2P0000000000",
    "2P0066100000",
    "2P0101200000",
    "3EF9999",
    "3WS0300",
    "3DF9999",
    "3US9999",
    "3XS0000",
    "4C",
    "4W",
    "4H",
    "4V",
    "6PN",
    "6PF",
];
const REST: [&str; 6] = ["6RA", "6RE", "6RP", "6TR", "6TC", "501"];

fn frame(command: &str) -> Frame {
    let mut bytes = vec![0x02, Address::FACTORY.number()];
    bytes.extend(command.bytes());
    bytes.push(0x03);
    bytes.push(checksum(&bytes));
    let mut decoder = Decoder::new(Address::FACTORY);
    decoder.push(&bytes);
    decoder.next().unwrap().unwrap()
}

#[derive(Debug, Clone)]
enum Event {
    Command(String),
    Wait(Duration),
    Quirk(Quirk, bool),
    Fault(Fault, bool),
    Panel,
}

fn event() -> impl Strategy<Value = Event> {
    let commands = [&COMMANDS[..], &REST[..]].concat();
    prop_oneof![
        8 => prop::sample::select(commands).prop_map(|command| Event::Command(command.to_owned())),
        2 => "[0-7][ -~]{0,12}".prop_map(Event::Command),
        8 => (0_u64..20_000).prop_map(|ms| Event::Wait(Duration::from_millis(ms))),
        1 => (0..Quirk::ALL.len(), any::<bool>())
            .prop_map(|(index, is_on)| Event::Quirk(Quirk::ALL[index].0, is_on)),
        2 => (0..Fault::ALL.len(), prop::bool::weighted(0.3))
            .prop_map(|(index, is_on)| Event::Fault(Fault::ALL[index].0, is_on)),
        1 => Just(Event::Panel),
    ]
}

fn switch<T: Ord>(set: &mut BTreeSet<T>, item: T, is_on: bool) {
    if is_on {
        set.insert(item);
    } else {
        set.remove(&item);
    }
}

proptest! {
    #[test]
    fn nothing_leaves_the_travel_and_every_reply_is_read(
        events in prop::collection::vec(event(), 0..40)
    ) {
        let mut unit = Rc2000c::new(&Options::default());
        let mut elapsed = Duration::ZERO;
        for event in events {
            match event {
                Event::Wait(time) => elapsed += time,
                Event::Quirk(quirk, is_on) => switch(&mut unit.quirks, quirk, is_on),
                Event::Fault(fault, is_on) => switch(&mut unit.faults, fault, is_on),
                Event::Panel => unit.use_panel(),
                Event::Command(command) => {
                    if let Some(reply) = unit.answer(&frame(&command)) {
                        let mut decoder = Decoder::new(Address::FACTORY);
                        decoder.push(&reply.to_frame(Address::FACTORY).to_bytes());
                        let read = Reply::parse(&decoder.next().unwrap().unwrap());
                        prop_assert!(read.is_ok(), "{command:?}: {reply:?}");
                    }
                }
            }
            unit.suffer();
            unit.advance(elapsed);
            let Snapshot { az_counts, el_counts, polarization_units, .. } = unit.snapshot();
            prop_assert!(AxisOptions::AZIMUTH.travel.contains(&az_counts), "{az_counts}");
            prop_assert!(AxisOptions::ELEVATION.travel.contains(&el_counts), "{el_counts}");
            prop_assert!(polarization_units <= 1012);
        }
    }

    #[test]
    fn without_a_motion_command_nothing_turns(
        waits in prop::collection::vec(0_u64..20_000, 0..20)
    ) {
        let mut unit = Rc2000c::new(&Options::default());
        let before = unit.snapshot();
        let mut elapsed = Duration::ZERO;
        for wait_ms in waits {
            elapsed += Duration::from_millis(wait_ms);
            unit.advance(elapsed);
            unit.answer(&frame("1"));
            unit.answer(&frame("501"));
        }
        prop_assert_eq!(Snapshot { mode: before.mode, ..unit.snapshot() }, before);
    }
}

#[test]
fn small_steps_of_time_and_one_long_one_end_alike() {
    let run = |step_ms: u64| {
        let mut unit = Rc2000c::new(&Options::default());
        unit.answer(&frame("2 GALAXY 5  "));
        for at_ms in (0..=30_000).step_by(step_ms as usize) {
            unit.advance(Duration::from_millis(at_ms));
        }
        unit.snapshot()
    };
    assert_eq!(run(30_000), run(50));
    assert_eq!(run(30_000), run(7_500));
}
