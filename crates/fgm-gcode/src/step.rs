use fgm_core::{ColorId, Motion};

/// What a [`Writer`](crate::Writer) takes: a motion, or a notice that a colour will be needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A step of the print.
    Motion(Motion),
    /// A colour whose head is needed soon: it is heated. Put in by [`Lead`](crate::Lead) for
    /// machines whose change itself cannot come early.
    Notice(ColorId),
}

impl From<Motion> for Step {
    fn from(motion: Motion) -> Self {
        Self::Motion(motion)
    }
}
