//! Options on how rays find surfaces, in place of what the script says.

use super::value;
use crate::scene::{Method, Settings};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// Options on how rays find surfaces.
#[derive(Args, Debug)]
pub struct Tracing {
    /// How rays find surfaces [default: what the script says, or else auto]
    #[arg(long, value_name = "NAME", value_parser = method())]
    method: Option<Method>,
    /// How far from the surface a hit may be, in pixels [default: what the script says, or else 0.1]
    #[arg(long, value_name = "PX", value_parser = value::positive, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// How many steps a ray may take through a shape [default: what the script says, or else 1024]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), allow_negative_numbers = true)]
    max_steps: Option<u32>,
    /// How much longer than Hart's the steps of `relaxed` are [default: what the script says, or else 1.6]
    #[arg(long, value_name = "W", value_parser = value::omega, allow_negative_numbers = true)]
    omega: Option<f64>,
}

impl Tracing {
    /// Puts what was asked for into the settings.
    pub fn apply(&self, settings: &mut Settings) {
        settings.method = self.method.unwrap_or(settings.method);
        settings.tolerance = self.tolerance.unwrap_or(settings.tolerance);
        settings.max_steps = self.max_steps.unwrap_or(settings.max_steps);
        settings.omega = self.omega.unwrap_or(settings.omega);
    }
}

/// The name of a method.
pub fn method() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(|(name, _)| name))
        .map(|name| Method::from_name(&name).expect("the parser takes only names of methods"))
}
