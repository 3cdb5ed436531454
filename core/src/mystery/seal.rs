//! The box that holds the truth until someone says the word.
//!
//! Argon2id (RFC 9106) makes a key of the word, slowly and with much memory, so that words cannot be tried by
//! the million; ChaCha20-Poly1305 (RFC 8439) seals the truth with it. The text is padded to one length: a box
//! with two effects looks like one with none.

use argon2::{Algorithm, Argon2, Params, Version};
use chacha20poly1305::aead::Aead;
use chacha20poly1305::{ChaCha20Poly1305, Key, KeyInit, Nonce};

use super::error::{MysteryError, SHORTEST_WORD};

/// Length of the salt, bytes.
pub const SALT: usize = 16;

/// Length of every text before it is sealed, bytes.
const PADDED: usize = 640;

/// Length of a seal: salt, padded text and the tag of Poly1305.
const SEALED: usize = SALT + PADDED + 16;

/// Memory of Argon2, KiB, and its passes: RFC 9106 recommends 64 MiB and 3 where memory is short; a phone's
/// browser gets half.
const MEMORY: u32 = 32 * 1024;
const PASSES: u32 = 3;

/// What a word and a salt make.
pub(super) struct Keys {
    seal: [u8; 32],
    /// Seed of the bench: known to nobody without the word, so that the noise tells nothing either.
    pub seed: u64,
}

impl Keys {
    /// Makes them; takes a part of a second.
    pub fn new(word: &str, salt: &[u8; SALT]) -> Result<Self, MysteryError> {
        let word = word.trim();
        let found = word.chars().count();
        if found < SHORTEST_WORD {
            return Err(MysteryError::ShortWord { found });
        }
        let mut out = [0; 40];
        let params = Params::new(MEMORY, PASSES, 1, Some(out.len()));
        Argon2::new(
            Algorithm::Argon2id,
            Version::V0x13,
            params.map_err(|_| MysteryError::Cipher)?,
        )
        .hash_password_into(word.as_bytes(), salt, &mut out)
        .map_err(|_| MysteryError::Cipher)?;
        let (mut seal, mut seed) = ([0; 32], [0; 8]);
        seal.copy_from_slice(&out[..32]);
        seed.copy_from_slice(&out[32..]);
        Ok(Self {
            seal,
            seed: u64::from_le_bytes(seed),
        })
    }

    fn cipher(&self) -> ChaCha20Poly1305 {
        ChaCha20Poly1305::new(&Key::from(self.seal))
    }

    /// Seals a text.
    pub fn seal(&self, salt: &[u8; SALT], text: &str) -> Result<Vec<u8>, MysteryError> {
        let mut padded = text.as_bytes().to_vec();
        if padded.len() > PADDED {
            return Err(MysteryError::Cipher);
        }
        padded.resize(PADDED, b' ');
        let sealed = self.cipher().encrypt(&nonce(), padded.as_slice());
        let sealed = sealed.map_err(|_| MysteryError::Cipher)?;
        Ok([salt.as_slice(), &sealed].concat())
    }
}

/// A key serves one salt, and so one text: the nonce need not differ.
fn nonce() -> Nonce {
    Nonce::default()
}

/// Opens a seal with a word.
pub(super) fn open(sealed: &[u8], word: &str) -> Result<String, MysteryError> {
    if sealed.len() != SEALED {
        return Err(MysteryError::BadSeal);
    }
    let (salt, rest) = sealed
        .split_first_chunk::<SALT>()
        .ok_or(MysteryError::BadSeal)?;
    let keys = Keys::new(word, salt).map_err(|_| MysteryError::WrongWord)?;
    let opened = keys.cipher().decrypt(&nonce(), rest);
    let text = String::from_utf8(opened.map_err(|_| MysteryError::WrongWord)?);
    text.map_err(|_| MysteryError::BadSeal)
}
