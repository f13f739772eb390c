//! What a scene needs of the pipeline, chosen once and not for each ray: what is not needed costs nothing.

use crate::scene::{Material, Model, Scene, Shadow};
use std::sync::Arc;

/// The stages that a scene compiles in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Features {
    /// There are lights, and some material answers them.
    pub lit: bool,
    /// Some material has Blinn's highlight, so that the vector half way between light and viewer counts.
    pub halfway: bool,
    /// Some material casts an opaque shadow.
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
    /// What `scene` with these `materials` needs.
    pub fn new(scene: &Scene, materials: &[Arc<Material>]) -> Self {
        let some = |has: &dyn Fn(&Material) -> bool| materials.iter().any(|m| has(m));
        let casts = |shadow| some(&|m| m.shadow == shadow);
        let refracts = some(&|m| !m.refract.is_zero());
        let lit =
            !scene.lights.is_empty() && some(&|m| !m.diffuse.is_zero() || !m.specular.is_zero());
        Self {
            lit,
            halfway: lit && some(&|m| m.model == Model::Blinn),
            opaque_shadows: lit && casts(Shadow::Opaque),
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
    use crate::scene::{Fog, Light, Source, Term};
    use glam::DVec3;

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
        let features = Features::new(&scene, &[Arc::default()]);
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
        let features = Features::new(&Scene::default(), &[Arc::new(glass)]);
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
        assert_eq!(Features::new(&scene, &[]), Features::default());
    }
}
