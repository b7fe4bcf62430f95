//! What the documents say of the code is there.

#[cfg(test)]
mod documents {
    use std::{fs, path::Path};

    /// Every Rust file below `folder`, by its path from the top and with its text.
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
        let named: Vec<(&str, &str)> =
            quoted.filter_map(|words| words.split_once(".rs::")).collect();
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
}
