//! Diagnostics as text: for people (miette), for editors (one line each), for programs (JSON lines).
