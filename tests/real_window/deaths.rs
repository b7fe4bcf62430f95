//! Deaths of the window while a jog key is held: the unit gets STOP, and no process of the program
//! remains.

use azel::clock::Instant;
use std::{
    fs,
    io::{self, Write as _},
    os::unix::process::CommandExt as _,
    path::PathBuf,
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use super::{
    processes::{self, Process},
    screen::{Running, Screen, wait_for},
    unit::Unit,
};

/// Time limit for STOP at the unit after a death.
const STOPS_IN: Duration = Duration::from_secs(2);
/// Time limit for STOP if the program ends in order, which takes one frame.
const ENDS_IN: Duration = Duration::from_secs(5);
/// Time limit for the end of every process of the program; the dead-man repeats STOP for 2 s.
const GONE_IN: Duration = Duration::from_secs(5);
/// Time limit for STOP by a program that starts again. It takes 5 s on a desk; the rest is for a
/// machine under load.
const BACK_IN: Duration = Duration::from_secs(10);
/// Time for which a test watches that nothing happens.
const WATCHED: Duration = Duration::from_secs(3);
/// Time for which a held key must move the antenna without a gap.
const STEADY: Duration = Duration::from_millis(700);
/// Log filter of the window: all events.
const EVENTS: &str = "azel=info";

/// The window with a held key, and the moving unit.
struct Scene {
    screen: Screen,
    unit: Unit,
    azel: Running,
    window: String,
    dead_men: Vec<Process>,
}

fn screen() -> Screen {
    Screen::new("1440x900")
}

fn command(screen: &Screen, unit: &Unit) -> Command {
    let mut command = screen.command(env!("CARGO_BIN_EXE_azel"));
    command.arg("--station").arg(screen.station_file(unit.address)).process_group(0);
    command
}

fn log_file(screen: &Screen) -> PathBuf {
    screen.folder.path().join("log.txt")
}

/// Prints a measured time, which `--nocapture` shows.
#[allow(clippy::print_stdout)]
fn report(what: &str, took: Duration) {
    println!("{what}: {} ms", took.as_millis());
}

impl Scene {
    fn new() -> Self {
        let (screen, unit) = (screen(), Unit::start());
        let log = fs::File::create(log_file(&screen)).expect("a log");
        Self::with_log(screen, unit, log.into(), EVENTS)
    }

    fn with_log(screen: Screen, unit: Unit, log: Stdio, filter: &str) -> Self {
        let start = Instant::now();
        let mut command = command(&screen, &unit);
        let (azel, window) = screen.window_of(command.env("AZEL_LOG", filter).stderr(log));
        unit.wait_until_read_since(start);
        let mut scene = Self { screen, unit, azel, window, dead_men: Vec::new() };
        scene.hold();
        scene
    }

    /// Holds the key X+ until the antenna moves without a gap, in several attempts. A press before
    /// the window shows the key does nothing, and a machine under load may let a hold run out.
    fn hold(&mut self) {
        let mut attempts = 0..;
        self.dead_men = wait_for("a held key", || {
            let pressed = Instant::now();
            self.screen.press_x_plus(attempts.next()?);
            let until = pressed + Duration::from_millis(1200);
            while Instant::now() < until && !self.unit.is_told_to_move_since(pressed) {
                thread::sleep(Duration::from_millis(20));
            }
            if self.unit.is_told_to_move_since(pressed) {
                thread::sleep(STEADY);
            }
            let is_held = self.unit.is_told_to_move_since(pressed)
                && !self.unit.is_told_to_stop_since(pressed)
                && self.unit.is_moving();
            let dead_men = processes::dead_men_of(self.azel.id());
            if is_held && !dead_men.is_empty() {
                return Some(dead_men);
            }
            self.screen.release_key();
            thread::sleep(Duration::from_millis(500));
            None
        });
        assert_eq!(self.dead_men.len(), 1, "{:?}", self.dead_men);
        assert_eq!(self.screen.marks(), 1);
    }

    /// Waits until every dead-man of any hold has ended.
    fn wait_until_unwatched(&self) {
        let start = Instant::now();
        wait_for("the dead-men to end", || {
            let ours = self.dead_men.iter().any(|process| process.runs());
            let is_over = !ours && processes::dead_men_of(self.azel.id()).is_empty();
            is_over.then_some(())
        });
        assert!(Instant::now() - start < GONE_IN, "{:?}", Instant::now() - start);
    }

    /// Kills the program with `kill`, then checks STOP, standstill and remaining processes.
    fn dies(mut self, what: &str, limit: Duration, kill: impl FnOnce(&mut Self)) {
        let killed = Instant::now();
        kill(&mut self);
        let took = self.unit.wait_for_stop(killed);
        report(&format!("{what} to STOP"), took);
        assert!(took < limit, "{what}: {took:?}");
        self.azel.wait_for_end();
        self.wait_until_unwatched();
        wait_for("the connection to close", || {
            (processes::established_at(self.unit.address) == 0).then_some(())
        });
        report(&format!("{what} to nothing left"), Instant::now() - killed);
        assert!(!self.unit.is_moving());
    }

    /// Suspends the process, continues it with the key still down, and checks that only a new press
    /// moves the antenna again.
    fn freezes(mut self, what: &str, signal: &str, frozen_for: Duration) {
        let frozen = Instant::now();
        self.azel.signal(signal);
        let took = self.unit.wait_for_stop(frozen);
        report(&format!("{what} to STOP"), took);
        assert!(took < STOPS_IN, "{what}: {took:?}");
        assert!(processes::is_stopped(self.azel.id()));
        thread::sleep((frozen + frozen_for).saturating_duration_since(Instant::now()));
        let thawed = Instant::now();
        self.azel.signal("CONT");
        self.unit.wait_until_read_since(thawed);
        thread::sleep(WATCHED);
        let heard = self.unit.heard_since(thawed);
        assert!(!self.unit.is_told_to_move_since(thawed), "{what}: {heard:?}");
        assert!(!self.unit.is_moving());
        wait_for("the alarm", || {
            let log = fs::read_to_string(log_file(&self.screen)).expect("the log");
            log.contains("DeadManFired").then_some(())
        });
        self.wait_until_unwatched();
        self.screen.release_key();
        self.hold();
        self.dies(&format!("{what}, then kill"), STOPS_IN, |scene| scene.azel.signal("KILL"));
    }
}

#[test]
#[ignore = "needs Xvfb, xdotool and OpenGL"]
fn a_window_that_is_killed_leaves_stop_behind() {
    Scene::new().dies("kill -9", STOPS_IN, |scene| scene.azel.signal("KILL"));
}

#[test]
#[ignore = "needs Xvfb, xdotool and OpenGL"]
fn a_window_that_freezes_moves_again_only_at_a_new_press() {
    let (short, long) = (Duration::from_millis(900), Duration::from_secs(4));
    Scene::new().freezes("a short SIGSTOP", "STOP", short);
    Scene::new().freezes("a long SIGSTOP", "STOP", long);
    Scene::new().freezes("Ctrl Z", "TSTP", long);
}

#[test]
#[ignore = "needs Xvfb, xdotool and OpenGL"]
fn a_window_that_loses_its_screen_leaves_stop_behind() {
    Scene::new().dies("windowkill", STOPS_IN, |scene| {
        scene.screen.xdotool(&["windowkill", &scene.window]);
    });
    for signal in ["TERM", "KILL"] {
        Scene::new().dies(&format!("{signal} to Xvfb"), STOPS_IN, |scene| {
            scene.screen.server.signal(signal);
        });
    }
}

#[test]
#[ignore = "needs Xvfb, xdotool and OpenGL"]
fn a_signal_that_ends_the_program_ends_the_jog() {
    for signal in ["INT", "TERM", "HUP"] {
        Scene::new().dies(&format!("SIG{signal}"), ENDS_IN, |scene| scene.azel.signal(signal));
    }
}

#[test]
#[ignore = "needs Xvfb, xdotool and OpenGL"]
fn a_signal_to_the_whole_process_group_ends_the_jog() {
    for (signal, limit) in [("TERM", ENDS_IN), ("KILL", STOPS_IN)] {
        let what = format!("SIG{signal} to the group");
        Scene::new().dies(&what, limit, |scene| scene.azel.signal_group(signal));
    }
}

#[test]
#[ignore = "needs Xvfb, xdotool and OpenGL"]
fn a_program_that_was_killed_in_a_jog_stops_the_unit_when_it_starts_again() {
    let mut scene = Scene::new();
    let killed = Instant::now();
    scene.azel.signal("KILL");
    scene.azel.wait_for_end();
    assert_eq!(scene.screen.marks(), 1, "the mark outlives the program");
    let before = scene.unit.clients().len();

    let started = Instant::now();
    let log = log_file(&scene.screen);
    let file = fs::File::create(&log).expect("a log");
    let mut command = command(&scene.screen, &scene.unit);
    let (azel, _) = scene.screen.window_of(command.env("AZEL_LOG", EVENTS).stderr(file));
    scene.azel = azel;
    // The unit has room for the new client once the dead-man has left the old connection.
    let came = wait_for("the new client", || scene.unit.clients().get(before).copied());
    let (at, first) =
        wait_for("its first word", || scene.unit.heard_since(came).into_iter().next());
    assert!(first.starts_with("STOP="), "{first}");
    wait_for("the mark to go", || (scene.screen.marks() == 0).then_some(()));
    let proved = Instant::now() - started;
    report("start to connected", came.saturating_duration_since(started));
    report("start to STOP", at.saturating_duration_since(started));
    report("start to proved standstill", proved);
    assert!(proved < BACK_IN, "{proved:?}");
    assert!(!scene.unit.is_moving());
    assert!(!scene.unit.is_told_to_move_since(killed));
    wait_for("the alarm", || {
        fs::read_to_string(&log).expect("the log").contains("LeftMoving").then_some(())
    });
    scene.wait_until_unwatched();
    assert_eq!(processes::established_at(scene.unit.address), 1);
}

#[test]
#[ignore = "needs Xvfb, xdotool and OpenGL"]
fn a_log_that_nobody_reads_holds_up_no_stop() {
    let (unread, mut log) = io::pipe().expect("a pipe");
    // Fill the pipe, so that even the first line of the log has to wait.
    log.write_all(&vec![b'\n'; 65_536]).expect("room in a new pipe");
    let scene = Scene::with_log(screen(), Unit::start(), log.into(), "azel=trace");
    let released = Instant::now();
    scene.screen.release_key();
    let took = scene.unit.wait_for_stop(released);
    report("release to STOP with an unread log", took);
    assert!(took < STOPS_IN, "{took:?}");
    scene.wait_until_unwatched();
    drop(unread);
}
