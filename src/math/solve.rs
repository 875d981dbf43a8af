//! Real roots of polynomials; small closed-form solvers.
