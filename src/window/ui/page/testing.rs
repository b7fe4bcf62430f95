//! Tests of pages, as Chromium prints and shows them.

use std::{fs, path::Path, process::Command};

/// Size of an A4 page at 96 dots an inch, and its min white margin after rounding, pixels.
const SIZE_PX: [u32; 2] = [794, 1123];
const MARGIN_PX: u32 = 36;
/// Height of the page foot that contains the last line, pixels.
const FOOT_PX: u32 = 24;

fn chromium(page: &Path, option: &str) {
    let run = Command::new("chromium")
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"])
        .args(["--no-pdf-header-footer", option])
        .arg(format!("--window-size={},{}", SIZE_PX[0], SIZE_PX[1]))
        .arg(format!("file://{}", page.display()))
        .output();
    let run = run.expect("Chromium is installed");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

/// Checks that Chromium prints a page on one sheet of A4. The image must keep within the margins
/// and end with the last line of the page.
pub(in crate::ui) fn prints_on_one_sheet(html: &str) {
    let folder = tempfile::tempdir().unwrap();
    let [page, pdf, picture] =
        ["page.html", "page.pdf", "page.png"].map(|name| folder.path().join(name));
    fs::write(&page, html).unwrap();
    chromium(&page, &format!("--print-to-pdf={}", pdf.display()));
    let pdf = fs::read(pdf).unwrap();
    let pdf = String::from_utf8_lossy(&pdf);
    let sheets = pdf.split("/Type /Page").skip(1).filter(|rest| !rest.starts_with('s')).count();
    assert_eq!(sheets, 1);
    // 210 mm by 297 mm in points.
    assert!(pdf.contains("/MediaBox [0 0 594.95") || pdf.contains("/MediaBox [0 0 595"));

    chromium(&page, &format!("--screenshot={}", picture.display()));
    let picture = image::open(picture).unwrap().into_luma8();
    assert_eq!(picture.dimensions(), (SIZE_PX[0], SIZE_PX[1]));
    let dark = |[left, top, right, bottom]: [u32; 4]| {
        let places = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
        places.filter(|(x, y)| picture.get_pixel(*x, *y).0[0] < 128).count()
    };
    let [width, height] = SIZE_PX;
    for white in [
        [0, 0, width, MARGIN_PX],
        [0, 0, MARGIN_PX, height],
        [width - MARGIN_PX, 0, width, height],
        [0, height - MARGIN_PX, width, height],
    ] {
        assert_eq!(dark(white), 0, "{white:?}");
    }
    let foot = [0, height - MARGIN_PX - FOOT_PX, width, height - MARGIN_PX];
    assert!(dark(foot) > 20, "the last line is missing");
}
