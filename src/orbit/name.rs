//! Names that the program itself defines: keys of settings and actions, axes, fixed sentences. They
//! are constants that can be deserialised.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::{Arc, Mutex, PoisonError},
};

use serde::{Deserialize, Deserializer, de};

/// A constant of the program. The alias keeps serde from borrowing the text from its input. A field
/// of this type, or of a container of it, sets its `deserialize_with` to one of the functions
/// below.
pub type Name = &'static str;

/// Max number of names. Azel never frees names that it has read; the program has a few hundred.
const MAX_NAMES: usize = 4096;
/// Max length of a name, bytes. The longest sentence has some 200 bytes.
const MAX_BYTES: usize = 1024;

static NAMES: Mutex<BTreeSet<Name>> = Mutex::new(BTreeSet::new());

fn keep(text: &str) -> Result<Name, &'static str> {
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(existing) = names.get(text) {
        return Ok(existing);
    }
    if names.len() >= MAX_NAMES || text.len() > MAX_BYTES {
        return Err("more or longer names than this program has");
    }
    let name: Name = Box::leak(text.into());
    names.insert(name);
    Ok(name)
}

#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct ReadName(Name);

impl<'de> Deserialize<'de> for ReadName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Text;

        impl de::Visitor<'_> for Text {
            type Value = ReadName;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a name")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<ReadName, E> {
                keep(text).map(ReadName).map_err(E::custom)
            }
        }

        deserializer.deserialize_str(Text)
    }
}

pub fn one<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Name, D::Error> {
    ReadName::deserialize(deserializer).map(|name| name.0)
}

pub fn option<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Name>, D::Error> {
    Ok(Option::<ReadName>::deserialize(deserializer)?.map(|name| name.0))
}

pub fn list<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Name>, D::Error> {
    Ok(Vec::<ReadName>::deserialize(deserializer)?.into_iter().map(|name| name.0).collect())
}

pub fn map<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<BTreeMap<Name, T>, D::Error> {
    let read = BTreeMap::<ReadName, T>::deserialize(deserializer)?;
    Ok(read.into_iter().map(|(name, value)| (name.0, value)).collect())
}

pub fn option_map<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Option<BTreeMap<Name, T>>, D::Error> {
    let read = Option::<BTreeMap<ReadName, T>>::deserialize(deserializer)?;
    Ok(read.map(|read| read.into_iter().map(|(name, value)| (name.0, value)).collect()))
}

pub fn shared_map<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Arc<BTreeMap<Name, T>>, D::Error> {
    map(deserializer).map(Arc::new)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, serde::Serialize, Deserialize)]
    struct WrittenName {
        #[serde(deserialize_with = "one")]
        one: Name,
        #[serde(deserialize_with = "option")]
        option: Option<Name>,
        #[serde(deserialize_with = "list")]
        list: Vec<Name>,
        #[serde(deserialize_with = "map")]
        map: BTreeMap<Name, u8>,
    }

    #[test]
    fn names_come_back_and_are_kept_once() {
        let written = WrittenName {
            one: "azimuth",
            option: Some("a sentence, with \"quotes\""),
            list: vec!["a", "b"],
            map: [("azimuth", 1)].into(),
        };
        let text = serde_json::to_string(&written).unwrap();
        let read: WrittenName = serde_json::from_str(&text).unwrap();
        assert_eq!(read, written);
        assert!(std::ptr::eq(keep("azimuth").unwrap(), read.one));
    }

    #[test]
    fn a_name_longer_than_any_is_refused() {
        let text = serde_json::to_string(&"x".repeat(MAX_BYTES + 1)).unwrap();
        assert!(one(&mut serde_json::Deserializer::from_str(&text)).is_err());
    }
}
