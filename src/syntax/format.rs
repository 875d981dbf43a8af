//! The canonical layout of a file: `ogee fmt`. Keeps every comment and the syntax tree; idempotent.
