//! What a scene needs of the pipeline, chosen once and not for each ray: what is not needed costs nothing.

use super::Surfaces;
use crate::scene::{Light, Material, Model, Scene, Shadow};

/// The stages that a scene compiles in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Features {
    /// There are lights, and some material answers them.
    pub lit: bool,
    /// Some material has Blinn's highlight, so that the vector half way between light and viewer counts.
    pub halfway: bool,
    /// Some material casts an opaque shadow, and not only where no light gets anyway: the only solid there is, seen from
    /// outside, has no shadow on itself but its dark side if it is convex.
    pub opaque_shadows: bool,
    /// Some material casts a tinted shadow.
    pub tinted_shadows: bool,
    /// Some material sends a reflected ray: a mirror, or glass, which reflects totally.
    pub reflects: bool,
    /// Some material sends a refracted ray.
    pub refracts: bool,
    /// Some transparent material absorbs light.
    pub absorbs: bool,
    /// There is fog.
    pub fog: bool,
}

impl Features {
    /// What `scene` with these `surfaces` needs.
    pub fn new(scene: &Scene, surfaces: &(impl Surfaces + ?Sized)) -> Self {
        let materials = surfaces.materials();
        let some = |has: &dyn Fn(&Material) -> bool| materials.iter().any(|m| has(m));
        let casts = |shadow| some(&|m| m.shadow == shadow);
        let refracts = some(&|m| !m.refract.is_zero());
        let lone = surfaces.lone_convex().filter(|_| !refracts);
        let is_lone = lone.is_some_and(|bounds| scene.camera.is_outside(&bounds));
        let shines = scene.lights.iter().any(Light::shines);
        let lit = shines && some(&|m| !m.diffuse.is_zero() || !m.specular.is_zero());
        Self {
            lit,
            halfway: lit && some(&|m| m.model == Model::Blinn),
            opaque_shadows: lit && casts(Shadow::Opaque) && !is_lone,
            tinted_shadows: lit && casts(Shadow::Tinted),
            reflects: refracts || some(&|m| !m.reflect.is_zero()),
            refracts,
            absorbs: some(&|m| !m.refract.is_zero() && !m.absorb.is_zero()),
            fog: scene.fog.is_some_and(|fog| fog.density > 0.0),
        }
    }

    /// The stages in words, in the order in which light passes them; what is left out is not compiled in.
    pub fn words(&self) -> Vec<&'static str> {
        [
            (self.lit, "direct light"),
            (self.halfway, "Blinn's highlights"),
            (self.opaque_shadows, "opaque shadows (any hit)"),
            (self.tinted_shadows, "tinted shadows (straight walk)"),
            (self.reflects, "reflected rays"),
            (self.refracts, "refracted rays"),
            (self.absorbs, "absorption"),
            (self.fog, "fog"),
        ]
        .into_iter()
        .filter_map(|(is_used, word)| is_used.then_some(word))
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyPrimitive, Sphere, Torus};
    use crate::scene::{Camera, Fog, Method, Node, Projection, Source, Term};
    use crate::trace::World;
    use glam::DVec3;
    use std::sync::Arc;

    /// The features of a scene that shows these shapes.
    fn features(scene: &Scene, shown: &[AnyPrimitive], material: &Arc<Material>) -> Features {
        let shape = |primitive: &AnyPrimitive| {
            let node = Node::primitive(primitive.clone()).unwrap();
            node.painted(material.clone())
        };
        let shown: Vec<_> = shown.iter().map(shape).collect();
        Features::new(scene, &World::of(&shown, &scene.settings).unwrap())
    }

    fn ball() -> AnyPrimitive {
        AnyPrimitive::Sphere(Sphere::new(1.0))
    }

    fn ring() -> AnyPrimitive {
        AnyPrimitive::Torus(Torus::new(1.0, 0.2))
    }

    fn sun() -> Light {
        Light {
            source: Source::Directional { toward: DVec3::Y },
            radiance: DVec3::ONE,
        }
    }

    #[test]
    fn plain_scene_needs_direct_light_and_any_hit_shadows() {
        let scene = Scene {
            lights: vec![sun()],
            ..Scene::default()
        };
        let features = features(&scene, &[ring()], &Arc::default());
        assert_eq!(
            features.words(),
            ["direct light", "opaque shadows (any hit)"]
        );
    }

    #[test]
    fn glass_needs_reflected_rays_for_total_reflection() {
        let glass = Material {
            refract: Term::Constant(0.9),
            ..Material::default()
        };
        let features = features(&Scene::default(), &[ball()], &Arc::new(glass));
        assert_eq!(features.words(), ["reflected rays", "refracted rays"]);
    }

    #[test]
    fn fog_without_density_is_no_fog() {
        let scene = Scene {
            fog: Some(Fog {
                color: DVec3::ONE,
                density: 0.0,
            }),
            ..Scene::default()
        };
        assert_eq!(features(&scene, &[], &Arc::default()), Features::default());
    }

    /// Whether a scene with a sun traces shadow rays.
    fn has_shadows(shown: &[AnyPrimitive], camera: Camera, method: Method) -> bool {
        let mut scene = Scene {
            lights: vec![sun()],
            camera,
            ..Scene::default()
        };
        scene.settings.method = method;
        features(&scene, shown, &Arc::default()).opaque_shadows
    }

    #[test]
    fn lone_convex_solid_needs_no_shadow_rays_from_outside() {
        let outside = Camera::default();
        assert!(!has_shadows(&[ball()], outside, Method::Auto));
        assert!(has_shadows(&[ring()], outside, Method::Auto));
        assert!(has_shadows(&[ball(), ring()], outside, Method::Auto));
        // As published, with the acne they may have.
        assert!(has_shadows(&[ball()], outside, Method::Sphere));
        let within = Camera {
            eye: DVec3::new(0.9, 0.0, 0.0),
            ..outside
        };
        assert!(has_shadows(&[ball()], within, Method::Auto));
        let wide = |distance: f64| Camera {
            eye: DVec3::new(0.0, 0.0, distance),
            projection: Projection::Orthographic { height: 4.0 },
            ..outside
        };
        assert!(!has_shadows(&[ball()], wide(2.0), Method::Auto));
        assert!(has_shadows(&[ball()], wide(0.5), Method::Auto));
    }
}
