//! Which passes the list shows.

use serde::{Deserialize, Serialize};

/// How far ahead the list may look, hours.
pub const SPANS_H: [u32; 4] = [6, 12, 24, 48];

/// The satellites whose passes are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scope {
    /// The satellites that the operator follows.
    #[default]
    Favourites,
    /// All satellites there are elements of.
    All,
}

/// Which passes the list shows. Each scope has its own span: a day of the whole
/// catalog is a hundred thousand passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ListChoice {
    pub scope: Scope,
    /// How far ahead for the favourites, hours; one of [`SPANS_H`].
    pub favourites_h: u32,
    /// How far ahead for all satellites, hours; one of [`SPANS_H`].
    pub all_h: u32,
}

impl Default for ListChoice {
    fn default() -> Self {
        Self { scope: Scope::Favourites, favourites_h: 48, all_h: 6 }
    }
}

impl ListChoice {
    /// How far ahead the list looks, hours.
    pub fn span_h(&self) -> u32 {
        match self.scope {
            Scope::Favourites => self.favourites_h,
            Scope::All => self.all_h,
        }
    }

    /// Looks so many hours ahead from now on, in the scope that is shown.
    pub fn set_span_h(&mut self, span_h: u32) {
        match self.scope {
            Scope::Favourites => self.favourites_h = span_h,
            Scope::All => self.all_h = span_h,
        }
    }
}
