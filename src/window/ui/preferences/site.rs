//! The page of the site: the fields of the station itself.

use std::{cmp::Ordering, sync::Arc};

use egui::{Rect, RichText, Ui};

use super::{
    FormState,
    columns::{self, Part},
    draft::Draft,
    findings, form,
    page::Page,
    preview,
    station_fields::{MONITORING, RECORD},
};
use crate::{
    astro::{Site, sun_moon},
    contract::{alarms::AlarmKind, antenna::AntennaModel, control::PortState},
    model::{
        DistanceUnit, Model, UiCommand,
        effects::{
            DEBOUNCE,
            sites::{Question, Standpoint, Tally},
        },
    },
    ui::{
        format, text, theme,
        widgets::status_line::{self, Tone},
        words,
    },
};

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    (draft, before): (&mut Draft, &Draft),
    state: &mut FormState,
    commands: &mut Vec<UiCommand>,
) {
    let page = Page::Site;
    let sections = draft.ground.sections();
    // The card of the record has three more lines.
    let rows_of = |(section, rows): &(&str, usize)| {
        if *section == RECORD && !model.demo { rows + 3 } else { *rows }
    };
    let rows: Vec<usize> = sections.iter().map(rows_of).collect();
    let standings = draft.ground_standings();
    let is_edited = page.counts(draft, before).edited > 0;
    let question = question(model, draft, before);
    let group = "station";
    columns::show(ui, rect, group, &rows, true, |ui, part| match part {
        Part::Card(card) => {
            let Some(&(section, _)) = sections.get(card) else { return };
            form::section(
                ui,
                group,
                (&mut draft.ground, &standings),
                section,
                &mut state.focus_target,
                |ui| {
                    // In the demonstration, only the record of the demonstration runs.
                    if section == RECORD && !model.demo {
                        about_record(ui, model);
                    }
                    if section == MONITORING {
                        about_metrics(ui, &model.metrics);
                    }
                },
            );
        }
        Part::Preview { is_fold } => {
            let site = draft.place();
            let value = site.map_or_else(String::new, |site| sun_in_short(site, model));
            let fold = is_fold.then_some(&mut state.preview_is_open);
            preview::card(ui, fold, &value, is_edited, |ui| {
                description(ui, site, model);
                if let Some(question) = &question {
                    ui.add_space(4.0);
                    passes(ui, question, model);
                }
            });
        }
        Part::Findings => findings::show(ui, page, draft),
    });
    if let Some(question) = question
        && model.site_effects.requested() != Some(&question)
    {
        ui.ctx().request_repaint_after_for(DEBOUNCE, egui::ViewportId::ROOT);
        commands.push(UiCommand::ShowMoved(Box::new(question)));
    }
}

/// Returns the question for the passes over the saved and the entered site, once the favourites are
/// loaded.
fn question(model: &Model, draft: &Draft, before: &Draft) -> Option<Question> {
    let favourites = &model.pass_lists.favourites;
    let station = |draft: &Draft| {
        draft.place()?;
        draft.ground.read().0.station()
    };
    Some(Question {
        satellites: Arc::clone(&favourites.satellites),
        start: favourites.made_at?,
        before: Standpoint::new(&station(before)?),
        after: Standpoint::new(&station(draft)?),
    })
}

