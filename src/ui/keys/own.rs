//! Keys that the operator has chosen in place of the usual ones.

use egui::{Key, Modifiers};

use super::{ALL, Binding, KeyScope};

/// A key of the table that can be changed: where it works, and the usual key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    place: KeyScope,
    usual: Key,
}

/// Why a key cannot be chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Clash {
    /// It is no letter, no digit and none of F5 to F12.
    NoShortcut,
    /// It does this already.
    Taken(&'static Binding),
}

/// The chosen keys.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct OwnKeys {
    chosen: Vec<(Slot, Key)>,
}

impl Binding {
    /// The keys that can be changed: single ones that neither move an antenna nor belong to a
    /// control.
    pub fn slots(&self) -> impl Iterator<Item = Slot> {
        self.with_slots().filter_map(|(_, slot)| slot)
    }

    /// All keys, each with its slot if it can be changed.
    pub fn with_slots(&self) -> impl Iterator<Item = (Key, Option<Slot>)> {
        let is_free = self.modifiers == Modifiers::NONE
            && !matches!(
                self.place,
                KeyScope::Everywhere | KeyScope::Focus | KeyScope::Elements | KeyScope::Preferences
            );
        // Space belongs to whatever control has the focus.
        self.keys.iter().map(move |(usual, act)| {
            let has_slot = is_free && !act.is_fixed() && *usual != Key::Space;
            (*usual, has_slot.then_some(Slot { place: self.place, usual: *usual }))
        })
    }
}

impl OwnKeys {
    /// The key in place of a usual one.
    pub fn of(&self, place: KeyScope, usual: Key) -> Key {
        let slot = Slot { place, usual };
        let chosen = self.chosen.iter().find(|(known, _)| *known == slot);
        chosen.map_or(usual, |(_, key)| *key)
    }

    pub fn of_slot(&self, slot: Slot) -> Key {
        self.of(slot.place, slot.usual)
    }

    pub fn is_own(&self, slot: Slot) -> bool {
        self.of_slot(slot) != slot.usual
    }

    /// The keys of a binding, as they are now.
    pub fn keys(&self, binding: &Binding) -> impl Iterator<Item = Key> {
        binding.keys().map(|usual| match binding.modifiers {
            Modifiers::NONE => self.of(binding.place, usual),
            _ => usual,
        })
    }

    /// Puts `key` in the place of the usual one, which may be `key` itself.
    pub fn choose(&mut self, slot: Slot, key: Key) -> Result<(), Clash> {
        if key != slot.usual && !is_shortcut(key) {
            return Err(Clash::NoShortcut);
        }
        if let Some(holder) = self.holder(slot, key) {
            return Err(Clash::Taken(holder));
        }
        self.put(slot, key);
        Ok(())
    }

    /// The binding that has `key` where the key of `slot` works, other than by `slot` itself.
    fn holder(&self, slot: Slot, key: Key) -> Option<&'static Binding> {
        let mut others = ALL
            .iter()
            .filter(|other| other.modifiers == Modifiers::NONE && overlap(other.place, slot.place));
        others.find(|other| {
            other.keys().any(|usual| {
                let is_itself = other.place == slot.place && usual == slot.usual;
                !is_itself && self.of(other.place, usual) == key
            })
        })
    }

    fn put(&mut self, slot: Slot, key: Key) {
        self.chosen.retain(|(known, _)| *known != slot);
        if key != slot.usual {
            self.chosen.push((slot, key));
        }
    }

    /// The chosen keys as words, to be kept: place, usual key, own key.
    pub fn kept(&self) -> impl Iterator<Item = [&'static str; 3]> {
        self.chosen.iter().map(|(slot, key)| [slot.place.word(), slot.usual.name(), key.name()])
    }

    /// Takes the kept words; those that do not fit any more are left out.
    pub fn from_kept<'a>(kept: impl IntoIterator<Item = [&'a str; 3]>) -> Self {
        let mut own = Self::default();
        for [place, usual, key] in kept {
            let slot = ALL.iter().flat_map(Binding::slots).find(|slot| {
                slot.place.word() == place && Some(slot.usual) == Key::from_name(usual)
            });
            let key = Key::from_name(key).filter(|key| is_shortcut(*key));
            if let (Some(slot), Some(key)) = (slot, key) {
                own.put(slot, key);
            }
        }
        // Only the whole table tells what clashes: one key may have been freed by another. A key
        // that is left out takes back its usual one, which may clash in turn.
        let clashes = |own: &Self| {
            own.chosen.iter().rposition(|(slot, key)| own.holder(*slot, *key).is_some())
        };
        while let Some(last) = clashes(&own) {
            own.chosen.remove(last);
        }
        own
    }
}

impl KeyScope {
    fn word(self) -> &'static str {
        match self {
            Self::Everywhere => "everywhere",
            Self::Views => "views",
            Self::Operate => "operate",
            Self::Plan => "plan",
            Self::Record => "record",
            Self::Map => "map",
            Self::Replay => "replay",
            Self::Elements => "elements",
            Self::Preferences => "preferences",
            Self::Focus => "focus",
        }
    }
}

/// Whether a key works in both of them at once.
fn overlap(a: KeyScope, b: KeyScope) -> bool {
    let everywhere = |of| matches!(of, KeyScope::Everywhere | KeyScope::Views | KeyScope::Replay);
    a == b || everywhere(a) || everywhere(b)
}

