//! Curves, kinetics, figures and chains: the pure mathematics of posing.
