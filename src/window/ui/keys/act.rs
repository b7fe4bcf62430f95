//! Effects of keys.

use egui::{FocusDirection, Ui};

use super::KeyTargets;
use crate::{
    astro::{Offset, TrackOffsets, time::add_seconds},
    contract::{
        self,
        antenna::AntennaModel,
        driver::{self, Intent, OffsetChange},
        passes::PredictedPass,
    },
    model::{
        Model, UiCommand, View,
        globe::MapDirection,
        replay::{ReplayCommand, Replayed},
        typed_path::OpenedFile,
    },
    station::Take,
    ui::{
        elements,
        operate::{LONG_STEP_S, card::OffsetStep},
        replay, second_step, theme,
    },
};

/// Effect of a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Act {
    /// Effect that the focused control or the app handles.
    There,
    Show(View),
    SelectAntenna(usize),
    /// Move of the selection by this many passes down the list.
    MoveInList(isize),
    NextPass,
    Drawer,
    Track,
    /// Question whether to park the selected antenna.
    Park,
    GoTo,
    Manual,
    /// Change of the offsets of the selected antenna's track.
    Offset(OffsetKey),
    /// Move of the jog rate by this many steps up.
    Rate(i32),
    /// Return to the current sky.
    SkyOfNow,
    /// Zoom of the timeline, in steps inwards.
    Zoom(isize),
    UsualZoom,
    /// Selection of the next satellite on that side of the map.
    Nearest(MapDirection),
    /// Zoom of the map: in for `true`, out for `false`.
    MapZoom(bool),
    WholeMap,
    MapLayers,
    /// Selection in the list of the plan, this many passes further down.
    PlannedPass(isize),
    /// Selection in the record, this many rows further down.
    RecordedPass(isize),
    /// Correction that the report's best explanation suggests.
    Correct,
    /// Replay of the pass in the report.
    ReplayReport,
    /// Export of the report's page.
    ExportReport,
    /// Move or end of a replay.
    Replay(ReplayKey),
    /// Choice of the selected pass for the schedule, or against it.
    ChoosePass(Option<Take>),
    /// Question whether to take a left-out pass.
    SwapPass,
    /// Zoom of the lanes: in for `true`, out for `false`.
    PlanZoom(bool),
    UsualPlan,
    Search,
    /// Next page of the preferences.
    NextPage,
    /// Choice of element files.
    ChooseElements,
    /// Request to the element servers that Azel may ask now.
    RefreshElements,
    Acknowledge,
    NextTheme,
    List,
}

impl Act {
    /// Returns `true` if the effect is possible now. Otherwise other handlers get the key.
    pub(super) fn is_possible(self, ui: &Ui, model: &Model) -> bool {
        match self {
            Self::SelectAntenna(index) => index < model.antennas.len(),
            Self::MoveInList(_)
            | Self::Nearest(_)
            | Self::PlannedPass(_)
            | Self::RecordedPass(_) => {
                let plain = ui.input(|input| input.modifiers.is_none());
                plain && ui.memory(|memory| memory.focused().is_none())
            }
            Self::Replay(ReplayKey::Play | ReplayKey::By(_) | ReplayKey::To { .. }) => {
                replay::takes_keys(ui)
            }
            // A focused button takes the key.
            Self::ReplayReport => ui.memory(|memory| memory.focused().is_none()),
            Self::Search => {
                !matches!(model.view, View::Antennas | View::Map | View::Plan | View::Setup)
            }
            Self::RefreshElements => model.sources.is_free(),
            Self::Offset(key) => {
                model.antenna().is_some_and(|antenna| key.offsets(antenna).is_some())
            }
            _ => true,
        }
    }

