//! Acts of an operator and their results.

use super::screen::{Satrak, Screen, wait_for};

/// Switches to Manual and holds the key X+ until the unit receives the motion. Repeats the clicks,
/// because a click before the window shows the key does nothing.
fn hold_x_plus(screen: &Screen, satrak: &mut Satrak) {
    let mut attempts = 0..;
    wait_for("the jog", || {
        screen.press_x_plus(attempts.next()?);
        let moved = satrak.line_soon("in payload=MOVE=,0.5,0");
        if moved.is_none() {
            screen.release_key();
        }
        moved
    });
}

#[test]
#[ignore = "needs Xvfb, xdotool, ImageMagick and OpenGL"]
fn the_demo_station_shows_a_moving_picture() {
    let screen = Screen::new("1440x900");
    let (_azel, _) = screen.azel(&[]);
    let first = wait_for("a picture", || {
        let picture = screen.picture();
        let colours: std::collections::HashSet<&[u8]> = picture.chunks_exact(3).collect();
        (colours.len() > 200).then_some(picture)
    });
    wait_for("a change of the picture", || (screen.picture() != first).then_some(()));
}

#[test]
#[ignore = "needs Xvfb, xdotool, ImageMagick and OpenGL"]
fn a_jog_ends_with_its_key_with_esc_and_with_the_window() {
    let screen = Screen::new("1440x900");
    let mut satrak = Satrak::start("127.0.0.1:0");
    let station = screen.station_file(satrak.address);
    let (mut azel, window) = screen.azel(&["--station", &station.to_string_lossy()]);
    satrak.wait_for_line("out payload=STATUS?");
    satrak.wait_for_line("out payload=STATUS?");

    hold_x_plus(&screen, &mut satrak);
    screen.release_key();
    satrak.wait_for_line("in payload=STOP=");

    hold_x_plus(&screen, &mut satrak);
    screen.xdotool(&["key", "Escape"]);
    satrak.wait_for_line("in payload=STOP=");
    screen.release_key();

    hold_x_plus(&screen, &mut satrak);
    // The window asks about the moving antenna, and the question ends the held key.
    screen.close(&window);
    satrak.wait_for_line("in payload=STOP=");
    screen.release_key();
    screen.xdotool(&["key", "Escape"]);
    satrak.wait_for_line("in payload=STOP=");
    wait_for("proved standstill", || (screen.marks() == 0).then_some(()));
    std::thread::sleep(std::time::Duration::from_secs(1));
    // On a slow screen, a late frame may end the jog before the question. The first request then
    // closes the window.
    if azel.runs() {
        screen.close(&window);
    }
    assert_eq!(azel.exit_code(), Some(0));
}

#[test]
#[ignore = "needs Xvfb, xdotool, ImageMagick and OpenGL"]
fn a_unit_that_comes_back_is_read_again() {
    let screen = Screen::new("1440x900");
    let mut satrak = Satrak::start("127.0.0.1:0");
    let address = satrak.address;
    let station = screen.station_file(address);
    let (_azel, _) = screen.azel(&["--station", &station.to_string_lossy()]);
    satrak.wait_for_line("out payload=STATUS?");
    drop(satrak);
    let mut satrak = Satrak::start(&address.to_string());
    satrak.wait_for_line("in payload=VERSION?");
    satrak.wait_for_line("in payload=STATUS?");
}
