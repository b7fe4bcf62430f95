//! Turns the actions of the card into commands.

use crate::{
    astro::{Angle, AzEl},
    contract::{
        self,
        antenna::AntennaModel,
        driver::{Command, Intent},
        passes::PredictedPass,
    },
    device::panel::Act,
    model::{Model, UiCommand},
    plan::{self, ProgramTrack},
    ui::{
        antenna_card::{CardAction, FollowChoice},
        confirm::Question,
        widgets::go_to::Target,
    },
};

/// Turns actions of the card into commands.
pub(super) struct CardHandler<'a> {
    pub(super) model: &'a Model,
    pub(super) antenna: &'a AntennaModel,
    pub(super) question: &'a mut Option<Question>,
    pub(super) commands: &'a mut Vec<UiCommand>,
}

impl CardHandler<'_> {
    pub(super) fn take(&mut self, action: CardAction) {
        let command = match action {
            CardAction::Connect => Command::Connect,
            CardAction::Disconnect => return self.disconnect(),
            CardAction::Stop => {
                return self.commands.push(UiCommand::StopAntenna(self.antenna.id()));
            }
            CardAction::Act(act) => return self.act(act),
            CardAction::Select(index) => {
                return self.commands.push(UiCommand::SelectAntenna(index));
            }
            CardAction::Follow(choice) => return self.follow(choice),
            CardAction::SetMode(Intent::Standby) => Command::Standby,
            CardAction::SetMode(Intent::Manual) => Command::Manual,
            CardAction::SetMode(Intent::Position) => Command::Hold,
            CardAction::SetMode(Intent::Park) => Command::Park,
            CardAction::SetMode(Intent::Track) | CardAction::TrackSelected => {
                let pass = self.model.selected_pass().map(PredictedPass::key);
                let antenna = self.antenna.id();
                let track = |pass| contract::Command::Track { antenna, pass, is_agreed: false };
                return self.commands.extend(pass.map(track).map(UiCommand::Station));
            }
            CardAction::KeepOffsets(of) => {
                let track = self.antenna.snapshot.program_track.as_ref();
                let keep = |offsets| contract::Command::KeepOffsets { subject: of, offsets };
                let keep = track.map(|track| UiCommand::Station(keep(track.offsets)));
                return self.commands.extend(keep);
            }
            CardAction::Offset(change) => Command::Offset(change),
            CardAction::TakeOver => Command::TakeOver,
            CardAction::GoOn => {
                let go_on = contract::Command::GoOn(self.antenna.id());
                return self.commands.push(UiCommand::Station(go_on));
            }
            CardAction::TrackAgain => {
                let again = self.antenna.track_again.as_ref();
                return self
                    .commands
                    .extend(again.map(|again| UiCommand::Station(again.command.clone())));
            }
            CardAction::TrackAnyway => {
                let pass = self.model.selected_pass().map(PredictedPass::key);
                let antenna = self.antenna.id();
                let track = |pass| contract::Command::Track { antenna, pass, is_agreed: true };
                return self.commands.extend(pass.map(track).map(UiCommand::Station));
            }
            CardAction::Jog { x, y, rate_deg_s } => {
                Command::Jog { rates_deg_s: [f64::from(x) * rate_deg_s, f64::from(y) * rate_deg_s] }
            }
            CardAction::JogReleased => Command::EndJog,
            CardAction::AllowUnguarded => Command::AllowUnguarded,
            CardAction::AllowWayOut => Command::AllowWayOut,
            CardAction::SeenStanding => Command::SeenStanding,
            CardAction::ActUnseen => match &self.antenna.asks_unseen {
                Some(act) => Command::ActUnseen(act.clone()),
                None => return,
            },
            CardAction::Step { x, y, step_deg } => {
                Command::Step { steps_deg: [f64::from(x) * step_deg, f64::from(y) * step_deg] }
            }
            CardAction::GoTo(Target { azimuth_deg, elevation_deg }) => Command::Position {
                azimuth: Some(Angle::from_degrees(azimuth_deg)),
                elevation: elevation_deg.map(Angle::from_degrees),
            },
            CardAction::SetAutoTrack(on) => Command::AutoTrack(on),
            // The plot reads the ghost from the fields themselves.
            CardAction::PreviewGoTo(_) | CardAction::Maintenance => return,
        };
        self.commands.push(self.for_antenna(command));
    }

    fn for_antenna(&self, command: Command) -> UiCommand {
        UiCommand::antenna(self.antenna.id(), command)
    }

    fn follow(&mut self, choice: FollowChoice) {
        let target = match choice {
            FollowChoice::Selected => {
                let pass = self.model.selected_pass().map(PredictedPass::key);
                let antenna = self.antenna.id();
                let track = |pass| contract::Command::ProgramTrackPass { antenna, pass };
                return self.commands.extend(pass.map(track).map(UiCommand::Station));
            }
            FollowChoice::Sun | FollowChoice::IntoSun => plan::Target::Sun,
            FollowChoice::Moon => plan::Target::Moon,
            FollowChoice::Direction(Target { azimuth_deg, elevation_deg }) => {
                let elevation_deg = elevation_deg.unwrap_or_default();
                plan::Target::Fixed(AzEl::from_degrees(azimuth_deg, elevation_deg))
            }
        };
        let site = self.model.station.site;
        let follow = Box::new(ProgramTrack::new(target, site, Vec::new()));
        let command = match choice {
            FollowChoice::IntoSun => Command::ProgramTrackIntoSun(follow),
            _ => Command::ProgramTrack(follow),
        };
        self.commands.push(self.for_antenna(command));
    }

    /// Disconnects, after a question if something would go on unwatched.
    fn disconnect(&mut self) {
        let command = self.for_antenna(Command::Disconnect);
        let snapshot = &self.antenna.snapshot;
        let moving = snapshot.state.measured.is_some_and(|measured| measured.moving());
        let program = snapshot.state.program.is_some_and(|program| program.enabled);
        if !(moving || program || snapshot.intent == Intent::Track) {
            return self.commands.push(command);
        }
        let text = format!(
            "Disconnect from {}? It is moving or tracking, and nobody will be watching it from \
             here.",
            self.antenna.config.name
        );
        *self.question = Some(Question { text, yes: "Disconnect", command });
    }

    fn act(&mut self, act: Act) {
        let action = self.antenna.variant().action(act.action);
        let command = self.for_antenna(Command::Act(act));
        match action.and_then(|action| Some((action.question?, action.label))) {
            Some((text, yes)) => {
                *self.question = Some(Question { text: text.to_owned(), yes, command });
            }
            None => self.commands.push(command),
        }
    }
}
