use std::ops::Range;

use fgm_field::{Expr, ExprError, ExprErrorKind};

use super::ast::Names;
use crate::source::Source;
use crate::{DesignError, Problem};

/// The number at `span`: a literal or an expression that depends on nothing.
pub(crate) fn constant(
    source: &Source,
    span: Range<usize>,
    names: &Names,
) -> Result<f64, DesignError> {
    let text = &source.text[span.clone()];
    // The usual case, without an expression around it.
    if text.bytes().all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b))
        && let Ok(value) = text.parse::<f64>()
        && value.is_finite()
    {
        return Ok(value);
    }
    let value = expression(source, span.clone(), names)?.value().filter(|v| v.is_finite());
    value.ok_or_else(|| source.error(span, Problem::NotConstant))
}

/// The expression at `span`. Its errors point into the file.
pub(crate) fn expression(
    source: &Source,
    span: Range<usize>,
    names: &Names,
) -> Result<Expr, DesignError> {
    // The last of a name counts, and the first that is looked at is taken.
    let names: Vec<(&str, f64)> = names.iter().rev().map(|(n, v)| (n.as_str(), *v)).collect();
    Expr::parse_with(&source.text[span.clone()], &names).map_err(|ExprError { span: at, kind }| {
        source.error(span.start + at.start..span.start + at.end, Problem::Expression { kind })
    })
}

/// Whether a name means something in expressions already.
pub(crate) fn is_reserved(name: &str) -> bool {
    !matches!(Expr::parse(name), Err(ExprError { kind: ExprErrorKind::UnknownVariable { .. }, .. }))
}
