use std::time::Duration;

use jiff::Timestamp;

use super::{axes::tests::IDLE, *};
use crate::{
    device::{Controller, Device, Extent},
    protocol::rc2000c::checksum,
};

const STATUS: &[u8] = b"\x02\x32\x31\x03\x02";
const STOP: &[u8] = b"\x02\x32\x33XS0000\x03\x0b";
const OFFLINE: &[u8] = b"\x06\x32\x33F\x03\x42";

/// A unit on the desk, and the current time.
struct Bench {
    unit: Rc2000c,
    now: Moment,
}

impl Bench {
    /// Returns a unit that was asked for its type and has not answered yet.
    fn new() -> Self {
        let antenna = Antenna::rc2000c("Dish", "/dev/ttyUSB0");
        let unit = Rc2000c::new(&antenna);
        let mut bench =
            Self { unit, now: Moment { steady: Instant::now(), utc: Timestamp::UNIX_EPOCH } };
        assert_eq!(bench.poll(), None, "silent without a link");
        bench.unit.link_up(bench.now);
        assert_eq!(bench.poll().as_deref(), Some(&b"\x02\x32\x30\x03\x03"[..]));
        bench
    }

    /// Returns an idle unit that was read once, with an empty list of satellites.
    fn idle() -> Self {
        let mut bench = Self::new();
        bench.hear(b"\x06\x32\x302KCA14\x03\x79");
        assert_eq!(bench.poll_after(50).as_deref(), Some(STATUS));
        bench.hear(IDLE);
        assert_eq!(bench.poll_after(50).as_deref(), Some(&b"\x02\x32\x3501\x03\x07"[..]));
        bench.hear(b"\x15\x32\x35\x03\x11");
        bench
    }

    fn poll(&mut self) -> Option<Vec<u8>> {
        self.unit.poll(self.now)
    }

    fn poll_after(&mut self, ms: u64) -> Option<Vec<u8>> {
        self.now.steady += Duration::from_millis(ms);
        self.poll()
    }

    fn hear(&mut self, bytes: &[u8]) {
        self.unit.receive(bytes, self.now);
    }

    fn events(&mut self) -> Vec<ControllerEvent> {
        std::iter::from_fn(|| self.unit.next_event()).collect()
    }
}

fn idle_reply_to(code: u8) -> Vec<u8> {
    let mut bytes = IDLE.to_vec();
    bytes.pop();
    bytes[2] = code;
    bytes.push(checksum(&bytes));
    bytes
}

#[test]
fn nothing_is_sent_before_the_gap_or_while_a_reply_is_waited_for() {
    let mut bench = Bench::new();
    assert_eq!(bench.poll_after(500), None);
    bench.hear(b"\x06\x32\x302KCA14\x03\x79");
    assert_eq!(bench.poll_after(49), None);
    assert_eq!(bench.poll_after(1).as_deref(), Some(STATUS));
    assert_eq!(bench.poll(), None);
}

#[test]
fn a_question_goes_out_three_times_and_then_no_more() {
    let mut bench = Bench::idle();
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
    assert_eq!(bench.poll_after(1043), None);
    assert_eq!(bench.poll_after(2).as_deref(), Some(STATUS));
    assert_eq!(bench.poll_after(1045).as_deref(), Some(STATUS));
    assert_eq!(bench.poll_after(1045), None);
    assert_eq!(bench.unit.state().traffic.unanswered, 3);
    let due = bench.unit.due(bench.now);
    assert_eq!(due - bench.now.steady, Duration::from_millis(500), "the next one has its time");
}

#[test]
fn after_a_repeated_question_the_surplus_answer_is_waited_for() {
    let mut bench = Bench::idle();
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
    let question_time = bench.now.steady;
    assert_eq!(bench.poll_after(1045).as_deref(), Some(STATUS));
    bench.hear(IDLE);
    let measured = bench.unit.state().measured.unwrap();
    assert_eq!(measured.requested, question_time, "it may answer the first of the two");
    assert_eq!(bench.poll_after(800), None);
    bench.hear(IDLE);
    assert_eq!(bench.poll_after(400).as_deref(), Some(STATUS));
    bench.hear(IDLE);
    assert_eq!(bench.unit.state().measured.unwrap().requested, bench.now.steady);
    bench.hear(IDLE);
    assert_eq!(bench.unit.state().traffic.unsolicited, 1, "a third answer to two questions");
}

#[test]
fn a_lost_status_leaves_the_position_of_a_moving_antenna_young() {
    let mut bench = Bench::idle();
    bench.unit.watch_closely(true);
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
    let lost = bench.now.steady;
    assert_eq!(bench.poll_after(700).as_deref(), Some(STATUS));
    let repeated = bench.now.steady;
    bench.hear(IDLE);
    let measured_at = |bench: &Bench| bench.unit.state().measured.unwrap().requested;
    assert_eq!(measured_at(&bench), lost, "it may answer either question");
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS), "without a pause");
    bench.hear(IDLE);
    assert_eq!(measured_at(&bench), repeated);
}

#[test]
fn the_reply_to_a_halt_ends_the_wait_for_earlier_answers() {
    let mut bench = Bench::idle();
    bench.unit.watch_closely(true);
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
    assert_eq!(bench.poll_after(700).as_deref(), Some(STATUS));
    bench.hear(IDLE);
    for (wait_ms, is_asked) in [(10_000, false), (60, false), (300, true)] {
        bench.now.steady += Duration::from_millis(wait_ms);
        if is_asked {
            bench.unit.ask_position(bench.now);
            assert_eq!(bench.poll().as_deref(), Some(STATUS));
        }
        bench.unit.halt(Extent::Motion, bench.now);
        bench.hear(&idle_reply_to(b'3'));
        assert_eq!(bench.poll_after(50).as_deref(), Some(STATUS), "after {wait_ms} ms");
        bench.hear(IDLE);
        assert_eq!(bench.unit.state().measured.unwrap().requested, bench.now.steady);
    }
}

