//! Long series as text: the bits of the numbers in base64. It is exact, and the page reads it several times faster than
//! decimals, in time that would be missing for drawing.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD_NO_PAD as LETTERS;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Bytes of a number.
const SIZE: usize = size_of::<f64>();

/// A series, packed.
struct Packed(Vec<f64>);

impl Serialize for Packed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(&self.0, serializer)
    }
}

impl<'de> Deserialize<'de> for Packed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserialize(deserializer).map(Self)
    }
}

pub(crate) fn serialize<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    serializer.serialize_str(&LETTERS.encode(bytes))
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<f64>, D::Error> {
    let text = String::deserialize(deserializer)?;
    let bytes = LETTERS.decode(text).map_err(D::Error::custom)?;
    let (numbers, rest) = bytes.as_chunks::<SIZE>();
    if !rest.is_empty() {
        return Err(D::Error::invalid_length(bytes.len(), &"numbers"));
    }
    Ok(numbers.iter().map(|b| f64::from_le_bytes(*b)).collect())
}

/// Several series.
pub(crate) mod many {
    use serde::{Deserialize as _, Deserializer, Serialize as _, Serializer};

    use super::Packed;

    pub(crate) fn serialize<S: Serializer>(
        series: &[Vec<f64>],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let packed: Vec<Packed> = series.iter().map(|s| Packed(s.clone())).collect();
        packed.serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<Vec<f64>>, D::Error> {
        let packed = Vec::<Packed>::deserialize(deserializer)?;
        Ok(packed.into_iter().map(|p| p.0).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_comes_back_to_the_bit() {
        let values = vec![0.0, -0.0, 0.1, f64::MIN_POSITIVE / 3.0, -1e300, f64::NAN];
        let text = serde_json::to_string(&Packed(values.clone())).unwrap();
        let Packed(again) = serde_json::from_str(&text).unwrap();
        let bits = |v: &[f64]| v.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&again), bits(&values));
    }

    #[test]
    fn what_is_cut_off_or_changed_is_refused() {
        let text = serde_json::to_string(&Packed(vec![1.5, 2.5])).unwrap();
        for bad in [text.replacen('A', "", 4), text.replacen('A', "!", 1)] {
            assert_ne!(bad, text);
            assert!(serde_json::from_str::<Packed>(&bad).is_err(), "{bad}");
        }
    }
}
