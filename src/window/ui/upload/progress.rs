//! The progress of an upload, step by step.

use std::cmp::Ordering;

use egui::{ProgressBar, RichText, Ui};

use crate::{
    contract::{
        self,
        transfer::{Progress, UploadStep},
        uploads::{Ask, Stage},
    },
    model::{Model, UiCommand},
    ui::{
        text, theme,
        widgets::{
            card,
            status_line::{Tone, line},
        },
    },
};

/// Descriptions of the steps. The first step covers everything before the transfer, the last
/// everything after it.
const STEPS: [&str; 8] = [
    "Connect, check the host key, log in",
    "Read the file on the unit",
    "Keep it on this computer",
    "Write the new file beside it",
    "Read back and compare",
    "Put it in its place",
    "Read back and compare again",
    "Tell the unit, ask for satellite and checks",
];

pub(super) fn show(ui: &mut Ui, model: &Model, commands: &mut Vec<UiCommand>) {
    let uploads = &model.uploads;
    let (now, progress) = match &uploads.stage {
        Stage::Working { progress, .. } => (progress.map_or(0, place), *progress),
        Stage::AsksAboutHostKey(_) | Stage::AsksForSecret(_) => (0, None),
        Stage::Selecting(_) => (STEPS.len() - 1, None),
        _ => return,
    };
    card::show(ui, f32::INFINITY, |ui| {
        let words = if uploads.is_roll_back { "Putting an old file back" } else { "Uploading" };
        ui.label(RichText::new(words).font(text::value()));
        for (index, step) in STEPS.iter().enumerate() {
            let words = format!("{} {step}", index + 1);
            match index.cmp(&now) {
                Ordering::Less => line(ui, Tone::Good, &words),
                Ordering::Greater => line(ui, Tone::Plain, &words),
                Ordering::Equal => {
                    line(ui, Tone::Now, &words);
                    bytes(ui, progress);
                }
            }
        }
        cancel(ui, &uploads.stage, commands);
    });
}

fn place(progress: Progress) -> usize {
    match progress.step {
        UploadStep::ReadOld => 1,
        UploadStep::KeepOld => 2,
        UploadStep::Write => 3,
        UploadStep::Compare => 4,
        UploadStep::Replace => 5,
        UploadStep::Prove => 6,
    }
}

fn bytes(ui: &mut Ui, progress: Option<Progress>) {
    let counts = |progress: &Progress| {
        matches!(progress.step, UploadStep::Write | UploadStep::Compare | UploadStep::Prove)
    };
    let Some(progress) = progress.filter(counts) else { return };
    let share = progress.done_bytes as f32 / progress.file_bytes.max(1) as f32;
    let words = format!("{} of {} bytes", progress.done_bytes, progress.file_bytes);
    ui.add(ProgressBar::new(share.min(1.0)).desired_height(16.0).text(words));
}

fn cancel(ui: &mut Ui, stage: &Stage, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let can = stage.can_cancel();
    ui.horizontal_wrapped(|ui| {
        if ui.add_enabled(can, egui::Button::new("Cancel upload")).clicked() {
            commands.push(UiCommand::Station(contract::Command::Upload(Ask::Cancel)));
        }
        let words = match stage {
            Stage::Working { is_cancelled: true, .. } => {
                "Cancelling: ends as soon as the unit allows."
            }
            Stage::Working { .. } if !can => "It can no longer be cancelled.",
            Stage::Selecting(_) => "The file is on the unit.",
            _ => "The old file stays on the unit until the new one is verified.",
        };
        ui.label(RichText::new(words).font(text::small()).color(t.t3));
    });
}
