//! What is said of Lipschitz constants that rays have refuted.

use super::console::{counted, say, speaks_color};
use super::stats::grouped;
use crate::catalogue::written;
use crate::lang::Loaded;
use crate::output::short;
use crate::scene::{Blame, Shape};
use crate::trace::{Refuted, World};

/// Warns of every constant that rays have refuted, with the node, its place in the script and two points that refute it.
/// Gives how many there are.
pub fn warn(loaded: &Loaded, world: &World) -> usize {
    let refuted = world.refuted();
    for refuted in &refuted {
        say(&warning(loaded, refuted));
    }
    refuted.len()
}

fn warning(loaded: &Loaded, refuted: &Refuted) -> String {
    let Blame {
        node,
        placed,
        points,
        values,
        constant,
    } = refuted.blame;
    let kind = node.kind();
    let name = placed.and_then(|placed| placed.name());
    let whole = match name {
        Some(name) if name != kind => format!("`{kind}` of `{name}`"),
        _ => format!("`{kind}`"),
    };
    let is_claimed = matches!(node.shape(), Shape::Field(field) if field.claimed.is_some());
    let claimed = if is_claimed { "claimed " } else { "" };
    let message =
        format!("rays refute the {claimed}Lipschitz constant of {whole}; the picture may be wrong");
    let [a, b] = points;
    let apart = (0..3).fold(0.0, |n: f64, i| n.hypot(b[i] - a[i]));
    let slope = (values[1] - values[0]).abs() / apart;
    let label = format!(
        "the constant is {}, but a slope is {}",
        written(constant),
        short(slope)
    );
    let witness = format!(
        "the field is {} at {} and {} at {}; {} found such points",
        written(values[0]),
        point(a),
        written(values[1]),
        point(b),
        walks(refuted.walks)
    );
    let help = if is_claimed {
        "claim more, or leave `lipschitz` out to have it derived"
    } else {
        "this constant was derived: please report the script"
    };
    let help = format!("{help}\n{witness}");
    let mark = placed
        .and_then(|placed| placed.place())
        .map(|place| place.mark);
    match mark {
        Some(_) => loaded.warning(mark, message, label, &help),
        // Where there is no place to put the label, the message says it.
        None => loaded.warning(None, format!("{message}: {label}"), String::new(), &help),
    }
    .render(speaks_color())
}

fn walks(n: u64) -> String {
    match n {
        1 => counted(1, "ray"),
        n => format!("{} rays", grouped(n)),
    }
}

fn point(p: [f64; 3]) -> String {
    format!("[{}]", p.map(written).join(", "))
}
