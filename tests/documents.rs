//! Checks of the documents' statements about the code.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use azel::controller::SPECS;

/// Adds the Rust files below `folder` to `found`, with their paths from the top and their texts.
fn sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push((path.display().to_string(), fs::read_to_string(&path).unwrap()));
        }
    }
}

#[test]
fn every_test_that_the_fault_matrix_names_is_there() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    sources(&top.join("src"), &mut files);
    sources(&top.join("tests"), &mut files);
    let matrix = fs::read_to_string(top.join("docs/reliability.md")).unwrap();
    let quoted = matrix.split('`').skip(1).step_by(2);
    let named: Vec<(&str, &str)> = quoted.filter_map(|words| words.split_once(".rs::")).collect();
    assert!(named.len() > 100, "{}", named.len());
    for (file, test) in named {
        let ends = format!("/{file}.rs");
        let head = format!("fn {test}(");
        let is_there =
            files.iter().any(|(path, text)| path.ends_with(&ends) && text.contains(&head));
        assert!(is_there, "{file}.rs has no {test}");
    }
    assert!(!matrix.contains("not tested"), "a fault is not tested");
}

#[test]
fn every_figure_of_the_fault_matrix_is_a_constant() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let matrix = fs::read_to_string(top.join("docs/reliability.md")).unwrap();
    let figures = matrix.split_once("## Figures").unwrap().1;
    let mut read = 0;
    for row in figures.lines().filter(|row| row.starts_with('|')) {
        let mut text = String::new();
        for words in row.split('`').skip(1).step_by(2) {
            if words.starts_with("src/") {
                text = fs::read_to_string(top.join(words)).unwrap();
                continue;
            }
            assert!(text.contains(&format!("const {words}: ")), "{row}");
            read += 1;
        }
    }
    assert!(read > 50, "{read}");
}

/// Returns the part of a file above its tests.
fn product(text: &str) -> &str {
    const HEAD: &str = "#[cfg(test)]\n";
    let is_module = |line: &str| line.contains("mod ") && line.ends_with('{');
    let opens = |at: &usize| text[at + HEAD.len()..].lines().next().is_some_and(is_module);
    let tests = text.match_indices(HEAD).map(|(at, _)| at).find(opens);
    &text[..tests.unwrap_or(text.len())]
}

/// Folders of packages that contain several layers.
const PACKAGES: [&str; 3] = ["station/", "units/", "window/"];
/// Layers inside the orbit package.
const IN_ORBIT: [&str; 2] = ["astro", "name"];

/// Returns the path of a file within its package, from its path below `src`.
fn in_package(path: &str) -> &str {
    PACKAGES.iter().find_map(|package| path.strip_prefix(package)).unwrap_or(path)
}

/// Returns the layer of a file, from its path below `src`.
fn layer(path: &str) -> &str {
    let mut parts = in_package(path).split('/').map(|part| part.trim_end_matches(".rs"));
    let layer = parts.next().unwrap_or_default();
    let inner = parts.next().filter(|inner| layer == "orbit" && IN_ORBIT.contains(inner));
    inner.unwrap_or(layer)
}

/// Returns the layers that a text names after `crate::`, also in braces.
fn named(text: &str) -> BTreeSet<String> {
    let word = |text: &str| -> String {
        text.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect()
    };
    let mut found = BTreeSet::new();
    for (at, head) in text.match_indices("crate::") {
        let rest = &text[at + head.len()..];
        let Some(list) = rest.strip_prefix('{') else {
            found.insert(word(rest));
            continue;
        };
        let (mut depth, mut begins) = (0, true);
        for (at, letter) in list.char_indices() {
            match letter {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => begins = true,
                _ if begins && letter.is_alphabetic() => {
                    found.insert(word(&list[at..]));
                    begins = false;
                }
                _ => {}
            }
        }
    }
    found
}

/// Returns the layers that each layer may use, directly or indirectly, from the table in
/// `docs/architecture.md`.
fn allowed() -> BTreeMap<String, BTreeSet<String>> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(top.join("docs/architecture.md")).unwrap();
    let mut layers = BTreeMap::<String, BTreeSet<String>>::new();
    for line in text.lines().filter(|line| line.starts_with("| `src/")) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let [names, _, may_know] = cells[..] else { panic!("{line}") };
        let mut knows = BTreeSet::new();
        for name in may_know.trim_end_matches('|').trim().split(", ") {
            match name {
                "nothing" => {}
                "all above" => knows.extend(layers.keys().cloned()),
                name => {
                    knows.insert(name.to_owned());
                    knows.extend(layers.get(name).into_iter().flatten().cloned());
                }
            }
        }
        for name in names.split(", ") {
            let name = name.trim_matches('`').trim_start_matches("src/");
            layers.insert(layer(name).to_owned(), knows.clone());
        }
    }
    layers
}

