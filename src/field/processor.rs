//! Which instructions wide closures may use, chosen when they are built.
//!
//! A closure made inside of a `#[target_feature]` function is compiled for those features and stays an ordinary boxed
//! closure, so the choice costs nothing per call. All levels give the same bits: there is no fused multiply-add.

use std::sync::OnceLock;

/// A level of vector instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// What every processor of the architecture has.
    Baseline,
    /// Eight f32 or four f64 at once.
    Avx2,
    /// Sixteen f32 or eight f64 at once.
    Avx512,
}

impl Level {
    /// All levels, by the names that the variable `FIELDSTONE_SIMD` takes.
    pub const ALL: [(&'static str, Self); 3] = [
        ("sse2", Self::Baseline),
        ("avx2", Self::Avx2),
        ("avx512", Self::Avx512),
    ];

    /// The best level of this processor, or the one that the variable `FIELDSTONE_SIMD` names if the processor has it.
    pub fn best() -> Self {
        let wanted = std::env::var("FIELDSTONE_SIMD").ok();
        let wanted = wanted.and_then(|name| {
            Self::ALL
                .iter()
                .find(|(word, _)| *word == name)
                .map(|(_, level)| *level)
        });
        Self::supported().min(wanted.unwrap_or(Self::Avx512))
    }

    /// The best level of this processor.
    pub fn supported() -> Self {
        static FOUND: OnceLock<Level> = OnceLock::new();
        *FOUND.get_or_init(Self::detected)
    }

    fn detected() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let has_avx512 = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
                && is_x86_feature_detected!("avx512vl");
            if has_avx512 {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    /// The name of the level.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(_, level)| *level == self)
            .map_or("", |(word, _)| word)
    }
}
