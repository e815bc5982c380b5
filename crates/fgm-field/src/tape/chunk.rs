//! The tape over chunks of points.
//!
//! Every instruction is one loop over the lanes of its registers. The loops are plain Rust, written
//! so that the compiler turns them into vector code; on x86-64 they are compiled a second time for
//! AVX2, chosen at run time. Both give the same bits as the evaluation of one point.

use super::op::{Binary, Unary, each_binary, each_unary, select};
use super::{Instr, Reg};
use crate::math::{self, PowerSteps};

/// Points at a time.
pub(crate) const CHUNK: usize = 128;

/// Loops run over whole groups of this many lanes, so that short chunks leave no remainder.
const GROUP: usize = 16;

/// A register.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Lanes(pub(crate) [f64; CHUNK]);

/// An empty register.
pub(crate) const NO_LANES: Lanes = Lanes([0.0; CHUNK]);

/// Runs the instructions on the first `count` lanes.
pub(crate) fn run(instrs: &[Instr], regs: &mut [Lanes], count: usize) {
    let lanes = count.next_multiple_of(GROUP).min(CHUNK);
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        #[expect(unsafe_code, reason = "a function for AVX2 needs the check just made")]
        // SAFETY: the processor has AVX2.
        unsafe {
            return run_avx2(instrs, regs, lanes);
        }
    }
    run_all(instrs, regs, lanes);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_avx2(instrs: &[Instr], regs: &mut [Lanes], lanes: usize) {
    run_all(instrs, regs, lanes);
}

#[inline(always)]
fn run_all(instrs: &[Instr], regs: &mut [Lanes], lanes: usize) {
    for instr in instrs {
        step(*instr, regs, lanes);
    }
}

#[inline(always)]
fn step(instr: Instr, regs: &mut [Lanes], lanes: usize) {
    match instr {
        Instr::Const { out, value } => regs[usize::from(out)].0[..lanes].fill(value),
        Instr::Unary { op, out, a } => {
            let (out, [a]) = split(regs, out, [a], lanes);
            unary(op, out, a);
        }
        Instr::Binary { op, out, a, b } => {
            let (out, [a, b]) = split(regs, out, [a, b], lanes);
            macro_rules! run {
                ($f:expr) => {
                    for ((o, a), b) in out.iter_mut().zip(a).zip(b) {
                        *o = ($f)(*a, *b);
                    }
                };
            }
            each_binary!(op, run);
        }
        Instr::Right { op, out, a, value } => {
            let (out, [a]) = split(regs, out, [a], lanes);
            macro_rules! run {
                ($f:expr) => {
                    for (o, a) in out.iter_mut().zip(a) {
                        *o = ($f)(*a, value);
                    }
                };
            }
            each_binary!(op, run);
        }
        Instr::Left { op, out, value, b } => {
            let (out, [b]) = split(regs, out, [b], lanes);
            macro_rules! run {
                ($f:expr) => {
                    for (o, b) in out.iter_mut().zip(b) {
                        *o = ($f)(value, *b);
                    }
                };
            }
            each_binary!(op, run);
        }
        Instr::Powi { out, a, n } => {
            let (out, [a]) = split(regs, out, [a], lanes);
            powi(n, out, a);
        }
        Instr::Select { out, c, a, b } => {
            let (out, [c, a, b]) = split(regs, out, [c, a, b], lanes);
            for (((o, c), a), b) in out.iter_mut().zip(c).zip(a).zip(b) {
                *o = select(*c, *a, *b);
            }
        }
    }
}

/// The register written and those read; no instruction writes a register that it reads.
#[inline(always)]
fn split<const N: usize>(
    regs: &mut [Lanes],
    out: Reg,
    inputs: [Reg; N],
    lanes: usize,
) -> (&mut [f64], [&[f64]; N]) {
    let out = usize::from(out);
    let (before, rest) = regs.split_at_mut(out);
    let (out_lanes, after) = rest.split_at_mut(1);
    let (before, after) = (&*before, &*after);
    let inputs = inputs.map(|r| {
        let r = usize::from(r);
        let register = if r < out { &before[r] } else { &after[r - out - 1] };
        &register.0[..lanes]
    });
    (&mut out_lanes[0].0[..lanes], inputs)
}

#[inline(always)]
fn unary(op: Unary, out: &mut [f64], a: &[f64]) {
    match op {
        Unary::Sin => near_or_far(out, a, math::sin_near, libm::sin),
        Unary::Cos => near_or_far(out, a, math::cos_near, libm::cos),
        _ => {
            macro_rules! run {
                ($f:expr) => {
                    for (o, a) in out.iter_mut().zip(a) {
                        *o = ($f)(*a);
                    }
                };
            }
            each_unary!(op, run);
        }
    }
}

/// All lanes the fast way, then again those that lie too far out for it.
#[inline(always)]
fn near_or_far(out: &mut [f64], a: &[f64], near: impl Fn(f64) -> f64, far: impl Fn(f64) -> f64) {
    // Counted as an integer: a greatest float would keep the loop from being vectorised.
    let mut distant = 0u64;
    for (o, a) in out.iter_mut().zip(a) {
        *o = near(*a);
        distant |= u64::from(a.abs() > math::NEAR);
    }
    if distant != 0 {
        for (o, a) in out.iter_mut().zip(a).filter(|(_, a)| a.abs() > math::NEAR) {
            *o = far(*a);
        }
    }
}

/// The steps of [`math::powi`], each over all lanes.
#[inline(always)]
fn powi(n: i8, out: &mut [f64], a: &[f64]) {
    out.copy_from_slice(a);
    for bit in PowerSteps::of(n) {
        if bit {
            for (o, a) in out.iter_mut().zip(a) {
                *o = *o * *o * *a;
            }
        } else {
            for o in out.iter_mut() {
                *o *= *o;
            }
        }
    }
    if n < 0 {
        for o in out.iter_mut() {
            *o = 1.0 / *o;
        }
    }
}
