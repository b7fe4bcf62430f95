//! Matters of safety.

use crate::{driver::Safety, ui::format};

/// A matter of safety in words; `antenna` is its name.
pub fn safety(matter: &Safety, antenna: &str) -> String {
    match matter {
        Safety::DeadManFired => format!(
            "{antenna} was stopped by the dead-man: Azel was late. Press the key anew to move it."
        ),
        Safety::LeftMoving { since, asks: false } => format!(
            "Azel ended at {} while {antenna} was moved by hand. STOP was sent first.",
            format::time_z(*since)
        ),
        Safety::LeftMoving { since, asks: true } => format!(
            "Azel ended at {} while {antenna} was moved by hand, and nobody has seen it stand \
             since. Press STOP, or say that you have seen it stand.",
            format::time_z(*since)
        ),
        Safety::NoMark => format!(
            "It could not be written to disk that {antenna} is moved by hand: if Azel ended now, \
             its next start would not know. Look at the free space and rights of the disk."
        ),
        Safety::StoppedByFlags { axis } => format!(
            "{antenna} says that it stands. {axis} tells no angle, so nothing else proves it."
        ),
        Safety::FlagsContradict { axis, turned_deg } => format!(
            "{antenna} says that it stands, but {axis} has turned by {}. Look at the antenna.",
            format::degrees(turned_deg.abs(), 1)
        ),
        Safety::JogWithoutEffect => {
            format!("{antenna} took the jog, but its angle does not change.")
        }
        Safety::SessionBroke => format!(
            "The connection to {antenna} broke down inside Azel and was started again with STOP."
        ),
    }
}
