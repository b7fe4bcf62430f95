//! Secrets: a run with a password, and a search of everything that the run leaves behind.

use std::{
    io,
    sync::{Arc, Mutex},
};

use azel::{
    controller::satrak::settings::GROUPS,
    device::settings::{CopyHead, Secret, SettingsCopy, Value},
    sim::satrak::Fault,
};
use tracing_subscriber::fmt::MakeWriter;

use super::{
    rig::Rig,
    settings::{change, read, text, write_settings},
    wire::{all, line_text},
};

const PASSWORD: &str = "hunter2-of-the-ftp";

/// Log output, down to the finest level.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

impl io::Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl<'a> MakeWriter<'a> for Log {
    type Writer = Self;
    fn make_writer(&'a self) -> Self {
        self.clone()
    }
}

#[tokio::test(start_paused = true)]
async fn no_password_is_left_behind() {
    let log = Log::default();
    let subscriber = tracing_subscriber::fmt()
        .with_ansi(false)
        .with_max_level(tracing::Level::TRACE)
        .with_writer(log.clone())
        .finish();
    let guard = tracing::subscriber::set_default(subscriber);
    let mut rig = Rig::usual().await;
    let wish = change(
        "ftp",
        [
            ("address", text("10.0.1.2")),
            ("user", text("username")),
            ("password", Value::Secret(Secret::new(PASSWORD))),
            ("file", text("stations.txt")),
            ("satellite", text("TWIN")),
        ],
    );
    write_settings(&mut rig, wish.clone()).await.unwrap();
    read(&mut rig, "ftp").await;
    // Repeat this over a line that spoils, splits and repeats bytes.
    for fault in [Fault::Garbage, Fault::Split, Fault::Merge, Fault::BadChecksum] {
        rig.control.set_fault(fault, true);
        // The change may or may not get through.
        let _ = write_settings(&mut rig, wish.clone()).await;
        read(&mut rig, "ftp").await;
        rig.control.set_fault(fault, false);
    }
    let shown = rig.shown();
    let head = CopyHead {
        antenna: "Dish".to_owned(),
        address: "in memory".to_owned(),
        controller: "satrak".to_owned(),
        saved_at: "2026-08-12T11:15:30Z".parse().unwrap(),
    };
    let copy = SettingsCopy::text(&head, GROUPS, &shown.state.groups);
    drop(guard);
    let wire: String = all(|from| rig.wire().copy_from(from)).iter().map(line_text).collect();
    assert!(wire.contains("$SATELLITE_FTP=(hidden)") && wire.contains("$SATELLITE_FTP?(hidden)"));
    let logged = String::from_utf8(log.0.lock().unwrap().clone()).unwrap();
    assert!(logged.contains("settings group=\"ftp\""), "the log is not empty: {logged}");
    assert!(copy.contains("10.0.1.2"), "{copy}");
    for (what, left) in [
        ("log", logged),
        ("copy", copy),
        ("shown", format!("{shown:#?}")),
        ("events", format!("{:?}", rig.events())),
        ("record", format!("{:?}", rig.payloads())),
        ("wire", wire),
    ] {
        assert!(!left.contains(PASSWORD), "{what}");
    }
}
