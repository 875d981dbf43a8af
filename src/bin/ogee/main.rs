//! The command `ogee`: parses its arguments, calls the library, prints, and exits. Printing and exit codes live here alone.

fn main() {}
