//! Merging of new settings into the text of a station file that the operator may have edited.
//! Comments, order and spelling of unchanged entries stay.

use std::collections::BTreeMap;

use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

/// Key by which the merge matches the tables of an array, such as antennas. It matches other tables
/// by equal content or by name, else by position.
const ID: &str = "id";
const NAME: &str = "name";

/// Returns `new` with the comments and the order of `old`. Comments beside a removed setting go
/// with it. If the merged text would not have the content of `new`, returns `new` unchanged.
pub(super) fn rewritten(old: &str, new: &str) -> String {
    let is_valid = |merged: &str| is_same_text(merged, new);
    rewritten_with(old, old, new, &UnreadTree::default(), is_valid)
        .unwrap_or_else(|| new.to_owned())
}

/// Unreadable entries of a text.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct UnreadTree {
    /// `true` if the whole entry is unreadable.
    is_whole: bool,
    /// `true` if the entry was omitted from a list.
    is_left_out: bool,
    keys: BTreeMap<String, UnreadTree>,
    indices: BTreeMap<usize, UnreadTree>,
}

impl UnreadTree {
    /// Returns the entries at places such as `antenna[0].limits`, and the omitted list entries.
    pub(super) fn find<'a>(
        places: impl IntoIterator<Item = &'a str>,
        left_out: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let mut all = Self::default();
        for place in places {
            all.entry(place).is_whole = true;
        }
        for place in left_out {
            all.entry(place).is_left_out = true;
        }
        all
    }

    pub(super) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    fn entry(&mut self, place: &str) -> &mut Self {
        let mut here = self;
        for part in place.split('.') {
            let (key, index) = match part.split_once('[') {
                Some((key, rest)) => (key, rest.trim_end_matches(']').parse().ok()),
                None => (part, None),
            };
            here = here.keys.entry(key.to_owned()).or_default();
            if let Some(index) = index {
                here = here.indices.entry(index).or_default();
            }
        }
        here
    }
}

static ALL_READ: UnreadTree = UnreadTree {
    is_whole: false,
    is_left_out: false,
    keys: BTreeMap::new(),
    indices: BTreeMap::new(),
};

/// Merges like [`rewritten`], but keeps each unreadable entry of `old` unless the operator has
/// changed that setting. `read` is the readable part of `old`. Returns `None` if `is_valid` rejects
/// the text.
pub(super) fn rewritten_with(
    old: &str,
    read: &str,
    new: &str,
    unread: &UnreadTree,
    is_valid: impl Fn(&str) -> bool,
) -> Option<String> {
    let [mut text, target] = [old.parse::<DocumentMut>().ok()?, new.parse::<DocumentMut>().ok()?];
    let read = read.parse::<DocumentMut>().ok()?;
    merge(text.as_table_mut(), Some(read.as_table()), target.into_table(), unread);
    unplace(text.as_table_mut());
    let text = text.to_string();
    is_valid(&text).then_some(text)
}

fn is_same_text(one: &str, other: &str) -> bool {
    let [one, other] = [one, other].map(|text| toml::from_str::<toml::Table>(text).ok());
    one.is_some() && one == other
}

/// Merges `new` into `old`. `read` is the readable part of `old`.
fn merge(old: &mut dyn TableLike, read: Option<&dyn TableLike>, new: Table, unread: &UnreadTree) {
    let removed: Vec<String> =
        old.iter().map(|(key, _)| key.to_owned()).filter(|key| !new.contains_key(key)).collect();
    for key in removed {
        let unread = unread.keys.get(&key).unwrap_or(&ALL_READ);
        let was_read = read.is_some_and(|read| read.contains_key(&key));
        if unread.is_whole && !was_read {
            continue;
        }
        if unread.is_empty() {
            old.remove(&key);
        } else if let Some(old) = old.get_mut(&key) {
            let read = read.and_then(|read| read.get(&key));
            keep_unread(old, read, unread);
        }
    }
    for (key, new) in new {
        let unread = unread.keys.get(&key).unwrap_or(&ALL_READ);
        let read = read.and_then(|read| read.get(&key));
        match old.get_mut(&key) {
            Some(_) if unread.is_whole && read.is_some_and(|read| is_same_item(read, &new)) => {}
            Some(old) => merge_item(old, read, new, unread),
            None => drop(old.insert(&key, new)),
        }
    }
}

