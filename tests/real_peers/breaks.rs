//! Links that break, stall or are given up during an upload.

use azel::{
    contract::transfer::{TleFile, UploadStep},
    transfer::{CancellationToken, FolderError, FolderState, UploadError, UploadReason},
};

use super::{
    narrow::{Narrow, Then},
    unit::{FILE, LIMITS, OLD, Unit, elements},
};

/// Uploads over a link that ends in the middle of the new file.
fn broken(unit: &Unit, new: &TleFile, then: Then) -> UploadError {
    let link = Narrow::new(unit.address(), new.bytes().len() / 2, then);
    unit.pin_at(link.address());
    let nobody = CancellationToken::new();
    unit.upload_by(link.address(), new, &mut |_| {}, &nobody).unwrap_err()
}

/// Checks that the old file is in its place, and that the next upload leaves nothing else
/// behind.
fn assert_mended(unit: &Unit, new: &TleFile) {
    let old = unit.files().into_iter().find(|(name, _)| name == FILE).unwrap();
    assert_eq!(old.1, OLD);
    unit.upload(new).unwrap();
    assert_eq!(unit.files(), [(FILE.to_owned(), new.bytes().to_vec())]);
}

#[test]
#[ignore = "needs sshd and root"]
fn a_cut_in_the_middle_leaves_the_old_file() {
    let (unit, new) = (Unit::new(), elements(2000));
    let error = broken(&unit, &new, Then::Cut);
    assert!(matches!(error.reason, UploadReason::Folder(FolderError::Lost)), "{error}");
    assert_eq!(error.step, UploadStep::Write);
    assert!(matches!(error.state, FolderState::Leftover { .. }), "{error}");
    assert_mended(&unit, &new);
}

#[test]
#[ignore = "needs sshd and root"]
fn a_stall_in_the_middle_ends_by_its_limit_and_leaves_the_old_file() {
    let (unit, new) = (Unit::new(), elements(2000));
    let error = broken(&unit, &new, Then::Stall);
    let late = FolderError::TimedOut(LIMITS.request);
    assert!(matches!(&error.reason, UploadReason::Folder(reason) if *reason == late), "{error}");
    assert!(matches!(error.state, FolderState::Leftover { .. }), "{error}");
    assert_mended(&unit, &new);
}

#[test]
#[ignore = "needs sshd and root"]
fn a_cancel_in_the_middle_leaves_the_folder_as_it_was() {
    let (unit, new) = (Unit::new(), elements(2000));
    let cancel = CancellationToken::new();
    let mut tell = |progress: azel::contract::transfer::Progress| {
        if progress.step == UploadStep::Write && progress.done_bytes > 0 {
            cancel.cancel();
        }
    };
    let error = unit.upload_by(unit.address(), &new, &mut tell, &cancel).unwrap_err();
    assert!(matches!(error.reason, UploadReason::Cancelled), "{error}");
    assert_eq!((error.step, &error.state), (UploadStep::Write, &FolderState::AsBefore));
    unit.assert_as_before();
}