/// Shows the passes of the favourites over the saved and the edited site.
fn passes(ui: &mut Ui, question: &Question, model: &Model) {
    let t = theme::tokens(ui);
    ui.label(RichText::new("Favourites, next 48 h").font(text::body_medium()).color(t.t1));
    let effect = model.site_effects.effect.as_ref();
    let Some(effect) = effect.filter(|effect| effect.question == *question) else {
        ui.label(RichText::new("Being worked out.").font(text::small()).color(t.t3));
        return;
    };
    preview::heads(ui);
    let aos = |tally: &Tally| {
        tally.first_aos.map_or_else(|| "–".to_owned(), |time| format::moment(time, model.now))
    };
    let highest = |tally: &Tally| {
        if tally.count == 0 { "–".to_owned() } else { format::degrees(tally.highest_deg, 0) }
    };
    let (old, new) = (&effect.before, &effect.after);
    let rows = [
        ("Passes", old.count.to_string(), new.count.to_string(), new.count.cmp(&old.count)),
        (
            "Total time of passes",
            format::duration(old.up_s),
            format::duration(new.up_s),
            new.up_s.total_cmp(&old.up_s),
        ),
        ("Highest pass", highest(old), highest(new), new.highest_deg.total_cmp(&old.highest_deg)),
        ("First AOS", aos(old), aos(new), Ordering::Equal),
    ];
    for (label, was, now, gain) in rows {
        let colour = match gain {
            _ if was == now => t.t1,
            Ordering::Greater => t.ok,
            Ordering::Less => t.bad,
            Ordering::Equal => t.sat,
        };
        preview::cells(ui, label, (was, t.t2), (now, colour));
    }
}

/// Shows the path and size of the record, and whether Azel writes it.
fn about_record(ui: &mut Ui, model: &Model) {
    let Some(record) = &model.record else {
        let is_open_elsewhere =
            model.alarms.list().iter().any(|alarm| {
                matches!(alarm.kind, AlarmKind::StationElsewhere(_)) && !alarm.is_over()
            });
        let words = if is_open_elsewhere {
            "Nothing is recorded from here: the Azel that has this station open records it."
        } else {
            "Nothing is recorded: this user has no folder for records."
        };
        return status_line::line(ui, Tone::Plain, words);
    };
    if let Some(failing) = &record.failing {
        let start_text = format::moment(failing.last_write, model.now);
        let words = format!("Nothing has been recorded since {start_text}: {}.", failing.reason);
        status_line::line(ui, Tone::Bad, &words);
    } else {
        let size = format::bytes(record.bytes);
        status_line::line(ui, Tone::Now, &format!("Recording, {size} so far."));
    }
    status_line::line(ui, Tone::Plain, &record.path.display().to_string());
}

/// Shows the state of the port for metrics.
fn about_metrics(ui: &mut Ui, port: &PortState) {
    match port {
        PortState::Closed => {}
        PortState::Listening(address) => {
            let words = format!("Open at http://{address}/metrics.");
            status_line::line(ui, Tone::Now, &words);
        }
        PortState::Failed(reason) => {
            status_line::line(ui, Tone::Bad, &words::metrics_port_failed(reason));
        }
    }
}

fn sun_in_short(site: Site, model: &Model) -> String {
    let sun = sun_moon::sun(site, model.now);
    format!("Sun at {}", format::pointing_at(sun))
}

/// Shows the Sun at the site, and the distance between the site and the position that each unit
/// reports.
fn description(ui: &mut Ui, site: Option<Site>, model: &Model) {
    let Some(site) = site else {
        status_line::line(ui, Tone::Plain, "Latitude and longitude do not give a location yet.");
        return;
    };
    let place_text = words::place(site.latitude().degrees(), site.longitude().degrees());
    status_line::line(ui, Tone::Plain, &place_text);
    status_line::line(ui, Tone::Now, &words::sun_there(sun_moon::sun(site, model.now)));
    // The antennas of the demonstration are not at the new station.
    for antenna in model.antennas.iter().filter(|_| !model.demo) {
        let (tone, words) = distance(site, antenna, model.appearance.distances);
        status_line::line(ui, tone, &words);
    }
}

fn distance(site: Site, antenna: &AntennaModel, unit: DistanceUnit) -> (Tone, String) {
    let name = &antenna.config.name;
    let Some(place) = antenna.snapshot.state.on_board.place else {
        return (Tone::Plain, format!("{name} reports no position."));
    };
    words::off_the_told(name, place.km_from(site), unit)
}
