//! The peers' figures: CSV that whoever measured the peers on this machine wrote.
//!
//! ```text
//! scene,what,peer,value,p99,missed,wrong
//! s2,whole,POV-Ray,127,,,                     seconds for the whole picture
//! s2,object,fidget,0.67,,,                    seconds for the object alone
//! s2,evaluation,hand-written loop,209,,,      million points a second
//! s2,error,POV-Ray 0.01,15.4,8.2e-4,6,0       seconds, error of depth in scene units, rays missed, on a wrong surface
//! ```

use crate::Outcome;
use crate::machine;
use serde::Deserialize;
use std::path::Path;
use std::time::UNIX_EPOCH;

/// A figure of a peer.
#[derive(Clone, Debug, Deserialize)]
pub struct Figure {
    pub scene: String,
    pub what: String,
    pub peer: String,
    pub value: f64,
    pub p99: Option<f64>,
    pub missed: Option<u64>,
    pub wrong: Option<u64>,
}

/// All figures.
#[derive(Debug, Default)]
pub struct Peers {
    figures: Vec<Figure>,
    source: Option<String>,
}

impl Peers {
    /// The figures of a file; none without one.
    pub fn read(path: Option<&Path>) -> Outcome<Self> {
        let Some(path) = path else {
            return Ok(Self::default());
        };
        let named = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let mut reader = csv::Reader::from_path(path).map_err(|error| named(&error))?;
        let figures = reader.deserialize().collect::<Result<Vec<Figure>, _>>();
        let days = std::fs::metadata(path)?
            .modified()?
            .duration_since(UNIX_EPOCH)?
            .as_secs()
            / 86_400;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Ok(Self {
            figures: figures.map_err(|error| named(&error))?,
            source: Some(format!("{name} of {}", machine::date(days))),
        })
    }

    /// Where the figures come from, in a sentence.
    pub fn source(&self) -> String {
        match &self.source {
            Some(source) => format!(
                "The peers' figures are from the file {source}, measured on the same machine."
            ),
            None => "No peer was measured (`--peers FILE.csv` takes their figures).".into(),
        }
    }

    /// A figure of the peer whose name begins so.
    pub fn value(&self, scene: &str, what: &str, peer: &str) -> Option<f64> {
        let is_meant = |f: &&Figure| f.scene == scene && f.what == what && f.peer.starts_with(peer);
        self.figures.iter().find(is_meant).map(|f| f.value)
    }

    /// The peers' times at their errors.
    pub fn errors(&self) -> impl Iterator<Item = &Figure> {
        self.figures.iter().filter(|f| f.what == "error")
    }
}
