//! Every command in every state of an antenna, compared with the table of commands.

mod makes;
mod samples;
mod sessions;
mod stations;
mod stop;
