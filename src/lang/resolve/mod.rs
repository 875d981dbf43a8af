//! Names to slots: a syntax tree becomes a [`program::Program`] in which every name is a slot, a constant or a builtin, and
//! everything that can be told without running is told, also about code that never runs.
//!
//! Nothing is evaluated here.

mod blocks;
mod calls;
mod expressions;
mod items;
pub mod known;
pub mod load;
pub mod program;
mod scope;
pub mod straight;
mod words;

use super::builtins;
use super::limits::Limits;
use super::value::Value;
use crate::diag::{Code, Diagnostic, Sink, Span};
use crate::syntax::ast;
use known::{Known, Names};
use load::{FileId, Files};
use program::{Access, Body, Program, Unit, UnitId, Word};
use scope::{Declared, Owner, Scopes, Variable};
use std::collections::{HashMap, HashSet};

/// What a run is asked for, as far as names are concerned.
pub struct Setting<'a> {
    /// Guards.
    pub limits: Limits,
    /// `--set`: the top-level `let`s that are replaced, with what replaces them.
    pub set: &'a [(Word, ast::Expr)],
    /// `time`.
    pub time: f64,
    /// `frame`.
    pub frame: f64,
}

/// Resolves a file into what is known already: its items become the first unit of the program. Gives the names that are
/// visible after it; they are for [`Known::learn`].
pub fn resolve(
    known: &mut Known,
    files: &Files,
    root: FileId,
    setting: &Setting<'_>,
    sink: &mut Sink,
) -> Names {
    let before = std::mem::take(&mut known.names);
    let mut program = std::mem::take(&mut known.program);
    let mut resolver = Resolver {
        files,
        setting,
        sink,
        scopes: Scopes::with_globals(std::mem::take(&mut program.globals)),
        program,
        signatures: std::mem::take(&mut known.signatures),
        words: HashMap::new(),
        units: std::mem::take(&mut known.units),
        exports: std::mem::take(&mut known.exports),
        included: std::mem::take(&mut known.included),
        unknown_names: false,
        to_come: &[],
        at_root: true,
        used_settings: HashSet::new(),
    };
    let names = resolver.root(root, &before.0);
    resolver.report_unknown_settings(root);
    let Resolver { program, scopes, signatures, units, exports, included, .. } = resolver;
    let program = Program { globals: scopes.globals, ..program };
    *known = Known { program, signatures, units, exports, included, names: before };
    Names(names)
}

/// What a call must know of a function before its body is resolved.
#[derive(Clone, Debug)]
struct Signature {
    name: Word,
    span: Span,
    parameters: Vec<(Word, bool)>,
}

/// What a name means where it stands.
enum Meaning {
    Variable(Access, Variable),
    Constant(Value),
    Builtin(&'static super::table::Builtin),
}

/// What is around items, as far as properties are concerned.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// The top level of a file: no properties.
    Top,
    /// A function's body or a `with`: properties of a block that is not known yet.
    Loose,
    /// The braces of a block.
    Block(&'static super::table::Kind),
}

type Exports = HashMap<Word, (Access, Declared, Span)>;

struct Resolver<'a> {
    files: &'a Files,
    setting: &'a Setting<'a>,
    sink: &'a mut Sink,
    scopes: Scopes<'a>,
    program: Program,
    signatures: Vec<Signature>,
    words: HashMap<&'a str, Word>,
    units: HashMap<FileId, UnitId>,
    exports: HashMap<UnitId, Exports>,
    /// Files whose names are visible here by plain imports, outermost first.
    included: Vec<FileId>,
    /// An import failed, so that any name may be one of its names.
    unknown_names: bool,
    /// While a parameter's default is resolved, that parameter and those behind it.
    to_come: &'a [ast::Parameter],
    /// The root's unit is being resolved, not one imported with `as`.
    at_root: bool,
    used_settings: HashSet<usize>,
}

