//! Colours of the yarns of a warp or a weft: stripes of one, checks and plaids of both.

use crate::dye::{Dye, DyeError};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Yarns that may have one colour before it comes again.
const MOST: u32 = 100_000;

/// Colours of yarns that lie side by side, each for a number of yarns, again and again. Written `#c04030` where all are alike, or with
/// the numbers, as in `#c04030*4,#303034*2`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Stripes(Vec<(Dye, u32)>);

/// A text that does not say what colours yarns have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StripesError {
    /// A colour that is none.
    #[error(transparent)]
    Dye(#[from] DyeError),
    /// A number of yarns that is none.
    #[error(
        "'{0}' is no number of yarns: write a colour and how many yarns have it, as in #c04030*4,#303034*2"
    )]
    Count(String),
}

impl Stripes {
    /// The colour of a yarn, counted from 0.
    pub fn at(&self, yarn: usize) -> Dye {
        let all: usize = self.0.iter().map(|(_, count)| *count as usize).sum();
        let mut left = yarn % all.max(1);
        for (dye, count) in &self.0 {
            if left < *count as usize {
                return *dye;
            }
            left -= *count as usize;
        }
        Dye::UNDYED
    }

    /// The colours, in their order.
    pub fn dyes(&self) -> impl Iterator<Item = Dye> + '_ {
        self.0.iter().map(|(dye, _)| *dye)
    }
}

impl From<Dye> for Stripes {
    fn from(dye: Dye) -> Self {
        Self(vec![(dye, 1)])
    }
}

impl Default for Stripes {
    fn default() -> Self {
        Dye::UNDYED.into()
    }
}

impl fmt::Display for Stripes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [(dye, _)] = self.0[..] {
            return dye.fmt(f);
        }
        let stripes: Vec<String> = self.0.iter().map(|(dye, count)| format!("{dye}*{count}")).collect();
        f.write_str(&stripes.join(","))
    }
}

impl FromStr for Stripes {
    type Err = StripesError;

    fn from_str(text: &str) -> Result<Self, StripesError> {
        let stripe = |text: &str| {
            let (dye, count) = text.split_once('*').unwrap_or((text, "1"));
            let number = count.trim().parse().ok().filter(|n| (1..=MOST).contains(n));
            let count = number.ok_or_else(|| StripesError::Count(count.trim().to_owned()))?;
            Ok((dye.trim().parse()?, count))
        };
        let mut stripes: Vec<(Dye, u32)> =
            text.split(',').map(stripe).collect::<Result<_, StripesError>>()?;
        if let [(_, count)] = &mut stripes[..] {
            *count = 1; // however many, they are followed by more of the same
        }
        Ok(Self(stripes))
    }
}

impl TryFrom<String> for Stripes {
    type Error = StripesError;

    fn try_from(text: String) -> Result<Self, StripesError> {
        text.parse()
    }
}

impl From<Stripes> for String {
    fn from(stripes: Stripes) -> Self {
        stripes.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stripes_are_read_and_written() {
        let [red, black] = [[0xc0, 0x40, 0x30], [0x30, 0x30, 0x34]].map(Dye);
        let stripes: Stripes = "#c04030*2, #303034".parse().unwrap();
        assert_eq!([0, 1, 2, 3, 4, 5].map(|i| stripes.at(i)), [red, red, black, red, red, black]);
        assert_eq!(stripes.to_string(), "#c04030*2,#303034*1");
        assert_eq!(stripes.to_string().parse(), Ok(stripes));
        let plain = Stripes::from(red);
        assert_eq!((plain.at(7), plain.to_string().as_str()), (red, "#c04030"));
        assert_eq!("#c04030*4".parse(), Ok(plain));
        assert_eq!(Stripes::default().at(3), Dye::UNDYED);
        for wrong in ["", "red", "#c04030*0", "#c04030*x", "#c04030,", "#c04030*9999999"] {
            assert!(wrong.parse::<Stripes>().is_err(), "{wrong}");
        }
    }
}
