//! A stage: surfaces in closed form, so that the laws of light are checked apart from those of marching.

use fieldstone::scene::{Light, Material, Scene, Shadow, Sky, Term};
use fieldstone::shade::{Census, Surfaces, Whitted};
use fieldstone::trace::{
    Footprint, Occlusion, Occlusions, Outcome, Outcomes, Paint, Ray, RayColumns, Rays, Verdict,
    Visibility,
};
use glam::DVec3;
use std::sync::{Arc, Mutex};

/// A solid whose boundary a ray meets in closed form.
#[derive(Clone, Copy, Debug)]
pub enum Solid {
    Ball {
        centre: DVec3,
        radius: f64,
    },
    /// Where `low < normal . p < high`; one of them may be infinite.
    Slab {
        normal: DVec3,
        low: f64,
        high: f64,
    },
    /// A solid whose tracing always ends without an answer.
    Riddle,
}

impl Solid {
    /// Where the ray crosses the boundary, with the outward normal there.
    fn crossings(&self, ray: &Ray) -> Vec<(f64, DVec3)> {
        match *self {
            Self::Riddle => Vec::new(),
            Self::Ball { centre, radius } => {
                let from = ray.origin - centre;
                let b = from.dot(ray.direction);
                let discriminant = b * b - (from.length_squared() - radius * radius);
                if discriminant < 0.0 {
                    return Vec::new();
                }
                [-b - discriminant.sqrt(), -b + discriminant.sqrt()]
                    .map(|t| (t, (ray.at(t) - centre) / radius))
                    .to_vec()
            }
            Self::Slab { normal, low, high } => {
                let (height, rate) = (normal.dot(ray.origin), normal.dot(ray.direction));
                [(low, -normal), (high, normal)]
                    .into_iter()
                    .filter(|(level, _)| level.is_finite() && rate != 0.0)
                    .map(|(level, n)| ((level - height) / rate, n))
                    .collect()
            }
        }
    }
}

/// Solids with their materials, and the rays that were traced through them.
#[derive(Default)]
pub struct Stage {
    solids: Vec<(Solid, Arc<Material>)>,
    materials: Vec<Arc<Material>>,
    /// The batches of `nearest`, in order.
    pub traced: Mutex<Vec<Vec<Ray>>>,
    /// The rays of `occluded`.
    pub shadow_rays: Mutex<Vec<Ray>>,
}

impl Stage {
    pub fn new(solids: Vec<(Solid, Material)>) -> Self {
        let solids: Vec<_> = solids.into_iter().map(|(s, m)| (s, Arc::new(m))).collect();
        Self {
            materials: solids.iter().map(|(_, m)| m.clone()).collect(),
            solids,
            ..Self::default()
        }
    }

    fn find(&self, ray: &Ray, is_seen: impl Fn(&Material) -> bool) -> Outcome {
        let mut found = Outcome {
            verdict: Verdict::Miss,
            t: f64::INFINITY,
            error: 0.0,
            point: DVec3::ZERO,
            normal: DVec3::ZERO,
            part: 0,
            steps: 1,
            evaluations: 1,
        };
        for (part, (solid, material)) in self.solids.iter().enumerate() {
            if !is_seen(material) {
                continue;
            }
            if matches!(solid, Solid::Riddle) {
                return Outcome {
                    verdict: Verdict::Unknown,
                    ..found
                };
            }
            for (t, normal) in solid.crossings(ray) {
                if t > 0.0 && t < found.t && t <= ray.t_max {
                    found = Outcome {
                        verdict: Verdict::Hit,
                        t,
                        // What rounding leaves of the closed forms above.
                        error: 1e-14 * (t + ray.origin.length()),
                        point: ray.at(t),
                        normal,
                        part: part as u32,
                        ..found
                    };
                }
            }
        }
        found
    }
}

impl Surfaces for Stage {
    fn nearest(&self, rays: &Rays, visibility: Visibility, found: &mut Outcomes) {
        self.traced.lock().unwrap().push(rays.iter().collect());
        let is_seen = |m: &Material| visibility == Visibility::All || m.shadow != Shadow::None;
        *found = rays.iter().map(|ray| self.find(&ray, is_seen)).collect();
    }

    fn occluded(&self, rays: &RayColumns, numbers: &[u32], found: &mut Occlusions) {
        found.reset(rays[0].len());
        let rays = Rays::picked(*rays, numbers);
        self.shadow_rays.lock().unwrap().extend(rays.iter());
        let occlusion = |ray: Ray| Occlusion {
            verdict: self.find(&ray, |m| m.shadow == Shadow::Opaque).verdict,
            steps: 1,
            evaluations: 1,
        };
        found.put(numbers, rays.iter().map(occlusion));
    }

    fn paints(&self, part: u32, point: DVec3) -> Vec<Paint<'_>> {
        vec![Paint {
            material: &self.solids[part as usize].1,
            weight: 1.0,
            point: point.to_array(),
        }]
    }

    fn materials(&self) -> &[Arc<Material>] {
        &self.materials
    }
}

/// A ray of length-1 direction with a pixel as wide as a thousandth of its length.
pub fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray {
        origin,
        direction: direction.normalize(),
        t_max: f64::INFINITY,
        footprint: Footprint {
            at_origin: 0.0,
            spread: 1e-3,
        },
    }
}

/// The light along one ray, and the counts.
pub fn see(scene: &Scene, stage: &Stage, ray: Ray) -> (DVec3, Census) {
    let mut census = Census::default();
    let whitted = Whitted::new(scene, stage);
    let rays = Rays::from_iter([ray]);
    let outcomes = whitted.first_hits(&rays, &mut census);
    let light = whitted.light(&rays, &outcomes, &mut census);
    (DVec3::from_array(light.radiance.row(0)), census)
}

/// A scene of lights and a black sky.
pub fn scene(lights: Vec<Light>) -> Scene {
    let mut scene = Scene {
        lights,
        ..Scene::default()
    };
    scene.settings.depth = 8;
    scene
}

/// A scene without lights under an even sky.
pub fn under_sky(radiance: f64, depth: u32) -> Scene {
    let mut scene = scene(Vec::new());
    scene.sky = Sky::uniform(DVec3::splat(radiance));
    scene.settings.depth = depth;
    scene
}

/// A material that answers light in no way.
pub fn black() -> Material {
    Material {
        color: Term::Constant(DVec3::ZERO),
        ambient: number(0.0),
        diffuse: number(0.0),
        specular: number(0.0),
        ..Material::default()
    }
}

/// White and matt, without ambient light.
pub fn matt() -> Material {
    Material {
        color: Term::Constant(DVec3::ONE),
        diffuse: number(1.0),
        ..black()
    }
}

/// A mirror that reflects this share, and nothing else.
pub fn mirror(share: f64) -> Material {
    Material {
        reflect: number(share),
        ..black()
    }
}

/// A clear solid that lets all light pass.
pub fn clear(ior: f64) -> Material {
    Material {
        refract: number(1.0),
        ior: number(ior),
        ..black()
    }
}

/// A term that is the same everywhere.
pub fn number(x: f64) -> Term<f64> {
    Term::Constant(x)
}

/// The half-space below `y = level`.
pub fn ground(level: f64) -> Solid {
    Solid::Slab {
        normal: DVec3::Y,
        low: f64::NEG_INFINITY,
        high: level,
    }
}

pub fn ball(centre: [f64; 3], radius: f64) -> Solid {
    Solid::Ball {
        centre: DVec3::from_array(centre),
        radius,
    }
}
