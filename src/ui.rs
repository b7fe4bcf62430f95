//! Views and widgets: they draw and queue commands, nothing else.

pub mod antenna_card;
pub mod antennas;
pub mod banner;
pub mod bar;
pub mod confirm;
pub mod console;
pub mod copies;
pub mod dialogs;
pub mod elements;
pub mod format;
pub mod icons;
pub mod keys;
mod lean_shapes;
pub mod map;
pub mod operate;
pub mod pass_header;
pub mod pass_list;
pub mod preferences;
pub mod profile;
pub mod rail;
pub mod reminder_note;
mod second_step;
pub mod setup;
pub mod sky_plot;
pub mod source_test;
pub mod state_sentence;
pub mod text;
pub mod theme;
pub mod timeline;
pub mod tokens;
pub mod top_bar;
pub mod upload;
mod views;
pub mod widgets;
pub mod words;

pub use views::{Kept, Views};
