//! The cards of makes whose settings are more than fields.

mod satrak;

use super::section::Section;
use crate::controller::Make;

/// Makes by their key, with the cards of each.
static MAKES: [(&str, &[Section]); 1] = [(satrak::KEY, &satrak::SECTIONS)];

/// The cards of a unit of this make; `None` where each group is one.
pub(super) fn sections(make: &Make) -> Option<&'static [Section]> {
    MAKES.into_iter().find(|(key, _)| *key == make.key).map(|(_, sections)| sections)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_group_of_a_unit_stands_in_one_section() {
        for (key, sections) in MAKES {
            let make = crate::makes::makes().find(|make| make.key == key).unwrap();
            let shown: Vec<_> = sections.iter().flat_map(|section| section.keys).collect();
            let known: Vec<_> = make.groups.iter().map(|group| &group.key).collect();
            assert_eq!(shown, known);
        }
    }
}
