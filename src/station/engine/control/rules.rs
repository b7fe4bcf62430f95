//! Rules of control: who takes it from whom, and when it ends.

use std::{
    net::{IpAddr, SocketAddr},
    ops::BitOrAssign,
    time::Duration,
};

use crate::{
    clock::{Instant, Moment},
    contract::{
        CommandOrigin,
        control::{Answer, Control, Expected, NetworkClient, Party},
        driver::Refusal,
    },
};

/// Max silence of a client in control; after it, the client loses control.
const LAPSES_AFTER: Duration = Duration::from_secs(10);
/// Time in which an allowed client may reconnect: Gpredict hangs up 3.6 s after a refusal, and its
/// user engages it again.
const COMES_BACK_WITHIN: Duration = Duration::from_mins(1);
/// Time for which the operator can still decide about a program that has hung up.
const ASKED_LATELY: Duration = Duration::from_mins(2);
/// Longest kept part of a line, characters.
const MAX_LINE: usize = 64;

/// Result of a change of control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub(in crate::engine) enum Loss {
    /// No client lost control.
    None,
    /// A client lost control.
    Client,
}

impl BitOrAssign for Loss {
    fn bitor_assign(&mut self, other: Self) {
        if other == Self::Client {
            *self = other;
        }
    }
}

/// Returns the party behind a command; `None` for the station, whose stops hand control to nobody.
pub(super) fn party_of(origin: CommandOrigin) -> Option<Party> {
    match origin {
        CommandOrigin::Window => Some(Party::Window),
        CommandOrigin::Serve | CommandOrigin::Program | CommandOrigin::Signal => {
            Some(Party::Command)
        }
        CommandOrigin::Port(address) => Some(Party::Program(address)),
        CommandOrigin::Station => None,
    }
}

pub(in crate::engine) trait Rules {
    /// Gives control to `party`, or to nobody. A client that loses control needs a new permission
    /// from the operator, because it continues to send commands.
    fn give(&mut self, party: Option<Party>, now: Moment) -> Loss;
    /// Gives control to automatic operation exactly while it is on.
    fn follow_operation(&mut self, is_on: bool, now: Moment) -> Loss;
    /// Gives control to a client that sends a command, or returns the reason for a refusal.
    fn admit_client(&mut self, address: SocketAddr, now: Moment) -> Result<(), Refusal>;
    /// Permits a client to point the antenna and hands control to it, for the operator.
    fn hand_over(&mut self, address: SocketAddr, now: Moment) -> Loss;
    /// Adds a connected program, and permits it if it was expected.
    fn connected(&mut self, client: NetworkClient, now: Moment);
    /// Permits the address of a client without time limit.
    fn allow(&mut self, address: SocketAddr);
    /// Notes a line from a client.
    fn heard(&mut self, address: SocketAddr, line: &str, time: Instant);
    /// Removes an ended connection.
    fn disconnected(&mut self, address: SocketAddr, now: Moment) -> Loss;
    /// Takes control from a silent client, which may take it again.
    fn lapse(&mut self, now: Moment) -> Loss;
    /// Counts a stop from a client without control.
    fn ignore_stop(&mut self, address: SocketAddr);
    /// Gives control to the party that sent STOP, so that no client begins another motion.
    fn give_by_stop(&mut self, origin: CommandOrigin, now: Moment);
    /// Returns `true` if a client waits for the answer to this command.
    fn awaits(&self, number: u64) -> bool;
    /// Notes that a client waits for the answer to this command.
    fn expect_answer(&mut self, address: SocketAddr, number: u64);
    fn answered(&mut self, answer: &Answer);
}

impl Rules for Control {
    fn give(&mut self, party: Option<Party>, now: Moment) -> Loss {
        if self.party == party {
            return Loss::None;
        }
        let previous = std::mem::replace(&mut self.party, party);
        self.start = party.map(|_| now.utc);
        let Some(Party::Program(address)) = previous else { return Loss::None };
        self.expected.take_if(|expected| expected.address == address.ip());
        if let Some(client) = client_mut(self, address) {
            client.is_allowed = false;
        }
        Loss::Client
    }

