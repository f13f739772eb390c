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
    use crate::catalogue::{AnyPrimitive, Sphere};

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
