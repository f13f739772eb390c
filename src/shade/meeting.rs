//! Where a ray meets a surface, and which rays go on from there.

use super::medium::{Media, Medium};
use super::reflect::reflected;
use super::refract::refracted;
use super::wave::Path;
use super::{Surface, fresnel, offset};
use crate::trace::{Outcome, Ray};
use glam::DVec3;

/// A path at the surface that it hit.
pub struct Meeting<'a> {
    /// The path as it arrives.
    pub path: Path,
    /// What the tracer found.
    pub outcome: &'a Outcome,
    /// The surface there.
    pub surface: Surface,
    /// The unit normal on the side from which the path came.
    pub normal: DVec3,
    /// Whether it came from outside.
    is_outside: bool,
}

/// Where light comes from that a surface sends along a path.
pub struct Onward {
    /// The mirrored path.
    pub reflected: Option<Path>,
    /// The path through the surface.
    pub refracted: Option<Path>,
}

impl<'a> Meeting<'a> {
    /// `path` at `outcome`, which is a hit of `surface`.
    pub fn new(path: Path, outcome: &'a Outcome, surface: Surface) -> Self {
        let is_outside = outcome.normal.dot(path.ray.direction) <= 0.0;
        Self {
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
        offset::leaving(self.outcome, side, direction, self.path.ray.footprint)
    }

    /// A path that goes on with a share of this one's weight; `None` for no share.
    fn onward_path(
        &self,
        share: f64,
        side: DVec3,
        direction: DVec3,
        media: &Media,
    ) -> Option<Path> {
        (share != 0.0).then(|| Path {
            ray: self.leaving(side, direction),
            weight: self.path.weight * share,
            sample: self.path.sample,
            media: media.clone(),
        })
    }

    /// The reflected and refracted paths. The refracted share goes to the reflected one where reflection is total;
    /// Fresnel's equations divide the sum of both shares, of which an opaque surface sends only the reflected part.
    pub fn onward(&self) -> Onward {
        let s = &self.surface;
        let incident = self.path.ray.direction;
        let medium = Medium::new(self.outcome.part, s);
        let crossing = self.path.media.across(medium, self.is_outside);
        let (n1, n2) = (crossing.n1, crossing.n2);
        let through = (s.refract != 0.0)
            .then(|| refracted(incident, self.normal, n1, n2))
            .flatten();

        let both = s.reflect + s.refract;
        let (mut reflect, mut refract) = match through {
            Some(_) => (s.reflect, s.refract),
            None => (both, 0.0),
        };
        if s.fresnel != 0.0 {
            let cosine = (-incident.dot(self.normal)).clamp(0.0, 1.0);
            let share = fresnel::reflected_share(cosine, n1, n2);
            reflect += (both * share - reflect) * s.fresnel;
            if through.is_some() {
                refract += (both * (1.0 - share) - refract) * s.fresnel;
            }
        }
        Onward {
            reflected: self.onward_path(
                reflect,
                self.normal,
                reflected(incident, self.normal),
                &self.path.media,
            ),
            refracted: through.and_then(|direction| {
                self.onward_path(refract, -self.normal, direction, &crossing.beyond)
            }),
        }
    }
}
