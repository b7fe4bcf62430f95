//! The page of the site: fields of the station itself.

use egui::{Rect, Ui};

use super::{
    FormState,
    columns::{self, Part},
    draft::Draft,
    findings, form,
    page::Page,
    preview,
};
use crate::{
    astro::{Site, sun_moon},
    engine::antenna::AntennaModel,
    model::Model,
    ui::{
        format,
        widgets::told::{self, Tone},
        words,
    },
};

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    (draft, before): (&mut Draft, &Draft),
    state: &mut FormState,
) {
    let page = Page::Site;
    let sections = draft.ground.sections();
    let sections: Vec<(&str, usize)> =
        sections.into_iter().filter(|(section, _)| Page::of_section(section) == page).collect();
    let rows: Vec<usize> = sections.iter().map(|(_, rows)| *rows).collect();
    let standings = draft.ground_standings();
    let is_edited = page.counts(draft, before).edited > 0;
    let group = "station";
    columns::show(ui, rect, group, &rows, true, |ui, part| match part {
        Part::Card(card) => {
            let Some((section, _)) = sections.get(card) else { return };
            form::section(
                ui,
                group,
                (&mut draft.ground, &standings),
                section,
                &mut state.sought,
                |_| {},
            );
        }
        Part::Preview { is_fold } => {
            let site = draft.place();
            let value = site.map_or_else(String::new, |site| sun_in_short(site, model));
            let fold = is_fold.then_some(&mut state.preview_is_open);
            preview::card(ui, fold, &value, is_edited, |ui| about(ui, site, model));
        }
        Part::Findings => findings::show(ui, page, draft),
    });
}

fn sun_in_short(site: Site, model: &Model) -> String {
    let sun = sun_moon::sun(site, model.now);
    format!("Sun at {}", format::pointing_at(sun))
}

/// The Sun at the site, and how far it is from where each unit believes to stand.
fn about(ui: &mut Ui, site: Option<Site>, model: &Model) {
    let Some(site) = site else {
        told::line(ui, Tone::Plain, "Latitude and longitude make no place yet.");
        return;
    };
    let there = words::place(site.latitude().degrees(), site.longitude().degrees());
    told::line(ui, Tone::Plain, &there);
    told::line(ui, Tone::Now, &words::sun_there(sun_moon::sun(site, model.now)));
    for antenna in &model.antennas {
        let (tone, words) = distance(site, antenna);
        told::line(ui, tone, &words);
    }
}

fn distance(site: Site, antenna: &AntennaModel) -> (Tone, String) {
    let name = &antenna.config.name;
    let Some(told) = antenna.snapshot.state.on_board.place else {
        return (Tone::Plain, format!("{name} has not told a place."));
    };
    words::off_the_told(name, told.km_from(site))
}
