//! Convex problems.
