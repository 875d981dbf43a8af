//! A file and everything that it imports, read and parsed before any name is resolved.

use crate::diag::{Code, Diagnostic, Frame, Sink, SourceId, SourceMap, Span};
use crate::lang::limits::{Limits, exceeded};
use crate::scene::assets::Loader;
use crate::syntax::ast;
use crate::syntax::build::{ParseLimits, parse_file};
use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Index into [`Files::files`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FileId(pub usize);

/// A parsed file.
#[derive(Debug)]
pub struct LoadedFile {
    /// Its tree.
    pub tree: ast::File,
    /// Its source.
    pub source: SourceId,
    /// The import that first asked for it.
    pub imported_by: Option<Span>,
}

/// The files of a program; the first is the root.
#[derive(Debug, Default)]
pub struct Files {
    /// In the order they were read.
    pub files: Vec<LoadedFile>,
    /// The file that each import names, by the place of its path; absent where it could not be read.
    pub imports: HashMap<Span, FileId>,
    /// Each source's path, as paths are joined to it.
    pub paths: HashMap<SourceId, PathBuf>,
    /// What is read already, by path; none where it could not be.
    by_path: HashMap<PathBuf, Option<FileId>>,
}

impl Files {
    /// The imports that led to a source, innermost first.
    pub fn import_trace(&self, mut source: SourceId) -> Vec<Frame> {
        let mut frames = Vec::new();
        while let Some(span) = self.files.iter().find(|f| f.source == source).and_then(|f| f.imported_by) {
            frames.push(Frame { span, text: "imported here".into() });
            source = span.source;
        }
        frames
    }

    /// How many files there are and by which paths they are known, to come back to.
    pub fn mark(&self) -> FilesMark {
        FilesMark { n_files: self.files.len(), by_path: self.by_path.clone() }
    }

    /// Forgets all that was read since the mark was taken.
    pub fn forget_since(&mut self, mark: FilesMark) {
        self.files.truncate(mark.n_files);
        self.imports.retain(|_, file| file.0 < mark.n_files);
        self.by_path = mark.by_path;
    }

    /// Lets every file be read again when it is next asked for.
    pub fn forget_paths(&mut self) {
        self.by_path.clear();
    }

    /// Frees the syntax trees: once names are resolved nothing needs them, unless more items come.
    pub fn forget_trees(&mut self) {
        self.files.iter_mut().for_each(|file| file.tree.items = Vec::new());
    }

    /// A path as written at a place, joined to the folder of the file it stands in.
    pub fn join(&self, written: &str, at: Span) -> PathBuf {
        let folder = self.paths.get(&at.source).and_then(|p| p.parent());
        folder.map_or_else(|| PathBuf::from(written), |folder| folder.join(written))
    }
}

/// See [`Files::mark`].
pub struct FilesMark {
    n_files: usize,
    by_path: HashMap<PathBuf, Option<FileId>>,
}

/// Reads files and their imports.
pub struct Reading<'a> {
    /// How.
    pub loader: &'a dyn Loader,
    /// Where the texts are kept.
    pub sources: &'a mut SourceMap,
    /// Guards.
    pub limits: Limits,
    /// Where faults go.
    pub sink: &'a mut Sink,
    /// What was read.
    pub files: &'a mut Files,
}

impl<'a> Reading<'a> {
    /// Reads a root file. None where it cannot be read, which is reported.
    pub fn root_file(&mut self, path: &Path) -> Option<FileId> {
        let text = self.read(path, None)?;
        Some(self.add(path, text, None, &mut Vec::new()))
    }

    /// Takes a text as the root file of this path.
    pub fn root_text(&mut self, path: &Path, text: &str) -> FileId {
        self.add(path, text.into(), None, &mut Vec::new())
    }

    /// Takes items that are parsed already as a root file of this path.
    pub fn root_tree(&mut self, path: &Path, source: SourceId, tree: ast::File) -> FileId {
        self.add_tree(path, (source, tree, Vec::new()), None, &mut Vec::new())
    }

