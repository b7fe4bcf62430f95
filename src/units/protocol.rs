//! Codecs of the controllers: conversion between typed messages and bytes, without I/O.

mod parity;
pub mod rc2000c;
pub mod rotator_genius;
pub mod rotctld;
pub mod satrak;

pub use parity::Parity;