    pub(super) fn carry_out(
        self,
        ui: &Ui,
        model: &Model,
        targets: &mut KeyTargets<'_>,
        commands: &mut Vec<UiCommand>,
    ) {
        match self {
            Self::There => {}
            Self::Show(view) => commands.push(UiCommand::Show(view)),
            Self::SelectAntenna(index) => commands.push(UiCommand::SelectAntenna(index)),
            Self::MoveInList(down) => {
                ui.memory_mut(|memory| memory.move_focus(FocusDirection::None));
                commands.extend(targets.operate.neighbour(model, down).map(UiCommand::SelectPass));
            }
            Self::Replay(key) => commands.extend(key.command(model)),
            Self::Correct => targets.record.correct(model),
            Self::ExportReport => commands.extend(targets.record.export(model)),
            Self::ReplayReport => commands.extend(targets.record.replay(model)),
            Self::RecordedPass(down) => targets.record.step(model, down),
            Self::NextPass => {
                commands.extend(model.next_pass().map(|next| UiCommand::SelectPass(next.key())));
            }
            Self::Drawer => targets.operate.drawer_open = !targets.operate.drawer_open,
            Self::Track => {
                let pass = model.selected_pass().map(PredictedPass::key);
                let pass = pass.filter(|_| model.antenna().is_some());
                commands.extend(pass.map(UiCommand::AskToTrack));
            }
            Self::Park => {
                let antenna = model.antenna().filter(|antenna| antenna.can_park());
                *targets.question = antenna.map(second_step::before_parking);
            }
            Self::GoTo => go_to(model, targets, commands),
            Self::Manual => manual(model, targets, commands),
            Self::Offset(key) => {
                let step = targets.operate.card.offsets.step;
                let request = model.antenna().and_then(|model_antenna| {
                    Some((model_antenna.id(), key.change(model_antenna, step)?))
                });
                commands.extend(
                    request.map(|(id, change)| {
                        UiCommand::antenna(id, driver::Command::Offset(change))
                    }),
                );
            }
            Self::Rate(amount) if targets.operate.sky_time.has_focus => {
                targets.operate.sky_time.step(model, f64::from(amount) * LONG_STEP_S);
            }
            Self::Rate(amount) => {
                let manual =
                    |model_antenna: &&AntennaModel| model_antenna.snapshot.intent == Intent::Manual;
                if let Some(antenna) = model.antenna().filter(manual) {
                    let speeds = antenna.variant().capabilities.jog;
                    let max_deg_s = antenna.config.limits.maximum_rate_deg_s;
                    targets.operate.card.drive.change_rate(amount, speeds, max_deg_s);
                }
            }
            Self::SkyOfNow => targets.operate.sky_time.return_to_now(),
            Self::Zoom(closer) if targets.operate.sky.has_focus => {
                targets.operate.sky.zoom.step(closer > 0);
            }
            Self::Zoom(closer) => targets.operate.zoom.change(closer),
            Self::UsualZoom if targets.operate.sky.has_focus => targets.operate.sky.zoom.reset(),
            Self::UsualZoom => targets.operate.zoom.reset(),
            Self::Nearest(direction) => {
                ui.memory_mut(|memory| memory.move_focus(FocusDirection::None));
                let nearest = targets.map.nearest(model, direction);
                commands.extend(nearest.map(UiCommand::SelectSatellite));
            }
            Self::MapZoom(is_closer) => targets.map.change_zoom(is_closer),
            Self::WholeMap => targets.map.reset_zoom(),
            Self::MapLayers => targets.map.toggle_layers(),
            Self::PlannedPass(amount) => {
                ui.memory_mut(|memory| memory.move_focus(FocusDirection::None));
                let neighbour = targets.plan.neighbour(model, amount);
                commands.extend(neighbour.map(UiCommand::SelectPass));
            }
            Self::ChoosePass(take) => targets.plan.choose(model, take, commands),
            Self::SwapPass => {
                if let Some(question) = targets.plan.ask_to_swap(model) {
                    *targets.question = Some(question);
                }
            }
            Self::PlanZoom(is_closer) => targets.plan.change_zoom(is_closer),
            Self::UsualPlan => targets.plan.reset_zoom(),
            Self::Search => match model.view {
                View::Elements => targets.elements.focus_search(),
                View::Console => targets.console.focus_filter(),
                View::Preferences => targets.preferences.focus_search(),
                _ => targets.operate.filter_list(),
            },
            Self::NextPage => targets.preferences.next_page(),
            Self::ChooseElements => commands.push(UiCommand::ChooseFile(OpenedFile::Elements)),
            Self::RefreshElements => commands.push(elements::refresh_due(model)),
            Self::Acknowledge => {
                let command = model.alarms.newest_unseen().map(contract::Command::AcknowledgeAlarm);
                commands.extend(command.map(UiCommand::Station));
            }
            Self::NextTheme => commands.push(UiCommand::SetTheme(theme::name(ui).next())),
            Self::List => *targets.list_open = true,
        }
    }
}

