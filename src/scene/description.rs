//! A scene in full, as text: all that a picture of it depends on. Two scenes with the same text look the same.
//!
//! What follows from it is left out (certificates, recorded graphs), and so are names and places in the script.

use super::{Material, Node, Scene, Shape};
use std::collections::HashMap;
use std::fmt::{self, Write};
use std::sync::Arc;

/// Writes what nodes are, each material once.
struct Describer<'a> {
    out: &'a mut dyn Write,
    materials: HashMap<*const Material, usize>,
}

impl Scene {
    /// Writes all that a picture of the scene depends on.
    ///
    /// # Errors
    /// What `out` says.
    pub fn describe(&self, out: &mut dyn Write) -> fmt::Result {
        let mut describer = Describer {
            out: &mut *out,
            materials: HashMap::new(),
        };
        for node in &self.shown {
            describer.node(node)?;
        }
        let (camera, settings) = (&self.camera, &self.settings);
        writeln!(out, "{:?} {:?} {:?}", self.lights, self.sky, self.fog)?;
        writeln!(out, "{camera:?} {settings:?}")
    }
}

impl Describer<'_> {
    fn node(&mut self, node: &Node) -> fmt::Result {
        if let Some(material) = node.paint() {
            self.material(material)?;
        }
        match node.shape() {
            Shape::Primitive(primitive) => write!(self.out, "{primitive:?}")?,
            Shape::Field(field) => {
                write!(self.out, "field {:?} ", field.claimed)?;
                field.graph.describe(self.out)?;
            }
            Shape::Combination(combination, _) => write!(self.out, "{combination:?}")?,
            Shape::Modifier(modifier, _) => write!(self.out, "{modifier:?}")?,
            Shape::Displacement(_) => self.out.write_str("displace")?,
        }
        self.out.write_char('(')?;
        for child in node.children() {
            self.node(child)?;
        }
        self.out.write_str(")\n")
    }

    fn material(&mut self, material: &Arc<Material>) -> fmt::Result {
        let next = self.materials.len();
        let number = *self.materials.entry(Arc::as_ptr(material)).or_insert(next);
        match number == next {
            true => write!(self.out, "paint {number} {material:?} "),
            false => write!(self.out, "paint {number} "),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Camera, Light, Settings, Source};
    use super::*;
    use crate::catalogue::{AnyModifier, AnyPrimitive, Sphere, Translate};
    use glam::DVec3;

    fn text(scene: &Scene) -> String {
        let mut text = String::new();
        scene.describe(&mut text).unwrap();
        text
    }

    fn ball(radius: f64, x: f64) -> Arc<Node> {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(radius))).unwrap();
        let moved = AnyModifier::Translate(Translate::new([x, 0.0, 0.0]));
        Node::modifier(moved, ball).unwrap()
    }

    #[test]
    fn whatever_a_picture_depends_on_is_told_apart() {
        let scene = |radius: f64, x: f64| Scene {
            shown: vec![ball(radius, x)],
            ..Scene::default()
        };
        let plain = scene(1.0, 2.0);
        let painted = |color: f64| {
            let color = super::super::Term::Constant(DVec3::splat(color));
            let paint = Material {
                color,
                ..Material::default()
            };
            vec![ball(1.0, 2.0).painted(Arc::new(paint))]
        };
        let others = [
            scene(1.0f64.next_up(), 2.0),
            scene(1.0, 2.0f64.next_down()),
            scene(1.0, -2.0),
            Scene {
                shown: vec![ball(1.0, 2.0), ball(1.0, 2.0)],
                ..plain.clone()
            },
            Scene {
                shown: painted(0.5),
                ..plain.clone()
            },
            Scene {
                shown: painted(0.25),
                ..plain.clone()
            },
            Scene {
                camera: Camera {
                    eye: DVec3::new(4.0, 3.0, 6.0f64.next_up()),
                    ..Camera::default()
                },
                ..plain.clone()
            },
            Scene {
                settings: Settings {
                    size: [640, 361],
                    ..Settings::default()
                },
                ..plain.clone()
            },
            Scene {
                lights: vec![Light {
                    source: Source::Directional { toward: DVec3::Y },
                    radiance: DVec3::ONE,
                }],
                ..plain.clone()
            },
        ];
        let mut texts: Vec<String> = others.iter().map(text).collect();
        texts.push(text(&plain));
        texts.sort();
        texts.dedup();
        assert_eq!(texts.len(), others.len() + 1);
        assert_eq!(text(&plain), text(&scene(1.0, 2.0)));
        let named = Scene {
            shown: vec![ball(1.0, 2.0).labelled(Some("pearl".into()), None)],
            ..plain.clone()
        };
        assert_eq!(text(&plain), text(&named));
    }
}
