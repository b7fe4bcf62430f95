//! Links, sessions, intents and the gate.
