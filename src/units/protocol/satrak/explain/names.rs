//! Names of the values, in the order of the document.

use crate::protocol::satrak::Word;

/// Name of a value that the document does not list.
pub(super) const UNKNOWN: &str = "not in the document";

/// Name, unit of measure and codes of one value in the document.
#[derive(Debug, Clone, Copy)]
pub(super) struct Named {
    pub(super) name: &'static str,
    /// Unit of measure, which begins with a space if the number needs one before it.
    pub(super) unit: &'static str,
    /// Codes with their meanings.
    pub(super) codes: &'static [(&'static str, &'static str)],
}

impl Named {
    pub(super) const fn new(name: &'static str) -> Self {
        Self { name, unit: "", codes: &[] }
    }
}

/// Named values of one kind of frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct NamedFields {
    pub(super) named: &'static [Named],
    /// Index of the one value that may contain commas, counted from 0.
    pub(super) text_at: Option<usize>,
}

impl NamedFields {
    pub(super) const NONE: Self = Self::new(&[]);

    const fn new(named: &'static [Named]) -> Self {
        Self { named, text_at: None }
    }

    const fn with_text(named: &'static [Named], index: usize) -> Self {
        Self { named, text_at: Some(index) }
    }
}

const fn text(name: &'static str) -> Named {
    Named::new(name)
}

const fn number(name: &'static str, unit: &'static str) -> Named {
    Named { unit, ..Named::new(name) }
}

const fn code(name: &'static str, codes: &'static [(&'static str, &'static str)]) -> Named {
    Named { codes, ..Named::new(name) }
}

/// Marks a value of a setting that a `?` leaves unchanged.
const fn retained(named: Named) -> Named {
    if named.codes.is_empty() { Named { codes: KEEP, ..named } } else { named }
}

type Codes = &'static [(&'static str, &'static str)];

const KEEP: Codes = &[("?", "stays as it is")];
const NO_YES: Codes = &[("0", "no"), ("1", "yes"), ("?", "stays as it is")];
const OFF_ON: Codes = &[("0", "off"), ("1", "on")];
const LIMIT: Codes = &[("0", "clear"), ("1", "set")];
const FAULT: Codes = &[("0", "none"), ("1", "set")];
const SENSOR: Codes = &[("0", "none"), ("1", "set wrongly"), ("2", "not connected")];
const MOTION: Codes =
    &[("-1", "toward smaller angles"), ("0", "standing"), ("1", "toward larger angles")];
const TRACK_STATE: Codes = &[
    ("0", "outside the window"),
    ("1", "inside the window"),
    ("2", "the window is over"),
    ("3", "before the start"),
];
const BASE: Codes = &[("0", "resolver and encoder"), ("1", "resolver"), ("?", "stays as it is")];
const SSPA: Codes = &[("0", "off"), ("1", "on"), ("2", "by its own rule"), ("?", "stays as it is")];
const SSPA_RULE: Codes = &[
    ("0", "while tracking"),
    ("1", "while the carrier is locked"),
    ("2", "while both"),
    ("3", "while either"),
    ("?", "stays as it is"),
];
// The code has no `?`, because no request sets this value (section 13).
const TLE_MODE: Codes = &[("0", "file"), ("1", "web"), ("2", "FTP")];
const ON_ERROR: Codes = &[("0", "stops tracking"), ("1", "goes on with the last elements")];
const NONE: Codes = &[("NONE", "stays as it is")];

pub(super) const ANSWER: NamedFields =
    NamedFields::new(&[code("answer", &[("OK", "accepted"), ("ERR", "refused")])]);
// The document lists no error codes, so a code may hold commas.
pub(super) const REFUSAL: NamedFields =
    NamedFields::with_text(&[code("answer", &[("ERR", "refused")]), text("code")], 1);