impl<'a> Resolver<'a> {
    /// The items of a root file as the first unit, in a scope inside that of the names that were known before. Gives all
    /// names that are known after it.
    fn root(&mut self, file: FileId, before: &'a Exports) -> Exports {
        let captures = self.scopes.new_captures();
        self.scopes.enter(Owner::Unit, captures);
        if self.program.units.is_empty() {
            self.program.units.push(Unit { body: Body::default(), n_slots: 0, scene: None });
        }
        let items = self.flatten_file(file);
        self.scopes.open_known(before.iter().map(|(name, meaning)| (&**name, *meaning)));
        self.scopes.open(items, true);
        let body = self.scope_items(Place::Top);
        let names = self.collect_exports();
        self.scopes.close();
        self.scopes.close();
        let n_slots = self.scopes.leave();
        self.program.units[0] = Unit { body, n_slots, scene: None };
        names
    }

    /// The unit of a file that is imported `as` something.
    fn unit(&mut self, file: FileId, import: Span) -> UnitId {
        if let Some(unit) = self.units.get(&file) {
            return *unit;
        }
        let id = UnitId(self.program.units.len() as u32);
        self.units.insert(file, id);
        self.program.units.push(Unit { body: Body::default(), n_slots: 0, scene: None });
        let aside = self.scopes.set_aside();
        let included = std::mem::take(&mut self.included);
        let unknown = std::mem::replace(&mut self.unknown_names, false);
        let at_root = std::mem::replace(&mut self.at_root, false);
        let captures = self.scopes.new_captures();
        self.scopes.enter(Owner::Unit, captures);
        let items = self.flatten_file(file);
        self.scopes.open(items, true);
        let body = self.scope_items(Place::Top);
        let exports = self.collect_exports();
        self.scopes.close();
        let n_slots = self.scopes.leave();
        self.scopes.restore(aside);
        self.included = included;
        self.unknown_names = unknown;
        self.at_root = at_root;
        let scene = self.scopes.unnamed_global(&"scene".into(), import);
        self.exports.insert(id, exports);
        self.program.units[id.0 as usize] = Unit { body, n_slots, scene: Some(scene) };
        id
    }

    fn collect_exports(&mut self) -> Exports {
        let mut exports = Exports::new();
        for name in self.scopes.names() {
            if let Some((access, variable)) = self.scopes.find(name) {
                exports.insert(self.word(name), (access, variable.declared, variable.span));
            }
        }
        exports
    }

    /// A shared copy of a text of the source.
    fn word(&mut self, text: &'a str) -> Word {
        self.words.entry(text).or_insert_with(|| text.into()).clone()
    }

    fn report(&mut self, mut diagnostic: Diagnostic) {
        if let Some(span) = diagnostic.span {
            diagnostic.trace.extend(self.files.import_trace(span.source));
        }
        self.sink.push(diagnostic);
    }

    fn meaning(&mut self, name: &str) -> Option<Meaning> {
        if let Some((access, variable)) = self.scopes.find(name) {
            return Some(Meaning::Variable(access, variable));
        }
        match name {
            "time" => return Some(Meaning::Constant(Value::Number(self.setting.time))),
            "frame" => return Some(Meaning::Constant(Value::Number(self.setting.frame))),
            "on" => return Some(Meaning::Constant(Value::Bool(true))),
            "off" => return Some(Meaning::Constant(Value::Bool(false))),
            _ => {}
        }
        if let Some(value) = builtins::constant(name) {
            return Some(Meaning::Constant(value));
        }
        builtins::find(name).map(Meaning::Builtin)
    }

    /// Whether a name means something here.
    fn in_scope(&self, name: &str) -> bool {
        self.scopes.has(name)
            || matches!(name, "time" | "frame" | "on" | "off")
            || builtins::constant(name).is_some()
            || builtins::find(name).is_some()
    }

