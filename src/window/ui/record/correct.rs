//! Accepting a correction: Azel fills the values into the form of the unit or asks for
//! confirmation.

use crate::{
    contract,
    model::{
        Model, UiCommand, View,
        correction::{Correction, CorrectionMethod},
    },
    station::OffsetsSubject,
    ui::{antennas::AntennasState, confirm::Question, copies::CopiedValues, words},
};

/// Fills the values into their fields, marked as edited, or asks before Azel stores remembered
/// offsets.
pub fn take_over(
    Correction { antenna, method }: Correction,
    model: &Model,
    antennas: &mut AntennasState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let Some(place) = model.place(antenna) else { return };
    match method {
        CorrectionMethod::Settings { group, values, .. } => {
            for (field, value) in values {
                antennas.type_in(model, place, CopiedValues { group, field, value });
            }
            commands.push(UiCommand::SelectAntenna(place));
            commands.push(UiCommand::Show(View::Antennas));
        }
        CorrectionMethod::Remembered(offsets) => {
            let name = model.antennas.get(place).map_or("", |antenna| &antenna.config.name);
            let offsets_subject = OffsetsSubject::Antenna(antenna);
            let [now, afterwards] =
                [model.station.kept_offsets(offsets_subject), offsets].map(words::offsets);
            let text = format!(
                "Remember for {name}: {afterwards}, in place of {now}? It is added to what Azel sends \
                 in each track that begins from now on."
            );
            let command = contract::Command::KeepOffsets { subject: offsets_subject, offsets };
            let command = UiCommand::Station(command);
            *question = Some(Question { text, yes: "Remember", command });
        }
    }
}
