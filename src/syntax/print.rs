//! The tree as text, for `ogee ast` and its snapshots, and as JSON. A line a node, children indented by two blanks;
//! places are left out of the text, so that a scene can be laid out anew without changing it, and kept in the JSON.

use serde_json::{Value, json};

use super::ast::{
    Argument, Block, Body, Comprehension, Expr, ExprKind, File, Function, Ident, If, Item, ItemKind, Lambda,
    Parameter, TextPart, UnaryOp,
};
use crate::diag::Span;

/// The tree of a file, a line a node.
pub fn print(file: &File) -> String {
    lines(&nodes(&file.items))
}

/// The tree of one expression.
pub fn print_expression(value: &Expr) -> String {
    lines(&[expression(value)])
}

/// The tree of a file as JSON: `{"node", "text", "span": [start, end], "children"}`, empty parts left out.
pub fn print_json(file: &File) -> Value {
    let children: Vec<Value> = nodes(&file.items).iter().map(to_json).collect();
    json!({ "node": "file", "span": [file.span.start, file.span.end], "children": children })
}

/// A node of the tree as it is shown.
struct Node {
    /// What it is: `property`, `binary`.
    sort: &'static str,
    /// Its own part: a name, an operator, a literal.
    text: String,
    span: Option<Span>,
    children: Vec<Node>,
}

impl Node {
    fn new(sort: &'static str, text: impl Into<String>, span: Span) -> Node {
        Node { sort, text: text.into(), span: Some(span), children: Vec::new() }
    }

    /// A part of a node that has no place of its own.
    fn part(sort: &'static str, children: Vec<Node>) -> Node {
        Node { sort, text: String::new(), span: None, children }
    }

    fn with(self, children: Vec<Node>) -> Node {
        Node { children, ..self }
    }
}

fn lines(nodes: &[Node]) -> String {
    let mut out = String::new();
    nodes.iter().for_each(|node| line(node, 0, &mut out));
    out
}

fn line(node: &Node, depth: usize, out: &mut String) {
    out.extend(std::iter::repeat_n("  ", depth));
    out.push_str(node.sort);
    if !node.text.is_empty() {
        out.push(' ');
        out.push_str(&node.text);
    }
    out.push('\n');
    node.children.iter().for_each(|child| line(child, depth + 1, out));
}

fn to_json(node: &Node) -> Value {
    let mut object = json!({ "node": node.sort });
    if !node.text.is_empty() {
        object["text"] = json!(node.text);
    }
    if let Some(span) = node.span {
        object["span"] = json!([span.start, span.end]);
    }
    if !node.children.is_empty() {
        object["children"] = node.children.iter().map(to_json).collect();
    }
    object
}

fn nodes(items: &[Item]) -> Vec<Node> {
    items.iter().map(item).collect()
}

fn expressions(values: &[Expr]) -> Vec<Node> {
    values.iter().map(expression).collect()
}

fn item(item: &Item) -> Node {
    let new = |sort, text: &str| Node::new(sort, text, item.span);
    match &item.kind {
        ItemKind::Property(property) => {
            let sort = if property.values.is_empty() { "flag-or-placement" } else { "property" };
            new(sort, &property.name.name).with(expressions(&property.values))
        }
        ItemKind::Block(block) => block_node(block, item.span),
        ItemKind::Placement(value) => new("placement", "").with(vec![expression(value)]),
        ItemKind::Let(name, value) => new("let", &name.name).with(vec![expression(value)]),
        ItemKind::Var(name, value) => new("var", &name.name).with(vec![expression(value)]),
        ItemKind::Assign(name, value) => new("assign", &name.name).with(vec![expression(value)]),
        ItemKind::Function(function) => function_node(function, item.span),
        ItemKind::Return(value) => new("return", "").with(value.iter().map(expression).collect()),
        ItemKind::If(choice) => new("if", "").with(branches(choice)),
        ItemKind::For(turns) => {
            let list = Node::part("over", vec![expression(&turns.list)]);
            new("for", &turns.variable.name).with(vec![list, Node::part("each", nodes(&turns.items))])
        }
        ItemKind::While(turns) => {
            let condition = Node::part("condition", vec![expression(&turns.condition)]);
            new("while", "").with(vec![condition, Node::part("each", nodes(&turns.items))])
        }
        ItemKind::Import(import) => {
            let alias = import.alias.as_ref().map_or(String::new(), |a| format!(" as {}", a.name));
            new("import", &format!("{:?}{alias}", import.path))
        }
        ItemKind::Bad { defines } => new("bad", defines.as_ref().map_or("", |name| &name.name)),
    }
}

fn block_node(block: &Block, span: Span) -> Node {
    let label = block.label.as_ref().map_or(String::new(), |label| format!(" {}", label.name));
    Node::new("block", format!("{}{label}", block.kind.name), span).with(nodes(&block.items))
}

fn function_node(function: &Function, span: Span) -> Node {
    let mut children: Vec<Node> = function.parameters.iter().map(parameter).collect();
    children.push(match &function.body {
        Body::Expr(value) => Node::part("value", vec![expression(value)]),
        Body::Items(items) => Node::part("items", nodes(items)),
    });
    Node::new("function", &*function.name.name, span).with(children)
}

