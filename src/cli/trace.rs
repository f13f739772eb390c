//! `fieldstone trace`: what rays find.

use super::console::answer;
use super::failure::Failure;
use super::outline::object_name;
use super::script::{Script, chosen, compile};
use super::table::{self, Cell};
use super::tracing::Tracing;
use super::value::{self, NO_DIRECTION, has_direction};
use crate::render::View;
use crate::scene::{Node, Scene};
use crate::trace::{Footprint, Outcome, Ray, Verdict, Visibility};
use clap::Args;
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// The columns of the answer.
const COLUMNS: [&str; 10] = [
    "verdict", "t", "px", "py", "pz", "nx", "ny", "nz", "steps", "object",
];

const AFTER_HELP: &str = "\
The answer is CSV with the header `verdict,t,px,py,pz,nx,ny,nz,steps,object` and a row for each ray, or with --json an \
array of objects with these names. Numbers have the 17 digits that give the same f64 back; zeros at the end are left \
out. Where there is no hit, the fields between verdict and steps are empty, and so is the object (null in JSON).

  verdict    hit, miss or unknown
  t          the distance along the ray in scene units
  px py pz   the point that is hit
  nx ny nz   the outward unit normal there
  steps      how many steps the ray took
  object     the `let` or `field` that was hit, or else what it is, as in `sphere`

Directions may have any length but zero. Hits are as exact as --tolerance asks, in pixels of the scene's camera. \
Without --shape, rays meet everything that is shown. Lines of input that are empty or start with `#` are passed \
over, and so is a first line without numbers. A bad row ends the command with exit code 1.

Examples:
  fieldstone trace scene.sdf --ray 0,1,5,0,0,-1
  fieldstone trace scene.sdf --rays rays.csv --json
  fieldstone trace scene.sdf --shape core --method sphere --rays - < rays.csv";

/// Print what rays find: verdict, distance, point, normal, steps and object
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    script: Script,
    #[command(flatten)]
    rays: Rays,
    /// Only the shape of this top-level `let` or `field`
    #[arg(long, value_name = "NAME")]
    shape: Option<String>,
    #[command(flatten)]
    tracing: Tracing,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

/// Where the rays come from.
#[derive(Args, Debug)]
#[group(required = true, multiple = false)]
struct Rays {
    /// A ray: its origin and its direction
    #[arg(long, value_name = "OX,OY,OZ,DX,DY,DZ", value_parser = value::ray, allow_hyphen_values = true)]
    ray: Option<[f64; 6]>,
    /// A CSV file with six numbers a row; `-` is standard input
    #[arg(long, value_name = "FILE.csv")]
    rays: Option<PathBuf>,
}

impl Rays {
    fn read(&self) -> Result<Vec<[f64; 6]>, Failure> {
        let Some(path) = &self.rays else {
            return Ok(self.ray.into_iter().collect());
        };
        let rows = table::read(path)?;
        if let Some(row) = rows.iter().find(|row| !has_direction(&row.values)) {
            let (name, line) = (table::source_name(path), row.line);
            return Err(Failure::Other(format!(
                "{name}, line {line}: {NO_DIRECTION}"
            )));
        }
        Ok(rows.into_iter().map(|row| row.values).collect())
    }
}

/// Answers for each ray.
///
/// # Errors
/// If the script is wrong, the shape unknown, or the rays can't be read.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let loaded = arguments.script.load()?;
    let mut scene = Scene {
        shown: chosen(&loaded, arguments.shape.as_deref())?,
        ..loaded.scene
    };
    arguments.tracing.apply(&mut scene.settings);
    let rays = arguments.rays.read()?;
    let world = compile(&scene)?;
    let nodes: Vec<&Arc<Node>> = world.paths().map(|(_, node)| node).collect();
    let footprint = footprint(&scene);
    let rays: Vec<Ray> = rays.iter().map(|ray| of_numbers(ray, footprint)).collect();
    let rows: Vec<Vec<Cell>> = world
        .nearest(&rays, Visibility::All)
        .iter()
        .map(|outcome| row(outcome, &nodes))
        .collect();
    answer(&if arguments.json {
        table::to_json(&COLUMNS, &rows)
    } else {
        table::to_csv(&COLUMNS, &rows)
    })
}

/// How wide a pixel of the scene's camera is along a ray.
fn footprint(scene: &Scene) -> Footprint {
    View::new(&scene.camera, scene.settings.size)
        .ray(0.0, 0.0)
        .footprint
}

/// The ray of six numbers, whose direction is not zero.
fn of_numbers([ox, oy, oz, dx, dy, dz]: &[f64; 6], footprint: Footprint) -> Ray {
    let direction = DVec3::new(*dx, *dy, *dz);
    // Divided by its largest component first, a direction of any length has a length that is a number.
    let direction = direction / direction.abs().max_element();
    Ray {
        origin: DVec3::new(*ox, *oy, *oz),
        direction: direction.normalize(),
        t_max: f64::INFINITY,
        footprint,
    }
}

/// The answer for what a ray found in a world of these parts.
fn row(outcome: &Outcome, nodes: &[&Arc<Node>]) -> Vec<Cell> {
    let mut row = vec![Cell::Text(outcome.verdict.word().into())];
    let object = if outcome.verdict == Verdict::Hit {
        row.push(Cell::Number(outcome.t));
        row.extend(outcome.point.to_array().map(Cell::Number));
        row.extend(outcome.normal.to_array().map(Cell::Number));
        let node = nodes.get(outcome.part as usize);
        node.map_or(Cell::Empty, |node| Cell::Text(object_name(node).into()))
    } else {
        row.extend(vec![Cell::Empty; 7]);
        Cell::Empty
    };
    row.push(Cell::Count(outcome.steps));
    row.push(object);
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_of_any_length_are_normalised() {
        let footprint = Footprint {
            at_origin: 0.0,
            spread: 1e-3,
        };
        for length in [5e-324, 1e-200, 1.0, 1e300] {
            let ray = of_numbers(&[1.0, 2.0, 3.0, 0.0, -length, 0.0], footprint);
            assert_eq!(ray.direction, DVec3::NEG_Y);
        }
    }
}
