//! Scope and span of the pass list.

use serde::{Deserialize, Serialize};

/// Selectable spans of the pass list, hours.
pub const SPANS_H: [u32; 4] = [6, 12, 24, 48];

/// Satellites whose passes are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scope {
    /// Favourites only.
    #[default]
    Favourites,
    /// All satellites with elements.
    All,
}

/// Scope and spans of the pass list. Each scope has its own span, because one day of the
/// whole catalog has a hundred thousand passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ListChoice {
    pub scope: Scope,
    /// Span for the favourites, hours; one of [`SPANS_H`].
    pub favourites_h: u32,
    /// Span for all satellites, hours; one of [`SPANS_H`].
    pub all_h: u32,
}

impl Default for ListChoice {
    fn default() -> Self {
        Self { scope: Scope::Favourites, favourites_h: 48, all_h: 6 }
    }
}

impl ListChoice {
    /// Returns the span of the current scope, hours.
    pub fn span_h(&self) -> u32 {
        match self.scope {
            Scope::Favourites => self.favourites_h,
            Scope::All => self.all_h,
        }
    }

    /// Sets the span of the current scope, hours.
    pub fn set_span_h(&mut self, span_h: u32) {
        match self.scope {
            Scope::Favourites => self.favourites_h = span_h,
            Scope::All => self.all_h = span_h,
        }
    }
}
