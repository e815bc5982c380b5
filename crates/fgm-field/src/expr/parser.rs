//! From source to graph, by precedence climbing.

use std::ops::Range;

use crate::tape::op::{Binary, Unary};

use super::Expr;
use super::error::{ExprError, ExprErrorKind};
use super::graph::{Graph, NodeId};
use super::names;
use super::token::{Symbol, Token, TokenKind, next_token};

const VALUE: &str = "a number, a variable, a function or `(`";
const OPERATOR_OR_END: &str = "an operator or the end";
const OPERATOR_OR_CLOSE: &str = "an operator, `,` or `)`";

/// A part of the expression and where it begins.
#[derive(Clone, Copy)]
struct Operand {
    node: NodeId,
    start: usize,
}

/// Between two operands.
#[derive(Clone, Copy)]
struct Infix {
    op: Binary,
    /// Whether the operands change places: `a > b` is `b < a`.
    swapped: bool,
    /// Higher binds tighter.
    precedence: u8,
    /// Whether there is a token to step over; not in an implicit multiplication.
    written: bool,
}

/// The precedence of an implicit multiplication: that of `*`.
const PRODUCT: u8 = 5;

pub(crate) struct Parser<'s> {
    source: &'s str,
    constants: &'s [(&'s str, f64)],
    graph: Graph,
    token: Token<'s>,
    /// The end of the token before, and whether it was a closing parenthesis.
    previous: usize,
    after_close: bool,
    depth: usize,
}