fn parameter(parameter: &Parameter) -> Node {
    let default = parameter.default.iter().map(expression).collect();
    named("parameter", &parameter.name).with(default)
}

fn named(sort: &'static str, ident: &Ident) -> Node {
    Node::new(sort, &*ident.name, ident.span)
}

fn branches(choice: &If) -> Vec<Node> {
    let mut children = Vec::new();
    for (condition, items) in &choice.arms {
        children.push(Node::part("condition", vec![expression(condition)]));
        children.push(Node::part("then", nodes(items)));
    }
    children.extend(choice.otherwise.iter().map(|items| Node::part("else", nodes(items))));
    children
}

fn expression(value: &Expr) -> Node {
    let new = |sort, text: &str| Node::new(sort, text, value.span);
    match &value.kind {
        ExprKind::Number(value) => new("number", &number(*value)),
        ExprKind::Bool(truth) => new("bool", &truth.to_string()),
        ExprKind::Text(parts) => text(parts, value.span),
        ExprKind::Colour([r, g, b]) => new("colour", &format!("#{r:02x}{g:02x}{b:02x}")),
        ExprKind::Name(name) => new("name", name),
        ExprKind::Vector(components) => new("vector", "").with(expressions(components)),
        ExprKind::VectorLiteral { len, v } => {
            let components: Vec<String> = v[..usize::from(*len)].iter().map(|v| number(*v)).collect();
            new("vector", &format!("<{}>", components.join(", ")))
        }
        ExprKind::List(elements) => new("list", "").with(expressions(elements)),
        ExprKind::Comprehension(comprehension) => comprehension_node(comprehension, value.span),
        ExprKind::Unary(UnaryOp::Negate, operand) => new("unary", "-").with(vec![expression(operand)]),
        ExprKind::Unary(UnaryOp::Not, operand) => new("unary", "!").with(vec![expression(operand)]),
        ExprKind::Binary(op, operands, _) => {
            new("binary", op.text()).with(vec![expression(&operands.0), expression(&operands.1)])
        }
        ExprKind::Choice(parts) => {
            new("choice", "").with(vec![expression(&parts.0), expression(&parts.1), expression(&parts.2)])
        }
        ExprKind::Range(range) => {
            let mut children = vec![expression(&range.start), expression(&range.end)];
            children.extend(range.step.iter().map(|step| Node::part("step", vec![expression(step)])));
            new("range", if range.inclusive { "..=" } else { ".." }).with(children)
        }
        ExprKind::Call(call) => {
            let mut children = vec![expression(&call.callee)];
            children.extend(call.arguments.iter().map(argument));
            new("call", "").with(children)
        }
        ExprKind::Field(base, field) => {
            new("field", &format!(".{}", field.name)).with(vec![expression(base)])
        }
        ExprKind::Index(parts) => new("index", "").with(vec![expression(&parts.0), expression(&parts.1)]),
        ExprKind::With(with) => {
            new("with", "").with(vec![expression(&with.base), Node::part("items", nodes(&with.items))])
        }
        ExprKind::Lambda(lambda) => lambda_node(lambda, value.span),
        ExprKind::Block(block) => block_node(block, value.span),
        ExprKind::Bad => new("bad", ""),
    }
}

/// The shortest digits that read back as the same number; with an exponent where that is shorter.
fn number(value: f64) -> String {
    let (plain, scientific) = (value.to_string(), format!("{value:e}"));
    if plain.len() <= scientific.len() + 2 { plain } else { scientific }
}

fn text(parts: &[TextPart], span: Span) -> Node {
    match parts {
        [] => Node::new("text", "\"\"", span),
        [TextPart::Literal(literal)] => Node::new("text", format!("{literal:?}"), span),
        parts => Node::new("text", "", span).with(parts.iter().map(text_part).collect()),
    }
}

fn text_part(part: &TextPart) -> Node {
    match part {
        TextPart::Literal(literal) => {
            Node { text: format!("{literal:?}"), ..Node::part("literal", Vec::new()) }
        }
        TextPart::Value(value) => Node::part("interpolation", vec![expression(value)]),
    }
}

fn comprehension_node(comprehension: &Comprehension, span: Span) -> Node {
    let mut children = vec![
        Node::part("value", vec![expression(&comprehension.value)]),
        Node::part("over", vec![expression(&comprehension.list)]),
    ];
    children.extend(comprehension.condition.iter().map(|c| Node::part("condition", vec![expression(c)])));
    Node::new("comprehension", &*comprehension.variable.name, span).with(children)
}

fn argument(argument: &Argument) -> Node {
    match &argument.name {
        None => expression(&argument.value),
        Some(name) => named("argument", name).with(vec![expression(&argument.value)]),
    }
}

fn lambda_node(lambda: &Lambda, span: Span) -> Node {
    let mut children: Vec<Node> = lambda.parameters.iter().map(parameter).collect();
    children.push(Node::part("value", vec![expression(&lambda.body)]));
    Node::new("lambda", "", span).with(children)
}
