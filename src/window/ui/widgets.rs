//! Widgets. Each widget takes plain data and a rectangle, paints itself and returns the operator's
//! action. No widget calls the rest of the program.

pub mod alarm_list;
pub mod angle_field;
pub mod axes_table;
pub mod beam_bar;
pub mod button;
pub mod card;
pub mod check_box;
pub mod chip;
pub mod close_key;
pub mod context_menu;
pub mod copy_menu;
pub mod drop_down;
pub mod fold;
pub mod form;
pub mod go_to;
pub mod hold_button;
pub mod input;
pub mod inspector;
pub mod jog_pad;
pub mod link_chip;
pub mod list;
pub mod menu;
pub mod modal;
pub mod paint;
pub mod rate_slider;
pub mod segmented;
pub mod selection;
pub mod sentence;
pub mod status_line;
pub mod stop_button;
pub mod travel_gauge;

#[cfg(test)]
pub(crate) mod testing;
