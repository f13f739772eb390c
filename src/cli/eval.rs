//! `fieldstone eval`: the field at points.

use super::console::answer;
use super::failure::Failure;
use super::script::{Script, chosen};
use super::table::{self, Cell};
use super::value;
use crate::num::{Dual, Vec3};
use crate::scene::Node;
use clap::Args;
use std::path::PathBuf;
use std::sync::Arc;

/// The columns of the answer.
const COLUMNS: [&str; 8] = ["x", "y", "z", "value", "gx", "gy", "gz", "lipschitz"];

const AFTER_HELP: &str = "\
The answer is CSV with the header `x,y,z,value,gx,gy,gz,lipschitz` and a row for each point, or with --json an \
array of objects with these names. Numbers have the 17 digits that give the same f64 back; zeros at the end are left \
out. What is not finite reads inf, -inf or nan, and null in JSON.

  value      the field: negative inside, zero on the surface, positive outside
  gx gy gz   its gradient, by automatic differentiation
  lipschitz  a constant that the field's slope does not exceed on the shape's bounds

Without --shape, the field is the hard union of everything that is shown. Lines of input that are empty or start \
with `#` are passed over, and so is a first line without numbers. A bad row ends the command with exit code 1.

Examples:
  fieldstone eval scene.sdf --at 0,1.5,-2
  fieldstone eval scene.sdf --shape core --points points.csv --json
  echo 0,0,0 | fieldstone eval scene.sdf --points -";

/// Print value, gradient and Lipschitz constant of the field at points
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    script: Script,
    #[command(flatten)]
    points: Points,
    /// Only the shape of this top-level `let` or `field`
    #[arg(long, value_name = "NAME")]
    shape: Option<String>,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

/// Where the points come from.
#[derive(Args, Debug)]
#[group(required = true, multiple = false)]
struct Points {
    /// A point
    #[arg(long, value_name = "X,Y,Z", value_parser = value::point, allow_hyphen_values = true)]
    at: Option<[f64; 3]>,
    /// A CSV file with three numbers a row; `-` is standard input
    #[arg(long, value_name = "FILE.csv")]
    points: Option<PathBuf>,
}

impl Points {
    fn read(&self) -> Result<Vec<[f64; 3]>, Failure> {
        let rows = match &self.points {
            Some(path) => table::read(path)?,
            None => return Ok(self.at.into_iter().collect()),
        };
        Ok(rows.into_iter().map(|row| row.values).collect())
    }
}

/// Answers for each point.
///
/// # Errors
/// If the script is wrong, the shape unknown, or the points can't be read.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let loaded = arguments.script.load()?;
    let shapes = chosen(&loaded, arguments.shape.as_deref())?;
    let points = arguments.points.read()?;
    let rows: Vec<Vec<Cell>> = points.iter().map(|p| row(&shapes, *p)).collect();
    answer(&if arguments.json {
        table::to_json(&COLUMNS, &rows)
    } else {
        table::to_csv(&COLUMNS, &rows)
    })
}

/// The answer for the union of `shapes` at `p`.
fn row(shapes: &[Arc<Node>], p: [f64; 3]) -> Vec<Cell> {
    let (value, nearest) = smallest(shapes, p);
    let [gx, gy, gz] = nearest.map_or([f64::NAN; 3], |node| gradient(node, p));
    let lipschitz = shapes.iter().map(|n| n.lipschitz()).fold(0.0, f64::max);
    let [x, y, z] = p;
    [x, y, z, value, gx, gy, gz, lipschitz]
        .map(Cell::Number)
        .to_vec()
}

/// The smallest of the fields at `p`, and the shape that has it; the first that is not a number, if any.
fn smallest(shapes: &[Arc<Node>], p: [f64; 3]) -> (f64, Option<&Arc<Node>>) {
    let p = Vec3::splat(p);
    let mut best = (f64::INFINITY, shapes.first());
    for shape in shapes {
        let value: f64 = shape.evaluate(&p);
        if value.is_nan() {
            return (value, Some(shape));
        }
        if value < best.0 {
            best = (value, Some(shape));
        }
    }
    best
}

/// The gradient of the field at `p`.
fn gradient(node: &Node, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let p = Vec3::new(
        Dual::variable(x, 0),
        Dual::variable(y, 1),
        Dual::variable(z, 2),
    );
    let field: Dual<f64, 3> = node.evaluate(&p);
    field.partial
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyModifier, AnyPrimitive, Sphere, Translate};

    fn ball(radius: f64, at: [f64; 3]) -> Arc<Node> {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(radius))).unwrap();
        Node::modifier(AnyModifier::Translate(Translate::new(at)), ball).unwrap()
    }

    #[test]
    fn union_has_value_and_gradient_of_the_nearest() {
        let shapes = [ball(1.0, [-3.0, 0.0, 0.0]), ball(0.5, [3.0, 0.0, 0.0])];
        let expected = [1.0, 0.0, 0.0, 1.5, -1.0, 0.0, 0.0, 1.0].map(Cell::Number);
        assert_eq!(row(&shapes, [1.0, 0.0, 0.0]), expected);
    }
}
