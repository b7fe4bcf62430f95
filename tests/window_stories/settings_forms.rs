//! Settings forms of a unit, and the steps of the stories with each.

/// Steps with one form.
pub(crate) struct Story {
    pub(crate) group: &'static str,
    /// Name of the tab that has the form.
    pub(crate) tab: Option<&'static str>,
    pub(crate) is_service: bool,
    /// Choice that the story makes first and sends along with the first change.
    pub(crate) choice: Option<(&'static str, &'static str)>,
    /// Values that the story types one after the other, with the unit's next answer to `query`. The
    /// story checks the state of the last field.
    pub(crate) rounds: [(&'static [(&'static str, &'static str)], &'static str); 3],
    pub(crate) query: &'static str,
    /// Payload that another client sends in between; `None` if the unit reports no value that could
    /// change.
    pub(crate) foreign: Option<&'static str>,
}

pub(crate) const GENERAL: Story = Story {
    group: "general",
    tab: None,
    is_service: false,
    choice: Some(("Clock from GPS", "Off")),
    rounds: [
        (&[("Azimuth offset", "0.15"), ("Elevation threshold", "4")], "SETTINGS?,0,0,0.15,"),
        (&[("Elevation threshold", "5")], ",0,5.0"),
        (&[("Elevation threshold", "6.5")], ",0,6.5"),
    ],
    query: "SETTINGS?",
    foreign: Some("SETTINGS=,?,?,?,?,?,?,7.5,?,?,?,?"),
};

pub(crate) const GPS: Story = Story {
    group: "gps",
    tab: None,
    is_service: false,
    choice: Some(("Position from GPS", "Off")),
    rounds: [
        (&[("Latitude", "41.5")], "GPS_SETTINGS?,0,41.50N,"),
        (&[("Latitude", "33.86S")], ",33.86S,"),
        (&[("Latitude", "1N")], ",1.00N,"),
    ],
    query: "GPS_SETTINGS?",
    foreign: Some("GPS_SETTINGS=,0,41.50N,12.00W"),
};

pub(crate) const WINDOW: Story = Story {
    group: "window",
    tab: None,
    is_service: false,
    choice: None,
    rounds: [
        (
            &[("Start", "2026-08-12 12:00:00"), ("Stop", "2026-08-12 12:10:00")],
            "START_STOP_TIME?,12,0,0,12,8,2026,12,10,0,12,8,2026",
        ),
        (&[("Stop", "2026-08-12 12:11:30Z")], ",12,11,30,12,8,2026"),
        (&[("Stop", "2026-08-12 12:12:00")], ",12,12,0,12,8,2026"),
    ],
    query: "START_STOP_TIME?",
    foreign: Some("START_STOP_TIME=,11,59,0,12,8,2026,12,10,0,12,8,2026"),
};

pub(crate) const FILE: Story = Story {
    group: "file",
    tab: Some("File"),
    is_service: false,
    choice: Some(("Keep present track", "On")),
    rounds: [
        (
            &[("TLE file", "active.txt"), ("Satellite", "NOAA 20 (JPSS-1)")],
            ",NOAA 20 (JPSS-1),1,43013",
        ),
        (&[("Satellite", "ISS (ZARYA)")], ",ISS (ZARYA),"),
        (&[("Satellite", "SUOMI NPP")], ",SUOMI NPP,"),
    ],
    query: "SATELLITE?",
    foreign: Some("SATELLITE=,active.txt,NOAA 20 (JPSS-1),9,1"),
};

pub(crate) const WEB: Story = Story {
    group: "web",
    tab: Some("Web"),
    is_service: false,
    choice: Some(("When a fetch fails", "Continue")),
    rounds: [
        (&[("Web address", "https://example.org/a?b=1,2")], "/a?b=1%2C2,1,1"),
        (&[("Update period", "3")], ",3,1"),
        (&[("Update period", "4")], ",4,1"),
    ],
    query: "SATELLITE_HTTP?",
    foreign: Some("SATELLITE_HTTP=,https://example.org/b,1,1,0"),
};

pub(crate) const FTP: Story = Story {
    group: "ftp",
    tab: Some("FTP"),
    is_service: false,
    choice: Some(("When a fetch fails", "Continue")),
    rounds: [
        (
            &[
                ("Server address", "10.0.1.2"),
                ("User", "username"),
                ("Password", "hunter2"),
                ("TLE file", "active.txt"),
                ("Satellite", "ISS (ZARYA)"),
                ("Port", "2121"),
            ],
            "SATELLITE_FTP?,10.0.1.2,username,hunter2,2121,active.txt,ISS (ZARYA),",
        ),
        (&[("Password", "hunter3")], ",hunter3,"),
        (&[("Password", "hunter4")], ",hunter4,"),
    ],
    query: "SATELLITE_FTP?",
    foreign: Some("SATELLITE_FTP=,10.9.9.9,username,hunter2,2121,active.txt,ISS (ZARYA),1,1"),
};

pub(crate) const ANGLES: Story = Story {
    group: "angles",
    tab: None,
    is_service: true,
    choice: None,
    rounds: [
        (&[("X sensor reference", "29130")], "ANGLE_SETTINGS?,29130,160.0,"),
        (&[("X sensor reference", "29131")], ",29131,"),
        (&[("X sensor reference", "29132")], ",29132,"),
    ],
    query: "ANGLE_SETTINGS?",
    foreign: Some("ANGLE_SETTINGS=,0,29130,150.0,7282,40.0"),
};

pub(crate) const REDUCTION: Story = Story {
    group: "reduction",
    tab: None,
    is_service: true,
    choice: None,
    rounds: [
        (&[("X reduction", "4100")], "REDUCTION?,4100,4000"),
        (&[("X reduction", "4200")], "REDUCTION?,4200,"),
        (&[("X reduction", "4300")], "REDUCTION?,4300,"),
    ],
    query: "REDUCTION?",
    foreign: Some("REDUCTION=,4100,3900"),
};

pub(crate) const IMAGE: Story = Story {
    group: "image",
    tab: None,
    is_service: true,
    choice: None,
    rounds: [
        (&[("Image file", "a.json")], "LOAD_IMAGE?,"),
        (&[("Image file", "b.json")], "LOAD_IMAGE?,"),
        (&[("Image file", "c.json")], "LOAD_IMAGE?,"),
    ],
    query: "LOAD_IMAGE?",
    foreign: None,
};
