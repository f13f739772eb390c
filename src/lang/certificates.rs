//! What is said of a shape that has no finite Lipschitz constant.

use super::report::Diagnostic;
use super::source::Span;
use super::value::Value;
use crate::catalogue::{Bounds, Function, written};
use crate::scene::{Mark, Node, Obstacle, Shape, Trouble, trouble};

const BOUND_IT: &str =
    "bound it: `shape & box(10)`, or another solid that holds what you want to see";

/// The error for a shape that is shown at `at` and has no finite constant: it names the node at fault, where in the
/// script its field jumps or is infinitely steep, and the way out.
pub fn without_constant(node: &Node, at: Span) -> Diagnostic {
    let message = "this shape has no finite Lipschitz constant, so it cannot be traced";
    let error = Diagnostic::error(at, message);
    let Some((culprit, region)) = node.without_constant() else {
        return error.label("its slope has no bound").help(BOUND_IT);
    };
    let found = match culprit.shape() {
        Shape::Field(field) => trouble(&field.graph, region),
        _ => None,
    };
    match found {
        Some(found) => because_of(error, culprit.kind(), &found),
        None => over_region(error, node, culprit, &region),
    }
}

/// The error with what was found in the field called `name`.
fn because_of(error: Diagnostic, name: &str, found: &Trouble) -> Diagnostic {
    let near = near(found.point);
    let (what, help) = match found.obstacle {
        Obstacle::Choice(gap) if gap > 1e-6 => (
            format!("this jumps by {} {near}", written(shortened(gap))),
            "make both branches agree where the condition changes, as `min`, `max`, `clamp` and `mix` do",
        ),
        Obstacle::Choice(_) => (
            format!("both branches seem to agree {near}, but that cannot be proved"),
            "write it with `min`, `max`, `abs` or `clamp`, which are known to be continuous",
        ),
        Obstacle::Function(Function::Atan2) => (
            format!("`atan2` jumps {near}, by a full turn"),
            "use the angle inside of `sin` or `cos`, or keep the negative x axis out of the bounds",
        ),
        Obstacle::Function(
            function @ (Function::Floor
            | Function::Ceil
            | Function::Round
            | Function::Fract
            | Function::Modulo
            | Function::Sign),
        ) => (
            format!("`{}` jumps {near}", function.name()),
            "repeat a shape with `.repeat(...)`, or fold space with `abs`, which is continuous",
        ),
        Obstacle::Function(function) => (
            format!("the slope of `{}` has no bound {near}", function.name()),
            "keep its argument away from there, as in `max(x, 0.01)`",
        ),
        Obstacle::Quotient => (
            format!("the divisor may be 0 {near}"),
            "keep it away from 0, as in `max(x, 0.01)`",
        ),
        Obstacle::Shape => (
            format!("a shape that this asks has no bounded slope {near}"),
            BOUND_IT,
        ),
    };
    let error = error.label(format!("the slope of the field `{name}` has no bound"));
    let error = match found.mark {
        Mark(0) => error.label(what),
        mark => error.note(Span::marked(mark), what),
    };
    error.help(help)
}

/// The error where the slope only grows without bound, the further out the steeper.
fn over_region(error: Diagnostic, node: &Node, culprit: &Node, region: &Bounds) -> Diagnostic {
    let whose = match std::ptr::eq(node, culprit) {
        true => "its slope".into(),
        false => format!("the slope of its `{}`", culprit.kind()),
    };
    if !region.is_finite() {
        return error
            .label(format!("{whose} has no bound on all of space"))
            .help(BOUND_IT);
    }
    error
        .label(format!(
            "no bound of {whose} could be derived, not even inside of its bounds"
        ))
        .help(
            "a jump (`floor`, `if`), a pole (`1 / x`) or a root at 0 may be the cause: remove it, or claim a constant, \
             as in `field f(p) lipschitz 2 { ... }`",
        )
}

/// "near" and the point, rounded: the search for it ends next to the place, not on it, so at a coordinate of 0 it is off by
/// what does not count.
pub fn near(point: [f64; 3]) -> String {
    let size = point.iter().fold(0.0, |n: f64, c| n.max(c.abs()));
    let rounded = |c: f64| {
        if c.abs() < 1e-6 * size {
            0.0
        } else {
            shortened(c)
        }
    };
    format!("near {}", Value::Vector3(point.map(rounded)))
}

/// A number with four digits, for reading.
fn shortened(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
