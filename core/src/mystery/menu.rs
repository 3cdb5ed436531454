//! What the bench can hide, how strongly, and which experiments show it.

mod drive;
mod process;

use super::hideable::Hideable;
use crate::measurement::Kind;

/// Everything that can be hidden in such a system, in the order of the menu.
pub fn hideable(kind: Kind) -> &'static [Hideable] {
    match kind {
        Kind::Drive => drive::MENU,
        Kind::Process => process::MENU,
    }
}
