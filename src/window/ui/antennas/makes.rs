//! Makes whose settings need more than fields.

mod satrak;

use super::section::Section;
use crate::{device::settings::Group, station::ControllerSpec};

/// A make with cards of its own.
pub(super) struct Own {
    key: &'static str,
    pub(super) sections: &'static [Section],
    /// Group with the versions that a unit reports.
    pub(super) versions: &'static Group,
}

static MAKES: [Own; 1] = [satrak::OWN];

/// Returns the cards of this make; `None` if each group is a card.
pub(super) fn own(spec: &ControllerSpec) -> Option<&'static Own> {
    MAKES.iter().find(|own| own.key == spec.key)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::SPECS;

    #[test]
    fn every_group_of_a_unit_stands_in_one_section() {
        for Own { key, sections, .. } in &MAKES {
            let spec = SPECS.iter().find(|spec| spec.key == *key).unwrap();
            let groups = spec.variants.iter().flat_map(|variant| variant.groups);
            let shown: Vec<_> = sections.iter().flat_map(|section| section.keys).collect();
            let keys: Vec<_> = groups.map(|group| &group.key).collect();
            assert_eq!(shown, keys);
        }
    }
}
