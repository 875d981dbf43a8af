//! The table itself: what it promises to its readers.

use super::*;

#[test]
fn the_table_has_the_words_of_the_grammar() {
    let names: Vec<&str> = ALL.iter().map(|kind| kind.name).collect();
    assert_eq!(names, crate::syntax::build::KINDS);
}

#[test]
fn properties_have_unique_names_and_say_what_they_are() {
    for kind in ALL {
        let names: Vec<&str> = kind.properties().map(|p| p.name).collect();
        for (i, property) in kind.properties().enumerate() {
            assert!(!names[..i].contains(&property.name), "{}: {} twice", kind.name, property.name);
            assert!(
                !property.doc.is_empty() && !property.takes.is_empty(),
                "{}.{}",
                kind.name,
                property.name
            );
            assert!(!property.many || matches!(property.takes, [[_]]), "{}.{}", kind.name, property.name);
        }
        assert!(!kind.doc.is_empty() && !kind.example.is_empty(), "{}", kind.name);
        assert!(kind.example.contains(kind.name), "{} does not stand in its example", kind.name);
    }
}
