//! Stories of the operator in front of the whole window, without a display.

#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "the data is part of the test"
)]

mod bar;
mod clock;
mod closing;
mod console;
mod console_send;
mod demo;
mod drive;
mod elements;
mod extremes;
mod following;
mod fourth_make;
mod holds;
mod horizon;
mod keys;
mod maintenance;
mod makes;
mod mask;
mod on_board;
mod panel;
mod panel_layout;
mod panel_more;
mod passes;
mod popups;
mod preferences;
mod preferences_makes;
mod preferences_watch;
mod rig;
mod running;
mod sentences;
mod settings;
mod settings_cards;
mod settings_copies;
mod settings_desk;
mod settings_forms;
mod settings_service;
mod settings_unit;
mod source_tests;
mod states;
mod step;
mod stop;
mod unit;
mod upload_desk;
mod upload_questions;
mod uploads;
mod whole_degrees;