    fn add(
        &mut self,
        path: &Path,
        text: Arc<str>,
        imported_by: Option<Span>,
        chain: &mut Vec<(PathBuf, Span)>,
    ) -> FileId {
        let source = self.sources.add(path.to_string_lossy(), text.clone());
        let (tree, faults) = parse_file(source, &text, ParseLimits::nesting(self.limits.nesting));
        self.add_tree(path, (source, tree, faults), imported_by, chain)
    }

    fn add_tree(
        &mut self,
        path: &Path,
        (source, tree, faults): (SourceId, ast::File, Vec<Diagnostic>),
        imported_by: Option<Span>,
        chain: &mut Vec<(PathBuf, Span)>,
    ) -> FileId {
        let id = FileId(self.files.files.len());
        let mut imports = Vec::new();
        collect_imports(&tree.items, &mut imports);
        self.files.files.push(LoadedFile { tree, source, imported_by });
        self.files.paths.insert(source, path.to_owned());
        self.files.by_path.insert(normal(path), Some(id));
        for fault in faults {
            self.report(fault);
        }
        for import in imports {
            chain.push((normal(path), import.path_span));
            self.import(&import, chain);
            chain.pop();
        }
        id
    }

    fn import(&mut self, import: &ast::Import, chain: &mut Vec<(PathBuf, Span)>) {
        let path = self.files.join(&import.path, import.path_span);
        let key = normal(&path);
        if let Some(start) = chain.iter().position(|(file, _)| *file == key) {
            return self.report_cycle(&chain[start..], import.path_span);
        }
        let id = match self.files.by_path.get(&key) {
            Some(known) => *known,
            None => self
                .read(&path, Some(import.path_span))
                .map(|text| self.add(&path, text, Some(import.path_span), chain)),
        };
        self.files.by_path.insert(key, id);
        if let Some(id) = id {
            self.files.imports.insert(import.path_span, id);
        }
    }

    fn report(&mut self, mut diagnostic: Diagnostic) {
        if let Some(span) = diagnostic.span {
            diagnostic.trace.extend(self.files.import_trace(span.source));
        }
        self.sink.push(diagnostic);
    }

    fn report_cycle(&mut self, chain: &[(PathBuf, Span)], closing: Span) {
        let name = |p: &Path| p.file_name().unwrap_or(p.as_os_str()).to_string_lossy().into_owned();
        let mut names: Vec<String> = chain.iter().map(|(p, _)| name(p)).collect();
        names.extend(names.first().cloned());
        let mut said = Diagnostic::new(
            Code::ImportCycle,
            closing,
            format!("files import each other in a circle: {}", names.join(" → ")),
        )
        .label("closes the circle")
        .hint("move what both files need into a third one");
        for (_, span) in chain.iter().filter(|(_, span)| *span != closing) {
            said = said.also(*span, "on the way");
        }
        self.report(said);
    }

    /// A file's text; faults are reported at the import, or without a place for the root.
    fn read(&mut self, path: &Path, at: Option<Span>) -> Option<Arc<str>> {
        let shown = path.display();
        let bytes = match self.loader.read(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let said =
                    Diagnostic::new(Code::FileNotFound, at, format!("`{shown}` cannot be read: {error}"));
                self.report(match at {
                    Some(_) => said.hint("a path is relative to the file that writes it"),
                    None => said,
                });
                return None;
            }
        };
        let most = self.limits.file.min(u64::from(u32::MAX) - 1);
        if bytes.len() as u64 > most {
            let message = format!("`{shown}` has {} bytes", bytes.len());
            self.report(exceeded(Code::FileTooLarge, at, message, "file", most));
            return None;
        }
        match String::from_utf8(bytes) {
            Ok(text) => Some(text.into()),
            Err(error) => {
                let place = error.utf8_error().valid_up_to();
                let line = 1 + error.as_bytes()[..place].iter().filter(|b| **b == b'\n').count();
                let message =
                    format!("`{shown}` is not UTF-8 text: byte {place}, in line {line}, begins no character");
                self.report(
                    Diagnostic::new(Code::NotUtf8, at, message).hint("save the file as UTF-8 in your editor"),
                );
                None
            }
        }
    }
}

