//! Control of an antenna: at most one party has it at a time.
//!
//! The window, automatic operation and `azel` commands take control with their commands, because
//! the operator stands behind them. A program on the network can take control only while nobody has
//! it, or when the operator grants it. The program renews control with every line, and loses it
//! when silent.

mod rules;

use std::net::SocketAddr;

use super::Engine;
use crate::{
    clock::Moment,
    contract::{
        Command, CommandOrigin,
        control::{Answer, ClientCommand, NetworkClient, Party},
        driver::{self, Refusal, TakesControl, TrackProblem},
    },
    plan::{ProgramTrack, Target},
    station::AntennaId,
};
pub(super) use rules::Rules;
use rules::{Loss, party_of};

impl Engine {
    pub(super) fn moment(&self) -> Moment {
        Moment { utc: self.now, steady: self.steady }
    }

    /// Returns the origin of the current request.
    fn origin(&self) -> CommandOrigin {
        self.current_request.map_or(CommandOrigin::Station, |request| request.origin)
    }

    /// Updates control of an antenna from automatic operation and the connections.
    pub(super) fn watch_control(&mut self, index: usize) {
        let now = self.moment();
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let entries = self.client.board().connections(antenna.shown.id());
        let port = self.station.network_port(antenna.shown.id());
        let listening = self.ports.as_ref().map(|ports| ports.state(antenna.shown.id()));
        let control = &mut antenna.shown.control;
        control.port = listening.unwrap_or_default();
        let mut loss = control.follow_operation(antenna.shown.operation.is_on(), now);
        let peers: Vec<SocketAddr> = control.clients.iter().map(|client| client.address).collect();
        let is_gone = |peer: &SocketAddr| entries.iter().all(|entry| entry.peer != *peer);
        for peer in peers.into_iter().filter(is_gone) {
            loss |= control.disconnected(peer, now);
        }
        for entry in entries {
            let may_point = port.is_some_and(|port| port.allowed.contains(&entry.peer.ip()));
            if control.client(entry.peer).is_none() {
                control.connected(NetworkClient::new(entry.peer, entry.program, now.utc), now);
                if may_point {
                    control.allow(entry.peer);
                }
            }
            if let Some((line, time)) = entry.last_line {
                control.heard(entry.peer, &line, time);
            }
        }
        loss |= control.lapse(now);
        // The snapshot has the unit's answer to the last command of a client.
        if let Some(answer) = &antenna.shown.snapshot.answer {
            control.answered(answer);
        }
        self.end_motion_of_client(index, loss);
    }

    /// Opens and closes ports according to the settings. Only the Azel that drives an antenna opens
    /// its port.
    pub(super) fn open_ports(&self) {
        let Some(ports) = &self.ports else { return };
        let is_ours = |id: AntennaId| {
            let antenna = self.antennas.iter().find(|antenna| antenna.shown.id() == id);
            antenna.is_some_and(|antenna| antenna.shown.held_by.is_none())
        };
        let open = self.station.network_ports.iter().filter(|port| is_ours(port.antenna));
        ports.listen(open.map(|port| (port.antenna, port.listen)));
    }

    /// Ends the motion of a client that lost control: its turn stops, and its track of a fixed
    /// direction ends at the target.
    fn end_motion_of_client(&mut self, index: usize, loss: Loss) {
        if loss == Loss::Client {
            self.send(index, driver::Command::EndJog);
            self.send(index, driver::Command::EndAtTarget);
        }
    }

    /// Takes control for the operator's command, as the command's row says.
    pub(super) fn take_control_by(&mut self, index: usize, command: &Command) {
        let now = self.moment();
        let party = party_of(self.origin());
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let control = &mut antenna.shown.control;
        let is_of_client = matches!(control.party, Some(Party::Program(_)));
        let loss = match command.row().takes_control {
            TakesControl::FromAll => control.give(party, now),
            TakesControl::FromClients if is_of_client => control.give(party, now),
            TakesControl::FromClients | TakesControl::Never => Loss::None,
        };
        self.end_motion_of_client(index, loss);
    }

