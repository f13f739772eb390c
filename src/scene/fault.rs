//! Why a node can't exist.

/// What is wrong with an entry or its arguments, in the words of a script; the language adds the place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The parameter at fault, where it is one.
    pub parameter: Option<&'static str>,
    /// What is wrong.
    pub message: String,
    /// What to write instead; empty where there is nothing to say.
    pub hint: String,
}

impl Fault {
    /// A fault of the entry as a whole.
    pub fn new(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self {
            parameter: None,
            message: message.into(),
            hint: hint.into(),
        }
    }

    /// A fault of one parameter.
    pub fn of(parameter: &'static str, message: impl Into<String>) -> Self {
        Self {
            parameter: Some(parameter),
            message: message.into(),
            hint: String::new(),
        }
    }
}
