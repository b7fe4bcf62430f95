//! Pictures of every view, taken from the real window on the demo station with a recorded pass.
//!
//! The test takes all of them at one size in one theme. The long form takes every size in every
//! theme and keeps them as `target/pictures/<view>-<size>-<theme>.png`:
//!
//! `AZEL_PICTURES=all cargo test --test processes real_window::pictures -- --ignored --nocapture`
//!
//! Sizes such as `1024x640,1440x900` in place of `all` take only these sizes.

use std::{
    collections::HashSet,
    fs,
    path::{Path, PathBuf},
    thread,
    time::Duration,
};

use azel::{
    app::App,
    clock::Clock,
    engine::Settings,
    model::{Model, ThemeName, View},
};
use egui::{Key, Modifiers, Pos2, Rect, Role};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use super::{
    recorded::Tracked,
    screen::{Running, Screen, wait_for},
};

const SIZES: [[u32; 2]; 4] = [[1024, 640], [1440, 900], [1920, 1080], [2560, 1440]];
const THEMES: [(ThemeName, &str); 3] =
    [(ThemeName::Dark, "dark"), (ThemeName::Light, "light"), (ThemeName::Night, "night")];
/// Environment variable with the sizes of the long form.
const LONG_FORM: &str = "AZEL_PICTURES";
/// Time in which the window finishes the effects of a key or a click.
const SETTLES_IN: Duration = Duration::from_millis(800);
/// Number of colours that every view exceeds; text alone has many shades.
const LEAST_COLOURS: usize = 60;

