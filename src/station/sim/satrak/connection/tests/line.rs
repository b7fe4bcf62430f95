//! Tests of every command, and of failures of the line.

use super::*;

#[tokio::test(start_paused = true)]
async fn every_command_is_answered_and_settings_are_remembered() {
    let (mut client, control) = Client::new(&options(some_day()));
    for (request, query, values) in [
        (
            "TRACK_AUTO_ENABLE=,0",
            "VERSION?",
            "SATRAK CU V1.2 18/10/2017,SATRAK DU V1.22 18/10/2017",
        ),
        (
            "START_STOP_TIME=,20,30,0,11,8,2027,20,35,0,11,8,2027",
            "START_STOP_TIME?",
            "20,30,0,11,8,2027,20,35,0,11,8,2027",
        ),
        (
            "SETTINGS=,?,100,1.0,?,?,0,?,6.25,0,2,3.0",
            "SETTINGS?",
            "1,100,1.0,0.0,60000,0,3.0,6.25,0,2,0,3.0",
        ),
        ("GPS_SETTINGS=,0,33.86S,151.21E", "GPS_SETTINGS?", "0,33.86S,151.21E"),
        ("ANGLE_SETTINGS=0,39049,160.0,36838,40.0", "ANGLE_SETTINGS?", "39049,160.0,36838,40.0"),
        ("REDUCTION=,4000,2000", "REDUCTION?", "4000,2000"),
        (
            "SATELLITE=,stations.txt,ISS (ZARYA),3,0",
            "SATELLITE?",
            "stations.txt,ISS (ZARYA),3,25544,",
        ),
        (
            "SATELLITE_HTTP=, https://example.org/a%2Cb,1,1,0",
            "SATELLITE_HTTP?",
            "https://example.org/a%2Cb,1,1",
        ),
        (
            "SATELLITE_FTP=, 10.0.1.2,username,secret,22,1,1",
            "SATELLITE_FTP?",
            "10.0.1.2,username,secret,22,,,1,1",
        ),
        ("LOAD_IMAGE=,sysImage.json", "LOAD_IMAGE?", "0"),
    ] {
        client.done(request).await;
        let frame = client.ask(query).await;
        assert!(frame.line().starts_with(&format!("{query},{values}")), "{}", frame.line());
        assert!(Said::parse(&frame).is_ok(), "{}", frame.line());
    }
    for query in ["GPS_DATA?", "TPOS?", "TIME?", "STATUS?", "ERRSTATUS?"] {
        assert!(Said::parse(&client.ask(query).await).is_ok(), "{query}");
    }
    client.refused("SETTINGS=,1,100,1.0,2.0,60000,1,3.0,6.0,1,1,1,2.0", "2").await;
    client.refused("START_STOP_TIME=,20,30,0,11,8,2027,20,30,0,11,8,2027", "3").await;
    assert_eq!(client.ask("HELLO=").await.line(), "HELLO=,ERR,1");
    let heard = format!("{:?}", control.received());
    assert!(heard.contains("LOAD_IMAGE=,sysImage.json") && !heard.contains("secret"));
}

#[tokio::test(start_paused = true)]
async fn each_quirk_changes_the_bytes_as_it_says() {
    let (mut client, control) = Client::new(&options(some_day()));
    let default = client.raw("STATUS?").await;
    assert_eq!(default, "$STATUS?,0,0.00,90.00,0,0,0,0,0,0,0,0,0,0,90.0,90.0,0*12\r\n");
    for (quirk, request, bytes) in [
        (Quirk::NoComma, "STATUS?", "$STATUS?0,0.00,90.00,0,0,0,0,0,0,0,0,0,0,90.0,90.0,0*"),
        (Quirk::Fields15, "STATUS?", "$STATUS?,0,0.00,90.00,0,0,0,0,0,0,0,0,0,0,90.0,90.0*"),
        (Quirk::Err11, "ERRSTATUS?", "$ERRSTATUS?,0,0,0,0,0,0,0,0,0,0,0*72\r\n"),
        (Quirk::Time6, "TIME?", "$TIME?,16,43,0,17,3,2026*"),
        (Quirk::LowerHex, "STOP=", "$STOP=,OK*0d\r\n"),
        (Quirk::LfOnly, "STOP=", "$STOP=,OK*0D\n"),
        (Quirk::SpaceBeforeEq, "TRACK_AUTO_ENABLE=,0", "$TRACK_AUTO_ENABLE =,OK*74\r\n"),
        (Quirk::DecimalComma, "STATUS?", "$STATUS?,0,0,00,90,00,0,0,0,0,0,0,0,0,0,0,90,0,90,0,0*"),
    ] {
        control.set_quirk(quirk, true);
        let reply = client.raw(request).await;
        assert!(reply.starts_with(bytes), "{quirk}: {reply}");
        control.set_quirk(quirk, false);
    }
    assert_eq!(client.raw("STATUS?").await, default);
    control.set_quirk(Quirk::DecimalComma, true);
    let error = Said::parse(&client.ask("STATUS?").await).unwrap_err();
    assert!(matches!(error, ReplyError::Count { looks_like_decimal_commas: true, .. }));
}