    fn follow_operation(&mut self, is_on: bool, now: Moment) -> Loss {
        if is_on {
            return self.give(Some(Party::Automatic), now);
        }
        if self.party == Some(Party::Automatic) { self.give(None, now) } else { Loss::None }
    }

    fn admit_client(&mut self, address: SocketAddr, now: Moment) -> Result<(), Refusal> {
        let party = self.party;
        // The last commands of a connection may arrive after its end.
        let client = client_mut(self, address).ok_or(Refusal::ClientGone)?;
        let refusal = match party {
            Some(party) if party == Party::Program(address) => return Ok(()),
            Some(party) => Refusal::InControl(party),
            None if client.is_allowed => {
                client.asks_since = None;
                let _ = self.give(Some(Party::Program(address)), now);
                return Ok(());
            }
            None => Refusal::NotAllowed,
        };
        client.asks_since.get_or_insert(now.utc);
        Err(refusal)
    }

    fn hand_over(&mut self, address: SocketAddr, now: Moment) -> Loss {
        if self.missed.take_if(|client| client.address == address).is_some() {
            // It takes control when it comes back.
            let loss = self.give(None, now);
            expect(self, address.ip(), now);
            return loss;
        }
        let Some(client) = client_mut(self, address) else { return Loss::None };
        client.asks_since = None;
        // Count the client's silence from here: it may have sent nothing while refused.
        let line = client.last_line.take().map(|(line, _)| line).unwrap_or_default();
        client.last_line = Some((line, now.steady));
        let loss = self.give(Some(Party::Program(address)), now);
        self.allow(address);
        expect(self, address.ip(), now);
        loss
    }

    fn connected(&mut self, client: NetworkClient, now: Moment) {
        let address = client.address;
        let is_expected = self
            .expected
            .is_some_and(|expected| expected.address == address.ip() && now.steady < expected.end);
        self.clients.retain(|other| other.address != address);
        self.clients.push(NetworkClient { is_allowed: is_expected, ..client });
    }

    fn allow(&mut self, address: SocketAddr) {
        if let Some(client) = client_mut(self, address) {
            client.is_allowed = true;
        }
    }

    fn heard(&mut self, address: SocketAddr, line: &str, time: Instant) {
        let Some(client) = client_mut(self, address) else { return };
        let is_news = client.last_line.as_ref().is_none_or(|(_, last)| *last < time);
        if is_news {
            client.last_line = Some((line.chars().take(MAX_LINE).collect(), time));
        }
    }

    fn disconnected(&mut self, address: SocketAddr, now: Moment) -> Loss {
        let place = self.clients.iter().position(|client| client.address == address);
        if let Some(client) = place.map(|place| self.clients.remove(place)) {
            if client.is_allowed {
                expect(self, address.ip(), now);
            }
            if client.asks_since.is_some() {
                self.missed = Some(client);
            }
        }
        leave(self, address)
    }

    fn lapse(&mut self, now: Moment) -> Loss {
        self.missed.take_if(|client| is_silent_for(client, ASKED_LATELY, now));
        let Some(Party::Program(address)) = self.party else { return Loss::None };
        let client = self.client(address);
        let is_silent = client.is_none_or(|client| is_silent_for(client, LAPSES_AFTER, now));
        if is_silent { leave(self, address) } else { Loss::None }
    }

    fn ignore_stop(&mut self, address: SocketAddr) {
        if let Some(client) = client_mut(self, address) {
            client.ignored_stops = client.ignored_stops.saturating_add(1);
        }
    }

    fn give_by_stop(&mut self, origin: CommandOrigin, now: Moment) {
        // STOP has already ended the motion of a client that loses control.
        let _ = self.give(party_of(origin), now);
    }

    fn awaits(&self, number: u64) -> bool {
        self.clients.iter().any(|client| client.pending == Some(number))
    }

