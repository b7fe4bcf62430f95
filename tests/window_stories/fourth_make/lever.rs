//! Make that turns an antenna by one long lever.

use std::{
    collections::VecDeque,
    io::{BufRead as _, BufReader, Write as _},
    net::TcpListener,
    sync::mpsc,
    thread,
    time::Duration,
};

use azel::{
    astro::{Angle, AzEl},
    clock::{Instant, Moment},
    controller::satrak,
    device::{
        AntennaState, Axis, AxisMotion, Capabilities, Controller, ControllerEvent, Device, Drive,
        Effect, Extent, JogSpeeds, Measured, Motion, SecondAxis, Standstill, Variant,
        settings::{Field, Key},
    },
    station::{Connection, ControllerSpec, DefaultFigures, Link, Setting, Table},
};

pub(crate) static SPEC: ControllerSpec = ControllerSpec {
    key: "lever",
    name: "Archimedes Lever",
    short_name: "Lever",
    link: Link::Tcp,
    default_address: "lever.example:1",
    defaults: DefaultFigures { beam_width_deg: 7.0, ..satrak::SPEC.defaults },
    settings: &[&CODE, &GEAR, &SHAFTS],
    closed_note: None,
    element_files: None,
    explain: None,
    why_no_question: None,
    variants: &[&VARIANT, &LEVEL],
    variant: |connection| if connection.whole(&SHAFTS) == 1 { &LEVEL } else { &VARIANT },
    open: |antenna| Box::new(Lever::of(&antenna.connection)),
};

pub(crate) static CODE: Setting =
    Setting::new(Field::edit(Key::text("code", |_| Ok(())), "Access code"), || "".into())
        .noted(|value| (*value == "".into()).then_some("It takes no orders so."));

pub(crate) static GEAR: Setting = Setting::new(
    Field::edit(Key::word("gear", &[("low", "Low gear"), ("high", "High gear")]), "Gear"),
    || "low".into(),
)
.in_table(DRIVE);

pub(crate) static SHAFTS: Setting =
    Setting::new(Field::edit(Key::integer("shafts", 1, 4), "Shafts"), || 2.into()).in_table(DRIVE);

const DRIVE: Table = Table { key: "drive", title: "Drive" };

static VARIANT: Variant = Variant {
    capabilities: Capabilities {
        axes: ["Az", "El"],
        has_program: false,
        takes_positions: true,
        arrives_within_deg: 1.0,
        position_step_deg: 0.0,
        azimuth_wraps: false,
        second_axis: SecondAxis::Elevation,
        jog: JogSpeeds::AnyRate,
        jogs_one_axis: false,
        steps: false,
        ends_jogs: false,
        waits_for_word: false,
        standstill: Standstill { resolution_deg: 0.1, slowest_deg_s: 0.5, overrun_s: 0.5 },
        effect: Effect { shows_after_s: 4.0, ignores_deg: 0.0 },
        stop_note: None,
    },
    groups: &[],
    actions: &[],
    track_offsets: None,
    clock: None,
};

/// Variant with one shaft, which turns only the azimuth.
static LEVEL: Variant = Variant {
    capabilities: Capabilities {
        axes: ["Az", ""],
        second_axis: SecondAxis::Absent,
        ..VARIANT.capabilities
    },
    groups: &[],
    actions: &[],
    track_offsets: None,
    clock: None,
};

/// Command at which the controller panics instead of sending it.
pub(super) const FRAGILE: &str = "G 180 45";

/// Interval between two questions for the position.
const PERIOD: Duration = Duration::from_millis(100);
/// Max length of a line, bytes; a longer line is noise.
const LONGEST: usize = 256;

/// Controller of a protocol of lines: a code; `P?`, answered by `P` and a position; `G` and a
/// position or `J` and two rates, answered by the same letter; `S`. TCP loses nothing, so the
/// controller repeats no question, and an answer belongs to the one pending question.
struct Lever {
    greeting: String,
    state: AntennaState,
    orders: VecDeque<String>,
    /// Motion that is queued, or that was sent and has no answer yet.
    motion: Option<Motion>,
    events: VecDeque<ControllerEvent>,
    heard: Vec<u8>,
    /// Time of the pending question for the position.
    asked: Option<Instant>,
    next_question: Option<Instant>,
}

impl Lever {
    fn of(connection: &Connection) -> Self {
        let (code, gear) = (connection.text(&CODE), connection.text(&GEAR));
        Self {
            greeting: format!("C {code} {gear} {}\n", connection.whole(&SHAFTS)),
            state: AntennaState::default(),
            orders: VecDeque::new(),
            motion: None,
            events: VecDeque::new(),
            heard: Vec::new(),
            asked: None,
            next_question: None,
        }
    }

    fn take_line(&mut self, line: &str, now: Moment) {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        let is_motion = ["G", "J"].contains(&word);
        let figures: Vec<f64> = rest.split(' ').filter_map(|figure| figure.parse().ok()).collect();
        match (word, &figures[..], self.asked, self.motion) {
            ("P", &[azimuth_deg, elevation_deg], Some(asked), _) => {
                self.asked = None;
                self.take_position([azimuth_deg, elevation_deg], asked, now);
            }
            (_, [], _, Some(motion)) if is_motion => {
                self.motion = None;
                self.events.push_back(ControllerEvent::Accepted(motion.into()));
            }
            _ => {
                self.state.traffic.unreadable += 1;
                self.state.traffic.last_unreadable = Some(now.steady);
                return;
            }
        }
        self.state.traffic.replies += 1;
        self.state.traffic.last_reply = Some(now.steady);
    }

