//! HTTPS server with certificates of an authority made for the test.

use std::{
    fs,
    io::{BufRead as _, BufReader, Read as _},
    path::Path,
    process::{Child, ChildStdout, Command, Stdio},
};

use rustls::pki_types::CertificateDer;

use super::user::run;

/// Name of the only file.
pub(crate) const FILE: &str = "weather.tle";

/// Configuration of the authority: its files are in its own folder.
const CONFIG: &str = "[ca]\ndefault_ca = own\n[own]\ndatabase = index.txt\nserial = serial\n\
                      unique_subject = no\nnew_certs_dir = .\ncertificate = ca.pem\nprivate_key = ca.key\n\
                      default_md = sha256\ncopy_extensions = copy\npolicy = names\n\
                      [names]\ncommonName = supplied\n";
const NEW_KEY: [&str; 5] = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"];

/// Certificate authority with a folder for its files.
pub(crate) struct Authority {
    folder: tempfile::TempDir,
}

impl Authority {
    pub(crate) fn new(name: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("ca.conf"), CONFIG).unwrap();
        fs::write(folder.path().join("index.txt"), "").unwrap();
        fs::write(folder.path().join("serial"), "01\n").unwrap();
        let authority = Self { folder };
        let mut openssl = authority.openssl();
        openssl.args(["req", "-x509", "-days", "2", "-subj", &format!("/CN={name}")]).args(NEW_KEY);
        run(openssl.args(["-keyout", "ca.key", "-out", "ca.pem"]));
        run(authority
            .openssl()
            .args(["x509", "-in", "ca.pem", "-outform", "DER", "-out", "ca.der"]));
        authority
    }

    pub(crate) fn certificate(&self) -> CertificateDer<'static> {
        fs::read(self.folder.path().join("ca.der")).unwrap().into()
    }

    /// Makes a certificate in `server.pem` for a host called `name`, valid from 2020 until the
    /// year `end`.
    fn certify(&self, name: &str, end: u16) {
        let mut openssl = self.openssl();
        openssl.args(["req", "-new", "-subj", "/CN=server"]).args(NEW_KEY);
        openssl.args(["-addext", &format!("subjectAltName=DNS:{name}")]);
        run(openssl.args(["-keyout", "server.key", "-out", "server.csr"]));
        let mut openssl = self.openssl();
        openssl.args(["ca", "-batch", "-notext", "-config", "ca.conf", "-in", "server.csr"]);
        openssl.args(["-out", "server.pem", "-startdate", "20200101000000Z", "-enddate"]);
        run(openssl.arg(format!("{end}0101000000Z")));
    }

    fn openssl(&self) -> Command {
        let mut openssl = Command::new("openssl");
        openssl.current_dir(self.folder.path());
        openssl
    }
}

/// HTTPS server that runs until it is dropped.
pub(crate) struct HttpsServer {
    process: Child,
    pub(crate) port: u16,
    /// Output of the server, kept open because the server ends without a reader.
    _said: BufReader<ChildStdout>,
}

impl HttpsServer {
    /// Starts a server with `content` in [`FILE`] and a certificate of `authority` for `name`,
    /// valid until the year `end`.
    pub(crate) fn new(authority: &Authority, name: &str, end: u16, content: &[u8]) -> Self {
        authority.certify(name, end);
        let folder: &Path = authority.folder.path();
        fs::write(folder.join(FILE), content).unwrap();
        let mut openssl = authority.openssl();
        openssl.args(["s_server", "-WWW", "-accept", "127.0.0.1:0", "-cert", "server.pem"]);
        openssl.args(["-key", "server.key"]).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut process = openssl.stdin(Stdio::null()).spawn().unwrap();
        // The output contains the port of the server.
        let mut said = BufReader::new(process.stdout.take().unwrap());
        let port = said
            .by_ref()
            .lines()
            .map_while(Result::ok)
            .find_map(|line| line.strip_prefix("ACCEPT ")?.rsplit(':').next()?.parse().ok())
            .unwrap();
        Self { process, port, _said: said }
    }
}

impl Drop for HttpsServer {
    fn drop(&mut self) {
        // The server may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
