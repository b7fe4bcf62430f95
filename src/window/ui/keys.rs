//! Table of keyboard shortcuts, which is also the source of the list of keys.

mod act;
pub mod digits;
pub mod list;

use egui::{Key, Modifiers, Ui};

use super::{
    confirm::Question,
    console::ConsoleState,
    elements::ElementsState,
    map::MapState,
    operate::OperateState,
    plan::PlanState,
    preferences::PreferencesState,
    record::RecordState,
    replay::{LONG_STEP_S, STEP_S},
    widgets::menu,
};
use crate::{
    astro::{Angle, Offset},
    model::{Model, UiCommand, View, globe::MapDirection},
    station::Take,
};
use act::{Act, OffsetKey, ReplayKey};

/// Line of the list of keys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Binding {
    /// Modifiers held with each of the keys.
    pub modifiers: Modifiers,
    /// Keys, each with its effect.
    keys: &'static [(Key, Act)],
    /// Scope in which the keys work.
    pub place: KeyScope,
    /// Effect of the keys, below a heading that names their scope.
    pub does: &'static str,
}

/// Views and situations in which a key works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyScope {
    /// All views, also while the operator types.
    Everywhere,
    /// All views, but not while the operator types.
    Views,
    /// Operate view, but not while the operator types.
    Operate,
    /// Plan view, but not while the operator types.
    Plan,
    /// Record view, but not while the operator types.
    Record,
    /// Map view, but not while the operator types.
    Map,
    /// All views of a replay, but not while the operator types.
    Replay,
    /// Elements view, also while the operator types.
    Elements,
    /// Preferences view, also while the operator types.
    Preferences,
    /// Focused control, which handles the key itself.
    Focus,
}

impl Binding {
    /// Returns the effect of the keys, with the view that they work in.
    pub fn does_where(&self) -> String {
        let place = match self.place {
            KeyScope::Plan => "in Plan: ",
            KeyScope::Record => "in Record: ",
            KeyScope::Map => "in Map: ",
            KeyScope::Replay => "in a replay: ",
            // Azel opens with the Operate view; the effects of the other scopes name their views.
            KeyScope::Everywhere
            | KeyScope::Views
            | KeyScope::Operate
            | KeyScope::Elements
            | KeyScope::Preferences
            | KeyScope::Focus => "",
        };
        format!("{place}{}", self.does)
    }

    /// Returns the keys of the binding.
    pub fn keys(&self) -> impl Iterator<Item = Key> {
        self.keys.iter().map(|(key, _)| *key)
    }

    /// Returns `true` for the STOP key.
    pub fn is_stop(&self) -> bool {
        self.keys().eq([Key::Escape])
    }
}

const fn row(place: KeyScope, keys: &'static [(Key, Act)], does: &'static str) -> Binding {
    Binding { modifiers: Modifiers::NONE, keys, place, does }
}

const fn with_modifiers(modifiers: Modifiers, binding: Binding) -> Binding {
    Binding { modifiers, ..binding }
}