#[test]
fn once_each_answer_has_come_nothing_more_is_waited_for() {
    let mut bench = Bench::idle();
    bench.unit.watch_closely(true);
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
    assert_eq!(bench.poll_after(700).as_deref(), Some(STATUS));
    bench.hear(IDLE);
    bench.hear(IDLE);
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
}

#[test]
fn answers_that_come_late_and_together_are_taken_for_no_younger_than_they_are() {
    let mut bench = Bench::idle();
    bench.unit.watch_closely(true);
    let mut questions = Vec::new();
    for wait_ms in [500, 700, 700] {
        assert_eq!(bench.poll_after(wait_ms).as_deref(), Some(STATUS));
        questions.push(bench.now.steady);
    }
    for question_time in questions {
        bench.hear(IDLE);
        assert_eq!(bench.unit.state().measured.unwrap().requested, question_time);
    }
}

#[test]
fn a_renewal_that_comes_too_late_is_not_sent() {
    let mut bench = Bench::idle();
    let motion = Motion::Jog { x_deg_s: 0.0, y_deg_s: 2.0 };
    bench.unit.start(motion);
    let jog = bench.poll_after(50).unwrap();
    assert_eq!(&jog, b"\x02\x32\x33UF0600\x03\x15");
    bench.hear(&idle_reply_to(b'3'));
    assert_eq!(bench.poll_after(299), None, "nothing may hold up the next renewal");
    assert_eq!(bench.poll_after(1), Some(jog));
    bench.hear(&idle_reply_to(b'3'));
    assert_eq!(bench.events().len(), 2);
    assert_eq!(bench.poll_after(600).as_deref(), Some(STATUS));
    assert_eq!(bench.events(), [ControllerEvent::Unanswered(motion.into())]);
    assert!(!bench.unit.motion_under_way());
}

#[test]
fn a_halt_goes_past_a_reply_and_ends_what_waits() {
    let mut bench = Bench::idle();
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
    bench.unit.start(Motion::Jog { x_deg_s: 2.0, y_deg_s: 0.0 });
    assert_eq!(bench.unit.halt(Extent::Everything, bench.now), STOP);
    assert_eq!(bench.poll_after(10), None);
    bench.hear(IDLE);
    assert_eq!(bench.poll_after(50), None, "the halt is not answered yet");
    bench.hear(&idle_reply_to(b'3'));
    assert_eq!(bench.poll_after(50).as_deref(), Some(STATUS), "at once, to see it stand");
    assert_eq!(bench.events(), []);
}

#[test]
fn a_question_that_a_halt_has_overtaken_waits_for_it_before_it_is_repeated() {
    let mut bench = Bench::idle();
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
    bench.now.steady += Duration::from_millis(900);
    bench.unit.halt(Extent::Motion, bench.now);
    assert_eq!(bench.poll_after(200), None);
    assert!(bench.unit.due(bench.now) > bench.now.steady, "it never spins");
    bench.hear(&idle_reply_to(b'3'));
    assert_eq!(bench.poll_after(50).as_deref(), Some(STATUS));
}

#[test]
fn half_a_frame_that_does_not_go_on_hides_no_other() {
    let mut bench = Bench::idle();
    assert_eq!(bench.poll_after(500).as_deref(), Some(STATUS));
    bench.hear(&IDLE[..10]);
    let quiet = bench.unit.due(bench.now);
    assert_eq!(quiet - bench.now.steady, Duration::from_millis(100));
    assert_eq!(bench.poll_after(100), None);
    bench.hear(IDLE);
    assert_eq!(bench.unit.state().traffic.damaged, 1);
    assert_eq!(bench.unit.state().traffic.unanswered, 0);
    assert!(bench.unit.outstanding.is_none());
}

#[test]
fn an_offline_reply_in_a_jog_ends_it() {
    let mut bench = Bench::idle();
    let motion = Motion::Jog { x_deg_s: 2.0, y_deg_s: 0.0 };
    bench.unit.start(motion);
    let jog = bench.poll_after(50).unwrap();
    bench.hear(&idle_reply_to(b'3'));
    bench.events();
    assert_eq!(bench.poll_after(300), Some(jog));
    bench.hear(OFFLINE);
    let [ControllerEvent::Refused(refused, reason)] = &bench.events()[..] else { panic!() };
    assert_eq!((*refused, &**reason), (motion.into(), "remote mode is disabled on the unit"));
    assert!(!bench.unit.motion_under_way());
}

#[test]
fn any_bytes_are_harmless() {
    let mut bench = Bench::idle();
    for seed in 0..200_u32 {
        let noise: Vec<u8> = (0..97_u32)
            .map(|place| (seed.wrapping_mul(31) ^ place.wrapping_mul(97)) as u8)
            .collect();
        bench.hear(&noise);
        bench.poll_after(7);
    }
    assert!(bench.unit.heard.len() < 400);
    assert!(bench.unit.due(bench.now) > bench.now.steady, "it never spins");
}

#[test]
fn bytes_without_a_frame_are_heard_but_not_read() {
    let mut bench = Bench::new();
    assert_eq!(bench.unit.state().traffic.last_unreadable, None);
    bench.hear(b"\xf8\x80\xe6");
    assert_eq!(bench.unit.state().traffic.last_unreadable, Some(bench.now.steady));
}
