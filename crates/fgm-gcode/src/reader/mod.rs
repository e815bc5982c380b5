mod line;
mod number;
mod stream;

pub use line::{Arguments, Code, Command, Line, Pairs, Word};
pub use stream::{Lines, Reader, lines};
