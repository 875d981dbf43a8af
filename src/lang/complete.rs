//! Completion: the words that may stand where a person types, from the tables of kinds, functions and constants and from
//! the names in scope. Knows nothing of terminals and evaluates nothing.

use super::builtins;
use super::kinds::{self, common};
use super::members::{self, Family};
use super::table::{Builtin, Kind, Role};
use crate::syntax::build::{KEYWORDS, KINDS, continues_word};
use crate::syntax::unfinished::End;
use std::collections::{BTreeSet, HashMap};

/// What is in scope beside the tables.
#[derive(Clone, Debug, Default)]
pub struct Visible {
    /// Names of items.
    pub names: Vec<String>,
    /// What stands behind a dot after some of them.
    pub members: HashMap<String, Vec<String>>,
}

/// What may stand there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Completion {
    /// Where the word begins that is being typed.
    pub start: usize,
    /// The words that begin so, in alphabetical order.
    pub words: Vec<String>,
}

/// Completes the end of a text. Nothing within comments and texts.
pub fn complete(text: &str, visible: &Visible) -> Completion {
    let start = text.trim_end_matches(continues_word).len();
    let (before, typed) = text.split_at(start);
    let end = End::of(before);
    let begins_a_name = !typed.starts_with(|c: char| c.is_numeric());
    if end.in_text() || end.in_comment || end.in_remark || end.faulty || !begins_a_name {
        return Completion { start, words: Vec::new() };
    }
    let words = match before.strip_suffix('.') {
        Some(value) if value.ends_with('.') => expression_words(visible),
        Some(value) => members_of(value, visible),
        None => words_at(before, &end, typed.is_empty(), visible),
    };
    let mut words: Vec<String> =
        words.into_iter().filter(|word| word.starts_with(typed) && *word != typed).collect();
    if begins_item(before, &end) && words.iter().any(|word| builtins::find(word).is_none()) {
        // Where an item of a block begins, a function is what is wanted least.
        words.retain(|word| builtins::find(word).is_none());
    }
    Completion { start, words }
}

/// The components of vectors.
pub const LETTERS: [&str; 4] = ["x", "y", "z", "w"];

/// The names of a family's members.
pub fn names_of(family: &Family) -> impl Iterator<Item = &'static str> {
    family.members.iter().map(|member| member.name).filter(|name| !name.is_empty())
}

/// Whether an item of a block begins at the end of a text.
fn begins_item(before: &str, end: &End) -> bool {
    end.open.last().is_some_and(|(closer, _)| *closer == b'}')
        && before.trim_end_matches([' ', '\t']).ends_with(['{', '}', ';', '\n'])
}

/// What stands behind a dot: of a name that is known its own, of anything else what any value may have.
fn members_of(value: &str, visible: &Visible) -> BTreeSet<String> {
    let name = &value[value.trim_end_matches(continues_word).len()..];
    match visible.members.get(name) {
        Some(members) => members.iter().cloned().collect(),
        None if name.starts_with(|c: char| c.is_numeric()) => BTreeSet::new(),
        None => {
            let families = members::FAMILIES.iter().flat_map(|family| names_of(family));
            LETTERS.into_iter().chain(families).map(str::to_owned).collect()
        }
    }
}

/// Names, functions and constants.
fn expression_words(visible: &Visible) -> BTreeSet<String> {
    let tables = builtins::names().chain(["time", "frame", "true", "false"]).map(str::to_owned);
    visible.names.iter().cloned().chain(tables).collect()
}

fn words_at(before: &str, end: &End, nothing_typed: bool, visible: &Visible) -> BTreeSet<String> {
    let innermost = end.open.last();
    let mut words = match (innermost, nothing_typed) {
        // A list of all that there is helps nobody.
        (Some((b'}', _)) | None, true) => visible.names.iter().cloned().collect(),
        _ => expression_words(visible),
    };
    let at_item = match innermost {
        Some((b')', at)) => {
            words.extend(called(&before[..*at]).into_iter().flat_map(named_arguments));
            false
        }
        Some((b'}', _)) | None => true,
        Some(_) => false,
    };
    if at_item {
        let block = block_around(before, end);
        let item = before.rsplit([';', '\n', '{', '}']).next().unwrap_or_default();
        words.extend(item_words(block, item, nothing_typed));
    }
    words
}

