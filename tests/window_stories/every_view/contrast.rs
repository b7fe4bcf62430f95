//! Contrast of every text with its ground, in every theme.

use egui::{Pos2, Rect, Role, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use azel::{
    model::ThemeName,
    ui::{operate::card, theme, tokens, top_bar},
};

use crate::window_stories::{
    every_view::{
        Findings, SCENES,
        painted::{self, Run},
    },
    rig::{LARGE, Window, settle},
};

/// Min contrast of text.
const TEXT: f64 = 4.5;
/// Min contrast of large text: from 24 px, or bold from 18.66 px.
const LARGE_TEXT: f64 = 3.0;

/// Returns the min contrast of a text. Safety data need the same contrast through the veil of a
/// question as without it.
fn needed(run: &Run, safety_data: &[Rect]) -> f64 {
    let is_large = run.size >= 24.0 || (run.is_bold && run.size >= 18.66);
    let is_safety_data = safety_data.iter().any(|place| place.contains(run.rect.center()));
    if is_large || (run.is_veiled && !is_safety_data) { LARGE_TEXT } else { TEXT }
}

/// Returns the places of disabled buttons that egui fades; the guidelines ask no contrast of these.
/// Locked buttons have a dashed border and full colours.
fn disabled(window: &Window) -> Vec<Rect> {
    let names = ["Add source", "Move up", "Move down"];
    let buttons = window.query_all_by_role(Role::Button).filter(|of| {
        let node = of.accesskit_node();
        node.is_disabled() && names.contains(&node.label().unwrap_or_default().as_str())
    });
    buttons.map(|of| of.rect()).collect()
}

#[test]
fn the_rows_of_a_table_lie_on_the_tone_of_an_input_in_the_light_theme() {
    for name in ["Elements", "Plan", "Map", "Console"] {
        let scene = SCENES.iter().find(|scene| scene.name == name).expect(name);
        let mut window = scene.open(LARGE);
        theme::set(&window.ctx, ThemeName::Light);
        settle(&mut window);
        let field = theme::tokens(&window.ctx).field;
        let rows: Vec<Rect> =
            window.query_all_by_role(Role::ListBoxOption).map(|row| row.rect()).collect();
        let is_of_a_row = |run: &Run| rows.iter().any(|row| row.contains(run.rect.center()));
        let runs = painted::runs(&window);
        let on_field = runs.iter().filter(|run| is_of_a_row(run) && run.ground == field).count();
        assert!(on_field > 2, "{name}: {on_field} texts");
    }
}

/// Finds texts with too little contrast in any theme, in a window of size [`LARGE`]. Counts all
/// texts. The window ends in the dark theme.
pub(super) fn check(window: &mut Window, findings: &mut Findings) {
    // The safety data are in the top bar and on the card of Operate.
    let [width, height] = LARGE;
    let bar = Rect::from_min_size(Pos2::ZERO, vec2(width, top_bar::HEIGHT));
    let card = Rect::from_min_max(pos2(width - card::WIDTH, 0.0), pos2(width, height));
    let safety_data = [bar, card];
    for name in [ThemeName::Light, ThemeName::Night, ThemeName::Dark] {
        theme::set(&window.ctx, name);
        settle(window);
        let faded = disabled(window);
        for run in painted::runs(window) {
            findings.count(1);
            if faded.iter().any(|place| place.contains(run.rect.center())) {
                continue;
            }
            let ratio = tokens::contrast(run.colour, run.ground);
            if ratio < needed(&run, &safety_data) {
                findings.add(&format!(
                    "{name:?} {:?} on {:?}: {ratio:.2}, {:?} at {:?}",
                    run.colour.to_hex(),
                    run.ground.to_hex(),
                    run.text,
                    run.rect.min
                ));
            }
        }
    }
}
