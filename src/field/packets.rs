//! A field at many points, a packet of them at a time, by the closures with which rays cross free space.

use super::{Closure, Level, compile_wide};
use crate::num::{F32x32, Lanes, Vec3};
use crate::scene::Node;

/// The lanes in which rays cross free space.
pub type Packet = F32x32;

/// A field that is ready to be evaluated at packets of points.
pub struct Packets {
    closure: Closure<Packet>,
}

impl Packets {
    /// How many points are in a packet.
    pub const WIDTH: usize = Packet::WIDTH;

    /// The field of `node`, with the best instructions that the processor has.
    pub fn new(node: &Node) -> Self {
        Self {
            closure: compile_wide(node, Level::best()),
        }
    }

    /// The points as packets; lanes without a point repeat the last one.
    pub fn of_points(points: &[[f64; 3]]) -> Vec<Vec3<Packet>> {
        let packet = |points: &[[f64; 3]]| {
            let last = points.len() - 1;
            let axis = |axis: usize| Lanes::from_fn(|lane| points[lane.min(last)][axis] as f32);
            Vec3::new(axis(0), axis(1), axis(2))
        };
        points.chunks(Self::WIDTH).map(packet).collect()
    }

    /// The values at a packet of points.
    pub fn at(&self, points: &Vec3<Packet>) -> Packet {
        (self.closure)(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{
        AnyBlend, AnyModifier, AnyPrimitive, Combination, Hard, Operation, Smooth,
    };
    use crate::catalogue::{Capsule, Cuboid, Cylinder, Rotate, Scale, Sphere, Torus, Translate};
    use crate::num::samples::random;
    use std::sync::Arc;

    /// A primitive that is moved, or turned too, or scaled too, with others like it beside it.
    fn leaf(seed: u64) -> Arc<Node> {
        let size = 0.2 + 0.3 * random(seed);
        let primitive = match seed / 3 % 6 {
            0 => AnyPrimitive::Sphere(Sphere::new(size)),
            1 => AnyPrimitive::Cuboid(Cuboid::new([size, 2.0 * size, 0.3], 0.1 * size)),
            2 => AnyPrimitive::Cylinder(Cylinder::new(size, 3.0 * size, 0.0)),
            3 => AnyPrimitive::Capsule(Capsule::new(size, 3.0 * size)),
            4 => AnyPrimitive::Torus(Torus::new(2.0 * size, size)),
            _ => AnyPrimitive::Sphere(Sphere::new(0.5 * size)),
        };
        let shift = [0, 1, 2].map(|axis| 4.0 * random(seed * 3 + axis) - 2.0);
        let steps = [
            AnyModifier::Scale(Scale::new([0.5 + size; 3])),
            AnyModifier::Rotate(Rotate::new(3.0 * size, [0.6, 0.0, 0.8], 0.0, 0.0, 0.0)),
            AnyModifier::Translate(Translate::new(shift)),
        ];
        let bare = Node::primitive(primitive).unwrap();
        let wanted = &steps[2 - (seed / 7 % 3) as usize..];
        let place = |node, step: &AnyModifier| Node::modifier(step.clone(), node).unwrap();
        wanted.iter().fold(bare, place)
    }

    /// Neighbours of one kind go through one closure; the fold from first to last stays as it is.
    #[test]
    fn a_union_has_the_bits_of_its_children_joined_one_by_one() {
        let points: Vec<[f64; 3]> = (0..256)
            .map(|i| [0, 1, 2].map(|axis| 6.0 * random(1000 + 3 * i + axis) - 3.0))
            .collect();
        let points = Packets::of_points(&points);
        let (hard, smooth) = (Hard::new(), Smooth::new(0.4));
        for seed in 0..20 {
            let nodes: Vec<Arc<Node>> = (0..3 + seed).map(|i| leaf(seed * 31 + i)).collect();
            for is_hard in [true, false] {
                let blend = if is_hard {
                    AnyBlend::Hard(hard.clone())
                } else {
                    AnyBlend::Smooth(smooth.clone())
                };
                let union = Combination {
                    operation: Operation::Union,
                    blend,
                };
                let union = Node::combination(union, nodes.clone()).unwrap();
                let union = Packets::new(&union);
                let children: Vec<Packets> = nodes.iter().map(|node| Packets::new(node)).collect();
                for points in &points {
                    let values = children.iter().map(|child| child.at(points));
                    let join = |all, own| {
                        if is_hard {
                            Operation::Union.join(&hard, all, own)
                        } else {
                            Operation::Union.join(&smooth, all, own)
                        }
                    };
                    let expected = values.reduce(join).unwrap();
                    assert_eq!(union.at(points).0, expected.0, "seed {seed}");
                }
            }
        }
    }

    #[test]
    fn a_last_packet_that_is_not_full_repeats_its_last_point() {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap();
        let points: Vec<[f64; 3]> = (0..Packets::WIDTH + 3)
            .map(|i| [i as f64, 0.0, 0.0])
            .collect();
        let packets = Packets::of_points(&points);
        assert_eq!(packets.len(), 2);
        let values = Packets::new(&ball).at(&packets[1]).0;
        let first = Packets::WIDTH as f32 - 1.0;
        assert_eq!(values[..3], [first, first + 1.0, first + 2.0]);
        assert!(values[3..].iter().all(|v| *v == first + 2.0));
    }
}
