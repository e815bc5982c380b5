use std::ops::Range;
use std::sync::Arc;

use super::ast::{Arg, Names, Node, Value};
use super::kind::NodeKind;
use super::number;
use super::token::{Kind, Token, tokenize};
use crate::problem::{MAX_DEPTH, MAX_NAMES, MAX_NODES};
use crate::source::Source;
use crate::{DesignError, Problem};

/// Reads a text into its nodes, those at the top in their order. There is at least one.
pub(crate) fn parse(source: &Source) -> Result<Vec<Node>, DesignError> {
    let tokens = tokenize(source)?;
    let mut parser =
        Parser { source, tokens, at: 0, names: Arc::default(), nodes: 0, open: Vec::new() };
    let nodes = parser.block(None)?;
    if nodes.is_empty() {
        return Err(source.error(0..0, Problem::NoNode));
    }
    Ok(nodes)
}

struct Parser<'a> {
    source: &'a Source,
    /// Never empty; the last is the end.
    tokens: Vec<Token>,
    at: usize,
    names: Names,
    nodes: usize,
    /// The brackets that are open, and where they stand.
    open: Vec<(char, Range<usize>)>,
}

impl<'a> Parser<'a> {
    fn kind(&self) -> Kind {
        self.tokens[self.at].kind
    }

    fn span(&self) -> Range<usize> {
        self.tokens[self.at].span.clone()
    }

