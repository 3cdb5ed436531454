//! A form for a file that does not say what its columns are: which column is what, in which unit.

mod asking;
mod choice;
mod form;

pub use asking::Wanted;
pub use form::Form;