/// Properties of the block around, the words that the item's property takes, and what begins an item.
fn item_words(block: Around, item: &str, nothing_typed: bool) -> Vec<String> {
    let mut words: Vec<&str> = match block {
        Around::Kind(kind) => kind.properties().map(|p| p.name).collect(),
        Around::Any => kinds::ALL
            .iter()
            .flat_map(|kind| kind.own)
            .chain(common::of_role(Role::Object))
            .map(|p| p.name)
            .collect(),
        Around::Top => Vec::new(),
    };
    if let Around::Kind(kind) = block {
        // The last word of the item that is a property says what may follow it.
        let named = |word: &str| kind.property(word);
        words.extend(item.split_whitespace().rev().find_map(named).into_iter().flat_map(|p| p.words()));
    }
    if !nothing_typed {
        words.extend(KINDS.iter().chain(KEYWORDS));
    }
    words.into_iter().map(str::to_owned).collect()
}

/// What is around a place among items.
#[derive(Clone, Copy)]
enum Around {
    /// No braces.
    Top,
    /// The braces of a block.
    Kind(&'static Kind),
    /// The braces of a function or of `with`: properties of any block.
    Any,
}

fn block_around(text: &str, end: &End) -> Around {
    for (_, at) in end.open.iter().rev().filter(|(closer, _)| *closer == b'}') {
        let head = text[..*at].trim_end();
        let head = head.rsplit([';', '\n', '{', '}']).next().unwrap_or_default();
        let mut words = head.split_whitespace().rev();
        let (last, before) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        if let Some(kind) = kinds::find(last).or_else(|| kinds::find(before)) {
            return Around::Kind(kind);
        }
        if last == "with" || head.trim_start().starts_with("fn ") {
            return Around::Any;
        }
    }
    Around::Top
}

/// The builtin whose call a bracket opens.
fn called(before: &str) -> Option<&'static Builtin> {
    builtins::find(&before[before.trim_end_matches(continues_word).len()..])
}

fn named_arguments(builtin: &'static Builtin) -> impl Iterator<Item = String> {
    builtin.parameters.iter().map(|parameter| format!("{}:", parameter.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        let members = HashMap::from([("trees".to_owned(), vec!["oak".to_owned(), "scene".to_owned()])]);
        complete(text, &Visible { names: vec!["radiance_of_sun".into(), "trees".into()], members }).words
    }

    #[test]
    fn properties_are_those_of_the_block_around() {
        assert!(words("sphere { rad").contains(&"radius".to_owned()));
        assert_eq!(words("sphere { radius 1  cen"), ["center"]);
        assert_eq!(words("sphere {\n  radiu"), ["radius"]);
        assert_eq!(words("sphere {\n  rad"), ["radiance_of_sun", "radius"]);
        assert_eq!(words("sphere {\n  radian"), ["radiance_of_sun"]);
        assert_eq!(words("sphere {\n  smooths"), ["smoothstep"]);
        assert!(words("torus ring { ra").contains(&"radii".to_owned()));
        assert_eq!(words("sphere { material { expo"), ["exponent"]);
        assert!(words("sphere { material { diffuse 1 }\n ra").contains(&"radius".to_owned()));
        assert!(words("sphere { if a { rad").contains(&"radius".to_owned()));
        assert!(!words("rad").contains(&"radius".to_owned()));
        assert!(words("fn f() {\n expo").contains(&"exponent".to_owned()));
    }

    #[test]
    fn words_of_an_enumeration_follow_their_property() {
        assert_eq!(words("material { lobe pho"), ["phong"]);
        assert!(words("camera { projection ").contains(&"fisheye".to_owned()));
    }

    #[test]
    fn names_functions_constants_and_kinds_are_offered_where_they_may_stand() {
        assert_eq!(words("radia"), ["radiance_of_sun", "radians"]);
        assert_eq!(words("smooths"), ["smoothstep"]);
        assert_eq!(words("1 + tau"), Vec::<String>::new());
        assert!(words("1 + ta").contains(&"tau".to_owned()));
        assert_eq!(words("spher"), ["sphere"]);
        assert!(!words("max(spher").contains(&"sphere".to_owned()));
        assert_eq!(words("image(\"a.png\", wra"), ["wrap:"]);
    }

    #[test]
    fn members_follow_a_dot_and_ranges_do_not() {
        assert_eq!(words("trees."), ["oak", "scene"]);
        assert_eq!(words("trees.o"), ["oak"]);
        assert_eq!(words("f(1).x"), Vec::<String>::new());
        assert_eq!(words("f(1).curv"), ["curvature"]);
        assert!(words("0..ta").contains(&"tau".to_owned()));
    }

    #[test]
    fn nothing_is_offered_in_texts_comments_and_numbers() {
        for text in ["\"sph", "// sph", "/* sph", "1e", "sphere { radius 1 } } sph"] {
            assert_eq!(words(text), Vec::<String>::new(), "{text}");
        }
    }

    #[test]
    fn with_nothing_typed_only_what_is_near_is_listed() {
        assert_eq!(words(""), ["radiance_of_sun", "trees"]);
        assert!(words("sphere { ").len() < 20);
    }
}
