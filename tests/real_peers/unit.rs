//! Unit for tests of uploads: `sshd` serves its folder of elements, and a simulator answers on its
//! port for commands.

use std::{
    fs,
    net::SocketAddr,
    path::{Path, PathBuf},
    process::Command,
    sync::LazyLock,
    time::Duration,
};

use azel::{
    clock::Clock,
    contract::transfer::{FileName, Peer, Progress, TleFile, Uploaded},
    controller::satrak::ELEMENT_FILES,
    orbit::{Catalog, Elements, bundled},
    transfer::{
        self, CancellationToken, ConnectError, KeptFiles, KnownHosts, Limits, Login, Proof,
        SftpFolder, Upload, UploadError, open_sftp,
    },
};

use super::{
    doorman::Doorman,
    user::{PASSWORD, User, open_folder, run},
};

pub(crate) const FILE: &str = "weather.txt";
pub(crate) const OLD: &[u8] = b"the elements of last week\n";

/// Upload limits, short where nothing is slow, so that a stall ends a test soon.
pub(crate) const LIMITS: Limits = Limits {
    connect: Duration::from_secs(5),
    log_in: Duration::from_secs(30),
    request: Duration::from_secs(3),
    file: Duration::from_secs(30),
    file_bytes: 4 << 20,
};

pub(crate) struct Unit {
    // The first field, because fields drop in order and its servers run as the user.
    doorman: Doorman,
    pub(crate) user: User,
    pub(crate) known: KnownHosts,
    pub(crate) kept: KeptFiles,
    pub(crate) home: tempfile::TempDir,
}

impl Unit {
    /// Starts a unit with [`OLD`] in [`FILE`] and its host key pinned.
    pub(crate) fn new() -> Self {
        let unit = Self::unpinned("ed25519", "internal-sftp");
        unit.pin();
        unit
    }

    /// Starts a unit with an unknown host key of `kind`, and files served by `sftp`.
    pub(crate) fn unpinned(kind: &str, sftp: &str) -> Self {
        let home = open_folder();
        let path = home.path().to_owned();
        let user = User::new(&path);
        fs::create_dir(path.join("tle")).unwrap();
        fs::write(path.join("tle").join(FILE), OLD).unwrap();
        user.own(&path.join("tle"));
        user.own(&path.join("tle").join(FILE));
        fs::create_dir_all("/run/sshd").unwrap();
        let config = path.join("sshd_config");
        let lines = format!(
            "HostKey {0}/host_key\nUsePAM no\nPasswordAuthentication yes\n\
             KbdInteractiveAuthentication no\nAuthorizedKeysFile {0}/authorized\nStrictModes no\n\
             PermitRootLogin no\nAllowUsers {1}\nSubsystem sftp {sftp}\nMaxStartups 100\n",
            path.display(),
            user.name
        );
        fs::write(&config, lines).unwrap();
        let doorman = Doorman::new(move || {
            let mut sshd = Command::new("/usr/sbin/sshd");
            sshd.args(["-i", "-f"]).arg(&config);
            sshd
        });
        let known = KnownHosts::new(path.join("console/known_hosts"));
        let kept = KeptFiles::new(path.join("console/uploads"));
        let unit = Self { doorman, user, known, kept, home };
        unit.make_host_key(kind);
        unit
    }

    /// Gives the unit another host key.
    pub(crate) fn make_host_key(&self, kind: &str) {
        let key = self.host_key();
        if key.exists() {
            fs::remove_file(&key).unwrap();
        }
        run(Command::new("ssh-keygen").args(["-q", "-N", "", "-t", kind, "-f"]).arg(key));
    }

    pub(crate) fn host_key(&self) -> PathBuf {
        self.home.path().join("host_key")
    }

    /// Returns the fingerprint as `ssh-keygen` on the unit shows it.
    pub(crate) fn fingerprint(&self) -> String {
        let shown = run(Command::new("ssh-keygen").arg("-lf").arg(self.host_key()));
        shown.split(' ').nth(1).unwrap().to_owned()
    }