/// Removes everything from `old` except its unreadable entries.
fn keep_unread(old: &mut Item, read: Option<&Item>, unread: &UnreadTree) {
    let empty = match old {
        Item::ArrayOfTables(_) | Item::Value(Value::Array(_)) => {
            Item::ArrayOfTables(ArrayOfTables::new())
        }
        _ => Item::Table(Table::new()),
    };
    merge_item(old, read, empty, unread);
}

fn merge_item(old: &mut Item, read: Option<&Item>, new: Item, unread: &UnreadTree) {
    let mut new = new;
    // The new text has `antenna = []` for an empty list of tables.
    if new.as_array().is_some_and(Array::is_empty) && !unread.indices.is_empty() {
        new = Item::ArrayOfTables(ArrayOfTables::new());
    }
    if old.is_value() && !unread.indices.is_empty() {
        // The old entry is a list such as `keep_out = [{ name = "mast" }]`, perhaps with other
        // values.
        match std::mem::take(old).into_array_of_tables() {
            Ok(tables) if new.is_array_of_tables() => *old = Item::ArrayOfTables(tables),
            Ok(tables) => {
                *old =
                    Item::ArrayOfTables(tables).into_value().map_or_else(|item| item, Item::Value);
            }
            Err(unchanged) => {
                *old = unchanged;
                new = new.into_value().map_or_else(|item| item, Item::Value);
            }
        }
    }
    let read_table = read.and_then(Item::as_table_like);
    match (&mut *old, new) {
        (Item::Value(Value::Array(old)), Item::Value(Value::Array(new))) => {
            let unread = old.iter().enumerate().filter(|(index, _)| {
                unread.indices.get(index).is_some_and(|unread| unread.is_left_out)
            });
            let unread: Vec<_> = unread.map(|(index, value)| (index, value.clone())).collect();
            if unread.is_empty() && is_same_array(old, &new) {
                return;
            }
            merge_array(old, new);
            for (index, value) in unread {
                old.insert_formatted(index.min(old.len()), value);
            }
        }
        (Item::Value(old), Item::Value(new)) => merge_value(old, new),
        (Item::Table(old), Item::Table(new)) => {
            // Without a header or a dotted key, an empty table would be missing in the text.
            old.set_implicit(old.is_implicit() && !new.is_empty());
            old.set_dotted(old.is_dotted() && !new.is_empty());
            merge(old, read_table, new, unread);
        }
        (Item::ArrayOfTables(old), Item::ArrayOfTables(new)) => {
            merge_tables(old, read.and_then(Item::as_array_of_tables), new, unread);
        }
        // The old entry is a table such as `site = { latitude_deg = 41.0, longitude_deg = 29.0 }`.
        (Item::Value(Value::InlineTable(old)), Item::Table(new)) => {
            merge(old, read_table, new, unread);
        }
        (old, new) => *old = new,
    }
}

fn merge_value(old: &mut Value, new: Value) {
    if is_same(old, &new) {
        return;
    }
    let decor = old.decor().clone();
    match (&mut *old, new) {
        (Value::Array(old), Value::Array(new)) => merge_array(old, new),
        (Value::InlineTable(old), Value::InlineTable(new)) => {
            merge(old, None, new.into_table(), &ALL_READ);
        }
        (old, new) => *old = new,
    }
    *old.decor_mut() = decor;
}