    /// Gives control to `party`, or to nobody.
    pub(super) fn give_control(&mut self, index: usize, party: Option<Party>) {
        let now = self.moment();
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let loss = antenna.shown.control.give(party, now);
        self.end_motion_of_client(index, loss);
    }

    /// Hands control from the operator to a program.
    pub(super) fn hand_over(&mut self, index: usize, client: SocketAddr, always: bool) {
        let now = self.moment();
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let control = &antenna.shown.control;
        let has_missed = control.missed.as_ref().is_some_and(|missed| missed.address == client);
        if control.client(client).is_none() && !has_missed {
            return;
        }
        let id = antenna.shown.id();
        self.suspend_for_operator(index);
        if always {
            self.change_station(|station| station.allow_client(id, client.ip()));
        }
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let loss = antenna.shown.control.hand_over(client, now);
        self.end_motion_of_client(index, loss);
    }

    /// Carries out a command of a program on the network.
    pub(super) fn take_client_command(&mut self, id: AntennaId, command: ClientCommand) {
        let CommandOrigin::Port(peer) = self.origin() else {
            tracing::error!(?command, "only a program on the network sends this");
            return;
        };
        let Some(index) = self.place(id) else { return };
        self.watch_control(index);
        if command == ClientCommand::Stop {
            return self.stop_for_client(index, peer);
        }
        let refusal = self.refusal_of_client(index, peer);
        if let Some(refusal) = refusal {
            return self.answer_client(index, peer, Some(refusal.into()));
        }
        if matches!(command, ClientCommand::Turn { is_repeated: false, .. }) {
            self.send(index, driver::Command::Manual);
        }
        let number = self.number();
        if let Some(antenna) = self.antennas.get_mut(index) {
            antenna.shown.control.expect_answer(peer, number);
        }
        match command {
            ClientCommand::Point(direction) => {
                let target = Target::Fixed(direction);
                let mut track = ProgramTrack::new(target, self.station.site, Vec::new());
                self.begin_with_offsets(id, &mut track);
                self.send(index, driver::Command::ProgramTrack(Box::new(track)));
            }
            ClientCommand::Park => self.send(index, driver::Command::Park),
            ClientCommand::Turn { rates_deg_s, .. } => {
                self.send(index, driver::Command::Jog { rates_deg_s });
            }
            ClientCommand::Stop => {}
        }
    }

    /// Returns the reason to refuse a motion of this program.
    fn refusal_of_client(&mut self, index: usize, peer: SocketAddr) -> Option<Refusal> {
        let now = self.moment();
        let is_closing = self.closing.is_some();
        let antenna = self.antennas.get_mut(index)?;
        if is_closing {
            return Some(Refusal::Closing);
        }
        if let Some(holder) = &antenna.shown.held_by {
            return Some(Refusal::Elsewhere(holder.to_string()));
        }
        antenna.shown.control.admit_client(peer, now).err()
    }

    fn answer_client(&mut self, index: usize, peer: SocketAddr, problem: Option<TrackProblem>) {
        let number = self.number();
        if let Some(antenna) = self.antennas.get_mut(index) {
            antenna.shown.control.expect_answer(peer, number);
            antenna.shown.control.answered(&Answer { number, problem });
        }
    }

    /// Handles a client's stop, which does not count as the operator's STOP: Gpredict sends one
    /// after a refusal, `HamClock` when it connects.
    fn stop_for_client(&mut self, index: usize, peer: SocketAddr) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        match antenna.shown.control.party {
            None => self.send(index, driver::Command::Hold),
            Some(Party::Program(address)) if address == peer => {
                self.send(index, driver::Command::Hold);
            }
            Some(Party::Program(_) | Party::Window | Party::Automatic | Party::Command) => {
                antenna.shown.control.ignore_stop(peer);
            }
        }
    }
}