const STATUS: NamedFields = NamedFields::new(&[
    code("fault or warning", FAULT),
    number("azimuth", "°"),
    number("elevation", "°"),
    code("limit X+", LIMIT),
    code("limit X\u{2212}", LIMIT),
    code("limit Y+", LIMIT),
    code("limit Y\u{2212}", LIMIT),
    code("tracking", OFF_ON),
    code("tracking state", TRACK_STATE),
    code("clock set from GPS", NO_YES),
    number("GPS lock delay", " s"),
    code("motion of X", MOTION),
    code("motion of Y", MOTION),
    number("angle of X", "°"),
    number("angle of Y", "°"),
    code("auto-track", OFF_ON),
]);
const FAULTS: NamedFields = NamedFields::new(&[
    code("link between control and drive unit", FAULT),
    code("elements out of date", FAULT),
    code("element file missing", FAULT),
    code("satellite missing in the file", FAULT),
    code("elements from the web", FAULT),
    code("tracking stopped by an error", FAULT),
    code("setup", FAULT),
    code("motor of X", FAULT),
    code("motor of Y", FAULT),
    code("sensor of X", SENSOR),
    code("sensor of Y", SENSOR),
    code("link to the GPS receiver", FAULT),
]);
const TIME: NamedFields = NamedFields::new(&[
    text("hour"),
    text("minute"),
    text("second"),
    text("day"),
    text("month"),
    text("year"),
    number("milliseconds", " ms"),
]);
const WINDOW: NamedFields = NamedFields::new(&[
    text("start, hour"),
    text("start, minute"),
    text("start, second"),
    text("start, day"),
    text("start, month"),
    text("start, year"),
    text("stop, hour"),
    text("stop, minute"),
    text("stop, second"),
    text("stop, day"),
    text("stop, month"),
    text("stop, year"),
]);
const FROM_GPS: Named = code("clock from GPS", NO_YES);
const TIME_OFFSET: Named = retained(number("tracking time offset", " ms"));
const AZ_OFFSET: Named = retained(number("azimuth offset", "°"));
const EL_OFFSET: Named = retained(number("elevation offset", "°"));
const LEAD: Named = retained(number("go to start before", " ms"));
const POSITION_BASE: Named = code("position base", BASE);
const MINIMUM: Named = retained(number("minimum elevation", "°"));
const NORTH: Named = retained(number("north offset", "°"));
const AMPLIFIER: Named = code("SSPA", SSPA);
const RULE: Named = code("SSPA rule", SSPA_RULE);
const THRESHOLD: Named = retained(number("elevation threshold", "°"));
const SETTINGS: NamedFields = NamedFields::new(&[
    FROM_GPS,
    TIME_OFFSET,
    AZ_OFFSET,
    EL_OFFSET,
    LEAD,
    POSITION_BASE,
    MINIMUM,
    NORTH,
    AMPLIFIER,
    RULE,
    code("source of the elements", TLE_MODE),
    THRESHOLD,
]);
// Section 13 omits the source of the elements, so the threshold moves up by one place.
const SET_SETTINGS: NamedFields = NamedFields::new(&[
    FROM_GPS,
    TIME_OFFSET,
    AZ_OFFSET,
    EL_OFFSET,
    LEAD,
    POSITION_BASE,
    MINIMUM,
    NORTH,
    AMPLIFIER,
    RULE,
    THRESHOLD,
]);
const ANGLES: NamedFields = NamedFields::new(&[
    number("sensor of X", " counts"),
    number("angle of X there", "°"),
    number("sensor of Y", " counts"),
    number("angle of Y there", "°"),
]);
const SET_ANGLES: NamedFields = NamedFields::new(&[
    code("present position", NO_YES),
    number("sensor of X", " counts"),
    number("angle of X there", "°"),
    number("sensor of Y", " counts"),
    number("angle of Y there", "°"),
]);
const GPS: NamedFields = NamedFields::new(&[
    text("latitude"),
    text("longitude"),
    code("fix", NO_YES),
    text("hour"),
    text("minute"),
    text("second"),
    text("day"),
    text("month"),
    text("year of the century"),
]);
// The names are neutral: section 17 calls them X and Y, but 306.00 in its example only fits an
// azimuth.
const POSITION: NamedFields = NamedFields::new(&[
    number("first angle", "°"),
    number("second angle", "°"),
    text("hour"),
    text("minute"),
    text("second"),
    text("day"),
    text("month"),
    text("year"),
    number("milliseconds", " ms"),
]);
const PLACE: NamedFields =
    NamedFields::new(&[code("place from GPS", NO_YES), text("latitude"), text("longitude")]);
