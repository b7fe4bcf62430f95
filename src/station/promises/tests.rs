use std::sync::{
    atomic::{AtomicBool, Ordering},
    mpsc,
};

use super::*;

fn holds(text: &str) -> FileState {
    FileState::Holds(text.to_owned())
}

/// Disk that waits at each step until the test releases it.
pub(crate) struct SlowDisk {
    begun: mpsc::Receiver<FileState>,
    go_on: mpsc::SyncSender<()>,
}

impl SlowDisk {
    pub(crate) fn new() -> (Promises, Self) {
        let (begin, begun) = mpsc::sync_channel(100);
        let (go_on, released) = mpsc::sync_channel::<()>(100);
        let released = Mutex::new(released);
        let promises = Promises::new(move |path, state| {
            begin.send(state.clone()).unwrap();
            // An error means that the test dropped the sender and releases all steps.
            let _ = released.lock().unwrap().recv();
            to_disk(path, state)
        });
        (promises, Self { begun, go_on })
    }

    /// Waits until the disk has begun a step.
    pub(crate) fn begun(&self) -> FileState {
        self.begun.recv_timeout(std::time::Duration::from_secs(20)).unwrap()
    }

    pub(crate) fn go_on(&self) {
        self.go_on.send(()).unwrap();
    }
}

/// Returns promises on a disk that is full while `is_full` is `true`.
pub(crate) fn full_disk(is_full: &Arc<AtomicBool>) -> Promises {
    let is_full = Arc::clone(is_full);
    Promises::new(move |path, state| match state {
        FileState::Holds(_) | FileState::HoldsAndKeepsOld(_) if is_full.load(Ordering::Relaxed) => {
            Err(io::ErrorKind::StorageFull.into())
        }
        _ => to_disk(path, state),
    })
}

#[test]
fn a_late_write_brings_no_removed_promise_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let runtime = tokio::runtime::Runtime::new().unwrap();
    let _within = runtime.enter();
    let (promises, disk) = SlowDisk::new();
    promises.put(&path, holds("a"));
    assert_eq!(disk.begun(), holds("a"));
    promises.put(&path, FileState::Absent);
    assert_eq!(promises.read(&path).unwrap(), None);
    assert_eq!(promises.promised(&path), PromisedFile::Pending);
    disk.go_on();
    assert_eq!(disk.begun(), FileState::Absent);
    disk.go_on();
    runtime.block_on(promises.settled(std::slice::from_ref(&path)));
    assert!(!path.exists());
}

#[test]
fn a_late_removal_takes_no_newer_promise_away() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    fs::write(&path, "old").unwrap();
    let runtime = tokio::runtime::Runtime::new().unwrap();
    let _within = runtime.enter();
    let (promises, disk) = SlowDisk::new();
    promises.put(&path, FileState::Absent);
    assert_eq!(disk.begun(), FileState::Absent);
    // The disk receives only the newest of several pending requests.
    for text in ["first", "second"] {
        promises.put(&path, holds(text));
    }
    disk.go_on();
    assert_eq!(disk.begun(), holds("second"));
    disk.go_on();
    assert_eq!(promises.finish(&path, None), Ok(()));
    assert_eq!(fs::read_to_string(&path).unwrap(), "second");
    assert_eq!(promises.promised(&path), PromisedFile::OnDisk);
}

#[test]
fn one_file_waits_for_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let [slow, fast] = ["slow.toml", "fast.toml"].map(|name| folder.path().join(name));
    let (begin, begun) = mpsc::sync_channel(1);
    let (go_on, released) = mpsc::sync_channel::<()>(1);
    let (released, hangs) = (Mutex::new(released), slow.clone());
    let promises = Promises::new(move |path, state| {
        if path == hangs {
            begin.send(()).unwrap();
            let _ = released.lock().unwrap().recv();
        }
        to_disk(path, state)
    });
    let runtime = tokio::runtime::Runtime::new().unwrap();
    let _within = runtime.enter();
    promises.put(&slow, holds("a"));
    begun.recv().unwrap();
    assert_eq!(promises.put_and_wait(&fast, holds("b")), Ok(()));
    assert_eq!((slow.exists(), promises.promised(&slow)), (false, PromisedFile::Pending));
    drop(go_on);
    assert_eq!(promises.finish(&slow, None), Ok(()));
}

#[test]
fn a_full_disk_is_told_with_its_reason_and_the_next_request_is_tried() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let is_full = Arc::new(AtomicBool::new(false));
    let promises = full_disk(&is_full);
    promises.put_and_wait(&path, holds("old")).unwrap();
    is_full.store(true, Ordering::Relaxed);
    let reason = promises.put_and_wait(&path, holds("new")).unwrap_err();
    assert!(reason.contains("no storage space"), "{reason}");
    assert_eq!(promises.promised(&path), PromisedFile::Failed(reason));
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    is_full.store(false, Ordering::Relaxed);
    promises.put_and_wait(&path, holds("newer")).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "newer");
}

#[test]
fn work_that_never_runs_or_breaks_off_is_a_failure() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let promises = Promises::default();
    drop(promises.request(&path, holds("a")));
    assert!(matches!(promises.promised(&path), PromisedFile::Failed(_)));
    promises.put_and_wait(&path, holds("a")).unwrap();

    let breaks = Promises::new(|_, _| panic!("a bug"));
    let work = breaks.request(&path, holds("b")).unwrap();
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| work.run())).unwrap_err();
    assert!(matches!(breaks.promised(&path), PromisedFile::Failed(_)));
    assert_eq!(fs::read_to_string(&path).unwrap(), "a");
}
