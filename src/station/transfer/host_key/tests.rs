use super::*;

const ONE: &str =
    "ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAICpcOM1dV6aTLHjQBB0PQ023XX9N5YWJkobDs9b7Ga5U one";
const TWO: &str =
    "ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAIEW3EBo4Em16hrVMZDUQcg7v/Pq35hmOWjXp9At0UPIZ two";
const THREE: &str = "ecdsa-sha2-nistp256 AAAAE2VjZHNhLXNoYTItbmlzdHAyNTYAAAAIbmlzdHAyNTYAAABBBNScV7mmYjyBcEGsexCE0NZ91vQYRuqXzQBkeUd0pm12GMbWeYI6IzLmSd027PotffSnxW4oNI3oyTL5gqR4Yo8= three";
/// Fingerprint in the form of `ssh-keygen -lf`.
const FINGERPRINT_ONE: &str = "SHA256:xtHUAijFzjeZW7nK3IjuWlIEdn00NF3KRrYerlaM/vk";

fn offered(host: &str, port: u16, key: &str) -> OfferedKey {
    OfferedKey::new(host, port, key.parse().unwrap())
}

/// Returns a file with `text`, and its folder, which must stay alive.
fn file(text: &str) -> (tempfile::TempDir, KnownHosts) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("known_hosts");
    fs::write(&path, text).unwrap();
    (folder, KnownHosts::new(path))
}

#[test]
fn a_key_is_asked_about_once_then_pinned_and_another_refused() {
    let folder = tempfile::tempdir().unwrap();
    let known_hosts = KnownHosts::new(folder.path().join("deeper").join("known_hosts"));
    let good = offered("Unit", 22, ONE);
    assert_eq!(known_hosts.check(&good).unwrap(), KeyVerdict::Unknown);
    known_hosts.pin(&good).unwrap();
    assert_eq!(known_hosts.check(&good).unwrap(), KeyVerdict::Pinned);
    assert_eq!(known_hosts.check(&offered("unit", 22, ONE)).unwrap(), KeyVerdict::Pinned);
    let changed = KeyVerdict::Changed { pinned: vec![FINGERPRINT_ONE.to_owned()] };
    assert_eq!(known_hosts.check(&offered("unit", 22, TWO)).unwrap(), changed);
    // A key of another algorithm counts as changed; otherwise an attacker could bypass the pin.
    assert_eq!(known_hosts.check(&offered("unit", 22, THREE)).unwrap(), changed);
    assert_eq!(known_hosts.check(&offered("unit", 2222, TWO)).unwrap(), KeyVerdict::Unknown);
    assert_eq!(known_hosts.check(&offered("unit2", 22, TWO)).unwrap(), KeyVerdict::Unknown);
}

#[test]
fn the_file_is_openssh_s() {
    let (_folder, known_hosts) = file(
        "# mine\nold ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAIEW3EBo4Em16hrVMZDUQcg7v/Pq35hmOWjXp9At0UPIZ",
    );
    known_hosts.pin(&offered("192.0.2.7", 22, ONE)).unwrap();
    known_hosts.pin(&offered("fe80::1", 2222, THREE)).unwrap();
    let text = fs::read_to_string(known_hosts.path()).unwrap();
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(lines[0], "# mine");
    assert_eq!(format!("{} one", lines[2]), format!("192.0.2.7 {ONE}"));
    assert_eq!(format!("{} three", lines[3]), format!("[fe80::1]:2222 {THREE}"));
    assert_eq!(known_hosts.check(&offered("old", 22, TWO)).unwrap(), KeyVerdict::Pinned);
    let kinds = known_hosts.algorithms("fe80::1", 2222).unwrap();
    assert_eq!(kinds.iter().map(ToString::to_string).collect::<Vec<_>>(), ["ecdsa-sha2-nistp256"]);
}

#[test]
fn lines_of_other_kinds_pin_nothing() {
    let text = format!(
        "*.example {ONE}\n@cert-authority unit {ONE}\nother,unit,third {TWO}\n\
         |1|O33ESRMWPVkMYIwJ1Uw+n877jTo=|nuuC5vEqXlEZ/8BXQR7m619W6Ak= {ONE}\n"
    );
    let (_folder, known_hosts) = file(&text);
    assert_eq!(known_hosts.check(&offered("a.example", 22, ONE)).unwrap(), KeyVerdict::Unknown);
    assert_eq!(known_hosts.check(&offered("example.com", 22, ONE)).unwrap(), KeyVerdict::Unknown);
    assert_eq!(known_hosts.check(&offered("unit", 22, TWO)).unwrap(), KeyVerdict::Pinned);
    assert!(matches!(
        known_hosts.check(&offered("unit", 22, ONE)).unwrap(),
        KeyVerdict::Changed { .. }
    ));
}

#[test]
fn a_revoked_key_is_refused_even_when_it_is_pinned_and_stays_so() {
    let (_folder, known_hosts) = file(&format!("@revoked unit {ONE}\nunit {ONE}\nunit {TWO}\n"));
    assert_eq!(known_hosts.check(&offered("unit", 22, ONE)).unwrap(), KeyVerdict::Revoked);
    assert_eq!(known_hosts.check(&offered("unit", 22, TWO)).unwrap(), KeyVerdict::Pinned);
    known_hosts.forget("unit", 22).unwrap();
    assert_eq!(known_hosts.check(&offered("unit", 22, ONE)).unwrap(), KeyVerdict::Revoked);
    assert_eq!(known_hosts.check(&offered("unit", 22, TWO)).unwrap(), KeyVerdict::Unknown);
}

#[test]
fn a_damaged_file_never_makes_a_known_host_unknown() {
    let (_folder, known_hosts) = file(&format!("# x\n\nunit {}\n", &ONE[..40]));
    let error = known_hosts.check(&offered("unit", 22, TWO)).unwrap_err();
    assert!(matches!(error, KnownHostsError::Line { line: 3, .. }), "{error}");
    // A folder in place of the file is unreadable too.
    let folder = tempfile::tempdir().unwrap();
    let error = KnownHosts::new(folder.path()).check(&offered("unit", 22, TWO)).unwrap_err();
    assert!(matches!(error, KnownHostsError::Disk { .. }), "{error}");
}

#[test]
fn forgetting_a_host_leaves_the_others() {
    let (_folder, known_hosts) = file(&format!("# mine\nunit {ONE}\n[unit]:2222 {TWO}\n"));
    known_hosts.forget("UNIT", 22).unwrap();
    let text = fs::read_to_string(known_hosts.path()).unwrap();
    assert_eq!(text, format!("# mine\n[unit]:2222 {TWO}\n"));
}