#[tokio::test(start_paused = true)]
async fn each_fault_of_the_line_does_as_it_says() {
    let (mut client, control) = Client::new(&options(some_day()));
    control.set_fault(Fault::Silence, true);
    client.send("MOVE=,1,0").await;
    assert!(client.receive().await.is_none());
    assert!(control.state().is_moving);
    control.set_fault(Fault::Silence, false);

    control.set_fault(Fault::Unsolicited, true);
    assert_eq!(client.ask("STOP=").await.word(), "STOP=");
    assert_eq!(client.receive().await.unwrap().unwrap().word(), "DATETIMEG?=");
    control.set_fault(Fault::Unsolicited, false);

    for (fault, lost) in [(Fault::DropReply, None), (Fault::BadChecksum, Some(()))] {
        control.set_fault(fault, true);
        let mut frames = Vec::new();
        for _ in 0..6 {
            client.send("STOP=").await;
            frames.push(client.receive().await.map(|frame| frame.map_err(|_| ())));
        }
        let bad = frames.iter().filter(|frame| **frame == lost.map(Err)).count();
        assert_eq!(bad, 2, "{fault}: {frames:?}");
        control.set_fault(fault, false);
    }

    control.set_fault(Fault::Garbage, true);
    client.send("STOP=").await;
    assert!(client.receive().await.unwrap().is_err());
    let frame = client.receive().await.unwrap().unwrap();
    assert_eq!(frame.oddities(), [Oddity::NoiseBeforeHeader]);
    control.set_fault(Fault::Garbage, false);

    control.set_fault(Fault::Split, true);
    assert!(client.raw("STATUS?").await.len() <= 8);
    assert_eq!(client.receive().await.map(|frame| frame.is_ok()), Some(false));
    assert_eq!(client.ask("STOP=").await.line(), "STOP=,OK");
    control.set_fault(Fault::Split, false);

    control.set_fault(Fault::Merge, true);
    client.send("STOP=").await;
    client.send("TRACK=,0").await;
    let reply = client.raw("VERSION?").await;
    assert_eq!(reply.matches('$').count(), 3, "{reply}");
}

#[tokio::test(start_paused = true)]
async fn faults_of_the_unit_are_reported_and_suffered() {
    let (mut client, control) = Client::new(&options(some_day()));
    for (fault, _) in Fault::ALL {
        let Fault::Unit(kind) = fault else { continue };
        control.set_fault(fault, true);
        assert!(client.status().await.fault, "{fault}");
        let Said::Faults(faults) = client.reply("ERRSTATUS?").await else { panic!("no faults") };
        assert_eq!(faults.active().collect::<Vec<_>>(), [kind]);
        control.set_fault(fault, false);
    }
    assert!(!client.status().await.fault);
    control.set_fault(Fault::Unit(FaultKind::Setup), true);
    client.refused("MOVE=,1,0", "6").await;
    control.set_fault(Fault::Unit(FaultKind::Setup), false);
    control.set_fault(Fault::Unit(FaultKind::XMotor), true);
    control.set_fault(Fault::Unit(FaultKind::YSensor), true);
    client.done("MOVE=,1,1").await;
    seconds(5).await;
    let state = control.state();
    assert!(state.is_moving, "the Y motor runs, unseen");
    assert!((state.x_deg - 90.0).abs() < 1e-9 && (state.y_deg - 90.0).abs() < 1e-9);
}

#[tokio::test(start_paused = true)]
async fn broken_frames_are_not_answered_and_dropping_closes() {
    let (mut client, control) = Client::new(&options(some_day()));
    client.write(b"$MOVE=,1,0*00\r\n").await;
    assert!(client.receive().await.is_none());
    assert!(!control.state().is_moving && control.received().is_empty());
    control.drop_clients();
    let mut buffer = [0; 8];
    assert_eq!(client.stream.read(&mut buffer).await.unwrap(), 0);
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_hangs_up_answers_questions_and_carries_commands_out() {
    let (mut client, control) = Client::new(&options(some_day()));
    control.set_fault(Fault::HangUp, true);
    assert_eq!(client.ask("VERSION?").await.word(), "VERSION?");
    client.send("MOVE=,1,0").await;
    assert!(client.receive().await.is_none());
    assert!(control.state().is_moving);
    let mut rest = [0; 8];
    assert_eq!(client.stream.read(&mut rest).await.unwrap(), 0, "the connection is closed");
}
