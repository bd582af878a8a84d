//! Function network, command language and display structure.
