//! A measured mystery: what may be hidden, a record of it from an independent bench, and the truth, sealed.
//!
//! The record comes from [`crate::rig`], never from the models that are fitted. The truth travels with it in a
//! box that opens with a word ([`seal_of`], [`Reveal::open`]); without the word neither the file nor the link
//! says what is hidden, how much of it, or how many effects there are.

mod bench;
mod error;
mod experiment;
mod hideable;
mod make;
mod menu;
mod record;
mod reveal;
mod seal;
mod truth;

pub use error::{MysteryError, SHORTEST_WORD};
pub use experiment::Experiment;
pub use hideable::{Hideable, Strength};
pub use make::{Choice, Pick, Request, make};
pub use menu::hideable;
pub use record::{Column, Mystery, columns, seal_of};
pub use reveal::{Answer, Compared, Mark, Reveal, Row};
pub use seal::SALT;
pub use truth::{Hidden, Truth};
