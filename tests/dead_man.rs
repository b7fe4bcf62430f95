//! Dead-man as a separate process on real sockets. The unit gets STOP no matter how the program
//! that started the dead-man ends.

use std::{
    io::{Read as _, Write as _},
    net::{TcpListener, TcpStream},
    os::{fd::OwnedFd, unix::process::CommandExt as _},
    process::{Child, ChildStdin, Command, Stdio},
    time::{Duration, Instant},
};

const STOP: &[u8] = b"$STOP=*29\r\n";

/// A watching child, the pipe to it, and the unit's end of the link.
struct Watched {
    child: Child,
    beat: Option<ChildStdin>,
    unit: TcpStream,
    /// The program's own handle of the link.
    link: TcpStream,
}

impl Watched {
    fn start() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let link = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (unit, _) = listener.accept().unwrap();
        link.set_nonblocking(true).unwrap();
        let digits =
            STOP.iter().fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"));
        let mut child = Command::new(env!("CARGO_BIN_EXE_azel"))
            .args(["dead-man", &digits])
            .env_clear()
            .process_group(0)
            .stdin(Stdio::piped())
            .stdout(Stdio::from(OwnedFd::from(link.try_clone().unwrap())))
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let beat = child.stdin.take();
        Self { child, beat, unit, link }
    }

    fn beat_for(&mut self, time: Duration) {
        let until = Instant::now() + time;
        while Instant::now() < until {
            self.beat.as_mut().unwrap().write_all(b".").unwrap();
            std::thread::park_timeout(Duration::from_millis(50));
        }
    }

    /// Returns `true` if the unit receives STOP within `time`.
    fn hears_within(&mut self, time: Duration) -> bool {
        self.unit.set_read_timeout(Some(time)).unwrap();
        let mut first = [0; STOP.len()];
        match self.unit.read_exact(&mut first) {
            Ok(()) => {
                assert_eq!(first, STOP);
                true
            }
            Err(_) => false,
        }
    }

    /// Returns everything that the unit receives until the connection is shut down.
    fn rest(&mut self) -> Vec<u8> {
        self.unit.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let mut rest = Vec::new();
        self.unit.read_to_end(&mut rest).unwrap();
        rest
    }

    fn signal(&self, name: &str) {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args(["-s", name, &id]).status().unwrap().success());
    }
}

#[test]
fn while_it_beats_nothing_is_written_and_at_its_word_it_ends() {
    let mut watched = Watched::start();
    watched.beat_for(Duration::from_secs(1));
    watched.beat.as_mut().unwrap().write_all(b"e").unwrap();
    assert!(watched.child.wait().unwrap().success());
    drop(watched.link.try_clone());
    assert!(!watched.hears_within(Duration::from_millis(300)));
}

#[test]
fn without_a_beat_it_insists_on_stop_and_shuts_the_link_down() {
    let mut watched = Watched::start();
    watched.beat_for(Duration::from_millis(300));
    let silent = Instant::now();
    assert!(watched.hears_within(Duration::from_secs(5)));
    let waited = silent.elapsed();
    assert!(waited >= Duration::from_millis(300), "{waited:?}");
    let rest = watched.rest();
    assert_eq!(rest.len() % STOP.len(), 0);
    assert!((8..=11).contains(&(rest.len() / STOP.len())), "{}", rest.len() / STOP.len());
    watched.child.wait().unwrap();
}

#[test]
fn a_pipe_that_closes_is_a_process_that_died() {
    let mut watched = Watched::start();
    watched.beat_for(Duration::from_millis(300));
    drop(watched.beat.take());
    assert!(watched.hears_within(Duration::from_secs(5)));
    drop(watched.unit);
    watched.child.wait().unwrap();
}

#[test]
fn signals_that_end_the_program_do_not_end_the_watch() {
    let mut watched = Watched::start();
    watched.beat_for(Duration::from_millis(500));
    for name in ["INT", "TERM", "HUP", "TSTP", "QUIT"] {
        watched.signal(name);
        watched.beat_for(Duration::from_millis(100));
    }
    assert!(watched.child.try_wait().unwrap().is_none(), "it has ended");
    assert!(!watched.hears_within(Duration::from_millis(10)), "it has fired");
    drop(watched.beat.take());
    assert!(watched.hears_within(Duration::from_secs(5)));
    drop(watched.unit);
    watched.child.wait().unwrap();
}

#[test]
fn a_program_that_was_late_learns_that_it_has_fired() {
    let mut watched = Watched::start();
    watched.beat_for(Duration::from_millis(200));
    assert!(watched.hears_within(Duration::from_secs(5)));
    let mut beat = watched.beat.take().unwrap();
    let told = (0..100).any(|_| {
        std::thread::park_timeout(Duration::from_millis(10));
        beat.write_all(b".").is_err()
    });
    assert!(told, "the pipe still takes beats");
    drop(watched.unit);
    watched.child.wait().unwrap();
}