/// Key of a replay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ReplayKey {
    /// Start or pause of the playback.
    Play,
    /// Jump to the next or the previous recorded event.
    Event {
        is_next: bool,
    },
    /// Move by this many seconds.
    By(f64),
    /// Jump to the start of the stretch, or to its end.
    To {
        end: bool,
    },
    Leave,
}

impl ReplayKey {
    fn command(self, model: &Model) -> Option<UiCommand> {
        let Replayed { time, stretch, .. } = model.replay.as_ref()?;
        Some(UiCommand::Replay(match self {
            Self::Play => ReplayCommand::PlayOrPause,
            Self::Event { is_next } => ReplayCommand::Event { is_next },
            Self::By(seconds) => ReplayCommand::To(add_seconds(*time, seconds)),
            Self::To { end: false } => ReplayCommand::To(stretch.start),
            Self::To { end: true } => ReplayCommand::To(stretch.end),
            Self::Leave => return Some(UiCommand::LeaveReplay),
        }))
    }
}

/// Key for the offsets of a track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum OffsetKey {
    /// Time offset more or less by a tenth of a second.
    Time {
        is_more: bool,
    },
    TimeToZero,
    /// Other offset less or more by the step chosen on the card.
    Less(Offset),
    More(Offset),
    Undo,
}

impl OffsetKey {
    /// Returns the offsets in force, if the key can change them.
    fn offsets(self, antenna: &AntennaModel) -> Option<TrackOffsets> {
        let snapshot = &antenna.snapshot;
        if antenna.follows() {
            return Some(snapshot.program_track.as_ref()?.offsets);
        }
        antenna.variant().track_offsets.filter(|_| antenna.tracks())?;
        let is_held = match self {
            Self::Less(offset) | Self::More(offset) => {
                matches!(offset, Offset::Azimuth(_) | Offset::Elevation(_))
            }
            Self::Undo => true,
            Self::Time { .. } | Self::TimeToZero => false,
        };
        is_held.then(|| snapshot.meant_offsets())
    }

    fn change(self, antenna: &AntennaModel, step: OffsetStep) -> Option<OffsetChange> {
        let [time, ..] = self.offsets(antenna)?.components();
        Some(match self {
            Self::Time { is_more } => {
                let step = OffsetStep::Medium.to_offset(time);
                OffsetChange::Step(if is_more { step } else { -step })
            }
            Self::TimeToZero => OffsetChange::Step(-time),
            Self::Less(offset) => OffsetChange::Step(-step.to_offset(offset)),
            Self::More(offset) => OffsetChange::Step(step.to_offset(offset)),
            Self::Undo => OffsetChange::Undo,
        })
    }
}

fn manual(model: &Model, targets: &mut KeyTargets<'_>, commands: &mut Vec<UiCommand>) {
    let Some(antenna) = model.antenna() else { return };
    commands.push(UiCommand::antenna(antenna.id(), driver::Command::Manual));
    if antenna.tracked_name().is_none() {
        targets.operate.card.drive.focus_pad();
    }
}

/// Focuses the go-to fields. They are open only in Position, so the key selects Position first if
/// another mode is on.
fn go_to(model: &Model, targets: &mut KeyTargets<'_>, commands: &mut Vec<UiCommand>) {
    let Some(antenna) =
        model.antenna().filter(|model_antenna| model_antenna.snapshot.link.is_open())
    else {
        return;
    };
    let is_tracked = antenna.tracked_name().is_some();
    let intent = antenna.snapshot.intent;
    if is_tracked || matches!(intent, Intent::Standby | Intent::Track) {
        commands.push(UiCommand::antenna(antenna.id(), driver::Command::Hold));
    }
    if !is_tracked {
        targets.operate.card.drive.go_to.focus();
    }
}
