//! The schedule: which antenna takes which pass.

mod row;
mod solve;
#[cfg(test)]
mod testing;
