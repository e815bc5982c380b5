//! Expressions as straight-line code over registers, with three evaluators: of one point, of a
//! chunk of points, of a box.

pub(crate) mod chunk;
pub(crate) mod interval;
pub(crate) mod op;

use std::cell::Cell;
use std::thread::LocalKey;

use fgm_core::Interval;

use crate::expr::graph::{Node, NodeId, needed};
use op::{Binary, Unary};

/// The number of a register.
pub(crate) type Reg = u16;

/// One step. The register written is never one of those read.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Instr {
    Const {
        out: Reg,
        value: f64,
    },
    Unary {
        op: Unary,
        out: Reg,
        a: Reg,
    },
    Binary {
        op: Binary,
        out: Reg,
        a: Reg,
        b: Reg,
    },
    /// `a op value`.
    Right {
        op: Binary,
        out: Reg,
        a: Reg,
        value: f64,
    },
    /// `value op b`.
    Left {
        op: Binary,
        out: Reg,
        value: f64,
        b: Reg,
    },
    Powi {
        out: Reg,
        a: Reg,
        n: i8,
    },
    Select {
        out: Reg,
        c: Reg,
        a: Reg,
        b: Reg,
    },
}

/// A compiled expression.
#[derive(Clone, Debug)]
pub(crate) struct Tape {
    instrs: Vec<Instr>,
    /// The variables that are read, by their index, and their registers.
    inputs: Vec<(usize, Reg)>,
    result: Reg,
    registers: usize,
    /// The value, where it depends on nothing.
    constant: Option<f64>,
}

/// Registers of one point or one box that live on the stack: most tapes need few, and clearing
/// more takes time. Still longer tapes take a thread's buffer.
const FEW: usize = 8;
const MANY: usize = 32;

thread_local! {
    static NUMBERS: Cell<Vec<f64>> = const { Cell::new(Vec::new()) };
    static CHUNKS: Cell<Vec<chunk::Lanes>> = const { Cell::new(Vec::new()) };
}

/// Hands `with` at least `count` registers of the thread. They are taken out of their cell
/// meanwhile, so that an evaluation inside another finds an empty cell and not a locked one.
fn borrow_registers<T: Clone, R>(
    key: &'static LocalKey<Cell<Vec<T>>>,
    count: usize,
    fill: T,
    with: impl FnOnce(&mut [T]) -> R,
) -> R {
    let mut registers = key.take();
    if registers.len() < count {
        registers.resize(count, fill);
    }
    let result = with(&mut registers[..count]);
    key.set(registers);
    result
}

impl Tape {
    /// Compiles what `root` needs.
    pub(crate) fn compile(nodes: &[Node], root: NodeId) -> Self {
        Compiler::new(nodes, root).run()
    }

    /// The value for these variables.
    pub(crate) fn eval(&self, var: impl Fn(usize) -> f64) -> f64 {
        if self.registers <= FEW {
            self.eval_in(var, &mut [0.0; FEW])
        } else if self.registers <= MANY {
            self.eval_in(var, &mut [0.0; MANY])
        } else {
            borrow_registers(&NUMBERS, self.registers, 0.0, |r| self.eval_in(var, r))
        }
    }

    fn eval_in(&self, var: impl Fn(usize) -> f64, regs: &mut [f64]) -> f64 {
        for &(index, register) in &self.inputs {
            regs[usize::from(register)] = var(index);
        }
        self.run(regs)
    }

    fn run(&self, regs: &mut [f64]) -> f64 {
        for instr in &self.instrs {
            let get = |r: Reg| regs[usize::from(r)];
            let (out, value) = match *instr {
                Instr::Const { out, value } => (out, value),
                Instr::Unary { op, out, a } => (out, op.apply(get(a))),
                Instr::Binary { op, out, a, b } => (out, op.apply(get(a), get(b))),
                Instr::Right { op, out, a, value } => (out, op.apply(get(a), value)),
                Instr::Left { op, out, value, b } => (out, op.apply(value, get(b))),
                Instr::Powi { out, a, n } => (out, crate::math::powi(get(a), n)),
                Instr::Select { out, c, a, b } => (out, op::select(get(c), get(a), get(b))),
            };
            regs[usize::from(out)] = value;
        }
        regs[usize::from(self.result)]
    }

    /// A range that holds every value for variables in these ranges.
    pub(crate) fn bounds(&self, var: impl Fn(usize) -> Interval) -> Interval {
        if self.registers <= FEW {
            self.bounds_in(var, &mut [0.0; 2 * FEW])
        } else if self.registers <= MANY {
            self.bounds_in(var, &mut [0.0; 2 * MANY])
        } else {
            borrow_registers(&NUMBERS, 2 * self.registers, 0.0, |r| self.bounds_in(var, r))
        }
    }

    fn bounds_in(&self, var: impl Fn(usize) -> Interval, ends: &mut [f64]) -> Interval {
        // Lower and upper ends apart: a pair just written one by one and read as one waits for
        // the memory.
        let (lo, hi) = ends.split_at_mut(ends.len() / 2);
        for &(index, register) in &self.inputs {
            let range = interval::checked(var(index));
            lo[usize::from(register)] = range.lo;
            hi[usize::from(register)] = range.hi;
        }
        self.run_bounds(lo, hi)
    }

