//! A server of elements on loopback that can fail.

use std::{
    io::{BufRead as _, BufReader, Write as _},
    net::{SocketAddr, TcpListener, TcpStream},
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    thread,
    time::Duration,
};

/// Max wait for a client's request.
const PATIENCE: Duration = Duration::from_secs(10);

pub(super) struct ElementServer {
    address: SocketAddr,
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    is_failing: AtomicBool,
    is_over: AtomicBool,
    requests: AtomicUsize,
}

impl ElementServer {
    pub(super) fn new(body: Vec<u8>) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let shared = Arc::<Shared>::default();
        let served = Arc::clone(&shared);
        let serve = move || {
            for stream in listener.incoming().map_while(Result::ok) {
                if served.is_over.load(Ordering::Relaxed) {
                    return;
                }
                served.requests.fetch_add(1, Ordering::Relaxed);
                answer(stream, served.is_failing.load(Ordering::Relaxed), &body);
            }
        };
        thread::Builder::new().name("element-server".to_owned()).spawn(serve).unwrap();
        Self { address, shared }
    }

    pub(super) fn url(&self) -> String {
        format!("http://{}/elements", self.address)
    }

    /// Sets whether the server answers with 403 or with the elements.
    pub(super) fn set_failing(&self, is_failing: bool) {
        self.shared.is_failing.store(is_failing, Ordering::Relaxed);
    }

    pub(super) fn requests(&self) -> usize {
        self.shared.requests.load(Ordering::Relaxed)
    }
}

impl Drop for ElementServer {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Relaxed);
        // The connection wakes the thread.
        let _ = TcpStream::connect(self.address);
    }
}

fn answer(mut stream: TcpStream, is_failing: bool, elements: &[u8]) {
    let _ = stream.set_read_timeout(Some(PATIENCE));
    let Ok(reader) = stream.try_clone() else { return };
    let lines = BufReader::new(reader).lines().map_while(Result::ok);
    lines.take_while(|line| !line.is_empty()).for_each(drop);
    let (status, body) = if is_failing { ("403 Forbidden", &[][..]) } else { ("200 OK", elements) };
    let head =
        format!("HTTP/1.1 {status}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n", body.len());
    // Ignore errors: the client may have left.
    let _ = stream.write_all(&[head.as_bytes(), body].concat());
}
