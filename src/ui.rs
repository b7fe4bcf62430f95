//! Views and widgets: they draw and queue commands, nothing else.

pub mod text;
pub mod theme;
pub mod tokens;
