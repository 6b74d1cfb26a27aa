//! Everything that iterates: the persistent-contact yarn simulator and its thread.

mod bend;
mod contact_length;
mod gravity;
mod local;
mod mass;
mod noise;
mod parallel;
mod stretch;
mod wrap;

#[cfg(test)]
mod testing;
