//! Sections of a unit's settings, in the order of the list.

use egui::Ui;

use super::{
    cards::{CardEffects, fields, service},
    form::Form,
    makes, row,
    unit::ShownUnit,
};
use crate::{device::settings::Group, station::Connection};

/// Function that draws the content of a card.
pub(super) type Content = fn(&mut Ui, &ShownUnit<'_>, &mut Form, &Section, &mut CardEffects<'_>);

/// Card of the view, with the settings that it shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Section {
    pub(super) title: &'static str,
    /// Keys of the section's groups, which identify the section.
    pub(super) keys: &'static [&'static str],
    /// Flag: the section opens only with the service functions.
    pub(super) is_service: bool,
    /// Column if there are two; cards without one alternate.
    pub(super) column: Option<Column>,
    pub(super) content: Content,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Column {
    Left,
    Right,
}

impl PartialEq for Section {
    fn eq(&self, other: &Self) -> bool {
        self.keys == other.keys
    }
}

impl Section {
    /// Returns the sections of the unit behind `connection`.
    pub(super) fn new(connection: &Connection) -> Vec<Self> {
        let plain = |group: &&'static Group| Self {
            title: group.title,
            keys: std::slice::from_ref(&group.key),
            is_service: group.is_service,
            column: None,
            content: if group.is_service { service::show } else { all_fields },
        };
        let own = makes::own(connection.spec()).map(|own| own.sections.to_vec());
        own.unwrap_or_else(|| connection.variant().groups.iter().map(plain).collect())
    }
}

fn all_fields(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    section: &Section,
    _: &mut CardEffects<'_>,
) {
    row::head(ui);
    for key in section.keys {
        fields(ui, unit, form, key, |_| true);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::SPECS;

    #[test]
    fn a_make_without_cards_of_its_own_has_one_for_each_of_its_groups() {
        for spec in SPECS.iter().filter(|spec| makes::own(spec).is_none()) {
            let connection = spec.connection("");
            let (sections, groups) = (Section::new(&connection), connection.variant().groups);
            assert_eq!(sections.len(), groups.len());
            for (section, group) in sections.iter().zip(groups) {
                assert_eq!((section.keys, section.title), ([group.key].as_slice(), group.title));
            }
        }
    }
}
