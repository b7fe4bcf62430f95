//! The program without a reader of its log: it keeps running, and it ends in order.

use std::{
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::{SocketAddr, TcpListener, TcpStream},
    process::{Child, ChildStderr, Command, ExitStatus, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use azel::protocol::satrak::encode;

/// Number of questions that log more than a pipe holds (64 kB).
const FLOOD: usize = 130;

struct Simulator {
    process: Child,
    unread: Option<ChildStderr>,
    client: BufReader<TcpStream>,
}

impl Drop for Simulator {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Simulator {
    fn start() -> Self {
        let address = free_address();
        let mut process = Command::new(env!("CARGO_BIN_EXE_azel"))
            .args(["simulate", "satrak", "--listen", &address.to_string()])
            .env("AZEL_LOG", "trace")
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let unread = process.stderr.take();
        let until = Instant::now() + Duration::from_secs(20);
        let client = loop {
            match TcpStream::connect(address) {
                Ok(client) => break client,
                Err(error) => assert!(Instant::now() < until, "{error}"),
            }
            sleep(Duration::from_millis(20));
        };
        client.set_read_timeout(Some(Duration::from_secs(10))).expect("a socket");
        client.set_write_timeout(Some(Duration::from_secs(10))).expect("a socket");
        Self { process, unread, client: BufReader::new(client) }
    }

    /// Sends a long command that does not exist, and returns the reply.
    fn ask(&mut self) -> String {
        let command = encode(&format!("HELLO=,{}", "x".repeat(900)));
        self.client.get_mut().write_all(&command).expect("the unit takes a command");
        let mut reply = String::new();
        self.client.read_line(&mut reply).expect("the unit answers");
        reply
    }

    fn flood(&mut self) {
        for _ in 0..FLOOD {
            let reply = self.ask();
            assert!(reply.starts_with("$HELLO=,ERR"), "{reply}");
        }
    }

    /// Asks the program to end, and returns its exit status.
    fn end(&mut self) -> ExitStatus {
        let id = self.process.id().to_string();
        let told = Command::new("kill").args(["-TERM", &id]).status().expect("a signal");
        assert!(told.success());
        let until = Instant::now() + Duration::from_secs(5);
        loop {
            if let Some(status) = self.process.try_wait().expect("a process") {
                return status;
            }
            assert!(Instant::now() < until, "the program hangs on its log");
            sleep(Duration::from_millis(20));
        }
    }
}

fn free_address() -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    listener.local_addr().expect("an address")
}

#[test]
fn a_program_whose_log_nobody_reads_answers_and_ends() {
    let mut simulator = Simulator::start();
    simulator.flood();
    assert_eq!(simulator.end().code(), Some(0));
}

#[test]
fn a_log_that_is_read_late_is_whole_and_plain() {
    let mut simulator = Simulator::start();
    simulator.flood();
    let mut log = simulator.unread.take().expect("piped");
    let reader = std::thread::Builder::new().name("log reader".to_owned()).spawn(move || {
        let mut text = String::new();
        log.read_to_string(&mut text).expect("the log is text");
        text
    });
    assert_eq!(simulator.end().code(), Some(0));
    let text = reader.expect("a thread").join().expect("the log is read");
    assert_eq!(text.lines().filter(|line| line.contains("payload=HELLO=,x")).count(), FLOOD);
    assert!(!text.contains('\u{1b}'), "colour codes go to terminals only");
}
