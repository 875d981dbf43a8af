//! Scopes: which name means which slot. Functions see all names of the blocks around them, also those declared later;
//! everything else sees the names declared before it.

use super::program::{Access, Capture, FunctionId, UnitId, Word};
use crate::diag::Span;
use crate::syntax::ast;
use std::collections::HashMap;

/// Index into [`Scopes::variables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VariableId(u32);

/// What a name was declared as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declared {
    /// `let`, a parameter, a loop's variable or a block's label: never assigned again.
    Value,
    /// `var`.
    Var,
    /// `fn`.
    Function(FunctionId),
    /// `import … as`.
    Module(UnitId),
    /// Something that could not be read: its uses are silent.
    Poison,
}

/// A declared name.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// What as.
    pub declared: Declared,
    /// The name's place.
    pub span: Span,
    place: Place,
    scope: u32,
}

#[derive(Clone, Copy, Debug)]
enum Place {
    Global(u32),
    Local(u32),
}

/// What encloses a scope's names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The top level of a unit: its slots are the unit's frame.
    Unit,
    /// A function of the functions of this scope, which share their captures.
    Declared {
        /// The scope they are declared in.
        scope: u32,
    },
    /// A lambda.
    Lambda,
}

struct Scope<'a> {
    id: u32,
    names: HashMap<&'a str, VariableId>,
    items: Vec<&'a ast::Item>,
    first_slot: u32,
    global: bool,
}

struct Context<'a> {
    owner: Owner,
    captures: usize,
    scopes: Vec<Scope<'a>>,
    next_slot: u32,
    n_slots: u32,
    returns: bool,
}

#[derive(Default)]
struct Captures {
    sources: Vec<Capture>,
    of: HashMap<VariableId, u32>,
}

/// The scopes around the place that is being resolved.
#[derive(Default)]
pub struct Scopes<'a> {
    contexts: Vec<Context<'a>>,
    variables: Vec<Variable>,
    captures: Vec<Captures>,
    n_scopes: u32,
    /// Every top-level name of every unit, by its global slot.
    pub globals: Vec<(Word, Span)>,
}

/// What was around a unit.
pub struct Aside<'a>(Vec<Context<'a>>);

/// A list of captures that is being filled.
#[derive(Clone, Copy, Debug)]
pub struct CaptureList(usize);

impl<'a> Scopes<'a> {
    /// No scope yet, but global slots that are taken.
    pub fn with_globals(globals: Vec<(Word, Span)>) -> Self {
        Scopes { globals, ..Scopes::default() }
    }

    /// An empty list of captures, for a lambda or for the functions of a scope.
    pub fn new_captures(&mut self) -> CaptureList {
        self.captures.push(Captures::default());
        CaptureList(self.captures.len() - 1)
    }

    /// What was captured.
    pub fn take_captures(&mut self, list: CaptureList) -> Vec<Capture> {
        std::mem::take(&mut self.captures[list.0].sources)
    }

    /// Enters a unit or function.
    pub fn enter(&mut self, owner: Owner, captures: CaptureList) {
        let returns = matches!(owner, Owner::Declared { .. });
        self.contexts.push(Context {
            owner,
            captures: captures.0,
            scopes: Vec::new(),
            next_slot: 0,
            n_slots: 0,
            returns,
        });
    }

    /// Leaves it; how many slots its frame needs.
    pub fn leave(&mut self) -> u32 {
        self.contexts.pop().expect("every leave follows an enter").n_slots
    }

