//! Enums that are numbers on the wire.

/// Declares an enum with a number for each variant. `Unknown` keeps a number without a meaning.
macro_rules! coded {
    ($(#[$about:meta])* $name:ident { $($(#[$doc:meta])* $variant:ident = $code:literal,)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name {
            $($(#[$doc])* $variant,)*
            /// A number that the document does not explain.
            Unknown(i64),
        }

        impl $name {
            pub const fn from_code(code: i64) -> Self {
                match code {
                    $($code => Self::$variant,)*
                    // One unexplained number must not invalidate all other values of a reply.
                    other => Self::Unknown(other),
                }
            }

            pub const fn code(self) -> i64 {
                match self {
                    $(Self::$variant => $code,)*
                    Self::Unknown(other) => other,
                }
            }
        }
    };
}

pub(super) use coded;