    fn expect_answer(&mut self, address: SocketAddr, number: u64) {
        if let Some(client) = client_mut(self, address) {
            client.pending = Some(number);
        }
    }

    fn answered(&mut self, answer: &Answer) {
        let mut clients = self.clients.iter_mut();
        if let Some(client) = clients.find(|client| client.pending == Some(answer.number)) {
            client.pending = None;
            client.answer = Some(answer.clone());
        }
    }
}

fn is_silent_for(client: &NetworkClient, span: Duration, now: Moment) -> bool {
    let last = client.last_line.as_ref();
    last.is_none_or(|(_, time)| now.steady.saturating_duration_since(*time) >= span)
}

fn client_mut(control: &mut Control, address: SocketAddr) -> Option<&mut NetworkClient> {
    control.clients.iter_mut().find(|client| client.address == address)
}

fn expect(control: &mut Control, address: IpAddr, now: Moment) {
    control.expected = Some(Expected { address, end: now.steady + COMES_BACK_WITHIN });
}

/// Takes control from the client, if it has control.
fn leave(control: &mut Control, address: SocketAddr) -> Loss {
    if control.party != Some(Party::Program(address)) {
        return Loss::None;
    }
    control.party = None;
    control.start = None;
    Loss::Client
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: &str = "2026-08-12T10:00:00Z";

    struct Scene {
        control: Control,
        now: Moment,
    }

    impl Scene {
        fn new() -> Self {
            let now = Moment { utc: START.parse().unwrap(), steady: Instant::now() };
            Self { control: Control::default(), now }
        }

        fn pass(&mut self, seconds: u64) {
            self.now.steady += Duration::from_secs(seconds);
        }

        fn connect(&mut self, port: u16) -> SocketAddr {
            let address = SocketAddr::from(([127, 0, 0, 1], port));
            self.control.connected(NetworkClient::new(address, None, self.now.utc), self.now);
            address
        }

        fn heard(&mut self, address: SocketAddr) {
            self.control.heard(address, "p", self.now.steady);
        }

        fn admit(&mut self, address: SocketAddr) -> Result<(), Refusal> {
            self.heard(address);
            self.control.admit_client(address, self.now)
        }
    }

    #[test]
    fn a_client_points_once_the_operator_has_decided() {
        let mut scene = Scene::new();
        let client = scene.connect(1);
        assert_eq!(scene.admit(client), Err(Refusal::NotAllowed));
        assert_eq!(scene.control.client(client).unwrap().asks_since, Some(scene.now.utc));
        assert_eq!(scene.control.hand_over(client, scene.now), Loss::None);
        assert_eq!(scene.control.party, Some(Party::Program(client)));
        assert_eq!(scene.admit(client), Ok(()));
    }

    #[test]
    fn an_allowed_client_takes_control_from_nobody_only() {
        let mut scene = Scene::new();
        let client = scene.connect(1);
        scene.control.allow(client);
        assert_eq!(scene.control.give(Some(Party::Window), scene.now), Loss::None);
        assert_eq!(scene.admit(client), Err(Refusal::InControl(Party::Window)));
        assert_eq!(scene.control.give(None, scene.now), Loss::None);
        assert_eq!(scene.admit(client), Ok(()));
        let other = scene.connect(2);
        scene.control.allow(other);
        assert_eq!(scene.admit(other), Err(Refusal::InControl(Party::Program(client))));
    }

    #[test]
    fn a_client_that_loses_control_to_somebody_asks_again() {
        for party in [Party::Window, Party::Automatic, Party::Command] {
            let mut scene = Scene::new();
            let client = scene.connect(1);
            assert_eq!(scene.control.hand_over(client, scene.now), Loss::None);
            assert_eq!(scene.control.give(Some(party), scene.now), Loss::Client);
            assert_eq!(scene.admit(client), Err(Refusal::InControl(party)));
            assert_eq!(scene.control.give(None, scene.now), Loss::None);
            assert_eq!(scene.admit(client), Err(Refusal::NotAllowed));
            // A new connection does not help either.
            assert_eq!(scene.control.disconnected(client, scene.now), Loss::None);
            let again = scene.connect(2);
            assert_eq!(scene.admit(again), Err(Refusal::NotAllowed));
        }
    }

    #[test]
    fn any_line_renews_control_and_silence_ends_it() {
        let mut scene = Scene::new();
        let client = scene.connect(1);
        assert_eq!(scene.control.hand_over(client, scene.now), Loss::None);
        for _ in 0..5 {
            scene.pass(9);
            assert_eq!(scene.control.lapse(scene.now), Loss::None);
            scene.heard(client);
        }
        scene.pass(10);
        assert_eq!(scene.control.lapse(scene.now), Loss::Client);
        assert_eq!(scene.control.party, None);
        // The client may take control again.
        assert_eq!(scene.admit(client), Ok(()));
    }

    #[test]
    fn an_allowed_client_may_come_back_for_a_minute() {
        let mut scene = Scene::new();
        let client = scene.connect(1);
        assert_eq!(scene.control.hand_over(client, scene.now), Loss::None);
        assert_eq!(scene.control.disconnected(client, scene.now), Loss::Client);
        scene.pass(59);
        let again = scene.connect(2);
        assert_eq!(scene.admit(again), Ok(()));
        assert_eq!(scene.control.disconnected(again, scene.now), Loss::Client);
        scene.pass(60);
        let late = scene.connect(3);
        assert_eq!(scene.admit(late), Err(Refusal::NotAllowed));
    }

    #[test]
    fn a_program_that_hung_up_before_the_decision_gets_control_when_it_comes_back() {
        let mut scene = Scene::new();
        assert_eq!(scene.control.give(Some(Party::Window), scene.now), Loss::None);
        let client = scene.connect(1);
        assert_eq!(scene.admit(client), Err(Refusal::InControl(Party::Window)));
        assert_eq!(scene.control.disconnected(client, scene.now), Loss::None);
        scene.pass(119);
        assert_eq!(scene.control.lapse(scene.now), Loss::None);
        assert_eq!(scene.control.missed.as_ref().unwrap().address, client);
        assert_eq!(scene.control.hand_over(client, scene.now), Loss::None);
        assert_eq!((scene.control.party, &scene.control.missed), (None, &None));
        let again = scene.connect(2);
        assert_eq!(scene.admit(again), Ok(()));
    }

    #[test]
    fn a_request_of_a_program_that_hung_up_is_forgotten() {
        let mut scene = Scene::new();
        let client = scene.connect(1);
        assert_eq!(scene.admit(client), Err(Refusal::NotAllowed));
        assert_eq!(scene.control.disconnected(client, scene.now), Loss::None);
        scene.pass(120);
        assert_eq!(scene.control.lapse(scene.now), Loss::None);
        assert_eq!(scene.control.missed, None);
        assert_eq!(scene.control.hand_over(client, scene.now), Loss::None);
        let again = scene.connect(2);
        assert_eq!(scene.admit(again), Err(Refusal::NotAllowed));
    }

    #[test]
    fn automatic_operation_is_in_control_while_it_is_on() {
        let mut scene = Scene::new();
        let client = scene.connect(1);
        assert_eq!(scene.control.hand_over(client, scene.now), Loss::None);
        assert_eq!(scene.control.follow_operation(false, scene.now), Loss::None);
        assert_eq!(scene.control.follow_operation(true, scene.now), Loss::Client);
        assert_eq!(scene.control.party, Some(Party::Automatic));
        assert_eq!(scene.control.follow_operation(false, scene.now), Loss::None);
        assert_eq!(scene.control.party, None);
    }

    #[test]
    fn a_command_after_the_end_of_its_connection_is_refused() {
        let mut scene = Scene::new();
        let client = scene.connect(1);
        assert_eq!(scene.control.hand_over(client, scene.now), Loss::None);
        assert_eq!(scene.control.disconnected(client, scene.now), Loss::Client);
        assert_eq!(scene.admit(client), Err(Refusal::ClientGone));
    }
}
