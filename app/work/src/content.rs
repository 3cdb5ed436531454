//! What is in a file, on its way to where it is read.

use std::ops::Deref;
use std::sync::Arc;

use hysteron_core::mystery::Mystery;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// What is in a file: as it stands there, or as it is kept.
#[derive(Clone, Serialize, Deserialize)]
pub enum Content {
    /// Its bytes.
    Plain(Bytes),
    /// A table, as `packed.rs` packs it.
    Packed(Bytes),
    /// A mystery that came in a link.
    Mystery(Box<Mystery>),
}

/// Bytes that are shared, and that cross to the worker in one piece.
#[derive(Clone)]
pub struct Bytes(Arc<Vec<u8>>);

impl From<Vec<u8>> for Bytes {
    fn from(bytes: Vec<u8>) -> Self {
        Self(Arc::new(bytes))
    }
}

impl Deref for Bytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.0
    }
}

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(self)
    }
}

impl<'de> Deserialize<'de> for Bytes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        serde_bytes::ByteBuf::deserialize(deserializer).map(|bytes| bytes.into_vec().into())
    }
}