/// A path without `.` and `..` where that can be told from the text, so that one file has one key.
fn normal(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(out.components().next_back(), Some(Component::Normal(_))) => {
                out.pop();
            }
            Component::ParentDir | Component::Normal(_) | Component::RootDir | Component::Prefix(_) => {
                out.push(part);
            }
        }
    }
    out
}

/// The imports among items, at any depth, in source order.
fn collect_imports(items: &[ast::Item], found: &mut Vec<ast::Import>) {
    for item in items {
        match &item.kind {
            ast::ItemKind::Import(import) => found.push((**import).clone()),
            ast::ItemKind::Block(block) => collect_imports(&block.items, found),
            ast::ItemKind::Function(function) => {
                function.parameters.iter().filter_map(|p| p.default.as_ref()).for_each(|e| within(e, found));
                match &function.body {
                    ast::Body::Items(items) => collect_imports(items, found),
                    ast::Body::Expr(e) => within(e, found),
                }
            }
            ast::ItemKind::If(choice) => {
                for (condition, items) in &choice.arms {
                    within(condition, found);
                    collect_imports(items, found);
                }
                choice.otherwise.iter().for_each(|items| collect_imports(items, found));
            }
            ast::ItemKind::For(turns) => {
                within(&turns.list, found);
                collect_imports(&turns.items, found);
            }
            ast::ItemKind::While(turns) => {
                within(&turns.condition, found);
                collect_imports(&turns.items, found);
            }
            ast::ItemKind::Property(property) => property.values.iter().for_each(|e| within(e, found)),
            ast::ItemKind::Placement(e) => within(e, found),
            ast::ItemKind::Let(_, e) | ast::ItemKind::Var(_, e) | ast::ItemKind::Assign(_, e) => {
                within(e, found)
            }
            ast::ItemKind::Return(e) => e.iter().for_each(|e| within(e, found)),
            ast::ItemKind::Bad { .. } => {}
        }
    }
}

/// The imports among the items of an expression's blocks.
fn within(e: &ast::Expr, found: &mut Vec<ast::Import>) {
    match &e.kind {
        ast::ExprKind::Block(block) => collect_imports(&block.items, found),
        ast::ExprKind::With(with) => {
            within(&with.base, found);
            collect_imports(&with.items, found);
        }
        ast::ExprKind::Vector(list) | ast::ExprKind::List(list) => list.iter().for_each(|e| within(e, found)),
        ast::ExprKind::Comprehension(c) => {
            [&c.value, &c.list].into_iter().chain(&c.condition).for_each(|e| within(e, found));
        }
        ast::ExprKind::Unary(_, e) | ast::ExprKind::Field(e, _) => within(e, found),
        ast::ExprKind::Binary(_, pair, _) | ast::ExprKind::Index(pair) => {
            within(&pair.0, found);
            within(&pair.1, found);
        }
        ast::ExprKind::Choice(three) => {
            [&three.0, &three.1, &three.2].into_iter().for_each(|e| within(e, found))
        }
        ast::ExprKind::Range(range) => {
            [&range.start, &range.end].into_iter().chain(&range.step).for_each(|e| within(e, found));
        }
        ast::ExprKind::Call(call) => {
            within(&call.callee, found);
            call.arguments.iter().for_each(|a| within(&a.value, found));
        }
        ast::ExprKind::Lambda(lambda) => within(&lambda.body, found),
        ast::ExprKind::Text(parts) => parts.iter().for_each(|part| match part {
            ast::TextPart::Value(e) => within(e, found),
            ast::TextPart::Literal(_) => {}
        }),
        ast::ExprKind::Number(_)
        | ast::ExprKind::Bool(_)
        | ast::ExprKind::Colour(_)
        | ast::ExprKind::Name(_)
        | ast::ExprKind::VectorLiteral { .. }
        | ast::ExprKind::Bad => {}
    }
}