    fn run_bounds(&self, lo: &mut [f64], hi: &mut [f64]) -> Interval {
        for instr in &self.instrs {
            let get = |r: Reg| Interval::new(lo[usize::from(r)], hi[usize::from(r)]);
            let (out, range) = match *instr {
                Instr::Const { out, value } => (out, interval::constant(value)),
                Instr::Unary { op, out, a } => (out, interval::unary(op, get(a))),
                Instr::Binary { op, out, a, b } => (out, interval::binary(op, get(a), get(b))),
                Instr::Right { op, out, a, value } => {
                    (out, interval::binary_right(op, get(a), value))
                }
                Instr::Left { op, out, value, b } => {
                    (out, interval::binary(op, interval::constant(value), get(b)))
                }
                Instr::Powi { out, a, n } => (out, interval::powi(get(a), n)),
                Instr::Select { out, c, a, b } => (out, interval::select(get(c), get(a), get(b))),
            };
            lo[usize::from(out)] = range.lo;
            hi[usize::from(out)] = range.hi;
        }
        let result = usize::from(self.result);
        Interval::new(lo[result], hi[result])
    }

    /// The values at up to [`chunk::CHUNK`] points, one an element of `out`; `load` writes each
    /// variable that is read into its lanes.
    pub(crate) fn eval_chunk(&self, out: &mut [f64], load: impl Fn(usize, &mut [f64])) {
        if let Some(value) = self.constant {
            out.fill(value);
            return;
        }
        borrow_registers(&CHUNKS, self.registers, chunk::NO_LANES, |regs| {
            for &(index, register) in &self.inputs {
                load(index, &mut regs[usize::from(register)].0[..out.len()]);
            }
            chunk::run(&self.instrs, regs, out.len());
            out.copy_from_slice(&regs[usize::from(self.result)].0[..out.len()]);
        });
    }
}

/// Register allocation by one scan: nodes stand in the order of evaluation, and a register is free
/// again after the last node that reads it.
struct Compiler<'a> {
    nodes: &'a [Node],
    root: NodeId,
    needed: Vec<bool>,
    /// The last node that reads each node.
    last_use: Vec<NodeId>,
    register: Vec<Reg>,
    free: Vec<Reg>,
    registers: Reg,
    tape: Tape,
}

impl<'a> Compiler<'a> {
    fn new(nodes: &'a [Node], root: NodeId) -> Self {
        let needed = needed(nodes, root);
        let mut last_use: Vec<NodeId> = (0..=root).collect();
        for (id, node) in nodes.iter().enumerate().take(needed.len()) {
            if needed[id] {
                node.operands().for_each(|operand| last_use[operand as usize] = id as NodeId);
            }
        }
        let tape = Tape {
            instrs: Vec::new(),
            inputs: Vec::new(),
            result: 0,
            registers: 0,
            constant: crate::expr::graph::constant_of(nodes[root as usize]),
        };
        let register = vec![0; needed.len()];
        Self { nodes, root, needed, last_use, register, free: Vec::new(), registers: 0, tape }
    }

    fn run(mut self) -> Tape {
        // Variables first: they are loaded before the first instruction.
        for (id, node) in self.nodes.iter().enumerate().take(self.needed.len()) {
            if let (true, Node::Var(var)) = (self.needed[id], node) {
                self.register[id] = self.take();
                self.tape.inputs.push((var.index(), self.register[id]));
            }
        }
        for id in 0..self.needed.len() {
            if self.needed[id] {
                self.emit(id);
            }
        }
        self.tape.result = self.register[self.root as usize];
        self.tape.registers = usize::from(self.registers);
        self.tape
    }

    fn take(&mut self) -> Reg {
        self.free.pop().unwrap_or_else(|| {
            self.registers += 1;
            self.registers - 1
        })
    }

    /// A constant that is folded into the instructions that read it gets no register of its own.
    fn immediate(&self, id: NodeId) -> Option<f64> {
        crate::expr::graph::constant_of(self.nodes[id as usize])
    }

    fn emit(&mut self, id: usize) {
        let node = self.nodes[id];
        if let Node::Var(_) = node {
            return;
        }
        let is_root = id == self.root as usize;
        if matches!(node, Node::Const(_)) && !is_root {
            return;
        }
        // Constants that cannot be immediate operands are made where they are needed.
        let mut made = [None; 3];
        let immediate = matches!(node, Node::Binary(..));
        let mut operands = [0; 3];
        for (slot, operand) in node.operands().enumerate() {
            operands[slot] = self.register[operand as usize];
            if let (Some(value), false) = (self.immediate(operand), immediate) {
                let out = self.take();
                self.tape.instrs.push(Instr::Const { out, value });
                operands[slot] = out;
                made[slot] = Some(out);
            }
        }
        // Taken before the operands are given back: no instruction writes what it reads.
        let out = self.take();
        self.register[id] = out;
        let [a, b, c] = operands;
        let instr = match node {
            Node::Const(bits) => Instr::Const { out, value: f64::from_bits(bits) },
            Node::Var(_) => return,
            Node::Unary(op, _) => Instr::Unary { op, out, a },
            Node::Powi(_, n) => Instr::Powi { out, a, n },
            Node::Select(..) => Instr::Select { out, c: a, a: b, b: c },
            Node::Binary(op, left, right) => match (self.immediate(left), self.immediate(right)) {
                (Some(value), _) => Instr::Left { op, out, value, b },
                (None, Some(value)) => Instr::Right { op, out, a, value },
                (None, None) => Instr::Binary { op, out, a, b },
            },
        };
        self.tape.instrs.push(instr);
        self.free.extend(made.into_iter().flatten());
        for (i, operand) in node.operands().enumerate() {
            // An operand read twice is given back once.
            let seen = node.operands().take(i).any(|earlier| earlier == operand);
            let dead = self.last_use[operand as usize] == id as NodeId;
            if dead && !seen && self.immediate(operand).is_none() {
                self.free.push(self.register[operand as usize]);
            }
        }
    }
}
