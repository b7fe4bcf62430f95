//! Names by which oddities and failures are switched on.

/// A name that stands for nothing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown {what} {name:?}; known are {}", known.join(", "))]
pub struct UnknownName {
    /// What was looked for.
    pub what: &'static str,
    /// As given.
    pub name: String,
    /// The names that stand for something.
    pub known: Vec<&'static str>,
}

/// What the name stands for.
pub(super) fn find<T: Copy>(
    what: &'static str,
    all: &[(T, &'static str)],
    name: &str,
) -> Result<T, UnknownName> {
    let found = all.iter().find(|(_, known)| *known == name).map(|(value, _)| *value);
    found.ok_or_else(|| UnknownName {
        what,
        name: name.to_owned(),
        known: all.iter().map(|(_, known)| *known).collect(),
    })
}

/// The name, empty when it has none.
pub(super) fn name_of<T: PartialEq>(all: &[(T, &'static str)], value: &T) -> &'static str {
    all.iter().find(|(known, _)| known == value).map_or("", |(_, name)| name)
}
