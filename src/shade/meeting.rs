//! Where a ray meets a surface, and which rays go on from there.

use super::medium::{Crossing, Medium};
use super::reflect::reflected;
use super::refract::refracted;
use super::wave::Path;
use super::{Surface, fresnel, offset};
use crate::trace::{Outcome, Ray};
use glam::DVec3;

/// A ray at the surface that it hit.
pub struct Meeting<'a> {
    /// The ray as it arrives.
    pub ray: &'a Ray,
    /// What it carries.
    pub path: &'a Path,
    /// What the tracer found.
    pub outcome: &'a Outcome,
    /// The surface there.
    pub surface: &'a Surface,
    /// The unit normal on the side from which the ray came.
    pub normal: DVec3,
    /// Whether it came from outside.
    is_outside: bool,
}

/// A ray that goes on with a share of the weight.
pub struct Branch {
    /// The share.
    pub share: f64,
    /// Where it goes.
    pub direction: DVec3,
}

/// Where the light comes from that a surface sends along a ray.
pub struct Onward {
    /// The mirrored ray.
    pub reflected: Branch,
    /// The ray through the surface, if there is one, and what it travels in.
    pub refracted: Option<(Branch, Crossing)>,
}

impl<'a> Meeting<'a> {
    /// `ray` at `outcome`, which is a hit of `surface`.
    pub fn new(ray: &'a Ray, path: &'a Path, outcome: &'a Outcome, surface: &'a Surface) -> Self {
        let is_outside = outcome.normal.dot(ray.direction) <= 0.0;
        Self {
            ray,
            path,
            outcome,
            surface,
            normal: if is_outside {
                outcome.normal
            } else {
                -outcome.normal
            },
            is_outside,
        }
    }

    /// The ray from here along `direction`, on the side of `side`.
    pub fn leaving(&self, side: DVec3, direction: DVec3) -> Ray {
        offset::leaving(self.outcome, side, direction, self.ray.footprint)
    }

    /// The reflected and the refracted ray. The refracted share goes to the reflected ray where reflection is total;
    /// Fresnel's equations divide the sum of both shares, of which an opaque surface sends only the reflected part.
    pub fn onward(&self) -> Onward {
        let s = self.surface;
        let incident = self.ray.direction;
        let mirrored = |share| Branch {
            share,
            direction: reflected(incident, self.normal),
        };
        if s.refract == 0.0 && s.fresnel == 0.0 {
            return Onward {
                reflected: mirrored(s.reflect),
                refracted: None,
            };
        }
        let medium = Medium::new(self.outcome.part, s);
        let crossing = self.path.media.across(medium, self.is_outside);
        let (n1, n2) = (crossing.n1, crossing.n2);
        let both = s.reflect + s.refract;
        let cosine = (-incident.dot(self.normal)).clamp(0.0, 1.0);
        let by_fresnel = fresnel::reflected_share(cosine, n1, n2);
        let mix = |constant: f64, share: f64| constant + (both * share - constant) * s.fresnel;
        if s.refract == 0.0 {
            return Onward {
                reflected: mirrored(mix(s.reflect, by_fresnel)),
                refracted: None,
            };
        }
        match refracted(incident, self.normal, n1, n2) {
            None => Onward {
                reflected: mirrored(both),
                refracted: None,
            },
            Some(direction) => Onward {
                reflected: mirrored(mix(s.reflect, by_fresnel)),
                refracted: Some((
                    Branch {
                        share: mix(s.refract, 1.0 - by_fresnel),
                        direction,
                    },
                    crossing,
                )),
            },
        }
    }
}
