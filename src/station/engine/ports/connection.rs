//! One connection of a port: reads lines and answers them. It never waits for a client that does
//! not read.

use std::{future::poll_fn, pin::Pin, task::Poll, time::Duration};

use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite};

use super::{answers, board::Seat};
use crate::{
    astro::AzEl,
    clock::Instant,
    contract::{
        Command, CommandOrigin,
        antenna::AntennaModel,
        control::{ClientCommand, Party},
    },
    driver::JOG_LEASE,
    engine::Client,
    protocol::rotctld::{self, ErrorCode, Line, Lines, Motion, Reply, Request, Sense, Speed},
    station::Mount,
};

/// Max number of bytes per read.
const READS: usize = 4096;
/// Time after which a command without a line feed counts as complete.
const LINE_ENDS: Duration = Duration::from_secs(2);
/// Max number of answered lines per second. Gpredict, the quickest known client, sends four.
const LINES_PER_SECOND: u32 = 100;
/// Timeout for the station's answer to a motion. libhamlib waits for 2 s in total.
const ANSWERS_WITHIN: Duration = Duration::from_millis(1500);

/// Serves one client until it hangs up, the port closes or the station ends.
pub(in crate::engine) async fn converse(
    stream: impl AsyncRead + AsyncWrite,
    seat: Seat,
    station: Client,
) {
    let station = station.acting_for(CommandOrigin::Port(seat.peer));
    let (reader, writer) = tokio::io::split(stream);
    tokio::pin!(reader, writer);
    let mut connection = Connection {
        seat,
        station,
        lines: Lines::default(),
        turning: None,
        pointed: None,
        budget: Budget::default(),
    };
    connection.serve(reader, writer).await;
}

/// Turn from `\move`, which Azel repeats until the turn ends.
struct Turn {
    rates_deg_s: [f64; 2],
    next: Instant,
}

struct Connection {
    seat: Seat,
    station: Client,
    lines: Lines,
    turning: Option<Turn>,
    /// Last accepted position: clients repeat it until the antenna has arrived.
    pointed: Option<AzEl>,
    budget: Budget,
}

/// Number of lines answered in the current second, and its start.
#[derive(Default)]
struct Budget {
    second: Option<Instant>,
    lines: u32,
}

impl Budget {
    /// Counts a line, and returns the pause before Azel answers it.
    fn take(&mut self, now: Instant) -> Option<Duration> {
        let second = *self.second.get_or_insert(now);
        let spent = now.saturating_duration_since(second);
        if spent >= Duration::from_secs(1) {
            (self.second, self.lines) = (Some(now), 0);
        }
        self.lines += 1;
        (self.lines > LINES_PER_SECOND).then(|| Duration::from_secs(1).saturating_sub(spent))
    }
}

/// Input of a connection.
enum Input {
    Bytes(usize),
    /// A pending line or the next step of a turn is due.
    Time,
    End,
}

impl Connection {
    async fn serve(
        &mut self,
        mut reader: Pin<&mut impl AsyncRead>,
        mut writer: Pin<&mut impl AsyncWrite>,
    ) {
        let mut buffer = [0; READS];
        loop {
            let input = self.input(&mut reader, &mut buffer).await;
            let lines = match input {
                Input::Bytes(0) | Input::End => return,
                Input::Bytes(count) => self.lines.push(buffer.get(..count).unwrap_or_default()),
                Input::Time => {
                    self.turn_on();
                    let is_pending = self.turning.is_none() && self.lines.has_pending();
                    self.lines.flush().filter(|_| is_pending).into_iter().collect()
                }
            };
            for line in lines {
                let Some(text) = self.answer(line).await else { return };
                if !write_now(writer.as_mut(), text.as_bytes()).await {
                    return;
                }
            }
        }
    }

