use fgm_core::{ColorId, Motion};

use crate::State;

/// What a [`Writer`](crate::Writer) takes: a motion, a notice that a colour will be needed, or a
/// state that is none of the palette's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A step of the print.
    Motion(Motion),
    /// A colour whose head is needed soon: it is heated. Put in by [`Lead`](crate::Lead) for
    /// machines whose change itself cannot come early.
    Notice(ColorId),
    /// From here on the machine is told to make this state, such as a mixture between two colours
    /// or beyond them, that leads to the deposit wanted.
    Tell {
        /// The colour of the palette that the state is shown as.
        color: ColorId,
        /// What the machine is told.
        state: State,
    },
    /// From here on this factor is on the fed filament, until the deposit's next colour.
    Flow(f64),
}

impl From<Motion> for Step {
    fn from(motion: Motion) -> Self {
        Self::Motion(motion)
    }
}
