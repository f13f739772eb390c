//! Lipschitz constants that a script claims, put to the test where the field is used.

use super::certificates::near;
use super::machine::Machine;
use super::report::Diagnostic;
use super::source::Span;
use super::value::Value;
use crate::catalogue::{Bounds, Modifier, with_modifier, written};
use crate::scene::{Claim, FieldShape, Node, Refutation, Shape, refute};
use std::collections::HashMap;
use std::sync::Arc;

/// How many different regions one field is tested on.
const MOST_REGIONS: usize = 16;

/// The regions on which each claiming field is evaluated, by its address.
type Regions = HashMap<*const FieldShape, Vec<Bounds>>;

/// A claim is loose where it is this many times what is derived.
const LOOSE: f64 = 2.0;

/// A claim is open where what ranges show is this many times larger: they come within 3 % where they can.
const OPEN: f64 = 1.05;

/// How many steps the samples of one claim on one region count for.
const STEPS_A_REGION: u64 = 4096;

impl Machine<'_> {
    /// Reports every claim that a point refutes: over the bounds of what shows the field, or, where nothing shows it,
    /// within ten units of the origin.
    pub fn check_claims(&mut self) {
        let mut regions = Regions::new();
        for node in &self.shown {
            collect(node, node.bounds(), &mut regions);
        }
        for (id, field) in self.derived.clone() {
            let Some(claimed) = field.claimed else {
                continue;
            };
            let shown = regions.get(&Arc::as_ptr(&field)).cloned();
            let is_shown = shown.is_some();
            let regions = shown.unwrap_or_else(|| vec![Bounds::EVERYWHERE]);
            let at = self.routine(id).claim.as_ref().map(|claim| claim.span);
            let cost = STEPS_A_REGION * regions.len() as u64;
            if at.is_some_and(|at| self.tick(cost, at).is_err()) {
                return;
            }
            let (mut derived, mut nearby) = (0.0f64, 0.0f64);
            let mut verdict = Claim::Derived(0.0);
            for region in regions {
                let effort;
                (verdict, effort) = refute(&field.graph, claimed, region);
                if at.is_some_and(|at| self.tick(effort / 2, at).is_err()) {
                    return;
                }
                match verdict {
                    Claim::Derived(constant) => derived = derived.max(constant),
                    Claim::Nearby(constant) => nearby = nearby.max(constant),
                    Claim::Refuted(_) | Claim::Jumps(_) => break,
                }
            }
            let Some(at) = at else { continue };
            let name = &self.routine(id).name.text;
            match verdict {
                Claim::Refuted(found) => {
                    self.diagnostics.push(refuted(name, at, claimed, found));
                }
                Claim::Jumps(point) => self.diagnostics.push(jumps(name, at, point)),
                _ if is_shown && nearby > OPEN * claimed => {
                    self.diagnostics.push(untested(name, at, nearby));
                }
                Claim::Nearby(_) => {}
                Claim::Derived(_) if derived.is_normal() && claimed > LOOSE * derived => {
                    self.diagnostics.push(loose(name, at, claimed, derived));
                }
                Claim::Derived(_) if derived.is_finite() && derived > OPEN * claimed => {
                    self.diagnostics.push(open(name, at, claimed, derived));
                }
                Claim::Derived(_) => {}
            }
        }
    }
}

fn jumps(name: &str, at: Span, point: [f64; 3]) -> Diagnostic {
    let message = format!("the claimed Lipschitz constant of `{name}` is refuted");
    Diagnostic::error(at, message)
        .label(format!("its value jumps {}", near(point)))
        .help("what jumps has no Lipschitz constant: make it continuous, as `abs`, `min`, `max` and `clamp` are")
}

fn open(name: &str, at: Span, claimed: f64, derived: f64) -> Diagnostic {
    let derived = written(rounded_up(derived));
    let message = format!("the claimed Lipschitz constant of `{name}` is not proved");
    Diagnostic::warning(at, message)
        .label(format!(
            "claimed {}, no point refutes it, but ranges only show {derived}",
            written(claimed)
        ))
        .help(format!("be sure, or claim {derived}"))
}

fn untested(name: &str, at: Span, known: f64) -> Diagnostic {
    let message = format!(
        "the claimed Lipschitz constant of `{name}` is only tested within ten units of the origin"
    );
    let label = match known.is_finite() {
        true => format!(
            "of what lies farther out, ranges only show {}",
            written(rounded_up(known))
        ),
        false => "of what lies farther out, ranges show nothing".into(),
    };
    Diagnostic::warning(at, message).label(label).help(
        "bound what is shown, as in `shape & box(40)`: then the claim is tested in the whole box",
    )
}

fn loose(name: &str, at: Span, claimed: f64, derived: f64) -> Diagnostic {
    let derived = written(rounded_up(derived));
    let message = format!("the claimed Lipschitz constant of `{name}` is loose, which costs time");
    Diagnostic::warning(at, message)
        .label(format!(
            "claimed {}, but {derived} is derived",
            written(claimed)
        ))
        .help(format!(
            "claim {derived}, or leave `lipschitz` out to have it derived"
        ))
}

fn refuted(name: &str, at: Span, claimed: f64, found: Refutation) -> Diagnostic {
    let slope = written(found.slope);
    let message = format!("the claimed Lipschitz constant of `{name}` is refuted");
    Diagnostic::error(at, message)
        .label(format!(
            "claimed {}, but the slope is {slope} at {}",
            written(claimed),
            Value::Vector3(found.point)
        ))
        .help(format!(
            "claim at least {slope}, or leave `lipschitz` out to have it derived"
        ))
}

/// The number with three digits, not below it but for rounding.
fn rounded_up(x: f64) -> f64 {
    let digits = |x: f64| format!("{x:.2e}").parse().unwrap_or(x);
    let nearest = digits(x);
    if nearest >= x * (1.0 - 1e-9) {
        return nearest;
    }
    digits(x * 1.005)
}

/// Notes the regions on which fields below `node` are evaluated for points of `region`.
fn collect(node: &Node, region: Bounds, regions: &mut Regions) {
    match node.shape() {
        Shape::Primitive(_) => {}
        Shape::Field(field) => {
            if field.claimed.is_some() {
                let known = regions.entry(Arc::as_ptr(field)).or_default();
                if known.len() < MOST_REGIONS && !known.contains(&region) {
                    known.push(region);
                }
            }
        }
        Shape::Combination(_, children) => {
            for child in children {
                collect(child, region, regions);
            }
        }
        Shape::Displacement(displacement) => {
            for operand in &displacement.operands {
                collect(operand, region, regions);
            }
        }
        Shape::Modifier(modifier, child) => {
            let inner = with_modifier!(modifier, m => m.domain(region));
            collect(child, inner, regions);
        }
    }
}
