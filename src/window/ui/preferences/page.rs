//! The pages of the preferences, in the order of their list.

use super::{draft::Draft, fields::Counts};
use crate::station::AntennaId;

/// A page of the preferences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Page {
    /// Location of the station, its passes, and the behaviour when the window closes.
    #[default]
    Site,
    /// Obstructions of the sky, and zones that antennas must not point at.
    Horizon,
    Antenna(AntennaId),
    /// Favourites with their priorities, limits and frequencies, and groups.
    Satellites,
    /// Automation rules.
    Rules,
    /// Notifications, sounds and reminders.
    Notices,
    /// Theme and scale.
    Appearance,
}

impl Page {
    /// Returns all pages of a station with the antennas of `draft`.
    pub(super) fn all(draft: &Draft) -> Vec<Self> {
        let antennas = draft.antennas.iter().map(|antenna| Self::Antenna(antenna.before().id));
        let mut all = vec![Self::Site, Self::Horizon];
        all.extend(antennas);
        all.extend([Self::Satellites, Self::Rules, Self::Notices, Self::Appearance]);
        all
    }

    /// Returns `true` if choices on the page take effect immediately, without saving.
    pub(super) fn is_used_at_once(self) -> bool {
        self == Self::Appearance
    }

    /// Returns the page after this one; the first page follows the last.
    pub(super) fn next(self, draft: &Draft) -> Self {
        let all = Self::all(draft);
        let index = all.iter().position(|page| *page == self);
        let next = index.and_then(|index| all.get(index + 1)).or(all.first());
        next.copied().unwrap_or_default()
    }

    pub(super) fn title(self, draft: &Draft) -> String {
        let title = match self {
            Self::Site => "Site",
            Self::Horizon => "Horizon and keep-outs",
            Self::Antenna(id) => return draft.antenna_title(id),
            Self::Satellites => "Satellites and priorities",
            Self::Rules => "Automation rules",
            Self::Notices => "Alarms and sounds",
            Self::Appearance => "Appearance",
        };
        title.to_owned()
    }

    /// Returns the number of unsaved edits and of invalid fields of the page. `before` is the draft
    /// of the saved station.
    pub(super) fn counts(self, draft: &Draft, before: &Draft) -> Counts {
        draft.section(self).map_or_else(Counts::default, |section| Counts {
            edited: section.edits(before),
            wrong: section.findings(draft).len(),
        })
    }
}
