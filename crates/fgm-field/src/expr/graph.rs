//! The hash-consed graph of an expression.

use std::collections::HashMap;

use crate::math;
use crate::tape::op::{self, Binary, Unary};

/// What an expression reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Var {
    X,
    Y,
    Z,
    /// The value of another field at the point. In source, 0 is `d`.
    Input(u8),
}

impl Var {
    /// The signed distance of the child.
    pub(crate) const DISTANCE: Self = Self::Input(0);

    /// Its place among the variables; x, y and z first.
    pub(crate) fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
            Self::Input(input) => 3 + usize::from(input),
        }
    }
}

/// The index of a node in its graph. A node's operands have lower indices than itself.
pub(crate) type NodeId = u32;

/// One operation; equal nodes are one node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    /// A number, by its bits.
    Const(u64),
    Var(Var),
    Unary(Unary, NodeId),
    Binary(Binary, NodeId, NodeId),
    Powi(NodeId, i8),
    Select(NodeId, NodeId, NodeId),
}

/// Nodes in the order in which they can be evaluated.
///
/// Constants are folded as nodes are added, with the very functions that the tape uses, and only
/// such rewritings are made as change no result, the sign of a zero included.
#[derive(Clone, Debug, Default)]
pub(crate) struct Graph {
    nodes: Vec<Node>,
    // Only looked up, never iterated: its order cannot leak.
    ids: HashMap<Node, NodeId>,
}

impl Graph {
    pub(crate) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub(crate) fn into_nodes(self) -> Vec<Node> {
        self.nodes
    }