    pub(crate) fn pin(&self) {
        match self.open_as(&self.login(), self.address(), LIMITS) {
            Err(ConnectError::UnknownHostKey(key)) => self.known.pin(&key).unwrap(),
            Err(error) => panic!("{error}"),
            Ok(_) => panic!("a host that nobody knows was trusted"),
        }
    }

    /// Pins the host key at another address too, for a relay in between.
    pub(crate) fn pin_at(&self, address: SocketAddr) {
        let text = fs::read_to_string(self.known.path()).unwrap();
        let direct = format!("[127.0.0.1]:{}", self.address().port());
        let through = text.replace(&direct, &format!("[127.0.0.1]:{}", address.port()));
        fs::write(self.known.path(), format!("{text}{through}")).unwrap();
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.doorman.address()
    }

    pub(crate) fn folder(&self) -> PathBuf {
        self.home.path().join("tle")
    }

    /// Returns the contents of the folder, sorted by name.
    pub(crate) fn files(&self) -> Vec<(String, Vec<u8>)> {
        let entries = fs::read_dir(self.folder()).unwrap().map(|entry| entry.unwrap().path());
        let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
        let mut files: Vec<_> =
            entries.map(|path| (name(&path), fs::read(&path).unwrap())).collect();
        files.sort();
        files
    }

    /// Checks that the folder has the old file and nothing else.
    pub(crate) fn assert_as_before(&self) {
        assert_eq!(self.files(), [(FILE.to_owned(), OLD.to_vec())]);
    }

    pub(crate) fn login(&self) -> Login {
        Login { user: self.user.name.clone(), proof: Proof::Password(PASSWORD.into()) }
    }

    pub(crate) fn open_as(
        &self,
        login: &Login,
        address: SocketAddr,
        limits: Limits,
    ) -> Result<SftpFolder, ConnectError> {
        block_on(self.open_async(login, address, limits))
    }

    async fn open_async(
        &self,
        login: &Login,
        address: SocketAddr,
        limits: Limits,
    ) -> Result<SftpFolder, ConnectError> {
        let (peer, cancel) = (peer(address), CancellationToken::new());
        let folder = self.folder();
        open_sftp(&peer, folder.to_str().unwrap(), login, &self.known, limits, &cancel).await
    }

    /// Uploads `elements` as [`FILE`] through `address`.
    pub(crate) fn upload_by(
        &self,
        address: SocketAddr,
        elements: &TleFile,
        tell: &mut dyn FnMut(Progress),
        cancel: &CancellationToken,
    ) -> Result<Uploaded, UploadError> {
        block_on(async {
            let mut folder = self.open_async(&self.login(), address, LIMITS).await.unwrap();
            let upload = Upload {
                unit: peer(self.address()),
                file: FileName::new(FILE, &ELEMENT_FILES).unwrap(),
                elements: elements.clone(),
            };
            let clock = Clock::system();
            transfer::upload(&mut folder, upload, &self.kept, &clock, tell, cancel).await
        })
    }

    pub(crate) fn upload(&self, elements: &TleFile) -> Result<Uploaded, UploadError> {
        self.upload_by(self.address(), elements, &mut |_| {}, &CancellationToken::new())
    }
}

pub(crate) fn peer(address: SocketAddr) -> Peer {
    Peer { host: address.ip().to_string(), port: address.port() }
}

/// Runs `work` with a time limit.
pub(crate) fn block_on<T>(work: impl Future<Output = T>) -> T {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let most = Duration::from_secs(90);
    runtime
        .block_on(async { tokio::time::timeout(most, work).await })
        .expect("this has to end within its own limits")
}

/// Returns a file of the first `count` bundled objects with distinct names.
pub(crate) fn elements(count: usize) -> TleFile {
    static CATALOG: LazyLock<Catalog> = LazyLock::new(|| bundled().unwrap());
    let mut names = std::collections::BTreeSet::new();
    let is_plain = |elements: &&Elements| {
        !elements.name().contains([',', '*', '$']) && elements.name().len() <= 24
    };
    let chosen = CATALOG.iter().filter(is_plain).filter(|one| names.insert(one.name().to_owned()));
    TleFile::new(chosen.take(count), &ELEMENT_FILES).unwrap()
}
