//! What a film can record of every pixel.

/// A quantity of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// The picture.
    Beauty,
    /// The flat colour of what is seen.
    Color,
    /// The distance to it.
    Depth,
    /// Its normal.
    Normal,
    /// The steps that finding it took.
    Steps,
    /// The evaluations that finding it took.
    Evaluations,
    /// How certain it is.
    Verdict,
    /// Which part of the world it is.
    Object,
}

/// What there is to say about a channel.
struct Declaration {
    name: &'static str,
    components: usize,
    summary: &'static str,
}

impl Channel {
    /// All channels.
    pub const ALL: [Self; 8] = [
        Self::Beauty,
        Self::Color,
        Self::Depth,
        Self::Normal,
        Self::Steps,
        Self::Evaluations,
        Self::Verdict,
        Self::Object,
    ];

    const fn declaration(self) -> Declaration {
        let (name, components, summary) = match self {
            Self::Beauty => (
                "beauty",
                3,
                "the picture: linear RGB, the mean of the samples",
            ),
            Self::Color => (
                "color",
                3,
                "the material's colour without light: linear RGB, the mean of the samples",
            ),
            Self::Depth => (
                "depth",
                1,
                "the distance to the nearest hit in scene units; infinite where there is none",
            ),
            Self::Normal => (
                "normal",
                3,
                "the outward unit normal of the nearest hit; zero where there is none",
            ),
            Self::Steps => (
                "steps",
                1,
                "the steps of a camera ray, the mean of the samples",
            ),
            Self::Evaluations => (
                "evaluations",
                1,
                "the evaluations of fields by a camera ray, the mean of the samples",
            ),
            Self::Verdict => (
                "verdict",
                1,
                "0 for a miss, 1 for a hit, 2 where some ray of the pixel could not tell",
            ),
            Self::Object => (
                "object",
                1,
                "the number of the part that was hit nearest; -1 where there is none",
            ),
        };
        Declaration {
            name,
            components,
            summary,
        }
    }

    /// The name on the command line and in file names.
    pub const fn name(self) -> &'static str {
        self.declaration().name
    }

    /// How many numbers it has in each pixel: 1 or 3.
    pub const fn components(self) -> usize {
        self.declaration().components
    }

    /// What the numbers mean, with units.
    pub const fn summary(self) -> &'static str {
        self.declaration().summary
    }

    /// The channel called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|channel| channel.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_is_found_by_its_name() {
        for (i, channel) in Channel::ALL.into_iter().enumerate() {
            assert_eq!(channel as usize, i);
            assert_eq!(Channel::from_name(channel.name()), Some(channel));
        }
        assert_eq!(Channel::from_name("Beauty"), None);
    }
}