    /// Declares a name in the innermost scope; a second one of the same name is reported.
    fn declare(&mut self, name: &'a ast::Ident, declared: Declared) -> Access {
        let word = self.word(&name.name);
        let (access, before) = self.scopes.declare(&name.name, &word, name.span, declared);
        if let Some(before) = before {
            let hint = match declared {
                Declared::Var | Declared::Value => {
                    "give one of them another name; a `var` is set again without `var`: `name = …`"
                }
                Declared::Function(_) | Declared::Module(_) | Declared::Poison => {
                    "give one of them another name"
                }
            };
            self.report(
                Diagnostic::new(
                    Code::DuplicateName,
                    name.span,
                    format!("`{}` is defined twice in this scope", name.name),
                )
                .label("again here")
                .also(before, "first here")
                .hint(hint),
            );
        }
        access
    }

    /// Says that a name means nothing here, unless a file is missing that may have defined it. A name that is nearly one of
    /// those here is a slip of the pen all the same.
    fn report_unknown(&mut self, name: &str, span: Span, words: &[&str]) {
        if let Some(parameter) = self.to_come.iter().find(|p| *p.name.name == *name) {
            let is_itself = std::ptr::eq(parameter, &self.to_come[0]);
            let what = if is_itself { "the parameter of this default" } else { "a parameter behind it" };
            let said = Diagnostic::new(Code::UsedBeforeSet, span, format!("`{name}` has no value yet here"))
                .label("not given yet")
                .also(parameter.name.span, what)
                .hint("a default may use the parameters before its own");
            return self.report(said);
        }
        if let Some(later) = self.scopes.declared_later(name) {
            return self.report(
                Diagnostic::new(Code::UsedBeforeSet, span, format!("`{name}` is used before it is defined"))
                    .label("not defined yet")
                    .also(later, "defined here")
                    .hint("items are evaluated in order: move the definition above its use"),
            );
        }
        let declared = self.scopes.names();
        let known: Vec<&str> = builtins::names().collect();
        let names = declared.iter().chain(&known).chain(words).map(|n| &**n);
        let mut said = Diagnostic::new(Code::UnknownName, span, format!("`{name}` is not defined"))
            .label("no such name here")
            .did_you_mean(name, names);
        if said.hints.is_empty() && self.unknown_names {
            return;
        }
        if said.hints.is_empty() && !words.is_empty() {
            said = said.hint(format!("this property takes one of the words {}", listed(words)));
        }
        self.report(said);
    }

    fn report_unknown_settings(&mut self, root: FileId) {
        let lets: Vec<&str> = self.files.files.get(root.0).map_or(Vec::new(), |f| {
            f.tree
                .items
                .iter()
                .filter_map(|i| if let ast::ItemKind::Let(n, _) = &i.kind { Some(&*n.name) } else { None })
                .collect()
        });
        for (i, (name, _)) in self.setting.set.iter().enumerate() {
            if !self.used_settings.contains(&i) && !self.unknown_names {
                let message = format!("`--set {name}=…` names no `let` of the scene's top level");
                let mut said = Diagnostic::new(Code::UnknownSetting, None, message)
                    .did_you_mean(name, lets.iter().copied());
                if said.hints.is_empty() {
                    said = said.hint(match lets.len() {
                        0 => "the scene has no top-level `let`".to_owned(),
                        _ => format!("it has {}", listed(&lets)),
                    });
                }
                self.sink.push(said);
            }
        }
    }
}

/// "`a`, `b` and `c`", at most eight of them.
fn listed(names: &[&str]) -> String {
    const SHOWN: usize = 8;
    let mut shown: Vec<String> = names.iter().take(SHOWN).map(|n| format!("`{n}`")).collect();
    if names.len() > SHOWN {
        shown.push("…".into());
    }
    match shown.len() {
        0 | 1 => shown.concat(),
        n => format!("{} and {}", shown[..n - 1].join(", "), shown[n - 1]),
    }
}
