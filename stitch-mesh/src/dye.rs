//! Colours of yarn.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// A colour as an artist gives it: sRGB, written `#rrggbb`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Dye(pub [u8; 3]);

/// A text that is not a colour.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is not a colour: write it as #rrggbb, as in #c04030")]
pub struct DyeError(String);

impl Dye {
    /// Wool as it comes from the sheep.
    pub const UNDYED: Self = Self([0xdd, 0xce, 0xb6]);

    /// The colour as linear RGB, as light adds up.
    pub fn linear(self) -> [f32; 3] {
        self.0.map(|c| {
            let c = f32::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        })
    }
}

impl Default for Dye {
    fn default() -> Self {
        Self::UNDYED
    }
}

impl fmt::Display for Dye {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

impl FromStr for Dye {
    type Err = DyeError;

    fn from_str(text: &str) -> Result<Self, DyeError> {
        let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii());
        let channel = |i: usize| u8::from_str_radix(digits?.get(i..i + 2)?, 16).ok();
        let all = || Some(Self([channel(0)?, channel(2)?, channel(4)?]));
        all().ok_or_else(|| DyeError(text.to_owned()))
    }
}

impl TryFrom<String> for Dye {
    type Error = DyeError;

    fn try_from(text: String) -> Result<Self, DyeError> {
        text.parse()
    }
}

impl From<Dye> for String {
    fn from(dye: Dye) -> String {
        dye.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_and_written() {
        assert_eq!("#C04030".parse::<Dye>().unwrap().to_string(), "#c04030");
        for text in ["", "c04030", "#c0403", "#c040300", "#c0403g", "#ä4030", "red"] {
            assert!(text.parse::<Dye>().is_err(), "{text}");
        }
        let [black, grey, white] =
            ["#000000", "#808080", "#ffffff"].map(|d| d.parse::<Dye>().unwrap().linear()[0]);
        assert_eq!((black, white), (0.0, 1.0));
        assert!((grey - 0.2159).abs() < 1e-3);
    }
}