fn is_shortcut(key: Key) -> bool {
    let name = key.name();
    let is_letter_or_digit = name.len() == 1 && name.chars().all(|of| of.is_ascii_alphanumeric());
    let is_function = name.strip_prefix('F').and_then(|number| number.parse().ok());
    is_letter_or_digit || is_function.is_some_and(|number: u8| (5..=12).contains(&number))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn slot(place: KeyScope, usual: Key) -> Slot {
        let slots = ALL.iter().flat_map(Binding::slots);
        slots.into_iter().find(|slot| *slot == Slot { place, usual }).expect("such a slot")
    }

    #[test]
    fn a_key_is_chosen_unless_it_does_something_else_there() {
        let next = slot(KeyScope::Operate, Key::N);
        let mut own = OwnKeys::default();
        let mut holder = |key| match own.choose(next, key) {
            Err(Clash::Taken(by)) => by.does_where(),
            other => format!("{other:?}"),
        };
        assert_eq!(holder(Key::T), "track the selected pass, park the antenna (asks first)");
        assert_eq!(holder(Key::A), "acknowledge the newest alarm");
        assert_eq!(own.choose(next, Key::Escape), Err(Clash::NoShortcut));
        assert_eq!(own.choose(next, Key::Space), Err(Clash::NoShortcut));
        assert_eq!(own.choose(next, Key::L), Ok(()), "it is a key of the map alone");
        assert_eq!(own.of(KeyScope::Operate, Key::N), Key::L);
        assert_eq!(own.choose(slot(KeyScope::Operate, Key::P), Key::N), Ok(()), "it is free now");
        let taken = own.choose(slot(KeyScope::Views, Key::A), Key::L);
        assert!(matches!(taken, Err(Clash::Taken(_))), "in one of the views: {taken:?}");
        assert!(matches!(own.choose(next, Key::N), Err(Clash::Taken(_))), "P has it");
        let taken = own.choose(slot(KeyScope::Views, Key::A), Key::Y);
        let Err(Clash::Taken(by)) = taken else { panic!("{taken:?}") };
        assert!(
            by.does_where().starts_with("in Plan: take the selected pass always"),
            "it says in which view"
        );
    }

    #[test]
    fn what_stops_or_moves_an_antenna_or_belongs_to_a_control_cannot_be_changed() {
        let slots: Vec<Slot> = ALL.iter().flat_map(Binding::slots).collect();
        assert!(slots.len() > 10);
        for usual in [Key::Escape, Key::T, Key::K, Key::G, Key::M, Key::PageUp, Key::F1, Key::Space]
        {
            assert!(slots.iter().all(|slot| slot.usual != usual), "{usual:?}");
        }
    }

    #[test]
    fn chosen_keys_come_back_as_they_were_kept_and_what_does_not_fit_is_left_out() {
        let mut own = OwnKeys::default();
        own.choose(slot(KeyScope::Operate, Key::N), Key::J).unwrap();
        own.choose(slot(KeyScope::Plan, Key::Y), Key::F9).unwrap();
        let kept: Vec<_> = own.kept().collect();
        assert_eq!(OwnKeys::from_kept(kept), own);
        let odd =
            [["operate", "T", "J"], ["operate", "N", "A"], ["x", "N", "J"], ["map", "L", "?"]];
        assert_eq!(OwnKeys::from_kept(odd), OwnKeys::default());
    }

    #[test]
    fn a_chain_of_keys_and_a_swap_come_back() {
        let (next, drawer) = (slot(KeyScope::Operate, Key::N), slot(KeyScope::Operate, Key::P));
        for choices in [
            [(next, Key::J), (drawer, Key::N), (next, Key::L)],
            [(next, Key::J), (drawer, Key::N), (next, Key::P)],
        ] {
            let mut own = OwnKeys::default();
            for (slot, key) in choices {
                own.choose(slot, key).unwrap();
            }
            assert_eq!(OwnKeys::from_kept(own.kept()), own);
        }
    }

    #[test]
    fn of_two_kept_keys_that_clash_the_first_stays() {
        let kept = [["operate", "N", "J"], ["operate", "P", "J"]];
        let mut first = OwnKeys::default();
        first.choose(slot(KeyScope::Operate, Key::N), Key::J).unwrap();
        assert_eq!(OwnKeys::from_kept(kept), first);
        let chain = [["operate", "N", "A"], ["operate", "P", "N"]];
        assert_eq!(OwnKeys::from_kept(chain), OwnKeys::default(), "N stays, so P cannot have it");
    }

    proptest! {
        #[test]
        fn keys_come_back_as_they_were_after_any_choices(
            choices in prop::collection::vec((any::<usize>(), any::<usize>()), 0..60)
        ) {
            let slots: Vec<Slot> = ALL.iter().flat_map(Binding::slots).collect();
            // Few keys, so that they are often taken, freed and swapped.
            let mut keys: Vec<Key> = slots.iter().map(|slot| slot.usual).collect();
            keys.extend([Key::J, Key::X, Key::F5]);
            let mut own = OwnKeys::default();
            for (slot, key) in choices {
                let _ = own.choose(slots[slot % slots.len()], keys[key % keys.len()]);
                prop_assert_eq!(OwnKeys::from_kept(own.kept()), own.clone());
            }
        }
    }
}
