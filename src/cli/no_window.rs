//! Why a window did not open, in one sentence.

use std::{
    env,
    path::{Path, PathBuf},
};

/// Libraries that the window toolkit opens at run time, any one of those of a row, and the
/// Debian package that brings them.
const OF_X11: [(&[&str], &str); 7] = [
    (&["libX11.so.6"], "libx11-6"),
    (&["libX11-xcb.so.1"], "libx11-xcb1"),
    (&["libXcursor.so.1"], "libxcursor1"),
    (&["libXi.so.6"], "libxi6"),
    (&["libxkbcommon.so.0"], "libxkbcommon0"),
    (&["libxkbcommon-x11.so.0"], "libxkbcommon-x11-0"),
    (&["libEGL.so.1", "libGL.so.1"], "libgl1"),
];

/// The sentence for a display that takes windows and offers nothing to paint them with.
pub(super) fn nothing_paints() -> String {
    let (missing, cure) = if cfg!(feature = "wgpu") {
        ("Vulkan", "A build without `--features wgpu` uses OpenGL instead.")
    } else {
        ("OpenGL", "A build with `--features wgpu` uses Vulkan instead.")
    };
    let problem = || {
        format!("The window could not be opened, because this display offers no {missing}. {cure}")
    };
    no_library().unwrap_or_else(problem)
}

/// The sentence for `error`, as the window toolkit says it.
pub(super) fn reason(error: &str) -> String {
    if let Some(sentence) = no_library() {
        return sentence;
    }
    if error.contains("Failed to open connection to X server") {
        let display = env::var("DISPLAY").unwrap_or_default();
        return format!(
            "The window could not be opened, because no X server answers at DISPLAY={display}."
        );
    }
    format!("The window could not be opened: {}", without_place(error))
}

/// The sentence for a system without a library that the window needs.
fn no_library() -> Option<String> {
    let missing = if cfg!(target_os = "linux") { missing(&folders()) } else { Vec::new() };
    let (library, _) = missing.first()?;
    let packages: Vec<&str> = missing.iter().map(|(_, package)| *package).collect();
    Some(format!(
        "The window could not be opened, because {library} is missing. \
         On Debian and Ubuntu: apt install {}",
        packages.join(" ")
    ))
}

/// The text without the place in the source of a library that stands before it, as in
/// `os error at …/mod.rs:788: Failed to load`.
fn without_place(error: &str) -> &str {
    let Some((_, place)) = error.rsplit_once(".rs:") else { return error };
    place.trim_start_matches(|letter: char| letter.is_ascii_digit() || letter == ':').trim()
}

/// The libraries that are in none of `folders`, with their packages.
fn missing(folders: &[PathBuf]) -> Vec<(&'static str, &'static str)> {
    // An empty file is no library.
    let is_there = |name: &&str| {
        let has = |folder: &PathBuf| {
            folder.join(name).metadata().is_ok_and(|metadata| metadata.len() > 0)
        };
        folders.iter().any(has)
    };
    let left_out = |names: &[&'static str]| match names {
        [first, ..] if !names.iter().any(is_there) => Some(*first),
        _ => None,
    };
    OF_X11.iter().filter_map(|(names, package)| Some((left_out(names)?, *package))).collect()
}

/// Where the loader looks for libraries on the usual distributions.
fn folders() -> Vec<PathBuf> {
    let of_the_machine = format!("{}-linux-gnu", env::consts::ARCH);
    let mut folders: Vec<PathBuf> = env::var_os("LD_LIBRARY_PATH")
        .map(|paths| env::split_paths(&paths).collect())
        .unwrap_or_default();
    for top in ["/lib", "/usr/lib", "/lib64", "/usr/lib64", "/usr/local/lib"] {
        folders.extend([PathBuf::from(top), Path::new(top).join(&of_the_machine)]);
    }
    folders
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn each_missing_library_is_named_with_its_package() {
        let folder = tempfile::tempdir().unwrap();
        let folders = [folder.path().to_owned()];
        for (names, _) in OF_X11 {
            fs::write(folder.path().join(names.last().unwrap()), "ELF").unwrap();
        }
        assert_eq!(missing(&folders), []);
        for (names, package) in OF_X11 {
            let library = folder.path().join(names.last().unwrap());
            fs::write(&library, "").unwrap();
            assert_eq!(missing(&folders), [(*names.first().unwrap(), package)]);
            fs::write(&library, "ELF").unwrap();
        }
    }

    #[test]
    fn the_place_in_a_library_is_left_out() {
        let error = "winit EventLoopError: os error at /root/x/linux/mod.rs:788: No luck: at all";
        assert_eq!(without_place(error), "No luck: at all");
        assert_eq!(without_place("No luck"), "No luck");
    }
}