    fn add(&mut self, node: Node) -> NodeId {
        *self.ids.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            (self.nodes.len() - 1) as NodeId
        })
    }

    pub(crate) fn constant(&mut self, value: f64) -> NodeId {
        self.add(Node::Const(value.to_bits()))
    }

    pub(crate) fn var(&mut self, var: Var) -> NodeId {
        self.add(Node::Var(var))
    }

    /// The number that a node is, if it does not depend on anything.
    pub(crate) fn value(&self, id: NodeId) -> Option<f64> {
        constant_of(self.nodes[id as usize])
    }

    pub(crate) fn unary(&mut self, op: Unary, a: NodeId) -> NodeId {
        if let Some(value) = self.value(a) {
            return self.constant(op.apply(value));
        }
        match (op, self.nodes[a as usize]) {
            (Unary::Neg, Node::Unary(Unary::Neg, inner)) => inner,
            (Unary::Abs, Node::Unary(Unary::Abs | Unary::Square, _)) => a,
            (Unary::Abs | Unary::Square, Node::Unary(Unary::Neg | Unary::Abs, inner)) => {
                self.unary(op, inner)
            }
            _ => self.add(Node::Unary(op, a)),
        }
    }

    pub(crate) fn binary(&mut self, op: Binary, a: NodeId, b: NodeId) -> NodeId {
        match (self.value(a), self.value(b)) {
            (Some(a), Some(b)) => return self.constant(op.apply(a, b)),
            (Some(value), None) => {
                if let Some(id) = self.with_left(op, value, b) {
                    return id;
                }
            }
            (None, Some(value)) => {
                if let Some(id) = self.with_right(op, a, value) {
                    return id;
                }
            }
            (None, None) => {
                if let Some(id) = self.with_itself(op, a, b) {
                    return id;
                }
            }
        }
        let (a, b) = if op.commutes() && b < a { (b, a) } else { (a, b) };
        self.add(Node::Binary(op, a, b))
    }

    /// Rewritings of `value op b`.
    fn with_left(&mut self, op: Binary, value: f64, b: NodeId) -> Option<NodeId> {
        match op {
            Binary::Add | Binary::Mul => self.with_right(op, b, value),
            _ => None,
        }
    }

    /// Rewritings of `a op value`.
    fn with_right(&mut self, op: Binary, a: NodeId, value: f64) -> Option<NodeId> {
        match op {
            // The other zero would turn -0 into 0.
            Binary::Add if value == 0.0 && value.is_sign_negative() => Some(a),
            Binary::Sub if value == 0.0 && value.is_sign_positive() => Some(a),
            Binary::Mul | Binary::Div | Binary::Pow | Binary::Root if value == 1.0 => Some(a),
            Binary::Mul if value == -1.0 => Some(self.unary(Unary::Neg, a)),
            Binary::Div => op::exact_reciprocal(value).map(|reciprocal| {
                let reciprocal = self.constant(reciprocal);
                self.binary(Binary::Mul, a, reciprocal)
            }),
            Binary::Pow if value == 0.0 => Some(self.constant(1.0)),
            Binary::Pow => math::small_power(value).map(|n| self.powi(a, n)),
            Binary::Root if value == 2.0 => Some(self.unary(Unary::Sqrt, a)),
            _ => None,
        }
    }

    /// Rewritings of an operation on one and the same node twice.
    fn with_itself(&mut self, op: Binary, a: NodeId, b: NodeId) -> Option<NodeId> {
        let same = a == b;
        match op {
            Binary::Mul if same => Some(self.unary(Unary::Square, a)),
            Binary::Min | Binary::Max if same => Some(a),
            Binary::Sub if same && self.is_finite(a) => Some(self.constant(0.0)),
            _ => None,
        }
    }

    /// Whether a node is surely finite, so that it less itself is 0 and not NaN: coordinates are.
    fn is_finite(&self, a: NodeId) -> bool {
        matches!(self.nodes[a as usize], Node::Var(Var::X | Var::Y | Var::Z))
    }

    /// `a^n`; `n` is not 0.
    pub(crate) fn powi(&mut self, a: NodeId, n: i8) -> NodeId {
        match (self.value(a), n) {
            (Some(value), _) => self.constant(math::powi(value, n)),
            (None, 1) => a,
            (None, 2) => self.unary(Unary::Square, a),
            _ => self.add(Node::Powi(a, n)),
        }
    }

    pub(crate) fn select(&mut self, c: NodeId, a: NodeId, b: NodeId) -> NodeId {
        match self.value(c) {
            Some(value) => {
                if value != 0.0 {
                    a
                } else {
                    b
                }
            }
            None if a == b => a,
            None => self.add(Node::Select(c, a, b)),
        }
    }

    /// Adds another graph's nodes, with `var` in place of its variables; the new id of `root`.
    ///
    /// Nodes that `root` does not need are left out.
    pub(crate) fn import(
        &mut self,
        nodes: &[Node],
        root: NodeId,
        mut var: impl FnMut(&mut Self, Var) -> NodeId,
    ) -> NodeId {
        let needed = needed(nodes, root);
        let mut new = vec![0; root as usize + 1];
        for (id, node) in nodes.iter().enumerate().take(root as usize + 1) {
            if !needed[id] {
                continue;
            }
            let at = |id: NodeId| new[id as usize];
            new[id] = match *node {
                Node::Const(bits) => self.add(Node::Const(bits)),
                Node::Var(v) => var(self, v),
                Node::Unary(op, a) => self.unary(op, at(a)),
                Node::Binary(op, a, b) => self.binary(op, at(a), at(b)),
                Node::Powi(a, n) => self.powi(at(a), n),
                Node::Select(c, a, b) => self.select(at(c), at(a), at(b)),
            };
        }
        new[root as usize]
    }
}

/// The number that a node is, if it is one.
pub(crate) fn constant_of(node: Node) -> Option<f64> {
    match node {
        Node::Const(bits) => Some(f64::from_bits(bits)),
        _ => None,
    }
}

/// Which of the nodes `root` depends on, itself included.
pub(crate) fn needed(nodes: &[Node], root: NodeId) -> Vec<bool> {
    let mut needed = vec![false; root as usize + 1];
    needed[root as usize] = true;
    for id in (0..=root as usize).rev() {
        if needed[id] {
            for operand in nodes[id].operands() {
                needed[operand as usize] = true;
            }
        }
    }
    needed
}

impl Node {
    /// The nodes that it needs.
    pub(crate) fn operands(self) -> impl Iterator<Item = NodeId> {
        let (ids, count) = match self {
            Self::Const(_) | Self::Var(_) => ([0; 3], 0),
            Self::Unary(_, a) | Self::Powi(a, _) => ([a, 0, 0], 1),
            Self::Binary(_, a, b) => ([a, b, 0], 2),
            Self::Select(c, a, b) => ([c, a, b], 3),
        };
        ids.into_iter().take(count)
    }
}