    async fn input(&mut self, reader: &mut Pin<&mut impl AsyncRead>, buffer: &mut [u8]) -> Input {
        let now = self.station.now().steady;
        let turn = self.turning.as_ref().map(|turn| turn.next);
        let line = self.lines.has_pending().then(|| now + LINE_ENDS);
        let due = turn.or(line);
        let clock = self.station.clock().clone();
        let time = async {
            match due {
                Some(due) => clock.sleep_until(due).await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            biased;
            () = self.seat.ended() => Input::End,
            read = reader.read(buffer) => read.map_or(Input::End, Input::Bytes),
            () = time => Input::Time,
        }
    }

    /// Returns the answer to a line, which may be empty; `None` to hang up.
    async fn answer(&mut self, line: Line) -> Option<String> {
        let now = self.station.now().steady;
        if let Some(pause) = self.budget.take(now) {
            self.station.clock().sleep(pause).await;
        }
        let Line::Text(line) = line else {
            return Some(format!("RPRT {}\n", ErrorCode::INVALID.report()));
        };
        self.seat.heard(&line, self.station.now().steady);
        let Some(command) = rotctld::Command::parse(&line) else { return Some(String::new()) };
        let reply = match command.request {
            Ok(Request::Quit) => return None,
            Ok(request) => self.carry_out(request).await,
            Err(code) => Reply::Error(code),
        };
        Some(reply.to_text(&command))
    }
}

/// Writes the bytes that the system takes at once. Returns `false` if the client could not read the
/// rest of the connection correctly.
async fn write_now(mut writer: Pin<&mut impl AsyncWrite>, bytes: &[u8]) -> bool {
    if bytes.is_empty() {
        return true;
    }
    let written = poll_fn(|context| match writer.as_mut().poll_write(context, bytes) {
        Poll::Ready(written) => Poll::Ready(Some(written)),
        Poll::Pending => Poll::Ready(None),
    });
    match written.await {
        // A client that does not read, such as Look4Sat, misses answers.
        None => true,
        // A partial answer would shift all later answers.
        Some(Ok(count)) => count == bytes.len(),
        Some(Err(_)) => false,
    }
}

impl Connection {
    async fn carry_out(&mut self, request: Request) -> Reply {
        // Any other command ends a turn; queries do not.
        if matches!(request, Request::Stop | Request::Motion(_)) {
            self.turning = None;
        }
        let snapshot = self.station.snapshot();
        let Some(antenna) =
            snapshot.antennas.iter().find(|antenna| antenna.id() == self.seat.antenna)
        else {
            return Reply::Error(ErrorCode::NOT_AVAILABLE);
        };
        let now = self.station.now().steady;
        match request {
            Request::State => Reply::State(answers::LIMITS),
            Request::Capabilities => Reply::Capabilities {
                name: antenna.spec().short_name.to_owned(),
                limits: answers::capabilities(antenna),
            },
            Request::Info => Reply::Info(antenna.config.name.clone()),
            Request::Position => {
                answers::position(antenna, now).map_or_else(Reply::Error, Reply::Position)
            }
            Request::Status => {
                answers::status(antenna, now).map_or_else(Reply::Error, Reply::Status)
            }
            Request::Stop => {
                self.pointed = None;
                // Do not wait for the station: a client's stop needs no answer.
                self.send(ClientCommand::Stop);
                Reply::Done
            }
            Request::Motion(motion) => match self.motion(antenna, motion).await {
                Ok(()) => Reply::Done,
                Err(code) => Reply::Error(code),
            },
            // The connection ends before this arm.
            Request::Quit => Reply::Done,
        }
    }

