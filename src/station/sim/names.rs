//! Names of quirks and faults.

#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown {subject} {name:?}; known are {}", valid.join(", "))]
pub struct UnknownName {
    /// Expected kind of name.
    pub subject: &'static str,
    /// Given name.
    pub name: String,
    /// All known names.
    pub valid: Vec<&'static str>,
}

/// Implements parsing and formatting by name, for types with a table `ALL` of values and names.
macro_rules! named {
    ($($type:ident is $subject:literal),* $(,)?) => {$(
        impl std::str::FromStr for $type {
            type Err = $crate::sim::UnknownName;
            fn from_str(name: &str) -> Result<Self, Self::Err> {
                let found = Self::ALL.iter().find(|(_, valid)| *valid == name);
                found.map(|(value, _)| *value).ok_or_else(|| $crate::sim::UnknownName {
                    subject: $subject,
                    name: name.to_owned(),
                    valid: Self::ALL.iter().map(|(_, name)| *name).collect(),
                })
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let named = Self::ALL.iter().find(|(value, _)| value == self);
                f.write_str(named.map_or("", |(_, name)| name))
            }
        }
    )*};
}

pub(super) use named;

/// Checks that the names of `all` are parsed to their values, and that the error for a wrong name
/// lists all names.
#[cfg(test)]
pub(super) fn assert_read_back<T>(all: &[(T, &str)])
where
    T: std::str::FromStr<Err = UnknownName>
        + std::fmt::Display
        + std::fmt::Debug
        + Copy
        + PartialEq,
{
    for (value, name) in all {
        assert_eq!(name.parse(), Ok(*value));
        assert_eq!(value.to_string(), *name);
    }
    let error = "no such name".parse::<T>().unwrap_err().to_string();
    let names: Vec<&str> = all.iter().map(|(_, name)| *name).collect();
    assert!(error.contains("no such name") && error.contains(&names.join(", ")), "{error}");
}