/// Replaces the values of `old` with those of `new`, and keeps the comments of equal values.
fn merge_array(old: &mut Array, new: Array) {
    let mut rest: Vec<Option<Value>> = old.iter().cloned().map(Some).collect();
    old.clear();
    for new in new {
        let same =
            rest.iter_mut().find(|rest| rest.as_ref().is_some_and(|item| is_same(item, &new)));
        old.push_formatted(same.and_then(Option::take).unwrap_or(new));
    }
}

/// A table of the old text.
#[derive(Default)]
struct OldTable<'a> {
    table: Table,
    read: Option<&'a Table>,
    unread: Option<&'a UnreadTree>,
}

impl OldTable<'_> {
    /// Returns `true` if `is_known` matches this table, or its readable part, with `new`.
    fn matches(&self, is_known: fn(&Table, &Table) -> bool, new: &Table) -> bool {
        is_known(&self.table, new) || self.read.is_some_and(|read| is_known(read, new))
    }
}

fn merge_tables(
    old: &mut ArrayOfTables,
    read: Option<&ArrayOfTables>,
    new: ArrayOfTables,
    unread: &UnreadTree,
) {
    let mut read = read.into_iter().flat_map(ArrayOfTables::iter);
    let mut left_out: Vec<(usize, Table)> = Vec::new();
    let mut rest: Vec<Option<OldTable<'_>>> = Vec::new();
    for (index, table) in old.iter().cloned().enumerate() {
        let unread = unread.indices.get(&index);
        if unread.is_some_and(|unread| unread.is_left_out) {
            left_out.push((index, table));
        } else {
            rest.push(Some(OldTable { table, read: read.next(), unread }));
        }
    }
    let mut old_tables: Vec<Option<OldTable<'_>>> = new.iter().map(|_| None).collect();
    // Matches by id, content or name take their tables before matches by position.
    for is_known in [is_of_same_id, is_unchanged, is_of_same_name] {
        for (previous, new) in
            old_tables.iter_mut().zip(new.iter()).filter(|(previous, _)| previous.is_none())
        {
            let found = rest
                .iter_mut()
                .find(|rest| rest.as_ref().is_some_and(|old| old.matches(is_known, new)));
            *previous = found.and_then(Option::take);
        }
    }
    let mut tables = Vec::new();
    for (index, (previous, new)) in old_tables.into_iter().zip(new).enumerate() {
        let has_id = new.contains_key(ID);
        let mut take_same_index = || rest.get_mut(index).filter(|_| !has_id).and_then(Option::take);
        let OldTable { mut table, read, unread } =
            previous.or_else(&mut take_same_index).unwrap_or_default();
        let read = read.map(|read| read as &dyn TableLike);
        merge(&mut table, read, new, unread.unwrap_or(&ALL_READ));
        tables.push(table);
    }
    for (index, table) in left_out {
        tables.insert(index.min(tables.len()), table);
    }
    old.clear();
    for table in tables {
        old.push(table);
    }
}

fn is_of_same_id(old: &Table, new: &Table) -> bool {
    has_same(old, new, ID)
}

fn is_of_same_name(old: &Table, new: &Table) -> bool {
    !new.contains_key(ID) && has_same(old, new, NAME)
}

fn is_unchanged(old: &Table, new: &Table) -> bool {
    !new.contains_key(ID) && is_same_table(old, new)
}

fn has_same(old: &Table, new: &Table, key: &str) -> bool {
    let [old, new] = [old, new].map(|table| table.get(key).and_then(Item::as_value));
    old.zip(new).is_some_and(|(old, new)| is_same(old, new))
}

fn is_same_table(old: &dyn TableLike, new: &dyn TableLike) -> bool {
    let is_same =
        |(key, new): (&str, &Item)| old.get(key).is_some_and(|old| is_same_item(old, new));
    old.len() == new.len() && new.iter().all(is_same)
}

