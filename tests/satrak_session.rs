//! Session of an antenna against a simulated Satrak, in paused time: the operator's view,
//! and the unit's commands.

mod rig;
pub(crate) mod scene;
mod script;

mod connect;
mod doubt;
mod every_command;
mod faults;
mod idle;
mod inside;
mod jog;
mod let_go;
mod lock_out;
mod oddities;
mod on_board;
mod overtaken;
mod position;
mod reconnect;
mod secrets;
mod settings;
mod settings_moving;
mod settings_refused;
mod silence;
mod stalled;
mod stop;
mod track;
mod two;
#[cfg(unix)]
mod unguarded;
mod unit_offsets;
mod wire;
