use std::{
    io::{BufRead as _, BufReader, Write as _},
    net::{Shutdown, TcpListener},
    thread,
};

use super::*;

const FILE: &[u8] = b"1 25544U\n2 25544\n";

/// Answers of a server to EPSV and PASV; `PORT` and `HIGH,LOW` are placeholders for its port.
#[derive(Clone, Copy)]
struct Answers {
    extended: &'static str,
    plain: &'static str,
}

/// Fetches a file from a server with these answers.
async fn fetched(answers: Answers, end: &'static str) -> Result<Vec<u8>, FetchError> {
    let [control, data] = [(); 2].map(|()| TcpListener::bind("127.0.0.1:0").unwrap());
    let port = data.local_addr().unwrap().port();
    let peer = Peer { host: "127.0.0.1".to_owned(), port: control.local_addr().unwrap().port() };
    let server = move || {
        let (mut stream, _) = control.accept().unwrap();
        let filled = |text: &str| {
            let [high, low] = port.to_be_bytes();
            text.replace("PORT", &port.to_string()).replace("HIGH,LOW", &format!("{high},{low}"))
        };
        let mut lines = BufReader::new(stream.try_clone().unwrap()).lines();
        let mut answer = "220 ready".to_owned();
        loop {
            if stream.write_all(format!("{answer}\r\n").as_bytes()).is_err() {
                return;
            }
            let Some(Ok(line)) = lines.next() else { return };
            answer = match line.split(' ').next().unwrap() {
                "USER" => "331 password".to_owned(),
                "PASS" => "230 in".to_owned(),
                "TYPE" => "200 binary".to_owned(),
                "EPSV" => filled(answers.extended),
                "PASV" => filled(answers.plain),
                "RETR" => {
                    stream.write_all(b"150 it comes\r\n").unwrap();
                    let (mut sent, _) = data.accept().unwrap();
                    sent.write_all(FILE).unwrap();
                    sent.shutdown(Shutdown::Both).unwrap();
                    end.to_owned()
                }
                _ => "200 well".to_owned(),
            };
        }
    };
    thread::Builder::new().name("ftp-server".to_owned()).spawn(server).unwrap();
    let password = "word".into();
    let request =
        Request { peer: &peer, roots: None, user: "op", password: &password, file: "a.tle" };
    fetch(request, Limits::default(), &CancellationToken::new()).await
}

const UNKNOWN: &str = "500 what?";

#[tokio::test]
async fn both_passive_modes_are_taken_in_every_spelling() {
    for (extended, plain) in [
        ("229 Entering Extended Passive Mode (|||PORT|)", UNKNOWN),
        ("229 Extended Passive Mode OK |||PORT|", UNKNOWN),
        ("229 (!!!PORT!)", UNKNOWN),
        (UNKNOWN, "227 Entering Passive Mode (10,0,0,7,HIGH,LOW)."),
        (UNKNOWN, "227 Entering Passive Mode. 10,0,0,7,HIGH,LOW"),
        (UNKNOWN, "227 =10,0,0,7,HIGH,LOW"),
        ("229 somewhere", "227 Entering Passive Mode 10,0,0,7,HIGH,LOW"),
        ("502 no", "227 at 10, 0, 0, 7, HIGH,LOW"),
    ] {
        let bytes = fetched(Answers { extended, plain }, "226 done").await;
        assert_eq!(bytes.unwrap(), FILE, "{extended} {plain}");
    }
}

#[tokio::test]
async fn an_answer_that_is_not_understood_is_called_that() {
    let answers = Answers { extended: UNKNOWN, plain: "227 Entering Passive Mode" };
    let error = fetched(answers, "226 done").await.unwrap_err();
    assert!(matches!(&error, FetchError::NotUnderstood(text) if text.contains("227")), "{error}");
    let answers = Answers { extended: UNKNOWN, plain: "530 not for you" };
    let error = fetched(answers, "226 done").await.unwrap_err();
    assert!(matches!(&error, FetchError::Refused(text) if text.contains("530")), "{error}");
}

#[tokio::test]
async fn an_interrupted_file_is_no_file() {
    let answers = Answers { extended: "229 (|||PORT|)", plain: UNKNOWN };
    let error = fetched(answers, "426 cut").await.unwrap_err();
    assert!(matches!(&error, FetchError::Refused(text) if text.contains("426")), "{error}");
}
