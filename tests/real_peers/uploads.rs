//! Successful uploads, roll-backs, and folders that refuse.

use std::{fs, os::unix::fs::PermissionsExt as _, process::Command};

use azel::{
    contract::transfer::{FileHash, Origin, UploadStep},
    transfer::{CancellationToken, FolderError, FolderState, UploadReason},
};

use super::{
    unit::{FILE, OLD, Unit, elements, peer},
    user::run,
};

#[test]
#[ignore = "needs sshd and root"]
fn an_upload_is_proved_and_can_be_rolled_back() {
    let unit = Unit::new();
    let path = unit.folder().join(FILE);
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    let new = elements(1500);
    let mut steps = Vec::new();
    let proof = unit
        .upload_by(
            unit.address(),
            &new,
            &mut |progress| {
                steps.push(progress.step);
                assert!(
                    progress.step != UploadStep::Write
                        || progress.done_bytes <= progress.file_bytes
                );
            },
            &CancellationToken::new(),
        )
        .unwrap();
    steps.dedup();
    assert_eq!(steps.len(), 6);
    assert_eq!(unit.files(), [(FILE.to_owned(), new.bytes().to_vec())]);
    assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o7777, 0o640);
    let sum = run(Command::new("sha256sum").arg(&path));
    assert!(sum.starts_with(&proof.sha256.to_string()), "{sum}");
    assert_eq!((proof.bytes, proof.objects.len()), (new.bytes().len() as u64, 1500));
    assert!(proof.oldest_age_s(proof.time).unwrap() > 0.0);

    let kept = unit.kept.list(&peer(unit.address()).to_string(), FILE).unwrap();
    let origins: Vec<_> = kept.iter().map(|one| one.origin).collect();
    assert_eq!(origins, [Origin::Uploaded, Origin::Found]);
    let old = unit.kept.read(&kept[1]).unwrap();
    let back = unit.upload(&old).unwrap();
    assert_eq!(back.sha256, FileHash::new(OLD));
    unit.assert_as_before();
}

#[test]
#[ignore = "needs sshd and root"]
fn a_unit_without_the_file_gets_it() {
    let unit = Unit::new();
    fs::remove_file(unit.folder().join(FILE)).unwrap();
    let new = elements(3);
    unit.upload(&new).unwrap();
    assert_eq!(unit.files(), [(FILE.to_owned(), new.bytes().to_vec())]);
}

#[test]
#[ignore = "needs sshd and root"]
fn a_server_that_cannot_replace_in_one_step_gets_two() {
    let unit = Unit::unpinned("rsa", "internal-sftp -P posix-rename");
    unit.pin();
    let new = elements(3);
    unit.upload(&new).unwrap();
    assert_eq!(unit.files(), [(FILE.to_owned(), new.bytes().to_vec())]);
    // Simulate an upload that broke off between its two steps. The next upload finds the old
    // elements.
    let path = unit.folder().join(FILE);
    fs::rename(&path, path.with_file_name(format!("{FILE}.azel-old"))).unwrap();
    unit.upload(&elements(4)).unwrap();
    assert_eq!(unit.files(), [(FILE.to_owned(), elements(4).bytes().to_vec())]);
    let kept = unit.kept.list(&peer(unit.address()).to_string(), FILE).unwrap();
    assert_eq!(kept[1].sha256, new.hash());
}

#[test]
#[ignore = "needs sshd and root"]
fn a_folder_that_may_only_be_read_is_told() {
    let unit = Unit::new();
    fs::set_permissions(unit.folder(), fs::Permissions::from_mode(0o555)).unwrap();
    let error = unit.upload(&elements(3)).unwrap_err();
    assert!(matches!(error.reason, UploadReason::Folder(FolderError::Denied)), "{error}");
    assert_eq!(error.step, UploadStep::Write);
    unit.assert_as_before();
}

#[test]
#[ignore = "needs sshd and root"]
fn a_folder_that_is_missing_is_told() {
    let unit = Unit::new();
    fs::rename(unit.folder(), unit.home.path().join("elsewhere")).unwrap();
    let error = unit.upload(&elements(3)).unwrap_err();
    assert!(matches!(error.reason, UploadReason::Folder(FolderError::Missing)), "{error}");
    assert_eq!(error.state, FolderState::AsBefore);
}

#[test]
#[ignore = "needs sshd and root"]
fn a_full_disk_leaves_the_old_file_and_nothing_else() {
    let unit = Unit::new();
    let folder = unit.folder();
    let disk = Disk::small(&folder);
    fs::write(folder.join(FILE), OLD).unwrap();
    unit.user.own(&folder);
    unit.user.own(&folder.join(FILE));
    let new = elements(2000);
    assert!(new.bytes().len() > 256 << 10);
    let error = unit.upload(&new).unwrap_err();
    assert!(matches!(error.reason, UploadReason::Folder(FolderError::DiskFull { .. })), "{error}");
    assert_eq!((error.step, &error.state), (UploadStep::Write, &FolderState::AsBefore));
    unit.assert_as_before();
    drop(disk);
}

/// A disk of 128 kB mounted on a folder.
struct Disk<'a>(&'a std::path::Path);

impl<'a> Disk<'a> {
    fn small(folder: &'a std::path::Path) -> Self {
        run(Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=128k", "azel-test"])
            .arg(folder));
        Self(folder)
    }
}

impl Drop for Disk<'_> {
    fn drop(&mut self) {
        // A server of the test may still use the disk.
        let _ = Command::new("umount").arg("-l").arg(self.0).status();
    }
}