#[test]
fn a_layer_names_only_those_that_the_architecture_text_allows() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&top, &mut files);
    let allowed = allowed();
    let (mut wrong, mut read) = (Vec::new(), 0);
    for (path, text) in &files {
        let path = Path::new(path).strip_prefix(&top).unwrap();
        let path = path.display().to_string().replace('\\', "/");
        let is_test = path.split('/').any(|part| ["tests", "testing"].contains(&part))
            || ["tests.rs", "testing.rs"].iter().any(|end| path.ends_with(end))
            || path.starts_with("painter/");
        if is_test || in_package(&path) == "lib.rs" {
            continue;
        }
        let layer = layer(&path);
        let knows = allowed.get(layer).unwrap_or_else(|| panic!("{layer} is in no row"));
        read += 1;
        // Contract modules have the names of the layers that fill them.
        let is_own = |other: &str| {
            layer == "contract" && top.join(layer).join(other).with_extension("rs").exists()
        };
        for other in named(product(text)) {
            if other != layer
                && !is_own(&other)
                && allowed.contains_key(&other)
                && !knows.contains(&other)
            {
                wrong.push(format!("{path}: {other}"));
            }
        }
    }
    assert!(read > 400, "{read}");
    assert_eq!(wrong, [""; 0], "not below");
}

#[test]
fn every_test_file_is_part_of_a_test_binary() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| fs::read_to_string(top.join(path)).unwrap();
    let manifest = read("Cargo.toml");
    let binaries = read("tests/azel.rs") + &read("tests/processes.rs");
    for entry in fs::read_dir(top.join("tests")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let Some(name) = name.strip_suffix(".rs") else { continue };
        let is_named = manifest.contains(&format!("[[test]]\nname = \"{name}\""))
            || binaries.contains(&format!("\nmod {name};"));
        assert!(is_named, "nothing runs tests/{name}.rs");
    }
}

/// Returns `true` if a file may name a make: the make's own folders, the lists of makes, and the
/// simulators.
fn may_name_a_make(path: &str, makes: &BTreeSet<String>) -> bool {
    let mut parts = path.split('/').map(|part| part.trim_end_matches(".rs"));
    let lists = [
        "controller.rs",
        "demo.rs",
        "engine/demo.rs",
        "protocol.rs",
        "sim.rs",
        "ui/antennas/makes.rs",
    ];
    parts.any(|part| makes.contains(part))
        || path.starts_with("makes")
        || path.starts_with("sim/")
        || lists.contains(&path)
}

#[test]
fn no_make_is_named_outside_of_its_folders() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&top, &mut files);
    let below = format!("{}/", top.display()).replace('\\', "/");
    let folders = fs::read_dir(top.join("units/controller")).unwrap().map(|entry| entry.unwrap());
    let folders = folders.filter(|entry| entry.file_type().unwrap().is_dir());
    let makes: BTreeSet<String> =
        folders.map(|entry| entry.file_name().into_string().unwrap()).collect();
    assert_eq!(makes.len(), SPECS.len(), "{makes:?}");
    // Spellings of each make: as a folder, as a type, and in the station file.
    let mut words: BTreeSet<String> = makes.iter().map(|make| make.replace('_', "")).collect();
    words.extend(SPECS.iter().map(|make| make.key.to_owned()));
    let mut named = BTreeSet::new();
    for (path, text) in &files {
        let path = path.replace('\\', "/").strip_prefix(&below).unwrap().to_owned();
        let is_test = ["tests", "stories", "testing"].iter().any(|word| path.contains(word));
        if is_test || may_name_a_make(in_package(&path), &makes) {
            continue;
        }
        let code = product(text).lines().map(|line| line.split("//").next().unwrap_or_default());
        let code = code.collect::<Vec<_>>().join("\n").to_lowercase();
        if words.iter().any(|make| code.contains(make)) {
            named.insert(path);
        }
    }
    assert_eq!(named, BTreeSet::new());
}

