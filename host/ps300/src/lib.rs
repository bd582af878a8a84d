//! Function network, command language and display structure.

pub mod language;
pub mod value;
