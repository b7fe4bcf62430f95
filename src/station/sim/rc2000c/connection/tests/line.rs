//! Tests of every command, the panel, and failures of the line.

use super::*;
use crate::protocol::rc2000c::{
    Alarm, Command, DeviceType, MountKind, NameDisplay, NameEntry, NameIndex, Position,
};
use crate::sim::rc2000c::Mode;

const POLL: Request = Request::Query(Query::Status);

fn name_at(index: u8) -> Request {
    Request::Query(Query::SatelliteName(NameIndex::new(index).unwrap()))
}

#[tokio::test(start_paused = true)]
async fn queries_are_answered_as_documented() {
    let (mut client, _control) = Client::new();
    let mount = MountKind::ElevationOverAzimuth;
    let device = Reply::DeviceType(DeviceType { mount, version: *b"14" });
    assert_eq!(client.ask(Request::Query(Query::DeviceType)).await, device);
    let name = SatelliteName::new("GALAXY 5").unwrap();
    let entry = Reply::SatelliteName(NameEntry { index: 2, count: 6, name });
    assert_eq!(client.ask(name_at(2)).await, entry);
    client.refused(name_at(7)).await;
    let status = client.status().await;
    assert_eq!(status.satellite.as_str(), "SBS 6");
    assert_eq!(status.name_display, NameDisplay::OnSatellite);
    assert_eq!((status.azimuth, status.elevation), (Position::Counts(1525), Position::Counts(750)));
    assert_eq!(status.feed.units(), Some(263));
    assert_eq!(status.receiver.unwrap().agc, 900);
}

#[tokio::test(start_paused = true)]
async fn any_command_takes_the_panel_from_the_local_operator() {
    let (mut client, control) = Client::new();
    assert_eq!(control.state().mode, Mode::Manual);
    client.status().await;
    assert_eq!(control.state().mode, Mode::Remote);
    client.status_after(to_position(2000, 750)).await;
    seconds(1.0).await;
    control.use_panel();
    seconds(2.0).await;
    let state = control.state();
    assert!(state.mode == Mode::Manual && !state.is_turning);
    client.write(b"\x02\x33\x31\x03\x03").await;
    client.write(b"\x02\x32\x31\x03\x01").await;
    assert!(client.receive().await.is_none());
    assert_eq!(control.state().mode, Mode::Manual, "broken, or for another controller");
}

#[tokio::test(start_paused = true)]
async fn a_disabled_remote_mode_says_so_behind_an_ack() {
    let (mut client, control) = Client::new();
    control.set_fault(Fault::RemoteDisabled, true);
    assert_eq!(client.ask(POLL).await, Reply::Offline { code: 0x31 });
    assert_eq!(client.ask(to_position(2000, 750)).await, Reply::Offline { code: 0x32 });
    let state = control.state();
    assert!(state.mode == Mode::Manual && !state.is_turning);
}

#[tokio::test(start_paused = true)]
async fn what_is_malformed_is_refused_or_passed_over() {
    let (mut client, control) = Client::new();
    let unknown = b"\x02\x32\x3f\x03";
    assert_eq!(client.ask_raw(unknown).await, Some(Reply::Refused { code: 0x3f }));
    assert_eq!(client.ask_raw(b"\x02\x32\x31A\x03").await, Some(Reply::Refused { code: 0x31 }));
    control.set_quirk(Quirk::SilentRefusal, true);
    assert_eq!(client.ask_raw(unknown).await, None);
    client.refused(name_at(7)).await;
    control.set_fault(Fault::Refuse, true);
    client.refused(Request::Stop).await;
    client.status().await;
}

#[tokio::test(start_paused = true)]
async fn a_command_in_two_halves_is_whole_unless_the_line_was_quiet_between() {
    let (mut client, control) = Client::new();
    let bytes = POLL.to_bytes(Address::FACTORY);
    for (pause_ms, is_answered) in [(90, true), (150, false)] {
        client.write(&bytes[..3]).await;
        sleep(Duration::from_millis(pause_ms)).await;
        client.write(&bytes[3..]).await;
        assert_eq!(client.receive().await.is_some(), is_answered, "{pause_ms}");
    }
    assert_eq!(control.received().len(), 1);
}

#[tokio::test(start_paused = true)]
async fn a_reply_takes_the_time_of_its_characters() {
    for (baud, expected_ms) in [(9600, 15 + 44), (300, 15 + 1433)] {
        let control = Control::new(&Options { baud, ..Options::default() });
        let mut client = Client::attached(&control);
        let request_time = Instant::now();
        client.status().await;
        let took_ms = (Instant::now() - request_time).as_millis();
        assert!((expected_ms..expected_ms + 3).contains(&took_ms), "{baud}: {took_ms}");
    }
}

