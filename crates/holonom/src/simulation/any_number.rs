//! Lists of numbers that a checkpoint keeps whatever they are: JSON has none that is not finite, so that these are texts there.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Written {
    Finite(f64),
    Other(String),
}

/// For `#[serde(with = …)]`.
pub(crate) fn serialize<S: Serializer>(numbers: &impl AsRef<[f64]>, to: S) -> Result<S::Ok, S::Error> {
    let written = |&number: &f64| if number.is_finite() { Written::Finite(number) } else { Written::Other(number.to_string()) };
    to.collect_seq(numbers.as_ref().iter().map(written))
}

/// For `#[serde(with = …)]`.
pub(crate) fn deserialize<'de, D: Deserializer<'de>, T: TryFrom<Vec<f64>>>(from: D) -> Result<T, D::Error> {
    let read = |written| match written {
        Written::Finite(number) => Ok(number),
        Written::Other(text) => text.parse().map_err(|_| D::Error::custom(format!("`{text}` is no number"))),
    };
    let numbers: Vec<f64> = Vec::<Written>::deserialize(from)?.into_iter().map(read).collect::<Result<_, _>>()?;
    let count = numbers.len();
    T::try_from(numbers).map_err(|_| D::Error::custom(format!("{count} numbers are not as many as there are")))
}