const SATELLITE: NamedFields = NamedFields::with_text(
    &[
        text("element file"),
        text("satellite"),
        // Section 23 gives this period no unit, and sections 25 and 27 give days.
        text("update period"),
        text("catalogue number"),
        number("maximum elevation", "°"),
    ],
    1,
);
const SET_SATELLITE: NamedFields = NamedFields::new(&[
    text("element file"),
    text("satellite"),
    text("update period"),
    code("present track goes on", NO_YES),
]);
const WEB: NamedFields = NamedFields::with_text(
    &[text("address"), number("update period", " d"), code("when an update fails", ON_ERROR)],
    0,
);
const SET_WEB: NamedFields = NamedFields::new(&[
    text("address"),
    number("update period", " d"),
    code("when an update fails", ON_ERROR),
    code("present track goes on", NO_YES),
]);
const VERSION: NamedFields = NamedFields::new(&[text("control unit"), text("drive unit")]);
// Section 31 gives no unit for the scales.
const SCALES: NamedFields = NamedFields::new(&[number("scale of X", ""), number("scale of Y", "")]);
// Section 29 does not explain the state, which may contain commas.
const IMAGE_STATE: NamedFields = NamedFields::with_text(&[text("state")], 0);
const IMAGE_FILE: NamedFields = NamedFields::new(&[text("image file")]);
const MOVE: NamedFields =
    NamedFields::new(&[number("rate of X", " °/s"), number("rate of Y", " °/s")]);
const STEP: NamedFields = NamedFields::new(&[number("step of X", "°"), number("step of Y", "°")]);
const GOTO: NamedFields = NamedFields::new(&[
    Named { unit: "°", ..code("azimuth", NONE) },
    Named { unit: "°", ..code("elevation", NONE) },
]);
const TRACK: NamedFields = NamedFields::new(&[code("tracking", OFF_ON)]);
const AUTO_TRACK: NamedFields = NamedFields::new(&[code("auto-track", OFF_ON)]);

/// Returns the names of the values after `word?` in a reply.
pub(super) const fn of_reply(word: Word) -> NamedFields {
    match word {
        Word::Version => VERSION,
        Word::Status => STATUS,
        Word::ErrStatus => FAULTS,
        Word::Time => TIME,
        Word::StartStopTime => WINDOW,
        Word::Settings => SETTINGS,
        Word::AngleSettings => ANGLES,
        Word::GpsData => GPS,
        Word::Tpos => POSITION,
        Word::GpsSettings => PLACE,
        Word::Satellite => SATELLITE,
        Word::SatelliteHttp => WEB,
        Word::LoadImage => IMAGE_STATE,
        Word::Reduction => SCALES,
        // The explanation hides SATELLITE_FTP as a whole, and the document has no queries for the
        // others.
        Word::SatelliteFtp
        | Word::Move
        | Word::Step
        | Word::Goto
        | Word::Stop
        | Word::Track
        | Word::TrackAutoEnable
        | Word::RtcReupdate => NamedFields::NONE,
    }
}

/// Returns the names of the values after `word=` in a request.
pub(super) const fn of_setting(word: Word) -> NamedFields {
    match word {
        Word::Move => MOVE,
        Word::Step => STEP,
        Word::Goto => GOTO,
        Word::Track => TRACK,
        Word::TrackAutoEnable => AUTO_TRACK,
        Word::Settings => SET_SETTINGS,
        Word::AngleSettings => SET_ANGLES,
        Word::Satellite => SET_SATELLITE,
        Word::SatelliteHttp => SET_WEB,
        Word::LoadImage => IMAGE_FILE,
        // These settings have the same values as the answer to their query.
        Word::Time
        | Word::StartStopTime
        | Word::GpsSettings
        | Word::SatelliteFtp
        | Word::Reduction => of_reply(word),
        Word::Version
        | Word::Stop
        | Word::Status
        | Word::ErrStatus
        | Word::GpsData
        | Word::Tpos
        | Word::RtcReupdate => NamedFields::NONE,
    }
}