const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// All keys, in the order of the list. The app handles the STOP key before all others.
pub const ALL: [Binding; 42] = [
    row(
        KeyScope::Focus,
        &[(Key::Escape, Act::There)],
        "STOP in every view; also closes what is open",
    ),
    with_modifiers(
        Modifiers::COMMAND,
        row(
            KeyScope::Everywhere,
            &[
                (Key::Num1, Act::Show(View::Operate)),
                (Key::Num2, Act::Show(View::Plan)),
                (Key::Num3, Act::Show(View::Elements)),
                (Key::Num4, Act::Show(View::Antennas)),
                (Key::Num5, Act::Show(View::Console)),
                (Key::Num6, Act::Show(View::Preferences)),
                (Key::Num7, Act::Show(View::Record)),
                (Key::Num8, Act::Show(View::Map)),
            ],
            "Operate, Plan, Elements, Antennas, Console, Preferences, Record, Map",
        ),
    ),
    row(
        KeyScope::Everywhere,
        &[
            (Key::F1, Act::SelectAntenna(0)),
            (Key::F2, Act::SelectAntenna(1)),
            (Key::F3, Act::SelectAntenna(2)),
            (Key::F4, Act::SelectAntenna(3)),
        ],
        "select an antenna",
    ),
    row(
        KeyScope::Operate,
        &[(Key::ArrowUp, Act::MoveInList(-1)), (Key::ArrowDown, Act::MoveInList(1))],
        "previous, next pass, unless the focus is elsewhere",
    ),
    row(
        KeyScope::Record,
        &[
            (Key::ArrowUp, Act::RecordedPass(-1)),
            (Key::ArrowDown, Act::RecordedPass(1)),
            (Key::Enter, Act::ReplayReport),
            (Key::C, Act::Correct),
            (Key::E, Act::ExportReport),
        ],
        "previous, next pass; replay; correct; export",
    ),
    row(
        KeyScope::Replay,
        &[
            (Key::Space, Act::Replay(ReplayKey::Play)),
            (Key::Comma, Act::Replay(ReplayKey::Event { is_next: false })),
            (Key::Period, Act::Replay(ReplayKey::Event { is_next: true })),
            (Key::Q, Act::Replay(ReplayKey::Leave)),
        ],
        "play, previous event, next, leave",
    ),
    // The keys of a replay precede those of the views, which use the same keys.
    with_modifiers(
        Modifiers::SHIFT,
        row(
            KeyScope::Replay,
            &[
                (Key::ArrowLeft, Act::Replay(ReplayKey::By(-LONG_STEP_S))),
                (Key::ArrowRight, Act::Replay(ReplayKey::By(LONG_STEP_S))),
            ],
            "10 s back, 10 s on",
        ),
    ),
    row(
        KeyScope::Replay,
        &[
            (Key::ArrowLeft, Act::Replay(ReplayKey::By(-STEP_S))),
            (Key::ArrowRight, Act::Replay(ReplayKey::By(STEP_S))),
            (Key::Home, Act::Replay(ReplayKey::To { end: false })),
            (Key::End, Act::Replay(ReplayKey::To { end: true })),
        ],
        "1 s back, 1 s on, beginning, end",
    ),
    row(
        KeyScope::Focus,
        &[(Key::Enter, Act::There)],
        "press the focused button; Left closes an open menu",
    ),
    row(KeyScope::Operate, &[(Key::N, Act::NextPass)], "the pass in progress or the next one"),
    row(KeyScope::Operate, &[(Key::P, Act::Drawer)], "pass list, in small windows"),
    row(
        KeyScope::Operate,
        &[(Key::T, Act::Track), (Key::K, Act::Park)],
        "track the selected pass, park the antenna (asks first)",
    ),
    row(
        KeyScope::Operate,
        &[(Key::G, Act::GoTo)],
        "Position: type a direction; Enter previews, Enter again moves the antenna",
    ),
    row(
        KeyScope::Operate,
        &[(Key::M, Act::Manual)],
        "Manual, arrows jog (asks first while tracking)",
    ),
    row(
        KeyScope::Focus,
        &[
            (Key::ArrowLeft, Act::There),
            (Key::ArrowRight, Act::There),
            (Key::ArrowUp, Act::There),
            (Key::ArrowDown, Act::There),
        ],
        "held: jog, in Manual with the pad focused",
    ),
    with_modifiers(
        Modifiers::SHIFT,
        row(
            KeyScope::Focus,
            &[
                (Key::ArrowLeft, Act::There),
                (Key::ArrowRight, Act::There),
                (Key::ArrowUp, Act::There),
                (Key::ArrowDown, Act::There),
            ],
            "one step, in Manual with the pad or a step key focused",
        ),
    ),
    row(
        KeyScope::Operate,
        &[
            (Key::OpenBracket, Act::Offset(OffsetKey::Time { is_more: false })),
            (Key::CloseBracket, Act::Offset(OffsetKey::Time { is_more: true })),
            (Key::Backspace, Act::Offset(OffsetKey::TimeToZero)),
            (Key::U, Act::Offset(OffsetKey::Undo)),
        ],
        "while tracking: time offset −100, +100 ms, reset, undo",
    ),
    // Bindings with more modifiers come first: a binding with fewer modifiers would match as well.
    with_modifiers(
        CTRL_SHIFT,
        row(
            KeyScope::Operate,
            &[
                (Key::ArrowLeft, Act::Offset(OffsetKey::Less(Offset::Across(Angle::ZERO)))),
                (Key::ArrowRight, Act::Offset(OffsetKey::More(Offset::Across(Angle::ZERO)))),
                (Key::ArrowUp, Act::Offset(OffsetKey::More(Offset::Along(Angle::ZERO)))),
                (Key::ArrowDown, Act::Offset(OffsetKey::Less(Offset::Along(Angle::ZERO)))),
            ],
            "while tracking: a step across the track or along it",
        ),
    ),
    with_modifiers(
        Modifiers::COMMAND,
        row(
            KeyScope::Operate,
            &[
                (Key::ArrowLeft, Act::Offset(OffsetKey::Less(Offset::Azimuth(Angle::ZERO)))),
                (Key::ArrowRight, Act::Offset(OffsetKey::More(Offset::Azimuth(Angle::ZERO)))),
                (Key::ArrowUp, Act::Offset(OffsetKey::More(Offset::Elevation(Angle::ZERO)))),
                (Key::ArrowDown, Act::Offset(OffsetKey::Less(Offset::Elevation(Angle::ZERO)))),
            ],
            "while tracking: a step in azimuth or elevation",
        ),
    ),
    row(
        KeyScope::Operate,
        &[(Key::PageUp, Act::Rate(1)), (Key::PageDown, Act::Rate(-1))],
        "jog rate up, down, in Manual",
    ),
    row(
        KeyScope::Operate,
        &[(Key::Home, Act::SkyOfNow)],
        "sky now; time slider: arrows 1 min, Page keys 10 min",
    ),
    row(
        KeyScope::Operate,
        &[(Key::Plus, Act::Zoom(1)), (Key::Minus, Act::Zoom(-1))],
        "shorter, longer time span; in the focused sky plot: zoom in, out",
    ),
    row(
        KeyScope::Operate,
        &[(Key::Num0, Act::UsualZoom)],
        "default span; in the focused sky plot: the whole sky",
    ),
    row(
        KeyScope::Map,
        &[
            (Key::ArrowLeft, Act::Nearest(MapDirection::West)),
            (Key::ArrowRight, Act::Nearest(MapDirection::East)),
            (Key::ArrowUp, Act::Nearest(MapDirection::North)),
            (Key::ArrowDown, Act::Nearest(MapDirection::South)),
        ],
        "the next satellite in that direction",
    ),
    row(
        KeyScope::Map,
        &[
            (Key::Plus, Act::MapZoom(true)),
            (Key::Minus, Act::MapZoom(false)),
            (Key::Num0, Act::WholeMap),
        ],
        "zoom in, zoom out, the whole map",
    ),
    row(KeyScope::Map, &[(Key::L, Act::MapLayers)], "layers"),
    row(
        KeyScope::Plan,
        &[
            (Key::ArrowLeft, Act::PlannedPass(-1)),
            (Key::ArrowRight, Act::PlannedPass(1)),
            (Key::ArrowUp, Act::PlannedPass(-1)),
            (Key::ArrowDown, Act::PlannedPass(1)),
        ],
        "previous, next pass",
    ),
    row(
        KeyScope::Plan,
        &[
            (Key::Y, Act::ChoosePass(Some(Take::Always))),
            (Key::B, Act::ChoosePass(None)),
            (Key::V, Act::ChoosePass(Some(Take::Never))),
            (Key::S, Act::SwapPass),
        ],
        "take the selected pass always, by plan, never; swap it in (asks first)",
    ),
    row(
        KeyScope::Plan,
        &[
            (Key::Plus, Act::PlanZoom(true)),
            (Key::Minus, Act::PlanZoom(false)),
            (Key::Num0, Act::UsualPlan),
        ],
        "shorter, longer time span; back to now",
    ),
    with_modifiers(
        Modifiers::COMMAND,
        row(
            KeyScope::Everywhere,
            &[(Key::F, Act::Search)],
            "filter the list of passes or the log; search catalogue or settings",
        ),
    ),
    with_modifiers(
        Modifiers::COMMAND,
        row(
            KeyScope::Focus,
            &[(Key::Enter, Act::There)],
            "in Antennas: apply; in Preferences: save",
        ),
    ),
    with_modifiers(
        Modifiers::COMMAND,
        row(
            KeyScope::Focus,
            &[(Key::Z, Act::There)],
            "undo; with Shift redo, in Horizon and keep-outs",
        ),
    ),
    row(
        KeyScope::Focus,
        &[(Key::Insert, Act::There), (Key::Delete, Act::There)],
        "add, remove a horizon point or zone corner; arrows move one",
    ),
    with_modifiers(
        Modifiers::COMMAND,
        row(
            KeyScope::Elements,
            &[(Key::O, Act::ChooseElements), (Key::R, Act::RefreshElements)],
            "in Elements: choose files, refresh what is due",
        ),
    ),
    with_modifiers(
        Modifiers::COMMAND,
        row(KeyScope::Preferences, &[(Key::Tab, Act::NextPage)], "in Preferences: the next page"),
    ),
    row(
        KeyScope::Focus,
        &[
            (Key::Space, Act::There),
            (Key::F, Act::There),
            (Key::Num1, Act::There),
            (Key::Num2, Act::There),
            (Key::Num3, Act::There),
            (Key::Num4, Act::There),
            (Key::Num5, Act::There),
            (Key::U, Act::There),
        ],
        "in the table of Elements: mark, favourite, priority 1 to 5, upload",
    ),
    with_modifiers(
        Modifiers::ALT,
        row(
            KeyScope::Focus,
            &[(Key::ArrowUp, Act::There), (Key::ArrowDown, Act::There)],
            "on an automation rule: move it up, down",
        ),
    ),
    with_modifiers(
        Modifiers::ALT,
        row(
            KeyScope::Focus,
            &[(Key::ArrowLeft, Act::There), (Key::ArrowRight, Act::There)],
            "in Set up: previous, next step; Enter for the next one too",
        ),
    ),
    row(KeyScope::Views, &[(Key::A, Act::Acknowledge)], "acknowledge the newest alarm"),
    with_modifiers(
        Modifiers::COMMAND,
        row(KeyScope::Everywhere, &[(Key::L, Act::NextTheme)], "next theme: dark, light, night"),
    ),
    row(KeyScope::Focus, &[(Key::Tab, Act::There)], "the next control; the first is STOP"),
    row(KeyScope::Views, &[(Key::Questionmark, Act::List)], "this list"),
];

