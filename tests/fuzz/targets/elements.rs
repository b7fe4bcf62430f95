#![no_main]

#[path = "../entry/all.rs"]
mod entry;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| entry::elements::run(bytes));
