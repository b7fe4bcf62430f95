//! An FTP server with one user and one file.

use std::{fs, net::SocketAddr, path::PathBuf, process::Command};

use rustls::pki_types::CertificateDer;

use super::{
    doorman::Doorman,
    user::{User, open_folder, run},
};

/// Name of the file in the user's home.
pub(crate) const FILE: &str = "weather.txt";

pub(crate) struct FtpServer {
    // The first field, because fields drop in order and its servers run as the user.
    doorman: Doorman,
    pub(crate) user: User,
    home: tempfile::TempDir,
}

impl FtpServer {
    /// Starts a server with `content` in [`FILE`]; it accepts log-ins with TLS only if `tls` is
    /// set.
    pub(crate) fn new(content: &[u8], tls: bool) -> Self {
        Self::with_options(content, tls, "")
    }

    /// Starts a server with `options` as further lines of its configuration.
    pub(crate) fn with_options(content: &[u8], tls: bool, options: &str) -> Self {
        let home = open_folder();
        let user = User::new(home.path());
        fs::write(home.path().join(FILE), content).unwrap();
        fs::create_dir_all("/var/run/vsftpd/empty").unwrap();
        let mut lines = "anonymous_enable=NO\nlocal_enable=YES\npam_service_name=vsftpd\n\
                         secure_chroot_dir=/var/run/vsftpd/empty\nseccomp_sandbox=NO\n\
                         xferlog_enable=NO\n"
            .to_owned()
            + options;
        if tls {
            let path = home.path().display();
            lines = format!(
                "{lines}ssl_enable=YES\nallow_anon_ssl=NO\nforce_local_logins_ssl=YES\n\
                 force_local_data_ssl=YES\nrequire_ssl_reuse=NO\nrsa_cert_file={path}/cert.pem\n\
                 rsa_private_key_file={path}/key.pem\n"
            );
        }
        let config = home.path().join("vsftpd.conf");
        fs::write(&config, lines).unwrap();
        let doorman = Doorman::new(move || {
            let mut vsftpd = Command::new("/usr/sbin/vsftpd");
            vsftpd.arg(&config);
            vsftpd
        });
        let server = Self { doorman, user, home };
        server.make_certificate();
        server
    }

    fn make_certificate(&self) {
        let mut openssl = Command::new("openssl");
        openssl.args(["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2"]);
        openssl.args(["-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1"]);
        openssl.args(["-addext", "basicConstraints=critical,CA:FALSE", "-keyout"]);
        run(openssl.arg(self.path("key.pem")).arg("-out").arg(self.path("cert.pem")));
        let mut openssl = Command::new("openssl");
        openssl.args(["x509", "-outform", "DER", "-in"]).arg(self.path("cert.pem"));
        run(openssl.arg("-out").arg(self.path("cert.der")));
    }

    pub(crate) fn certificate(&self) -> CertificateDer<'static> {
        fs::read(self.path("cert.der")).unwrap().into()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.home.path().join(name)
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.doorman.address()
    }
}