/// State that the keys change, apart from the model.
pub struct KeyTargets<'a> {
    /// Open question.
    pub question: &'a mut Option<Question>,
    pub operate: &'a mut OperateState,
    pub elements: &'a mut ElementsState,
    pub console: &'a mut ConsoleState,
    pub map: &'a mut MapState,
    pub plan: &'a mut PlanState,
    pub record: &'a mut RecordState,
    pub preferences: &'a mut PreferencesState,
    /// Flag: the list of keys is open.
    pub list_open: &'a mut bool,
}

/// Handles the keys of this frame.
pub fn take(ui: &Ui, model: &Model, targets: &mut KeyTargets<'_>, commands: &mut Vec<UiCommand>) {
    // A typed letter is no shortcut, and a dialog or a menu handles its own keys.
    let typing = ui.text_edit_focused()
        || menu::is_open(ui)
        || targets.question.is_some()
        || *targets.list_open
        || targets.record.is_asking();
    let works = |place| match place {
        KeyScope::Everywhere => true,
        KeyScope::Views => !typing,
        KeyScope::Operate => !typing && model.view == View::Operate,
        KeyScope::Record => !typing && model.view == View::Record,
        KeyScope::Map => !typing && model.view == View::Map,
        KeyScope::Plan => !typing && model.view == View::Plan,
        KeyScope::Replay => !typing && model.replay.is_some(),
        KeyScope::Elements => model.view == View::Elements,
        KeyScope::Preferences => model.view == View::Preferences,
        KeyScope::Focus => false,
    };
    for binding in ALL.iter().filter(|binding| works(binding.place)) {
        for (key, act) in binding.keys {
            if act.is_possible(ui, model)
                && ui.input_mut(|input| input.consume_key(binding.modifiers, *key))
            {
                act.carry_out(ui, model, targets, commands);
            }
        }
    }
}
