//! Floor 3: the scene language: from text to a scene.
//!
//! `text -scan-> brackets pair up -syntax-> statements -resolve-> names settled -machine-> values -> Scene`
//!
//! What is wrong with a script comes back as a [`Report`], every error with its place and a hint. Scripts are not
//! trusted: whatever they do ends within the limits of [`limits`].

mod answers;
mod arguments;
mod ast;
mod budget;
mod build;
mod builtin;
mod calls;
mod certificates;
mod claims;
mod color;
mod complaint;
mod entries;
mod fields;
mod functions;
mod hint;
mod intrinsics;
mod judgement;
pub mod limits;
mod literals;
mod load;
mod machine;
mod materials;
mod members;
mod noise;
mod numeric;
mod operators;
mod program;
mod relief;
mod report;
mod resolve;
mod scan;
mod settings;
mod shapes;
mod source;
mod statements;
mod syntax;
mod terms;
mod trial;
mod value;
mod words;

pub use judgement::Judgement;
pub use load::{LoadError, Loaded, load, load_text};
pub use report::{Diagnostic, Level, Report};
pub use source::{Source, Sources, Span};
pub use trial::TestResult;
pub use words::{Group, Word};