fn is_same_item(old: &Item, new: &Item) -> bool {
    if let (Some(old), Some(new)) = (old.as_table_like(), new.as_table_like()) {
        return is_same_table(old, new);
    }
    if let (Some(old), Some(new)) = (old.as_array_of_tables(), new.as_array_of_tables()) {
        let mut pairs = old.iter().zip(new.iter());
        return old.len() == new.len() && pairs.all(|(old, new)| is_same_table(old, new));
    }
    old.as_value().zip(new.as_value()).is_some_and(|(old, new)| is_same(old, new))
}

/// Returns `true` if both values are equal, in any spelling.
fn is_same(old: &Value, new: &Value) -> bool {
    match (old, new) {
        (Value::String(old), Value::String(new)) => old.value() == new.value(),
        (Value::Integer(old), Value::Integer(new)) => old.value() == new.value(),
        (Value::Float(old), Value::Float(new)) => old.value().to_bits() == new.value().to_bits(),
        (Value::Boolean(old), Value::Boolean(new)) => old.value() == new.value(),
        (Value::Datetime(old), Value::Datetime(new)) => old.value() == new.value(),
        (Value::Array(old), Value::Array(new)) => is_same_array(old, new),
        (Value::InlineTable(old), Value::InlineTable(new)) => {
            old.len() == new.len()
                && old.iter().all(|(key, old)| new.get(key).is_some_and(|new| is_same(old, new)))
        }
        _ => false,
    }
}

fn is_same_array(old: &Array, new: &Array) -> bool {
    old.len() == new.len() && old.iter().zip(new).all(|(old, new)| is_same(old, new))
}