    /// Sets what is around aside, for a unit that sees nothing of it.
    pub fn set_aside(&mut self) -> Aside<'a> {
        Aside(std::mem::take(&mut self.contexts))
    }

    /// Goes on where [`Scopes::set_aside`] left.
    pub fn restore(&mut self, aside: Aside<'a>) {
        self.contexts = aside.0;
    }

    fn context(&mut self) -> &mut Context<'a> {
        self.contexts.last_mut().expect("names are resolved inside a unit")
    }

    /// Opens a scope; `items` are those that it will hold, `global` says that its names are the unit's.
    pub fn open(&mut self, items: Vec<&'a ast::Item>, global: bool) -> u32 {
        self.n_scopes += 1;
        let id = self.n_scopes;
        let context = self.context();
        let first_slot = context.next_slot;
        context.scopes.push(Scope { id, names: HashMap::new(), items, first_slot, global });
        id
    }

    /// Opens a scope of names that have their global slots already.
    pub fn open_known(&mut self, names: impl Iterator<Item = (&'a str, (Access, Declared, Span))>) {
        let scope = self.open(Vec::new(), true);
        for (name, (access, declared, span)) in names {
            let Access::Global(slot) = access else { continue };
            let id = VariableId(self.variables.len() as u32);
            self.variables.push(Variable { declared, span, place: Place::Global(slot), scope });
            let innermost = self.context().scopes.last_mut().expect("a scope was just opened");
            innermost.names.insert(name, id);
        }
    }

    /// Closes the innermost scope; its slots are free again.
    pub fn close(&mut self) {
        let context = self.context();
        let scope = context.scopes.pop().expect("every close follows an open");
        context.next_slot = scope.first_slot;
    }

    /// The items of the innermost scope.
    pub fn items(&mut self) -> Vec<&'a ast::Item> {
        let scope = self.context().scopes.last().expect("items stand in a scope");
        scope.items.clone()
    }

    /// Whether `return` may stand here, and a setter that gives the former answer.
    pub fn set_returns(&mut self, returns: bool) -> bool {
        std::mem::replace(&mut self.context().returns, returns)
    }

    /// Declares a name in the innermost scope. An error is the place where the scope already has it; the name then means
    /// the new variable.
    pub fn declare(
        &mut self,
        name: &'a str,
        word: &Word,
        span: Span,
        declared: Declared,
    ) -> (Access, Option<Span>) {
        let id = VariableId(self.variables.len() as u32);
        let n_globals = self.globals.len() as u32;
        let context = self.contexts.last_mut().expect("names are declared inside a unit");
        let scope = context.scopes.last_mut().expect("names are declared inside a scope");
        let (place, access) = if scope.global {
            self.globals.push((word.clone(), span));
            (Place::Global(n_globals), Access::Global(n_globals))
        } else {
            let slot = context.next_slot;
            context.next_slot += 1;
            context.n_slots = context.n_slots.max(context.next_slot);
            (Place::Local(slot), Access::Local(slot))
        };
        self.variables.push(Variable { declared, span, place, scope: scope.id });
        let before = scope.names.insert(name, id);
        (access, before.map(|b| self.variables[b.0 as usize].span))
    }

    /// A global slot that no name of the scene reaches.
    pub fn unnamed_global(&mut self, word: &Word, span: Span) -> u32 {
        self.globals.push((word.clone(), span));
        self.globals.len() as u32 - 1
    }

    /// What a name means here.
    pub fn find(&mut self, name: &str) -> Option<(Access, Variable)> {
        for context_idx in (0..self.contexts.len()).rev() {
            for scope_idx in (0..self.contexts[context_idx].scopes.len()).rev() {
                if let Some(&id) = self.contexts[context_idx].scopes[scope_idx].names.get(name) {
                    let variable = self.variables[id.0 as usize];
                    return Some((self.access(id, variable, context_idx), variable));
                }
            }
        }
        None
    }

    /// Whether a name means something here; captures nothing.
    pub fn has(&self, name: &str) -> bool {
        self.contexts.iter().any(|c| c.scopes.iter().any(|s| s.names.contains_key(name)))
    }

    fn access(&mut self, id: VariableId, variable: Variable, context_idx: usize) -> Access {
        let slot = match variable.place {
            Place::Global(slot) => return Access::Global(slot),
            Place::Local(slot) => slot,
        };
        let mut access = Access::Local(slot);
        for inner in context_idx + 1..self.contexts.len() {
            let owner = self.contexts[inner].owner;
            let same_block = owner == Owner::Declared { scope: variable.scope };
            access = match (access, variable.declared) {
                (Access::Local(_), Declared::Function(function)) if same_block => Access::Sibling(function),
                _ => self.capture(id, variable, access, same_block, inner),
            };
        }
        access
    }

    /// Captures a variable, found at `access` in the context outside `inner`, into `inner`.
    fn capture(
        &mut self,
        id: VariableId,
        variable: Variable,
        access: Access,
        same_block: bool,
        inner: usize,
    ) -> Access {
        let list = &mut self.captures[self.contexts[inner].captures];
        let index = *list.of.entry(id).or_insert_with(|| {
            list.sources.push(match access {
                Access::Local(slot) if same_block => Capture::Fresh(slot),
                Access::Local(slot) if variable.declared == Declared::Var => Capture::Reference(slot),
                Access::Local(slot) => Capture::Value(slot),
                Access::Captured(slot) => Capture::Outer(slot),
                Access::Sibling(function) => Capture::Sibling(function),
                Access::Global(_) => unreachable!("globals are not captured"),
            });
            list.sources.len() as u32 - 1
        });
        Access::Captured(index)
    }

    /// Where a name that is not yet declared will be, in the blocks around: for "used before it is defined".
    pub fn declared_later(&self, name: &str) -> Option<Span> {
        let scopes = self.contexts.iter().rev().flat_map(|c| c.scopes.iter().rev());
        scopes
            .flat_map(|s| s.items.iter())
            .filter_map(|item| declares(item))
            .find(|n| &*n.name == name)
            .map(|n| n.span)
    }

    /// Every name that means something here.
    pub fn names(&self) -> Vec<&'a str> {
        self.contexts.iter().flat_map(|c| c.scopes.iter()).flat_map(|s| s.names.keys().copied()).collect()
    }

    /// The innermost scope's number.
    pub fn innermost(&mut self) -> u32 {
        self.context().scopes.last().expect("items stand in a scope").id
    }

    /// Whether this is the top level of a unit.
    pub fn at_top(&self) -> bool {
        matches!(&self.contexts[..], [unit] if unit.scopes.last().is_some_and(|scope| scope.global))
    }

    /// Whether `return` may stand here.
    pub fn may_return(&self) -> bool {
        self.contexts.last().is_some_and(|c| c.returns)
    }
}

/// The name that an item declares in its scope.
pub fn declares(item: &ast::Item) -> Option<&ast::Ident> {
    match &item.kind {
        ast::ItemKind::Let(name, _) | ast::ItemKind::Var(name, _) => Some(name),
        ast::ItemKind::Function(function) => Some(&function.name),
        ast::ItemKind::Block(block) => block.label.as_ref(),
        ast::ItemKind::Import(import) => import.alias.as_ref(),
        ast::ItemKind::Bad { defines } => defines.as_ref(),
        ast::ItemKind::Property(_)
        | ast::ItemKind::Placement(_)
        | ast::ItemKind::Assign(..)
        | ast::ItemKind::Return(_)
        | ast::ItemKind::If(_)
        | ast::ItemKind::For(_)
        | ast::ItemKind::While(_) => None,
    }
}
