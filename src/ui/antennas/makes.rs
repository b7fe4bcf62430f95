//! The cards of makes whose settings are more than fields.

mod satrak;

use super::section::Section;
use crate::station::ControllerSpec;

/// Makes by their key, with the cards of each.
static MAKES: [(&str, &[Section]); 1] = [(satrak::KEY, &satrak::SECTIONS)];

/// The cards of a unit of this make; `None` where each group is one.
pub(super) fn sections(spec: &ControllerSpec) -> Option<&'static [Section]> {
    MAKES.into_iter().find(|(key, _)| *key == spec.key).map(|(_, sections)| sections)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_group_of_a_unit_stands_in_one_section() {
        for (key, sections) in MAKES {
            let spec = crate::makes::SPECS.iter().find(|spec| spec.key == key).unwrap();
            let groups = spec.variants.iter().flat_map(|variant| variant.groups);
            let shown: Vec<_> = sections.iter().flat_map(|section| section.keys).collect();
            let known: Vec<_> = groups.map(|group| &group.key).collect();
            assert_eq!(shown, known);
        }
    }
}