/// Removes the text positions of the tables. Otherwise the tables of a moved antenna would follow
/// another antenna.
fn unplace(table: &mut Table) {
    table.set_position(None);
    for (_, item) in table.iter_mut() {
        match item {
            Item::Table(table) => unplace(table),
            Item::ArrayOfTables(tables) => tables.iter_mut().for_each(unplace),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const OLD: &str = r#"# Written by hand.
version = 1
name = 'Roof' # as on the door
favourites = [
    25544, # ISS
    # weather
    43013,
    57166,
]

# Measured with GPS.
site = { latitude_deg = 41.020, longitude_deg = 29.17 }

# The old dish.
[[antenna]]
id = 1
name = "Dish" # west
[antenna.limits]
maximum_rate_deg_s = 3 # the gear takes no more

# The new one.
[[antenna]]
id = 2
name = "Mast"
# end
"#;

    fn is_table_of(text: &str, expected: &str) {
        let [text, expected] =
            [text, expected].map(|text| toml::from_str::<toml::Table>(text).unwrap());
        assert_eq!(text, expected);
    }

    #[test]
    fn what_has_not_changed_stays_unchanged_written() {
        let new = r#"
version = 1
name = "Tower"
favourites = [43013, 25544, 40069]
[site]
latitude_deg = 41.02
longitude_deg = 29.5
[[antenna]]
id = 2
name = "Mast"
beam_width_deg = 2.0
[antenna.park]
azimuth_deg = 0.0
[[antenna]]
id = 1
name = "Dish"
[antenna.limits]
maximum_rate_deg_s = 3
[[antenna]]
id = 3
name = "Yagi"
[antenna.limits]
maximum_rate_deg_s = 6
"#;
        let text = rewritten(OLD, new);
        is_table_of(&text, new);
        for phrase in [
            "# Written by hand.",
            "name = \"Tower\" # as on the door",
            "# weather",
            "# Measured with GPS.\nsite = { latitude_deg = 41.020, longitude_deg = 29.5 }",
            "# The old dish.\n[[antenna]]\nid = 1",
            "name = \"Dish\" # west",
            "maximum_rate_deg_s = 3 # the gear takes no more",
            "# The new one.\n[[antenna]]\nid = 2",
        ] {
            assert!(text.contains(phrase), "{phrase:?} is lost:\n{text}");
        }
        assert_eq!(rewritten(&text, new), text, "a second time changes nothing");
    }

    #[test]
    fn the_comment_of_an_antenna_goes_with_it() {
        let new = "version = 1\n[[antenna]]\nid = 2\nname = \"Mast\"\n";
        let text = rewritten(OLD, new);
        is_table_of(&text, new);
        assert!(!text.contains("The old dish") && text.contains("# The new one."), "{text}");
    }

    #[test]
    fn the_comments_of_rules_and_groups_go_with_them() {
        let old = r#"# Clouds.
[[group]]
name = "Weather" # for the desk
satellites = [43013, 54234] # the two NOAA

[[group]]
name = "Stations"
satellites = [25544]

# The dish sleeps.
[[rule]]
antenna = 1
hours = { from = "22:00", to = "06:00" }
then = "park"

# The school.
[[rule]]
satellite = 25544 # ISS
then = "take"
"#;
        let new = r#"
[[group]]
name = "Stations"
satellites = [25544]
[[group]]
name = "Weather"
satellites = [43013]
[[rule]]
satellite = 25544
then = "take"
[[rule]]
antenna = 2
then = "leave"
[[rule]]
antenna = 1
then = "park"
[rule.hours]
from = "22:00"
to = "06:00"
"#;
        let text = rewritten(old, new);
        is_table_of(&text, new);
        for phrase in [
            "# Clouds.\n[[group]]\nname = \"Weather\" # for the desk",
            "# the two NOAA",
            "# The school.\n[[rule]]\nsatellite = 25544 # ISS",
            "# The dish sleeps.\n[[rule]]\nantenna = 1\nhours = { from",
        ] {
            assert!(text.contains(phrase), "{phrase:?} is lost:\n{text}");
        }
        assert_eq!(rewritten(&text, new), text, "a second time changes nothing");
    }

    fn any_table() -> impl Strategy<Value = toml::Table> {
        let key = || "[a-d]";
        let leaf = prop_oneof![
            (0_i64..3).prop_map(toml::Value::Integer),
            (0_i32..3).prop_map(|number| toml::Value::Float(f64::from(number) / 2.0)),
            "[a-c# \"]{0,4}".prop_map(toml::Value::String),
            prop::collection::vec((0_i64..4).prop_map(toml::Value::Integer), 0..4)
                .prop_map(toml::Value::Array),
        ];
        let value = leaf.prop_recursive(3, 24, 4, move |inner| {
            let table = prop::collection::btree_map(key(), inner, 0..4);
            let with_id = (prop::option::of(0_i64..4), table.clone()).prop_map(|(id, table)| {
                let id = id.map(|id| (ID.to_owned(), toml::Value::Integer(id)));
                toml::Value::Table(table.into_iter().chain(id).collect())
            });
            prop_oneof![
                table.prop_map(|table| toml::Value::Table(table.into_iter().collect())),
                prop::collection::vec(with_id, 0..4).prop_map(toml::Value::Array),
            ]
        });
        prop::collection::btree_map(key(), value, 0..5)
            .prop_map(|table| table.into_iter().collect())
    }

    proptest! {
        #[test]
        fn any_settings_go_into_any_text(old in any_table(), new in any_table(), is_long: bool) {
            let write = if is_long { toml::to_string_pretty } else { toml::to_string };
            let [old, new] = [&old, &new].map(|table| write(table).unwrap());
            let is_valid = |text: &str| is_same_text(text, &new);
            prop_assert!(rewritten_with(&old, &old, &new, &ALL_READ, is_valid).is_some(), "{old}\n---\n{new}");
        }
    }

    #[test]
    fn text_that_cannot_be_merged_is_replaced() {
        let new = "version = 1\nname = \"Tower\"\n";
        assert_eq!(rewritten("name = [", new), new);
        assert_eq!(rewritten("", new), new);
    }
}
