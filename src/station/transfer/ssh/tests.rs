use russh::{
    keys::{
        HashAlg, decode_secret_key,
        ssh_key::private::{Ed25519Keypair, KeypairData},
    },
    server::{self, Auth, Response},
};

use super::*;
use crate::transfer::KnownHosts;

/// Host with one user and one of two ways to log in.
struct Host {
    is_interactive: bool,
}

impl server::Handler for Host {
    type Error = russh::Error;

    async fn auth_password(&mut self, _: &str, password: &str) -> Result<Auth, Self::Error> {
        if !self.is_interactive && password == "word" {
            return Ok(Auth::Accept);
        }
        Ok(Auth::reject())
    }

    async fn auth_keyboard_interactive<'a>(
        &'a mut self,
        _: &str,
        _: &str,
        response: Option<Response<'a>>,
    ) -> Result<Auth, Self::Error> {
        let Some(mut response) = response else {
            return Ok(Auth::Partial {
                name: "".into(),
                instructions: "".into(),
                prompts: vec![("Password: ".into(), false)].into(),
            });
        };
        let is_right = response.next().is_some_and(|answer| &*answer == b"word");
        Ok(if is_right { Auth::Accept } else { Auth::reject() })
    }
}

fn ed25519() -> PrivateKey {
    let pair = KeypairData::from(Ed25519Keypair::from_seed(&[7; 32]));
    PrivateKey::new(pair, "").unwrap()
}

/// Logs in at a host with these algorithms. Returns the old algorithms in use.
async fn logged_in(
    preferred: Preferred,
    is_interactive: bool,
) -> Result<Vec<OldAlgorithm>, ConnectError> {
    logged_in_with(ed25519(), preferred, is_interactive).await
}

async fn logged_in_with(
    key: PrivateKey,
    preferred: Preferred,
    is_interactive: bool,
) -> Result<Vec<OldAlgorithm>, ConnectError> {
    let folder = tempfile::tempdir().unwrap();
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let peer = Peer { host: "127.0.0.1".to_owned(), port: listener.local_addr().unwrap().port() };
    let method =
        if is_interactive { MethodKind::KeyboardInteractive } else { MethodKind::Password };
    let config = server::Config {
        methods: [method].as_slice().into(),
        auth_rejection_time: std::time::Duration::ZERO,
        keys: vec![key.clone()],
        preferred,
        ..server::Config::default()
    };
    tokio::spawn(async move {
        let (stream, _) = listener.accept().await.unwrap();
        let session = server::run_stream(Arc::new(config), stream, Host { is_interactive }).await;
        if let Ok(session) = session {
            let _ = session.await;
        }
    });
    let known_hosts = KnownHosts::new(folder.path().join("known_hosts"));
    known_hosts.pin(&OfferedKey::new(&peer.host, peer.port, key.public_key().clone())).unwrap();
    let login = Login { user: "op".to_owned(), proof: Proof::Password("word".into()) };
    let cancel = CancellationToken::new();
    let ssh = connect(&peer, &login, &known_hosts, Limits::default(), &cancel).await?;
    Ok(ssh.old_algorithms)
}

#[tokio::test]
async fn old_algorithms_are_taken_and_named_where_a_host_offers_nothing_else() {
    use crate::contract::transfer::AlgorithmPart::{Cipher, KeyExchange, Mac};
    let default = Preferred::DEFAULT;
    for (preferred, expected) in [
        (default.clone(), vec![]),
        (Preferred { kex: vec![kex::ECDH_SHA2_NISTP256].into(), ..default.clone() }, vec![]),
        (
            Preferred { kex: vec![kex::DH_G14_SHA1].into(), ..default.clone() },
            vec![(KeyExchange, "diffie-hellman-group14-sha1")],
        ),
        (
            Preferred {
                cipher: vec![cipher::AES_128_CTR].into(),
                mac: vec![mac::HMAC_SHA1].into(),
                ..default.clone()
            },
            vec![(Mac, "hmac-sha1")],
        ),
        // The cipher needs no MAC.
        (Preferred { mac: vec![mac::HMAC_SHA1].into(), ..default.clone() }, vec![]),
        (
            Preferred {
                cipher: vec![cipher::AES_128_CBC].into(),
                mac: vec![mac::HMAC_SHA1].into(),
                kex: vec![kex::DH_G1_SHA1].into(),
                ..default.clone()
            },
            vec![
                (KeyExchange, "diffie-hellman-group1-sha1"),
                (Cipher, "aes128-cbc"),
                (Mac, "hmac-sha1"),
            ],
        ),
    ] {
        let old = logged_in(preferred, false).await.unwrap();
        let old: Vec<_> = old.iter().map(|old| (old.part, old.name.as_str())).collect();
        assert_eq!(old, expected);
    }
}

#[tokio::test]
async fn a_host_key_that_signs_with_sha1_alone_is_named() {
    let key = decode_secret_key(include_str!("tests/host_key"), None).unwrap();
    for (hash, expected) in [(None, vec!["ssh-rsa"]), (Some(HashAlg::Sha256), vec![])] {
        let preferred =
            Preferred { key: vec![Algorithm::Rsa { hash }].into(), ..Preferred::DEFAULT };
        let old = logged_in_with(key.clone(), preferred, false).await.unwrap();
        assert!(old.iter().all(|old| old.part == AlgorithmPart::HostKey));
        assert_eq!(old.iter().map(|old| old.name.as_str()).collect::<Vec<_>>(), expected);
    }
}

/// A connection uses the first algorithm of the client that the server also supports (RFC 4253,
/// section 7.1).
#[test]
fn old_algorithms_come_last() {
    let config = config(&[]);
    let place = |name: kex::Name| config.preferred.kex.iter().position(|own| *own == name).unwrap();
    for old in [kex::DH_G14_SHA1, kex::DH_GEX_SHA1, kex::DH_G1_SHA1] {
        assert!(place(old) > place(kex::CURVE25519));
        assert!(place(old) > place(kex::DH_G14_SHA256));
        assert!(place(old) > place(kex::ECDH_SHA2_NISTP521));
    }
    let place = |name: mac::Name| config.preferred.mac.iter().position(|own| *own == name).unwrap();
    assert!(place(mac::HMAC_SHA1) > place(mac::HMAC_SHA256));
    let place =
        |name: cipher::Name| config.preferred.cipher.iter().position(|own| *own == name).unwrap();
    assert!(place(cipher::AES_256_CBC) > place(cipher::AES_128_CTR));
}

#[tokio::test]
async fn a_host_without_a_common_algorithm_is_named_with_its_own() {
    let preferred = Preferred { cipher: vec![cipher::NONE].into(), ..Preferred::DEFAULT };
    let error = logged_in(preferred, false).await.unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, ConnectError::NoAgreement { .. }), "{text}");
    assert!(text.contains("ciphers") && text.contains("none"), "{text}");
}

#[tokio::test]
async fn a_host_that_asks_for_the_password_gets_it() {
    logged_in(Preferred::DEFAULT, true).await.unwrap();
}
