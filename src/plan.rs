//! Mount model and trackability.
