//! What objects are called in answers.

use crate::catalogue::Bounds;
use crate::scene::{Node, Shape};

/// The name of an object: that of its `let` or `field`, looked for under its transforms and other modifiers, or else the
/// word for what it is.
pub fn object_name(node: &Node) -> &str {
    let mut node = node;
    loop {
        match (node.name(), node.shape()) {
            (Some(name), _) => return name,
            (None, Shape::Modifier(_, child)) => node = child,
            (None, _) => return node.kind(),
        }
    }
}

/// A number for people: at most five significant digits.
pub fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let magnitude = x.abs().log10().floor();
    if !(-4.0..7.0).contains(&magnitude) {
        return format!("{x:.3e}");
    }
    let decimals = (4.0 - magnitude).max(0.0) as usize;
    let text = format!("{x:.decimals$}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    text.into()
}

/// A box for people.
pub fn bounds_in_words(bounds: &Bounds) -> String {
    if bounds.is_empty() {
        return "nothing".into();
    }
    if *bounds == Bounds::EVERYWHERE {
        return "everywhere".into();
    }
    let corner = |p: [f64; 3]| p.map(short).join(", ");
    format!("[{}] to [{}]", corner(bounds.low), corner(bounds.high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyModifier, AnyPrimitive, Sphere, Translate};

    #[test]
    fn names_are_found_under_transforms() {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap();
        let moved = |node| {
            Node::modifier(
                AnyModifier::Translate(Translate::new([1.0, 0.0, 0.0])),
                node,
            )
            .unwrap()
        };
        assert_eq!(object_name(&moved(ball.clone())), "sphere");
        let named = ball.labelled(Some("pearl".into()), None);
        assert_eq!(object_name(&moved(named)), "pearl");
    }

    #[test]
    fn numbers_for_people_are_short() {
        assert_eq!(short(1.0), "1");
        assert_eq!(short(-0.05), "-0.05");
        assert_eq!(short(1.0 / 3.0), "0.33333");
        assert_eq!(short(12345.678), "12346");
        assert_eq!(short(1e9), "1.000e9");
        assert_eq!(short(f64::INFINITY), "inf");
        assert_eq!(short(0.0), "0");
    }

    #[test]
    fn boxes_for_people() {
        assert_eq!(bounds_in_words(&Bounds::EVERYWHERE), "everywhere");
        assert_eq!(bounds_in_words(&Bounds::EMPTY), "nothing");
        let half = Bounds::new([f64::NEG_INFINITY, -1.0, 0.0], [0.5, 1.0, f64::INFINITY]);
        assert_eq!(bounds_in_words(&half), "[-inf, -1, 0] to [0.5, 1, inf]");
    }
}