    async fn motion(&mut self, antenna: &AntennaModel, motion: Motion) -> Result<(), ErrorCode> {
        let command = match motion {
            Motion::GoTo(position) => ClientCommand::Point(answers::direction(antenna, position)?),
            Motion::Park if antenna.variant().capabilities.takes_positions => ClientCommand::Park,
            Motion::Park => return Err(ErrorCode::NOT_AVAILABLE),
            Motion::Turn { sense, speed } => {
                let rates_deg_s = rates(antenna, sense, speed)?;
                ClientCommand::Turn { rates_deg_s, is_repeated: false }
            }
        };
        if !self.may_ask(antenna) {
            return Err(ErrorCode::REJECTED);
        }
        let is_in_control = antenna.control.party == Some(Party::Program(self.seat.peer));
        if let ClientCommand::Point(direction) = command
            && is_in_control
            && self.pointed == Some(direction)
        {
            return Ok(());
        }
        self.pointed = None;
        self.ask(command).await?;
        match command {
            ClientCommand::Point(direction) => self.pointed = Some(direction),
            ClientCommand::Turn { rates_deg_s, .. } => {
                let next = self.station.now().steady + JOG_LEASE / 3;
                self.turning = Some(Turn { rates_deg_s, next });
            }
            ClientCommand::Park | ClientCommand::Stop => {}
        }
        Ok(())
    }

    /// Returns `false` if the station would certainly refuse and the operator already knows of the
    /// request. This saves the station the work.
    fn may_ask(&self, antenna: &AntennaModel) -> bool {
        let client = antenna.control.client(self.seat.peer);
        client.is_none_or(|client| {
            client.asks_since.is_none()
                || match antenna.control.party {
                    Some(party) => party == Party::Program(self.seat.peer),
                    None => client.is_allowed,
                }
        })
    }

    /// Sends a motion, and waits for the answer of the station or the session.
    async fn ask(&mut self, command: ClientCommand) -> Result<(), ErrorCode> {
        let (antenna, peer) = (self.seat.antenna, self.seat.peer);
        let number = self.station.send_numbered(Command::Client(antenna, command));
        let Ok(number) = number else { return Err(ErrorCode::REJECTED) };
        let clock = self.station.clock().clone();
        let answered = async {
            loop {
                let snapshot = self.station.snapshot();
                let model = snapshot.antennas.iter().find(|model| model.id() == antenna);
                let client = model.and_then(|model| model.control.client(peer));
                let answer = client.and_then(|client| client.answer.as_ref());
                if let Some(answer) = answer.filter(|answer| answer.number == number) {
                    return answer
                        .problem
                        .as_ref()
                        .map_or(Ok(()), |problem| Err(answers::code(problem)));
                }
                if !self.station.changed().await {
                    return Err(ErrorCode::REJECTED);
                }
            }
        };
        clock.timeout(ANSWERS_WITHIN, answered).await.unwrap_or(Err(ErrorCode::TIMED_OUT))
    }

    fn send(&self, command: ClientCommand) {
        let command = Command::Client(self.seat.antenna, command);
        if self.station.send(command).is_err() {
            tracing::warn!(peer = %self.seat.peer, "the station is too busy for a client");
        }
    }

    /// Repeats a due turn while the client is in control.
    fn turn_on(&mut self) {
        let now = self.station.now().steady;
        let snapshot = self.station.snapshot();
        let model = snapshot.antennas.iter().find(|model| model.id() == self.seat.antenna);
        let party = model.and_then(|model| model.control.party);
        let Some(turn) = self.turning.as_mut().filter(|turn| turn.next <= now) else { return };
        turn.next = now + JOG_LEASE / 3;
        let rates_deg_s = turn.rates_deg_s;
        if party == Some(Party::Program(self.seat.peer)) {
            self.send(ClientCommand::Turn { rates_deg_s, is_repeated: true });
        } else {
            self.turning = None;
        }
    }
}

/// Returns the rates of azimuth and elevation, degrees per second.
fn rates(
    antenna: &AntennaModel,
    sense: Sense,
    speed: Option<Speed>,
) -> Result<[f64; 2], ErrorCode> {
    // The axes of an X/Y mount are neither azimuth nor elevation.
    if matches!(antenna.config.mount, Mount::Xy { .. }) {
        return Err(ErrorCode::NOT_AVAILABLE);
    }
    let share = speed.map_or(1.0, |speed| f64::from(speed.per_cent()) / 100.0);
    Ok(sense.signs().map(|sign| sign * share * antenna.config.limits.maximum_rate_deg_s))
}
