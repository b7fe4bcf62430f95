//! Listener on loopback that starts a server process for each connection, so that no test has to
//! wait for a server.

use std::{
    net::{SocketAddr, TcpListener, TcpStream},
    os::fd::OwnedFd,
    process::{Child, Command, Stdio},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
};

/// Listener that serves until it is dropped.
pub(crate) struct Doorman {
    address: SocketAddr,
    ends: Arc<AtomicBool>,
    servers: Arc<Mutex<Vec<Child>>>,
    thread: Option<JoinHandle<()>>,
}

impl Doorman {
    /// Starts a listener. `server` makes the process of one connection, with the connection as its
    /// input and output.
    pub(crate) fn new(server: impl Fn() -> Command + Send + 'static) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let ends = Arc::new(AtomicBool::new(false));
        let servers = Arc::new(Mutex::new(Vec::new()));
        let (told, running) = (Arc::clone(&ends), Arc::clone(&servers));
        let serve = move || {
            for stream in listener.incoming() {
                if told.load(Ordering::SeqCst) {
                    break;
                }
                let input = OwnedFd::from(stream.unwrap());
                let output = input.try_clone().unwrap();
                let mut command = server();
                command.stdin(Stdio::from(input)).stdout(Stdio::from(output));
                running.lock().unwrap().push(command.stderr(Stdio::null()).spawn().unwrap());
            }
        };
        let thread = thread::Builder::new().name("doorman".to_owned()).spawn(serve).unwrap();
        Self { address, ends, servers, thread: Some(thread) }
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Doorman {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::SeqCst);
        // Wake the thread; if this fails, the thread has already ended.
        let _ = TcpStream::connect(self.address);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        for server in self.servers.lock().unwrap().iter_mut() {
            // Most servers have ended with their connection.
            let _ = server.kill();
            let _ = server.wait();
        }
    }
}