    fn text(&self, span: Range<usize>) -> &'a str {
        &self.source.text[span]
    }

    /// Steps over a token; the end stays.
    fn next(&mut self) -> Range<usize> {
        let span = self.span();
        self.at = (self.at + 1).min(self.tokens.len() - 1);
        span
    }

    fn error(&self, span: Range<usize>, problem: Problem) -> DesignError {
        self.source.error(span, problem)
    }

    /// That something else was wanted here; at the end of the file, that the innermost bracket is
    /// never closed.
    fn unexpected(&self, expected: &'static str) -> DesignError {
        if self.kind() == Kind::End
            && let Some((open, span)) = self.open.last()
        {
            return self.error(span.clone(), Problem::Unclosed { open: *open });
        }
        let found = match self.kind() {
            Kind::End => "the end of the file".to_string(),
            Kind::Text => "a string".to_string(),
            _ => format!("`{}`", self.text(self.span())),
        };
        self.error(self.span(), Problem::Unexpected { found, expected })
    }

    fn expect(&mut self, mark: char, expected: &'static str) -> Result<Range<usize>, DesignError> {
        if self.kind() != Kind::Mark(mark) {
            return Err(self.unexpected(expected));
        }
        Ok(self.next())
    }

    fn open(&mut self, mark: char, expected: &'static str) -> Result<Range<usize>, DesignError> {
        let span = self.expect(mark, expected)?;
        self.open.push((mark, span.clone()));
        Ok(span)
    }

    fn close(&mut self, mark: char, expected: &'static str) -> Result<Range<usize>, DesignError> {
        let span = self.expect(mark, expected)?;
        self.open.pop();
        Ok(span)
    }

    /// Nodes and `let`s up to the closing brace of `parent`, or to the end of the file.
    fn block(&mut self, parent: Option<usize>) -> Result<Vec<Node>, DesignError> {
        let outer = Arc::clone(&self.names);
        let mut nodes = Vec::new();
        loop {
            match self.kind() {
                Kind::Name => {
                    self.nodes += 1;
                    if self.nodes > MAX_NODES {
                        return Err(self.error(self.span(), Problem::TooManyNodes));
                    }
                    if self.text(self.span()) == "let" {
                        self.define()?;
                    } else {
                        nodes.push(self.node(parent.unwrap_or(0))?);
                    }
                }
                Kind::Mark('}') if parent.is_some() => break,
                Kind::End if parent.is_none() => break,
                // A stray `;` does no harm.
                Kind::Mark(';') => self.at += 1,
                _ => {
                    return Err(self.unexpected(if parent.is_some() {
                        "a node or `}`"
                    } else {
                        "a node"
                    }));
                }
            }
        }
        self.names = outer;
        Ok(nodes)
    }

    /// `let name = number;`
    fn define(&mut self) -> Result<(), DesignError> {
        self.next();
        if self.kind() != Kind::Name {
            return Err(self.unexpected("a name"));
        }
        let span = self.next();
        let name = self.text(span.clone()).to_string();
        if number::is_reserved(&name) {
            return Err(self.error(span, Problem::ReservedName { name }));
        }
        if self.names.len() >= MAX_NAMES {
            return Err(self.error(span, Problem::TooManyNames));
        }
        self.expect('=', "`=`")?;
        let value = self.number(Mark::LET)?;
        self.expect(';', "`;`")?;
        Arc::make_mut(&mut self.names).push((name, value));
        Ok(())
    }

    fn node(&mut self, depth: usize) -> Result<Node, DesignError> {
        let name_span = self.next();
        let name = self.text(name_span.clone()).to_string();
        let Some(kind) = NodeKind::by_name(&name) else {
            let suggestion = NodeKind::nearest(&name).map(str::to_string);
            return Err(self.error(name_span, Problem::UnknownNode { name, suggestion }));
        };
        if depth >= MAX_DEPTH {
            return Err(self.error(name_span, Problem::TooDeep));
        }
        let start = self.open('(', "`(`")?.start;
        let args = self.args(')')?;
        let end = self.close(')', "`,` or `)`")?.end;
        let names = Arc::clone(&self.names);
        let children = match self.kind() {
            Kind::Mark('{') if kind.is_leaf() => {
                return Err(self.error(name_span, Problem::ChildrenUnwanted { node: name }));
            }
            Kind::Mark('{') => {
                self.open('{', "`{`")?;
                let children = self.block(Some(depth + 1))?;
                self.close('}', "a node or `}`")?;
                Some(children)
            }
            _ if kind.is_leaf() => {
                self.expect(';', "`;`")?;
                None
            }
            _ => return Err(self.unexpected("`{`")),
        };
        Ok(Node { name, kind, name_span, args, args_span: start..end, children, names })
    }

    /// Arguments up to `end`, which is left.
    fn args(&mut self, end: char) -> Result<Vec<Arg>, DesignError> {
        let mut args = Vec::new();
        while self.kind() != Kind::Mark(end) {
            args.push(self.arg()?);
            if self.kind() != Kind::Mark(',') {
                break;
            }
            self.next();
        }
        Ok(args)
    }

    fn arg(&mut self) -> Result<Arg, DesignError> {
        let start = self.span().start;
        let value = match self.kind() {
            Kind::Text => {
                let span = self.next();
                Value::Text(self.text(span.start + 1..span.end - 1).to_string())
            }
            Kind::Mark('[') => {
                // A list in a list is the only way to nest arguments, and brackets count.
                if self.open.len() > 2 * MAX_DEPTH + 8 {
                    return Err(self.error(self.span(), Problem::TooDeep));
                }
                self.open('[', "`[`")?;
                let list = self.args(']')?;
                self.close(']', "`,` or `]`")?;
                Value::List(list)
            }
            Kind::Mark('(') if self.is_vector() => self.vector()?,
            _ => Value::Number(self.number(Mark::ARGUMENT)?),
        };
        // The end of the last token of the argument.
        let end = self.tokens[self.at.saturating_sub(1)].span.end;
        Ok(Arg { value, span: start..end })
    }

    /// Whether the bracket here holds a comma of its own and is a whole argument: `(1, 2)`, and not
    /// `(1 + 2) * 3` or `(1)`.
    fn is_vector(&self) -> bool {
        let mut depth = 0_usize;
        let mut comma = false;
        for token in &self.tokens[self.at..] {
            match token.kind {
                Kind::Mark('(') => depth += 1,
                Kind::Mark(')') if depth <= 1 => return comma,
                Kind::Mark(')') => depth -= 1,
                Kind::Mark(',') => comma |= depth == 1,
                Kind::Mark(';' | '{' | '}' | '[' | ']') | Kind::End => return comma,
                _ => {}
            }
        }
        comma
    }

    fn vector(&mut self) -> Result<Value, DesignError> {
        self.open('(', "`(`")?;
        let mut vector = vec![self.number(Mark::ARGUMENT)?];
        while self.kind() == Kind::Mark(',') {
            self.next();
            vector.push(self.number(Mark::ARGUMENT)?);
        }
        self.close(')', "`,` or `)`")?;
        Ok(Value::Vector(vector))
    }

    /// A number, or an expression of numbers and names, up to a mark outside of its brackets.
    fn number(&mut self, wanted: Mark) -> Result<f64, DesignError> {
        let first = self.at;
        let opened = self.open.len();
        loop {
            let inside = self.open.len() > opened;
            match self.kind() {
                Kind::Mark('(') => {
                    self.open('(', "`(`")?;
                }
                Kind::Mark(')') if inside => {
                    self.close(')', "`)`")?;
                }
                // Commas are inside, and `==` is of expressions.
                Kind::Mark(',') if inside => self.at += 1,
                Kind::Mark('=') if self.at > first => self.at += 1,
                Kind::Name | Kind::Number | Kind::Operator(_) => self.at += 1,
                _ => break,
            }
        }
        if self.at == first || self.open.len() > opened {
            return Err(self.unexpected(wanted.0));
        }
        let span = self.tokens[first].span.start..self.tokens[self.at - 1].span.end;
        number::constant(self.source, span, &self.names)
    }
}

/// What is said where a number is missing.
#[derive(Clone, Copy)]
struct Mark(&'static str);

impl Mark {
    const LET: Self = Self("a number");
    const ARGUMENT: Self = Self("a number, a string, a vector or a list");
}
