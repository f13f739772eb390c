//! A scene in full, as text: all that a picture of it depends on. Two scenes with the same text look the same.
//!
//! What follows from it is left out (certificates, recorded graphs), and so are names and places in the script.

use super::{Material, Node, Scene, Shape, Term};
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
        self.children(node.children())
    }

    fn children(&mut self, nodes: &[Arc<Node>]) -> fmt::Result {
        self.out.write_char('(')?;
        for node in nodes {
            self.node(node)?;
        }
        self.out.write_str(")\n")
    }

    fn material(&mut self, material: &Arc<Material>) -> fmt::Result {
        let next = self.materials.len();
        let number = *self.materials.entry(Arc::as_ptr(material)).or_insert(next);
        write!(self.out, "paint {number} ")?;
        if number < next {
            return Ok(());
        }
        let Material {
            name: _,
            color,
            ambient,
            diffuse,
            specular,
            shininess,
            model,
            reflect,
            refract,
            ior,
            fresnel,
            absorb,
            shadow,
        } = &**material;
        self.term(color)?;
        self.term(absorb)?;
        for number in [ambient, diffuse, specular, shininess, reflect, refract, ior] {
            self.term(number)?;
        }
        write!(self.out, "{model:?} {fresnel} {shadow:?} ")
    }

    /// Writes a term of a material, a pattern with the shapes that it asks.
    fn term<T: fmt::Debug>(&mut self, term: &Term<T>) -> fmt::Result {
        match term {
            Term::Constant(value) => write!(self.out, "{value:?} "),
            Term::Pattern(graph) => {
                self.out.write_str("pattern ")?;
                graph.describe(self.out)?;
                self.children(graph.shapes())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Camera, GraphBuilder, Light, Mark, Settings, Source};
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
            let color = Term::Constant(DVec3::splat(color));
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

    /// A ball with a pattern: a number plus the field of another ball.
    fn patterned(number: f64, radius: f64, (name, mark): (&str, u64)) -> Scene {
        let mut builder = GraphBuilder::new();
        builder.mark(Mark(mark));
        let p = builder.point();
        let (number, field) = (
            builder.constant(number),
            builder.shape(&ball(radius, 0.0), p),
        );
        let sum = builder.add(number, field);
        let paint = Material {
            name: name.into(),
            diffuse: Term::Pattern(Arc::new(builder.finish(&[sum]))),
            ..Material::default()
        };
        Scene {
            shown: vec![ball(1.0, 2.0).painted(Arc::new(paint))],
            ..Scene::default()
        }
    }

    #[test]
    fn patterns_count_by_what_they_compute() {
        let plain = text(&patterned(0.5, 3.0, ("pearl", 1)));
        assert_eq!(plain, text(&patterned(0.5, 3.0, ("shell", 2))));
        assert_ne!(plain, text(&patterned(0.25, 3.0, ("pearl", 1))));
        assert_ne!(plain, text(&patterned(0.5, 2.0, ("pearl", 1))));
    }
}
