//! The operator takes a correction over: it is typed into the form of the unit, or asked about.

use crate::{
    contract,
    model::{
        Model, UiCommand, View,
        correction::{Correction, How},
    },
    station::OffsetsSubject,
    ui::{antennas::AntennasState, confirm::Question, copies::Taken, words},
};

/// Types the value in where it belongs, marked as edited, or asks before it is remembered.
pub fn take_over(
    Correction { antenna, how }: Correction,
    model: &Model,
    antennas: &mut AntennasState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let Some(place) = model.place(antenna) else { return };
    match how {
        How::Settings { group, values, .. } => {
            for (field, value) in values {
                antennas.type_in(model, place, Taken { group, field, value });
            }
            commands.push(UiCommand::SelectAntenna(place));
            commands.push(UiCommand::Show(View::Antennas));
        }
        How::Remembered(offsets) => {
            let name = model.antennas.get(place).map_or("", |antenna| &antenna.config.name);
            let of = OffsetsSubject::Antenna(antenna);
            let [now, then] = [model.station.kept_offsets(of), offsets].map(words::offsets);
            let text = format!(
                "Remember for {name}: {then}, in place of {now}? It is added to what Azel sends \
                 in each track that begins from now on."
            );
            let command = contract::Command::KeepOffsets { subject: of, offsets };
            let command = UiCommand::Station(command);
            *question = Some(Question { text, yes: "Remember", command });
        }
    }
}