#[test]
fn what_drives_is_named_by_no_view() {
    const OF_THE_DRIVER: [&str; 6] =
        ["AntennaHandle", "Controller", "Device", "Gate", "Session", "Stopper"];
    const OF_THE_STATION: [&str; 3] = ["Client", "Engine", "Handle"];
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&top, &mut files);
    let (mut wrong, mut read) = (Vec::new(), 0);
    for (path, text) in &files {
        let path = Path::new(path).strip_prefix(&top).unwrap();
        let path = path.display().to_string().replace('\\', "/");
        let names = |words: &[&str]| {
            let code = product(text).lines().filter(|line| !line.trim_start().starts_with("//"));
            let code: String = code.collect::<Vec<_>>().join("\n").replace("::Controller(", "");
            let mut found = code.split(|letter: char| !letter.is_alphanumeric());
            found.any(|word| words.contains(&word))
        };
        let is_wrong = match layer(&path) {
            // `model.rs` may take snapshots through the handle, but must not keep anything that
            // sends commands.
            "model" if path == "model.rs" => names(&OF_THE_DRIVER) || names(&["Client", "Engine"]),
            "ui" | "model" => names(&OF_THE_DRIVER) || names(&OF_THE_STATION),
            "app" => names(&OF_THE_DRIVER) || names(&["Engine"]),
            _ => continue,
        };
        read += 1;
        if is_wrong {
            wrong.push(path);
        }
    }
    assert!(read > 100, "{read}");
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Returns the documents at the top, in `docs` and in `docs/operator`.
fn documents() -> Vec<PathBuf> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["docs", "docs/operator"].map(|folder| top.join(folder));
    let entries = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let paths = entries.map(|entry| entry.unwrap().path());
    let pages = paths.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    let at_the_top = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| top.join(name));
    pages.chain(at_the_top).collect()
}

/// Returns the anchors of a document's headings, as GitHub makes them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut is_code = false;
    let mut found = BTreeSet::new();
    for line in text.lines() {
        is_code ^= line.starts_with("```");
        let Some(heading) = line.strip_prefix('#').filter(|_| !is_code) else { continue };
        let kept =
            heading.trim_start_matches('#').trim().chars().filter_map(|letter| match letter {
                ' ' => Some('-'),
                '-' | '_' => Some(letter),
                _ if letter.is_alphanumeric() => Some(letter),
                _ => None,
            });
        found.insert(kept.collect::<String>().to_lowercase());
    }
    found
}

#[test]
fn every_link_between_the_documents_leads_to_a_file_and_a_heading() {
    let (mut broken, mut read) = (Vec::new(), 0);
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for target in targets.filter(|target| !target.contains("://")) {
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path = match file {
                "" => document.clone(),
                file => document.parent().unwrap().join(file),
            };
            let leads = path.exists()
                && (anchor.is_empty()
                    || anchors(&fs::read_to_string(&path).unwrap()).contains(anchor));
            read += 1;
            if !leads {
                broken.push(format!("{}: {target}", document.display()));
            }
        }
    }
    assert!(read > 60, "{read}");
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn every_path_that_the_documents_name_is_there() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    sources(&top.join("src"), &mut files);
    sources(&top.join("tests"), &mut files);
    let (mut gone, mut read) = (Vec::new(), 0);
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        for path in
            text.split('`').skip(1).step_by(2).filter(|path| !path.contains(['<', '*', ' ']))
        {
            let path = path.split("::").next().unwrap_or_default();
            let is_whole = ["src/", "tests/", "benches/", "docs/", "assets/"]
                .iter()
                .any(|folder| path.starts_with(folder));
            // A document may give only the end of a path if the sentence names the folder.
            let end = format!("/{path}");
            let is_source = Path::new(path).extension().is_some_and(|of| of == "rs");
            let is_end = path.contains('/') && is_source;
            let is_there = match (is_whole, is_end) {
                (true, _) => top.join(path).exists(),
                (false, true) => files.iter().any(|(file, _)| file.ends_with(&end)),
                (false, false) => continue,
            };
            read += 1;
            if !is_there {
                gone.push(format!("{}: {path}", document.display()));
            }
        }
    }
    assert!(read > 150, "{read}");
    assert!(gone.is_empty(), "{gone:#?}");
}