/// An act of the operator.
#[derive(Clone, Copy)]
enum Act {
    /// A key, with its names in xdotool and in egui.
    Press(&'static str, Modifiers, Key),
    /// A click on the control of this name, else on the first whose name contains it.
    Click(&'static str),
    /// A click on the control, if it exists.
    ClickIfThere(&'static str),
    /// A click on this page in the list of the preferences.
    Page(&'static str),
    /// A click on the lower left corner, beside any popup over the window.
    ClickBeside,
}
use Act::{Click, ClickBeside, ClickIfThere, Page, Press};

const OPERATE: Act = Press("ctrl+1", Modifiers::COMMAND, Key::Num1);
const PLAN: Act = Press("ctrl+2", Modifiers::COMMAND, Key::Num2);
const ELEMENTS: Act = Press("ctrl+3", Modifiers::COMMAND, Key::Num3);
const ANTENNAS: Act = Press("ctrl+4", Modifiers::COMMAND, Key::Num4);
const CONSOLE: Act = Press("ctrl+5", Modifiers::COMMAND, Key::Num5);
const PREFERENCES: Act = Press("ctrl+6", Modifiers::COMMAND, Key::Num6);
const RECORD: Act = Press("ctrl+7", Modifiers::COMMAND, Key::Num7);
const MAP: Act = Press("ctrl+8", Modifiers::COMMAND, Key::Num8);
const FIRST_ANTENNA: Act = Press("F1", Modifiers::NONE, Key::F1);
const SECOND_ANTENNA: Act = Press("F2", Modifiers::NONE, Key::F2);
const THIRD_ANTENNA: Act = Press("F3", Modifiers::NONE, Key::F3);
const KEYS: Act = Press("question", Modifiers::NONE, Key::Questionmark);
const TRACK: Act = Press("t", Modifiers::NONE, Key::T);
const LEAVE_REPLAY: Act = Press("q", Modifiers::NONE, Key::Q);
const NEXT_THEME: Act = Press("ctrl+l", Modifiers::COMMAND, Key::L);

const CONTROLS: [Role; 5] =
    [Role::Button, Role::RadioButton, Role::Tab, Role::MenuItem, Role::ComboBox];
const PAGES: [Role; 1] = [Role::RadioButton];

/// A picture: its name and view, and the acts that open it and leave it for the next one.
struct Sight {
    name: &'static str,
    view: View,
    open: &'static [Act],
    leave: &'static [Act],
}

const fn sight(
    name: &'static str,
    view: View,
    open: &'static [Act],
    leave: &'static [Act],
) -> Sight {
    Sight { name, view, open, leave }
}

const SIGHTS: [Sight; 25] = [
    sight("operate", View::Operate, &[OPERATE, FIRST_ANTENNA], &[]),
    sight("operate-genius", View::Operate, &[SECOND_ANTENNA], &[]),
    sight("operate-rc2000c", View::Operate, &[THIRD_ANTENNA], &[FIRST_ANTENNA]),
    sight("alarms", View::Operate, &[Click("alarm")], &[Click("Close")]),
    sight("keys", View::Operate, &[KEYS], &[KEYS]),
    sight("question", View::Operate, &[TRACK], &[ClickBeside]),
    sight("plan", View::Plan, &[PLAN], &[]),
    sight("elements", View::Elements, &[ELEMENTS], &[]),
    sight(
        "upload",
        View::Elements,
        &[ClickIfThere("Details"), Click("Upload to")],
        &[Click("Back to the elements"), ClickIfThere("Close details")],
    ),
    sight("antennas", View::Antennas, &[ANTENNAS], &[]),
    sight("antennas-genius", View::Antennas, &[SECOND_ANTENNA], &[]),
    sight("antennas-rc2000c", View::Antennas, &[THIRD_ANTENNA], &[FIRST_ANTENNA]),
    sight("console", View::Console, &[CONSOLE], &[]),
    sight("record", View::Record, &[RECORD], &[]),
    sight("record-replay", View::Record, &[Click("Replay")], &[]),
    sight("replay", View::Operate, &[OPERATE], &[LEAVE_REPLAY]),
    sight("map", View::Map, &[MAP], &[]),
    sight("preferences-site", View::Preferences, &[PREFERENCES, Page("Site")], &[]),
    sight(
        "preferences-antenna",
        View::Preferences,
        &[Click("Add an antenna"), Click("Add SVS Satrak")],
        &[Click("Revert")],
    ),
    sight("preferences-satellites", View::Preferences, &[Page("Satellites and priorities")], &[]),
    sight("preferences-rules", View::Preferences, &[Page("Automation rules")], &[]),
    sight("preferences-horizon", View::Preferences, &[Page("Horizon and keep-outs")], &[]),
    sight("preferences-alarms", View::Preferences, &[Page("Alarms and sounds")], &[]),
    sight("preferences-appearance", View::Preferences, &[Page("Appearance")], &[]),
    sight("setup", View::Setup, &[Click("Set up your station")], &[OPERATE]),
];

/// The same window without a display, which gives the places of the controls.
struct Twin {
    window: Harness<'static, App>,
    _folder: tempfile::TempDir,
}

impl Twin {
    fn new([width, height]: [u32; 2], tracked: &Tracked) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let records = folder.path().join("records");
        tracked.put(&records);
        let settings = Settings {
            records: Some(records),
            path: Some(folder.path().join("station.toml")),
            library: Some(folder.path().join("elements")),
            dead_man: Some(env!("CARGO_BIN_EXE_azel").into()),
            ..Settings::default()
        };
        let window = Harness::builder()
            .with_size([width as f32, height as f32])
            .allow_missing_glyphs()
            .build_eframe(move |cc| {
                let app = App::new(&cc.egui_ctx, &settings, Clock::system()).expect("the demo");
                app.without_set_up()
            });
        let mut twin = Self { window, _folder: folder };
        wait_for("the twin of the demo station", || {
            twin.window.step();
            is_ready(twin.window.state().model()).then_some(())
        });
        twin
    }

    fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.window.key_press_modifiers(modifiers, key);
        self.window.run_steps(3);
    }

    fn click(&mut self, at: Pos2) {
        self.window.hover_at(at);
        self.window.drag_at(at);
        self.window.drop_at(at);
        self.window.run_steps(3);
    }

    /// Returns the place of a control with one of these roles, whose name contains `words`.
    fn find(&mut self, words: &str, roles: &[Role]) -> Option<Pos2> {
        // Content from another thread may take some frames.
        for _ in 0..50 {
            self.window.step();
            let is_control = |role: Role| roles.contains(&role);
            let found: Vec<_> = self
                .window
                .query_all_by_label_contains(words)
                .filter(|node| is_control(node.accesskit_node().role()))
                .collect();
            let is_named = |node: &&_| is_named(node, words);
            if let Some(node) = found.iter().find(is_named).or(found.first()) {
                return Some(node.rect().center());
            }
            thread::sleep(Duration::from_millis(10));
        }
        None
    }

    fn place(&mut self, words: &str, roles: &[Role]) -> Pos2 {
        self.find(words, roles).unwrap_or_else(|| panic!("no control {words:?}"))
    }

    fn has_page(&self, words: &str) -> bool {
        let page = self.window.get_by_role_and_label(Role::RadioButton, words);
        page.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    }

    fn view(&self) -> View {
        let app = self.window.state();
        app.replay().unwrap_or(app.model()).view
    }

    fn stop(&self) -> Rect {
        let mut stops = self.window.get_all_by_label_contains("STOP");
        let is_stop = |role| role == Role::Button;
        stops.find(|node| is_stop(node.accesskit_node().role())).expect("STOP").rect()
    }
}

fn is_named(node: &egui_kittest::Node<'_>, words: &str) -> bool {
    node.accesskit_node().label().as_deref() == Some(words)
}

fn is_ready(model: &Model) -> bool {
    let is_measured = model.antennas.iter().any(|of| of.snapshot.state.measured.is_some());
    model.antennas.len() == 3 && is_measured && model.selected.is_some()
}

/// A picture in rows of three bytes a pixel.
struct Picture {
    width: usize,
    pixels: Vec<u8>,
}

impl Picture {
    fn at(&self, place: Pos2) -> [u8; 3] {
        let start = 3 * (place.y as usize * self.width + place.x as usize);
        self.pixels[start..start + 3].try_into().expect("three bytes")
    }

    /// Returns `true` if more than a clock has changed.
    fn differs(&self, other: &Self) -> bool {
        let pairs = self.pixels.chunks_exact(3).zip(other.pixels.chunks_exact(3));
        pairs.filter(|(one, other)| one != other).count() > self.pixels.len() / 3 / 200
    }

    fn colours(&self) -> usize {
        self.pixels.chunks_exact(3).collect::<HashSet<_>>().len()
    }
}

/// The real window on a screen of its size, and its twin.
struct Scene {
    // The first field, so that the program ends before its screen.
    _azel: Running,
    screen: Screen,
    size: [u32; 2],
    twin: Twin,
}

impl Scene {
    fn new(size: [u32; 2], tracked: &Tracked) -> Self {
        let [width, height] = size.map(|side| side.to_string());
        let screen = Screen::new(&format!("{width}x{height}"));
        tracked.put(&screen.folder.path().join(".local/share/azel/records"));
        let (azel, window) = screen.azel(&["--demo"]);
        screen.xdotool(&["windowmove", &window, "0", "0"]);
        screen.xdotool(&["windowsize", &window, &width, &height]);
        let wanted = format!("Geometry: {width}x{height}");
        wait_for("the size of the window", || {
            screen.xdotool(&["getwindowgeometry", &window]).contains(&wanted).then_some(())
        });
        let mut scene = Self { _azel: azel, screen, size, twin: Twin::new(size, tracked) };
        scene.point_away();
        let (theme, _) = THEMES[0];
        wait_for("the first picture", || scene.is_drawn(theme).then_some(()));
        // Wait until both windows have found their passes and read their units.
        thread::sleep(4 * SETTLES_IN);
        scene.twin.window.run_steps(3);
        scene
    }

    fn picture(&self) -> Picture {
        Picture { width: self.size[0] as usize, pixels: self.screen.picture() }
    }

    /// Returns `true` if STOP is at its place in this theme's red, and the screen shows a picture.
    fn is_drawn(&self, theme: ThemeName) -> bool {
        let picture = self.picture();
        let stop = theme.tokens().stop;
        let above_word = self.twin.stop().center_top() + egui::vec2(0.0, 5.0);
        picture.at(above_word) == [stop.r(), stop.g(), stop.b()]
            && picture.colours() > LEAST_COLOURS
    }

    fn act(&mut self, act: Act) {
        let at = match act {
            Press(chord, modifiers, key) => {
                self.screen.xdotool(&["key", chord]);
                self.twin.press(modifiers, key);
                thread::sleep(SETTLES_IN / 4);
                return;
            }
            Click(words) => self.twin.place(words, &CONTROLS),
            Page(words) => self.twin.place(words, &PAGES),
            ClickIfThere(words) => match self.twin.find(words, &CONTROLS) {
                Some(at) => at,
                None => return,
            },
            ClickBeside => Pos2::new(3.0, self.size[1] as f32 - 3.0),
        };
        let [x, y] = [at.x, at.y].map(|place| format!("{place:.0}"));
        self.screen.xdotool(&["mousemove", &x, &y, "click", "1"]);
        self.twin.click(at);
        if let Page(words) = act {
            assert!(self.twin.has_page(words), "the page {words:?} is not shown");
        }
        thread::sleep(SETTLES_IN / 4);
        self.point_away();
    }

    /// Moves the pointer to a place where it covers and highlights nothing.
    fn point_away(&self) {
        let middle = self.size[0] / 2;
        self.screen.xdotool(&["mousemove", &middle.to_string(), "1"]);
        self.twin.window.hover_at(Pos2::new(middle as f32, 1.0));
    }

    /// Takes a picture of every view in each of the themes, and keeps it in `folder`. Returns the
    /// number of pictures.
    fn take(&mut self, themes: &[(ThemeName, &str)], folder: &Path) -> usize {
        let mut taken = 0;
        let mut last: Option<Picture> = None;
        for sight in &SIGHTS {
            for act in sight.open {
                self.act(*act);
            }
            assert_eq!(self.twin.view(), sight.view, "{}", sight.name);
            for (theme, word) in themes {
                let what = format!("{} in the {word} theme", sight.name);
                self.wait_for_theme(*theme, &what);
                thread::sleep(SETTLES_IN);
                let [width, height] = self.size;
                self.keep(&folder.join(format!("{}-{width}x{height}-{word}.png", sight.name)));
                taken += 1;
                if *theme == themes[0].0 {
                    let picture = self.picture();
                    let is_new = last.is_none_or(|last| last.differs(&picture));
                    assert!(is_new, "{what} looks as the view before it");
                    last = Some(picture);
                }
                if themes.len() > 1 {
                    self.act(NEXT_THEME);
                }
            }
            for act in sight.leave {
                self.act(*act);
            }
        }
        taken
    }

    /// Waits until the window has this theme. A busy machine may lose the key, so the function
    /// presses it again.
    fn wait_for_theme(&self, theme: ThemeName, what: &str) {
        let mut polls = 0;
        wait_for(what, || {
            if self.is_drawn(theme) {
                return Some(());
            }
            polls += 1;
            let is_before = |of: &&(ThemeName, &str)| of.0.next() == theme;
            let before = THEMES.iter().find(is_before).expect("a ring of themes");
            if polls % 20 == 0 && self.is_drawn(before.0) {
                self.screen.xdotool(&["key", "ctrl+l"]);
            }
            None
        });
    }

    fn keep(&self, path: &Path) {
        let path = path.to_string_lossy();
        let status = self
            .screen
            .command("import")
            .args(["-window", "root", "-define", "png:compression-level=3", &path])
            .status()
            .expect("ImageMagick");
        assert!(status.success(), "{path}");
    }
}

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("pictures");
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
#[ignore = "needs Xvfb, xdotool, ImageMagick and OpenGL"]
fn every_view_shows_itself_and_stop() {
    let wanted = std::env::var(LONG_FORM).ok();
    let (folder, tracked) = (folder(), Tracked::new());
    let mut taken = 0;
    for size in SIZES {
        let word = format!("{}x{}", size[0], size[1]);
        let (is_taken, themes) = match wanted.as_deref() {
            None => (size == SIZES[1], &THEMES[..1]),
            Some("all") => (true, &THEMES[..]),
            Some(sizes) => (sizes.split(',').any(|of| of == word), &THEMES[..]),
        };
        if is_taken {
            taken += Scene::new(size, &tracked).take(themes, &folder);
        }
    }
    println!("{taken} pictures in {}", folder.display());
    assert!(taken >= SIGHTS.len(), "{LONG_FORM} names no size of {SIZES:?}");
}
