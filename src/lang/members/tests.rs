//! The table's promises.

use super::*;

#[test]
fn members_are_documented_and_stand_in_order() {
    for family in FAMILIES {
        for (i, member) in family.members.iter().enumerate() {
            let (written, gives) = member.example;
            assert!(!member.doc.is_empty() && !gives.is_empty(), "{}", member.name);
            assert!(written.contains(&format!(".{}", member.name)) || member.form == Form::Call);
            assert_eq!(member.form == Form::Call, member.name.is_empty());
            assert!(member.form != Form::Call || i == 0, "the call stands first");
            assert!(member.form != Form::Field || (member.parameters.is_empty() && member.sampled.is_none()));
            assert!(member.sampled.is_none() || member.parameters.len() == 1, "tapes pass one argument");
            let same = |m: &Member| m.name == member.name && m.form == member.form;
            assert!(!family.members[..i].iter().any(same), "{} twice", member.name);
            let defaults = member.parameters.iter().filter_map(|p| p.default);
            assert!(defaults.into_iter().all(|d| builtins::default_value(d).is_some()));
        }
    }
}