impl<'s> Parser<'s> {
    /// Parses the whole source.
    pub(crate) fn parse(
        source: &'s str,
        constants: &'s [(&'s str, f64)],
    ) -> Result<(Graph, NodeId), ExprError> {
        if source.len() > Expr::MAX_LENGTH {
            let kind = ExprErrorKind::TooLong { length: source.len(), limit: Expr::MAX_LENGTH };
            return Err(ExprError { span: source.len()..source.len(), kind });
        }
        let token = next_token(source, 0)?;
        let graph = Graph::default();
        let mut parser =
            Self { source, constants, graph, token, previous: 0, after_close: false, depth: 0 };
        let root = parser.ternary()?;
        match parser.token.kind {
            TokenKind::End => Ok((parser.graph, root.node)),
            TokenKind::Symbol(Symbol::Close) => {
                Err(parser.unexpected("an operator or the end; no `(` belongs to this"))
            }
            _ => Err(parser.unexpected(OPERATOR_OR_END)),
        }
    }

    fn advance(&mut self) -> Result<(), ExprError> {
        self.previous = self.token.span.end;
        self.after_close = self.token.kind == TokenKind::Symbol(Symbol::Close);
        self.token = next_token(self.source, self.previous)?;
        Ok(())
    }

    /// Steps over a symbol if it is next.
    fn accept(&mut self, symbol: Symbol) -> Result<bool, ExprError> {
        let found = self.token.kind == TokenKind::Symbol(symbol);
        if found {
            self.advance()?;
        }
        Ok(found)
    }

    fn error(&self, span: Range<usize>, kind: ExprErrorKind) -> ExprError {
        ExprError { span, kind }
    }

    fn unexpected(&self, expected: &'static str) -> ExprError {
        let kind = match self.token.kind {
            TokenKind::End => ExprErrorKind::UnexpectedEnd { expected },
            _ => {
                let found = self.source[self.token.span.clone()].to_owned();
                ExprErrorKind::Unexpected { found, expected }
            }
        };
        self.error(self.token.span.clone(), kind)
    }

    /// Checks a new part: within the limits, and finite if it is a number.
    fn part(&self, start: usize, node: NodeId) -> Result<Operand, ExprError> {
        let span = start..self.previous;
        if self.graph.nodes().len() > Expr::MAX_NODES {
            let kind = ExprErrorKind::TooManyNodes { limit: Expr::MAX_NODES };
            return Err(self.error(span, kind));
        }
        match self.graph.value(node) {
            Some(value) if !value.is_finite() => {
                Err(self.error(span, ExprErrorKind::NotFinite { value }))
            }
            _ => Ok(Operand { node, start }),
        }
    }

    /// One level deeper.
    fn nested<T>(
        &mut self,
        parse: impl FnOnce(&mut Self) -> Result<T, ExprError>,
    ) -> Result<T, ExprError> {
        if self.depth >= Expr::MAX_DEPTH {
            let kind = ExprErrorKind::TooDeep { limit: Expr::MAX_DEPTH };
            return Err(self.error(self.token.span.clone(), kind));
        }
        self.depth += 1;
        let result = parse(self);
        self.depth -= 1;
        result
    }

    /// `c ? a : b`, from the right; or less.
    fn ternary(&mut self) -> Result<Operand, ExprError> {
        let c = self.binary(0)?;
        if !self.accept(Symbol::Question)? {
            return Ok(c);
        }
        let a = self.nested(Self::ternary)?;
        if !self.accept(Symbol::Colon)? {
            return Err(self.unexpected("`:` and the value for the other case"));
        }
        let b = self.nested(Self::ternary)?;
        let node = self.graph.select(c.node, a.node, b.node);
        self.part(c.start, node)
    }

    /// The operator that comes next, if one does.
    fn infix(&self) -> Option<Infix> {
        let written = |op, precedence| Infix { op, swapped: false, precedence, written: true };
        let swapped = |op, precedence| Infix { op, swapped: true, precedence, written: true };
        let implicit =
            Infix { op: Binary::Mul, swapped: false, precedence: PRODUCT, written: false };
        Some(match self.token.kind {
            TokenKind::Symbol(symbol) => match symbol {
                Symbol::Or => written(Binary::Or, 1),
                Symbol::And => written(Binary::And, 2),
                Symbol::Equal => written(Binary::Equal, 3),
                Symbol::NotEqual => written(Binary::NotEqual, 3),
                Symbol::Less => written(Binary::Less, 3),
                Symbol::LessEqual => written(Binary::LessEqual, 3),
                Symbol::Greater => swapped(Binary::Less, 3),
                Symbol::GreaterEqual => swapped(Binary::LessEqual, 3),
                Symbol::Plus => written(Binary::Add, 4),
                Symbol::Minus => written(Binary::Sub, 4),
                Symbol::Star => written(Binary::Mul, PRODUCT),
                Symbol::Slash => written(Binary::Div, PRODUCT),
                Symbol::Percent => written(Binary::Rem, PRODUCT),
                Symbol::Open => implicit,
                _ => return None,
            },
            TokenKind::Name("or") => written(Binary::Or, 1),
            TokenKind::Name("and") => written(Binary::And, 2),
            TokenKind::Name("not") => return None,
            TokenKind::Name(_) => implicit,
            TokenKind::Number(_) if self.after_close => implicit,
            TokenKind::Number(_) | TokenKind::End => return None,
        })
    }

    /// Operands joined by operators of at least this precedence, from the left.
    fn binary(&mut self, least: u8) -> Result<Operand, ExprError> {
        let mut left = self.unary()?;
        while let Some(infix) = self.infix().filter(|infix| infix.precedence >= least) {
            if infix.written {
                self.advance()?;
            }
            let right = self.binary(infix.precedence + 1)?;
            let divides = matches!(infix.op, Binary::Div | Binary::Rem);
            if divides && self.graph.value(right.node) == Some(0.0) {
                let span = left.start..self.previous;
                return Err(self.error(span, ExprErrorKind::DivisionByZero));
            }
            let (a, b) =
                if infix.swapped { (right.node, left.node) } else { (left.node, right.node) };
            let node = self.graph.binary(infix.op, a, b);
            left = self.part(left.start, node)?;
        }
        Ok(left)
    }

    /// A sign or `not`, which bind tighter than `*` and looser than `^`.
    fn unary(&mut self) -> Result<Operand, ExprError> {
        let start = self.token.span.start;
        let op = match self.token.kind {
            TokenKind::Symbol(Symbol::Minus) => Some(Unary::Neg),
            TokenKind::Symbol(Symbol::Plus) => None,
            TokenKind::Name("not") => Some(Unary::Not),
            _ => return self.power(),
        };
        self.advance()?;
        let operand = self.nested(Self::unary)?;
        let node = match op {
            Some(op) => self.graph.unary(op, operand.node),
            None => operand.node,
        };
        self.part(start, node)
    }

    /// `a ^ b`, from the right; `b` may have a sign.
    fn power(&mut self) -> Result<Operand, ExprError> {
        let base = self.primary()?;
        if !self.accept(Symbol::Caret)? {
            return Ok(base);
        }
        let exponent = self.nested(Self::unary)?;
        let node = self.graph.binary(Binary::Pow, base.node, exponent.node);
        self.part(base.start, node)
    }

    fn primary(&mut self) -> Result<Operand, ExprError> {
        let span = self.token.span.clone();
        match self.token.kind {
            TokenKind::Number(value) => {
                self.advance()?;
                let node = self.graph.constant(value);
                self.part(span.start, node)
            }
            TokenKind::Name(name) => self.name(name, span),
            TokenKind::Symbol(Symbol::Open) => {
                self.advance()?;
                let inner = self.nested(Self::ternary)?;
                self.close("an operator or `)`")?;
                self.part(span.start, inner.node)
            }
            _ => Err(self.unexpected(VALUE)),
        }
    }

    /// Steps over the closing parenthesis.
    fn close(&mut self, expected: &'static str) -> Result<(), ExprError> {
        if !self.accept(Symbol::Close)? {
            return Err(self.unexpected(expected));
        }
        Ok(())
    }

    /// A variable, a constant or a call.
    fn name(&mut self, name: &'s str, span: Range<usize>) -> Result<Operand, ExprError> {
        if matches!(name, "and" | "or") {
            return Err(self.unexpected(VALUE));
        }
        self.advance()?;
        if let Some(&(_, value)) = self.constants.iter().find(|(known, _)| *known == name) {
            let node = self.graph.constant(value);
            return self.part(span.start, node);
        }
        if let Some(node) = names::variable(&mut self.graph, name) {
            return self.part(span.start, node);
        }
        let called = self.token.kind == TokenKind::Symbol(Symbol::Open);
        match names::function(name) {
            Some(call) if called => self.call(name, call, span),
            Some(call) => {
                let kind =
                    ExprErrorKind::MissingArguments { name: name.into(), arity: call.arity() };
                Err(self.error(span, kind))
            }
            None => {
                let suggestion = names::suggestion(name, called, self.constants);
                let name = name.to_owned();
                let kind = if called {
                    ExprErrorKind::UnknownFunction { name, suggestion }
                } else {
                    ExprErrorKind::UnknownVariable { name, suggestion }
                };
                Err(self.error(span, kind))
            }
        }
    }

    /// The arguments of a function, from its opening parenthesis on.
    fn call(
        &mut self,
        name: &str,
        call: names::Call,
        span: Range<usize>,
    ) -> Result<Operand, ExprError> {
        self.advance()?;
        let mut arguments = Vec::new();
        if self.token.kind != TokenKind::Symbol(Symbol::Close) {
            loop {
                arguments.push(self.nested(Self::ternary)?.node);
                if !self.accept(Symbol::Comma)? {
                    break;
                }
            }
        }
        self.close(OPERATOR_OR_CLOSE)?;
        let (expected, found) = (call.arity(), arguments.len());
        let wrong = ExprErrorKind::ArgumentCount { function: name.into(), expected, found };
        let span = span.start..self.previous;
        if !expected.allows(found) {
            return Err(self.error(span, wrong));
        }
        match call.lower(&mut self.graph, &arguments) {
            Some(node) => self.part(span.start, node),
            None => Err(self.error(span, wrong)),
        }
    }
}