#[tokio::test(start_paused = true)]
async fn each_quirk_of_the_line_does_as_it_says() {
    let (mut client, control) = Client::new();
    control.set_quirk(Quirk::Echo, true);
    client.send(POLL).await;
    let echo = Reply::parse(&client.receive().await.unwrap().unwrap());
    assert_eq!(echo, Err(ReplyError::Echo { code: 0x31 }));
    assert!(Reply::parse(&client.receive().await.unwrap().unwrap()).is_ok());
    control.set_quirk(Quirk::Echo, false);

    control.set_quirk(Quirk::TypeCode, true);
    client.send(Request::Query(Query::DeviceType)).await;
    let frame = client.receive().await.unwrap().unwrap();
    assert_eq!(frame.code(), Command::Status.code());
    assert!(matches!(Reply::parse(&frame), Ok(Reply::DeviceType(_))));

    control.set_quirk(Quirk::ParityBit, true);
    client.send(POLL).await;
    assert!(client.receive().await.is_none(), "without parity it is not heard");
    let mut bytes = POLL.to_bytes(Address::FACTORY);
    Parity::Software.prepare(&mut bytes);
    client.write(&bytes).await;
    let mut buffer = [0; 64];
    let count = client.stream.read(&mut buffer).await.unwrap();
    assert!(buffer[..count].iter().any(|byte| *byte >= 0x80));
    Parity::Software.check(&mut buffer[..count]);
    client.decoder.push(&buffer[..count]);
    assert!(client.decoder.next().unwrap().is_ok());
}

#[tokio::test(start_paused = true)]
async fn an_older_controller_has_no_track_mode() {
    let (mut client, control) = Client::new();
    control.set_quirk(Quirk::Rc2000a, true);
    let status = client.status().await;
    assert_eq!((status.track, status.receiver), (None, None));
    let Reply::DeviceType(device) = client.ask(Request::Query(Query::DeviceType)).await else {
        panic!("no device type")
    };
    assert_eq!(device.to_string(), "RC2K 1.4");
}

#[tokio::test(start_paused = true)]
async fn each_fault_of_the_line_does_as_it_says() {
    let (mut client, control) = Client::new();
    control.set_fault(Fault::Silence, true);
    client.send(to_position(1600, 750)).await;
    assert!(client.receive().await.is_none());
    assert_eq!(control.state().mode, Mode::Remote);
    assert!(control.state().az_counts > 1525);
    control.set_fault(Fault::Silence, false);

    for fault in [Fault::DropReply, Fault::BitError, Fault::Truncate] {
        control.set_fault(fault, true);
        let mut whole = 0;
        for _ in 0..6 {
            client.send(POLL).await;
            let frame = client.receive().await;
            whole += usize::from(matches!(frame, Some(Ok(_))));
            // Skip the rest of a broken frame, until the line is quiet.
            while client.receive().await.is_some() {}
            client.decoder.line_is_quiet();
        }
        assert_eq!(whole, 4, "{fault}");
        control.set_fault(fault, false);
    }

    control.set_fault(Fault::Garbage, true);
    client.status().await;
    assert!(client.decoder.skipped_bytes() > 4);
    control.set_fault(Fault::Garbage, false);

    control.set_fault(Fault::Split, true);
    client.send(POLL).await;
    let mut buffer = [0; 64];
    let count = client.stream.read(&mut buffer).await.unwrap();
    assert_eq!(count, 7);
    client.decoder.push(&buffer[..count]);
    assert!(client.receive().await.unwrap().is_ok());
    control.set_fault(Fault::Split, false);

    control.set_fault(Fault::Merge, true);
    client.send(POLL).await;
    client.send(POLL).await;
    sleep(Duration::from_secs(1)).await;
    let count = client.stream.read(&mut buffer).await.unwrap();
    assert_eq!(count, 64);
}

#[tokio::test(start_paused = true)]
async fn alarms_show_the_most_urgent_first() {
    let (mut client, control) = Client::new();
    for (fault, _) in Fault::ALL {
        let Fault::Alarm(alarm) = fault else { continue };
        control.set_fault(fault, true);
        assert_eq!(client.status().await.alarm, alarm);
        control.set_fault(fault, false);
    }
    control.set_fault(Fault::Alarm(Alarm::AxisOptions), true);
    control.set_fault(Fault::Alarm(Alarm::LowBattery), true);
    assert_eq!(client.status().await.alarm, Alarm::LowBattery);
}

#[tokio::test(start_paused = true)]
async fn dropping_closes_and_the_controller_goes_on() {
    let (mut client, control) = Client::new();
    client.status_after(to_position(1700, 750)).await;
    control.drop_clients();
    let mut buffer = [0; 8];
    assert_eq!(client.stream.read(&mut buffer).await.unwrap(), 0);
    seconds(10.0).await;
    assert_eq!(control.state().az_counts, 1700);
}
