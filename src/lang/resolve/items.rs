//! Items and the scopes that they make.

use super::blocks::BlockOrPoison;
use super::load::FileId;
use super::program::{
    Access, Body, Expr, For, Function, FunctionBody, FunctionId, Functions, If, Item, ItemKind, Parameter,
    Property, While, Word,
};
use super::scope::{CaptureList, Declared, Owner};
use super::{Place, Resolver, Signature};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::builtins;
use crate::lang::table::Kind;
use crate::syntax::ast;

impl<'a> Resolver<'a> {
    /// A file's items with those of its plain imports in their places, each file once in a unit.
    pub(super) fn flatten_file(&mut self, file: FileId) -> Vec<&'a ast::Item> {
        self.included.push(file);
        let files = self.files;
        self.flatten(&files.files[file.0].tree.items)
    }

    fn flatten(&mut self, items: &'a [ast::Item]) -> Vec<&'a ast::Item> {
        let mut flat = Vec::with_capacity(items.len());
        for item in items {
            match &item.kind {
                ast::ItemKind::Import(import) if import.alias.is_none() => {
                    match self.files.imports.get(&import.path_span) {
                        Some(file) if self.included.contains(file) => {}
                        Some(file) => flat.append(&mut self.flatten_file(*file)),
                        None => self.unknown_names = true,
                    }
                }
                _ => flat.push(item),
            }
        }
        flat
    }

    /// Items in a scope of their own.
    pub(super) fn body(&mut self, items: &'a [ast::Item], place: Place) -> Body {
        let n_included = self.included.len();
        let items = self.flatten(items);
        self.scopes.open(items, false);
        let body = self.scope_items(place);
        self.scopes.close();
        self.included.truncate(n_included);
        body
    }

    /// The items of the scope that was just opened: its functions are declared first and resolved last.
    pub(super) fn scope_items(&mut self, place: Place) -> Body {
        let items = self.scopes.items();
        let declared: Vec<(&'a ast::Function, Access, FunctionId)> = items
            .iter()
            .filter_map(|item| match &item.kind {
                ast::ItemKind::Function(function) => Some(self.declare_function(function)),
                _ => None,
            })
            .collect();
        let resolved = items.iter().filter_map(|item| self.item(item, place)).collect();
        let functions = (!declared.is_empty()).then(|| Box::new(self.functions(&declared)));
        Body { items: resolved, functions }
    }

    fn declare_function(&mut self, function: &'a ast::Function) -> (&'a ast::Function, Access, FunctionId) {
        let id = self.new_function(Some(&function.name), &function.parameters, function.name.span);
        (function, self.declare(&function.name, Declared::Function(id)), id)
    }

    /// A place for a function whose body is not resolved yet.
    pub(super) fn new_function(
        &mut self,
        name: Option<&'a ast::Ident>,
        parameters: &'a [ast::Parameter],
        span: Span,
    ) -> FunctionId {
        let id = FunctionId(self.program.functions.len() as u32);
        let name = name.map(|n| self.word(&n.name));
        let parameters = parameters.iter().map(|p| (self.word(&p.name.name), p.default.is_some())).collect();
        self.signatures.push(Signature {
            name: name.clone().unwrap_or_else(|| "=>".into()),
            span,
            parameters,
        });
        let body = FunctionBody::Items(Body::default());
        self.program.functions.push(Function { name, parameters: Vec::new(), n_slots: 0, body, span });
        id
    }

    fn functions(&mut self, declared: &[(&'a ast::Function, Access, FunctionId)]) -> Functions {
        let captures = self.scopes.new_captures();
        let scope = self.scopes.innermost();
        for (function, _, id) in declared {
            self.function_body(*id, &function.parameters, Owner::Declared { scope }, captures, |resolver| {
                match &function.body {
                    ast::Body::Expr(e) => FunctionBody::Expr(resolver.expr(e)),
                    ast::Body::Items(items) => FunctionBody::Items(resolver.body(items, Place::Loose)),
                }
            });
        }
        let bindings = declared.iter().map(|(_, access, id)| (*access, *id)).collect();
        Functions { bindings, captures: self.scopes.take_captures(captures) }
    }

    /// Resolves a function's parameters and body in a context of its own.
    pub(super) fn function_body(
        &mut self,
        id: FunctionId,
        parameters: &'a [ast::Parameter],
        owner: Owner,
        captures: CaptureList,
        body: impl FnOnce(&mut Self) -> FunctionBody,
    ) {
        self.scopes.enter(owner, captures);
        self.scopes.open(Vec::new(), false);
        let mut resolved: Vec<Parameter> = Vec::with_capacity(parameters.len());
        for (i, parameter) in parameters.iter().enumerate() {
            let around = std::mem::replace(&mut self.to_come, &parameters[i..]);
            let default = parameter.default.as_ref().map(|e| self.expr(e));
            self.to_come = around;
            if default.is_none() && resolved.last().is_some_and(|p| p.default.is_some()) {
                self.report_default_before(parameter);
            }
            self.declare(&parameter.name, Declared::Value);
            resolved.push(Parameter { name: self.word(&parameter.name.name), default });
        }
        let body = body(self);
        self.scopes.close();
        let n_slots = self.scopes.leave();
        let function = &mut self.program.functions[id.0 as usize];
        function.parameters = resolved;
        function.n_slots = n_slots;
        function.body = body;
    }

    fn report_default_before(&mut self, parameter: &ast::Parameter) {
        self.report(
            Diagnostic::new(
                Code::WrongArity,
                parameter.name.span,
                format!("the parameter `{}` has no default, but the one before it has", parameter.name.name),
            )
            .hint("put the parameters without defaults first"),
        );
    }

    fn item(&mut self, item: &'a ast::Item, place: Place) -> Option<Item> {
        let kind = match &item.kind {
            ast::ItemKind::Property(property) => self.property(property, place),
            ast::ItemKind::Block(block) => match self.block_item(block, item.span, place) {
                BlockOrPoison::Block(block) => ItemKind::Block(block),
                BlockOrPoison::Poison => ItemKind::Poison(None),
            },
            ast::ItemKind::Placement(e) => ItemKind::Place(self.expr(e)),
            ast::ItemKind::Let(name, e) => {
                let value = self.let_value(name, e);
                ItemKind::Bind(self.declare(name, Declared::Value), value)
            }
            ast::ItemKind::Var(name, e) => {
                let value = self.expr(e);
                ItemKind::Bind(self.declare(name, Declared::Var), value)
            }
            ast::ItemKind::Assign(name, e) => self.assign(name, e, place),
            ast::ItemKind::Function(_) => return None,
            ast::ItemKind::Return(e) => self.return_item(e.as_ref(), item.span),
            ast::ItemKind::If(choice) => ItemKind::If(Box::new(If {
                arms: choice.arms.iter().map(|(c, items)| (self.expr(c), self.body(items, place))).collect(),
                otherwise: choice.otherwise.as_ref().map(|items| self.body(items, place)),
            })),
            ast::ItemKind::For(turns) => self.for_item(turns, place),
            ast::ItemKind::While(turns) => {
                let condition = self.expr(&turns.condition);
                ItemKind::While(Box::new(While { condition, body: self.body(&turns.items, place) }))
            }
            ast::ItemKind::Import(import) => self.import(import),
            ast::ItemKind::Bad { defines } => {
                if let Some(name) = defines {
                    let word = self.word(&name.name);
                    self.scopes.declare(&name.name, &word, name.span, Declared::Poison);
                }
                ItemKind::Poison(None)
            }
        };
        Some(Item { kind, span: item.span })
    }

    fn let_value(&mut self, name: &'a ast::Ident, e: &'a ast::Expr) -> Expr {
        let setting = self.setting;
        let replaced = setting.set.iter().rposition(|(set, _)| **set == *name.name);
        match replaced {
            Some(i) if self.at_root && self.scopes.at_top() => {
                let same = |(_, (set, _)): &(usize, &(Word, ast::Expr))| **set == *name.name;
                self.used_settings.extend(setting.set.iter().enumerate().filter(same).map(|(i, _)| i));
                self.expr(e);
                self.expr(&setting.set[i].1)
            }
            _ => self.expr(e),
        }
    }

    fn for_item(&mut self, turns: &'a ast::For, place: Place) -> ItemKind {
        let list = self.expr(&turns.list);
        self.scopes.open(Vec::new(), false);
        let slot = self.declare_local(&turns.variable);
        let body = self.body(&turns.items, place);
        self.scopes.close();
        ItemKind::For(Box::new(For { slot, list, body }))
    }

    /// The slot of a loop's variable.
    pub(super) fn declare_local(&mut self, name: &'a ast::Ident) -> u32 {
        match self.declare(name, Declared::Value) {
            Access::Local(slot) => slot,
            Access::Captured(_) | Access::Global(_) | Access::Sibling(_) => {
                unreachable!("a loop's scope is not the unit's top level")
            }
        }
    }

    fn assign(&mut self, name: &'a ast::Ident, e: &'a ast::Expr, place: Place) -> ItemKind {
        let value = self.expr(e);
        let Some((access, variable)) = self.scopes.find(&name.name) else {
            self.report_assign_unknown(name, place);
            return ItemKind::Poison(None);
        };
        match variable.declared {
            Declared::Var => ItemKind::Assign(access, value),
            Declared::Poison => ItemKind::Poison(None),
            Declared::Value | Declared::Function(_) | Declared::Module(_) => {
                self.report(
                    Diagnostic::new(
                        Code::NotAssignable,
                        name.span,
                        format!("`{}` cannot be assigned: it is not a `var`", name.name),
                    )
                    .label("assigned here")
                    .also(variable.span, "defined here")
                    .hint(match variable.declared {
                        Declared::Value => format!("define it with `var {} = …`", name.name),
                        _ => "use another name, defined with `var`".to_owned(),
                    }),
                );
                ItemKind::Poison(None)
            }
        }
    }

    fn report_assign_unknown(&mut self, name: &ast::Ident, place: Place) {
        if self.unknown_names {
            return;
        }
        let is_property = match place {
            Place::Block(kind) => kind.property(&name.name).is_some(),
            Place::Loose => super::words::is_property(&name.name),
            Place::Top => false,
        };
        if let Some(said) = constant_assigned(name) {
            return self.report(said);
        }
        let said = Diagnostic::new(Code::UnknownName, name.span, format!("`{}` is not defined", name.name));
        let said = if is_property {
            said.hint(format!("a property is written without `=`: `{} …`", name.name))
        } else {
            let names = self.scopes.names();
            said.did_you_mean(&name.name, names).hint(format!(
                "a new name is made by `let {0} = …`, or `var {0} = …` if it changes",
                name.name
            ))
        };
        self.report(said);
    }

    fn return_item(&mut self, e: Option<&'a ast::Expr>, span: Span) -> ItemKind {
        let value = e.map(|e| self.expr(e));
        if self.scopes.may_return() {
            return ItemKind::Return(value);
        }
        self.report(
            Diagnostic::new(Code::ReturnOutside, span, "`return` stands outside a function's body")
                .hint("a block's value is made of its items; `return` ends a `fn name(…) { … }`, and stands beside its items, not inside their braces"),
        );
        ItemKind::Poison(None)
    }

    fn import(&mut self, import: &'a ast::Import) -> ItemKind {
        let Some(alias) = &import.alias else {
            unreachable!("plain imports were replaced by their items");
        };
        match self.files.imports.get(&import.path_span) {
            Some(file) => {
                let unit = self.unit(*file, import.path_span);
                self.declare(alias, Declared::Module(unit));
                ItemKind::Import(unit, import.path_span)
            }
            None => {
                self.declare(alias, Declared::Poison);
                ItemKind::Poison(None)
            }
        }
    }

    fn property(&mut self, property: &'a ast::Property, place: Place) -> ItemKind {
        if property.values.is_empty() {
            return self.lone_name(&property.name, place);
        }
        let name = &property.name;
        if let Place::Block(kind) = place
            && let Some(said) = self.flag_before_property(kind, property)
        {
            self.report(said);
            return ItemKind::Poison(Some(self.word(&name.name)));
        }
        let values: Vec<Expr> = match place {
            Place::Block(kind) => self.property_values(Some(kind), property),
            Place::Loose => self.property_values(None, property),
            Place::Top => property.values.iter().map(|e| self.expr(e)).collect(),
        };
        let known = match place {
            Place::Block(kind) => kind.property(&name.name),
            Place::Loose | Place::Top => None,
        };
        let may_be = match place {
            Place::Block(kind) => known.is_some() || kind.open,
            Place::Loose => true,
            Place::Top => false,
        };
        if !may_be {
            self.report_unknown_property(name, &property.values, place);
            return ItemKind::Poison(Some(self.word(&name.name)));
        }
        let name_word = self.word(&name.name);
        ItemKind::Property(Box::new(Property { name: name_word, name_span: name.span, known, values }))
    }

    /// What to say where a flag stands before another property on its line, and takes that for its value: `ball limits -90, 90`.
    fn flag_before_property(&self, kind: &Kind, property: &ast::Property) -> Option<Diagnostic> {
        let flag = &property.name.name;
        let (word, span) = kind.property(flag).filter(|p| p.is_flag()).and(leading(&property.values[0]))?;
        if self.in_scope(word) || kind.property(word).is_none() {
            return None;
        }
        let message = format!("`{flag}` is a flag, and takes `{word}` behind it on its line for its value");
        let said = Diagnostic::new(Code::BadProperty, span, message)
            .hint(format!("in the middle of a line, set a flag with `{flag} on`"));
        Some(said)
    }

    fn report_unknown_property(&mut self, name: &ast::Ident, values: &[ast::Expr], place: Place) {
        let call_hint = match (self.in_scope(&name.name), values) {
            (true, [ast::Expr { kind: ast::ExprKind::Number(_) | ast::ExprKind::Name(_), .. }]) => {
                Some(format!("a call is written `{}(…)`", name.name))
            }
            (true, _) => Some("an assignment is written with `=`, a call with parentheses".to_owned()),
            (false, _) => None,
        };
        let said = match place {
            Place::Block(kind) => crate::lang::check::unknown_property(kind, &name.name, name.span),
            Place::Top | Place::Loose => {
                let said = Diagnostic::new(
                    Code::UnknownProperty,
                    name.span,
                    format!("`{}` with values is a property, and no block is around it", name.name),
                )
                .label("stands at the top level");
                let items = ["let", "var", "fn", "for", "if", "while", "import", "return"];
                let said = said.did_you_mean(&name.name, items);
                if said.hints.is_empty() && call_hint.is_none() {
                    said.hint("properties stand inside the braces of a block: `sphere { radius 2 }`")
                } else {
                    said
                }
            }
        };
        self.report(match call_hint {
            Some(hint) => said.hint(hint),
            None => said,
        });
    }

    /// A name alone: a flag where the block has one of this name, else a placement.
    fn lone_name(&mut self, name: &'a ast::Ident, place: Place) -> ItemKind {
        let in_scope = self.in_scope(&name.name);
        let flag = match place {
            Place::Block(kind) => match kind.property(&name.name) {
                Some(property) => super::words::is_flag(property) || !in_scope,
                None => !in_scope && kind.open,
            },
            Place::Loose => !in_scope && super::words::is_property(&name.name),
            Place::Top => false,
        };
        if flag {
            let name_word = self.word(&name.name);
            return ItemKind::Property(Box::new(Property {
                name: name_word,
                name_span: name.span,
                known: None,
                values: Vec::new(),
            }));
        }
        let names: Vec<&str> = match place {
            // What other blocks take is more likely meant so than a name that is not there.
            Place::Block(kind)
                if !(in_scope || self.unknown_names) && super::words::is_property(&name.name) =>
            {
                self.report(crate::lang::check::unknown_property(kind, &name.name, name.span));
                return ItemKind::Poison(Some(self.word(&name.name)));
            }
            Place::Block(kind) => kind.properties().map(|p| p.name).collect(),
            Place::Loose | Place::Top => Vec::new(),
        };
        ItemKind::Place(self.name(&name.name, name.span, &names))
    }
}

/// What to say where a name of the language itself is assigned.
fn constant_assigned(name: &ast::Ident) -> Option<Diagnostic> {
    let what = match &*name.name {
        "time" | "frame" => "the moment of the animation",
        constant if builtins::constant(constant).is_some() => "a constant",
        function if builtins::find(function).is_some() => "a function of the language",
        _ => return None,
    };
    let message = format!("`{}` is {what}, and cannot be assigned", name.name);
    let said = Diagnostic::new(Code::NotAssignable, name.span, message).label("assigned here");
    Some(said.hint(format!(
        "a name of your own hides it: `let {0} = …`, or `var {0} = …` if it changes",
        name.name
    )))
}

/// The name that an expression begins with, and where.
fn leading(expr: &ast::Expr) -> Option<(&str, Span)> {
    match &expr.kind {
        ast::ExprKind::Name(name) => Some((name, expr.span)),
        ast::ExprKind::Binary(_, sides, _) => leading(&sides.0),
        _ => None,
    }
}
