//! Placeholder
mod measured;