    fn take_position(
        &mut self,
        [azimuth_deg, elevation_deg]: [f64; 2],
        asked: Instant,
        now: Moment,
    ) {
        let axis = |angle_deg| Axis {
            angle_deg: Some(angle_deg),
            // The unit reports no motion, so the angles alone prove standstill.
            motion: AxisMotion::Still,
            drive: Drive::Off,
            plus_limit: false,
            minus_limit: false,
        };
        self.state.measured = Some(Measured {
            time: now.utc,
            requested: asked,
            received: now.steady,
            pointing: AzEl::from_degrees(azimuth_deg, elevation_deg).into(),
            axes: [axis(azimuth_deg), axis(elevation_deg)],
        });
        // The unit has no faults that would prevent motion.
        self.state.motion_lock = Some(false);
    }

    fn refuse(&mut self, motion: Motion) {
        self.events.push_back(ControllerEvent::Refused(motion.into(), "no lever".to_owned()));
    }
}

impl Device for Lever {
    fn link_up(&mut self, now: Moment) {
        self.state.link_since = Some(now.steady);
        self.orders = [self.greeting.clone()].into();
        (self.motion, self.asked, self.next_question) = (None, None, None);
        self.heard.clear();
    }

    fn receive(&mut self, bytes: &[u8], now: Moment) {
        self.heard.extend_from_slice(bytes);
        while let Some(end) = self.heard.iter().position(|byte| *byte == b'\n') {
            let line: Vec<u8> = self.heard.drain(..=end).collect();
            self.take_line(String::from_utf8_lossy(&line).trim(), now);
        }
        if self.heard.len() > LONGEST {
            self.heard.clear();
        }
    }

    fn poll(&mut self, now: Moment) -> Option<Vec<u8>> {
        if let Some(order) = self.orders.pop_front() {
            assert!(!order.starts_with(FRAGILE), "a controller with a fault of its own");
            return Some(order.into_bytes());
        }
        if self.asked.is_some() || self.next_question.is_some_and(|next| now.steady < next) {
            return None;
        }
        (self.asked, self.next_question) = (Some(now.steady), Some(now.steady + PERIOD));
        Some(b"P?\n".to_vec())
    }

    fn due(&self, now: Moment) -> Instant {
        match self.next_question {
            _ if !self.orders.is_empty() => now.steady,
            // The answer wakes the session.
            _ if self.asked.is_some() => now.steady + PERIOD,
            next => next.unwrap_or(now.steady),
        }
    }

    fn halt(&mut self, _: Extent, _: Moment) -> Vec<u8> {
        self.orders.clear();
        self.motion = None;
        b"S\n".to_vec()
    }

    /// Does nothing, because the interval of the questions is fixed.
    fn watch_closely(&mut self, _: bool) {}

    fn motion_under_way(&self) -> bool {
        self.motion.is_some()
    }

    fn state(&self) -> &AntennaState {
        &self.state
    }

    fn next_event(&mut self) -> Option<ControllerEvent> {
        self.events.pop_front()
    }
}

impl Controller for Lever {
    fn start(&mut self, motion: Motion) {
        let stays_deg = self.state.measured.map(|measured| measured.axes.map(|it| it.angle_deg));
        let order = match (motion, stays_deg) {
            (Motion::Jog { x_deg_s, y_deg_s }, _) => format!("J {x_deg_s} {y_deg_s}\n"),
            (Motion::Position { azimuth, elevation }, Some([az_deg, el_deg]))
                if let Some(az_deg) = azimuth.map(Angle::degrees).or(az_deg)
                    && let Some(el_deg) = elevation.map(Angle::degrees).or(el_deg) =>
            {
                format!("G {az_deg} {el_deg}\n")
            }
            _ => return self.refuse(motion),
        };
        self.orders.push_back(order);
        self.motion = Some(motion);
    }
}

/// Starts a unit that reaches any position at once. Returns its address and the lines that it
/// receives, without questions.
pub(crate) fn unit() -> (String, mpsc::Receiver<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let (tell, heard) = mpsc::sync_channel(64);
    let serve = move || {
        let mut place = "10 20".to_owned();
        for mut stream in listener.incoming().map_while(Result::ok) {
            let lines = BufReader::new(stream.try_clone().unwrap()).lines();
            for line in lines.map_while(Result::ok) {
                if line == "P?" {
                    // Write the answer in one piece: otherwise the second piece waits for the
                    // acknowledgement of the first.
                    stream.write_all(format!("P {place}\n").as_bytes()).unwrap();
                    continue;
                }
                if let Some(aim) = line.strip_prefix("G ") {
                    stream.write_all(b"G\n").unwrap();
                    aim.clone_into(&mut place);
                }
                // Ignore errors: the listener may have seen enough.
                let _ = tell.try_send(line);
            }
        }
    };
    thread::Builder::new().name("lever".to_owned()).spawn(serve).unwrap();
    (address, heard)
}
