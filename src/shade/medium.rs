//! What a ray travels in: the solids that it has entered and not left.
//!
//! The innermost of them, entered last, decides how light bends and how much is absorbed. So water in glass bends by
//! both indices at their boundary, and where two solids overlap, leaving the outer one while inside the inner one
//! changes nothing.

use super::Surface;
use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

/// The index of refraction of empty space.
const VACUUM: f64 = 1.0;

/// A transparent solid as a ray meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// The part of the world.
    pub part: u32,
    /// Its material, by address.
    pub material: usize,
    /// The index of refraction, positive.
    pub ior: f64,
    /// The absorption, per scene unit and channel.
    pub absorb: DVec3,
}

impl Medium {
    /// The medium behind a `surface` of `part`.
    pub fn new(part: u32, surface: &Surface) -> Self {
        Self {
            part,
            material: surface.material,
            ior: surface.ior,
            absorb: surface.absorb,
        }
    }
}

/// The media around a ray, innermost first; cheap to clone.
#[derive(Clone, Debug, Default)]
pub struct Media(Option<Arc<Layer>>);

#[derive(Debug)]
struct Layer {
    medium: Medium,
    around: Media,
}

/// A ray that goes through a boundary.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// The index of refraction before the boundary.
    pub n1: f64,
    /// The index of refraction behind it.
    pub n2: f64,
    /// The media behind it.
    pub beyond: Media,
}

impl Media {
    /// Empty space.
    pub const EMPTY: Self = Self(None);

    /// Whether it is empty space.
    pub fn is_empty(&self) -> bool {
        self.0.is_none()
    }

    /// Whether they are one and the same; others may be alike too.
    pub fn is_same(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }

    /// The innermost medium; `None` in empty space.
    pub fn innermost(&self) -> Option<&Medium> {
        self.0.as_deref().map(|layer| &layer.medium)
    }

    /// The absorption here.
    pub fn absorb(&self) -> DVec3 {
        self.innermost().map_or(DVec3::ZERO, |medium| medium.absorb)
    }

    fn ior(&self) -> f64 {
        self.innermost().map_or(VACUUM, |medium| medium.ior)
    }

    fn inside(&self, medium: Medium) -> Self {
        let around = self.clone();
        Self(Some(Arc::new(Layer { medium, around })))
    }

    /// The media without the innermost one for which `is_left`; `None` if there is none.
    fn without(&self, is_left: &impl Fn(&Medium) -> bool) -> Option<Self> {
        let layer = self.0.as_deref()?;
        if is_left(&layer.medium) {
            return Some(layer.around.clone());
        }
        let around = layer.around.without(is_left)?;
        Some(around.inside(layer.medium))
    }

    /// Through a boundary of `medium`, into it or out of it.
    pub fn across(&self, medium: Medium, is_entering: bool) -> Crossing {
        if is_entering {
            self.entering(medium)
        } else {
            self.leaving(medium)
        }
    }

    /// Into `medium`.
    pub fn entering(&self, medium: Medium) -> Crossing {
        Crossing {
            n1: self.ior(),
            n2: medium.ior,
            beyond: self.inside(medium),
        }
    }

    /// Out of `medium`: the one entered with the same part, else with the same material. If none was entered, the ray
    /// began inside of it, and leaves it for what is known to be around.
    pub fn leaving(&self, medium: Medium) -> Crossing {
        let same_part = |m: &Medium| m.part == medium.part;
        let same_material = |m: &Medium| m.material == medium.material;
        let left = self
            .without(&same_part)
            .or_else(|| self.without(&same_material));
        match left {
            Some(beyond) => Crossing {
                n1: self.ior(),
                n2: beyond.ior(),
                beyond,
            },
            None => Crossing {
                n1: medium.ior,
                n2: self.ior(),
                beyond: self.clone(),
            },
        }
    }
}

/// How rays go through boundaries: mostly as the one before, so that is kept.
#[derive(Default)]
pub struct Crossings {
    last: Option<Boundary>,
}

/// A boundary as a ray met it.
struct Boundary {
    /// What the ray was in.
    media: Media,
    medium: Medium,
    is_entering: bool,
    crossing: Crossing,
}

impl Crossings {
    /// As [`Media::across`].
    #[inline]
    pub fn across(&mut self, media: &Media, medium: Medium, is_entering: bool) -> &Crossing {
        self.last.take_if(|last| {
            let is_same = (last.medium == medium) & (last.is_entering == is_entering);
            !(is_same && last.media.is_same(media))
        });
        let boundary = self.last.get_or_insert_with(|| Boundary {
            media: media.clone(),
            medium,
            is_entering,
            crossing: media.across(medium, is_entering),
        });
        &boundary.crossing
    }

    /// Calls `each` with the neighbours among some rays that go through a surface in the same way, with what they are in and how
    /// they cross: of all rays the media around them, the parts that they hit, and whether they come from the outside.
    pub fn each(
        &mut self,
        rays: Range<usize>,
        surface: &Surface,
        (media, parts, is_outside): (&Surroundings, &[u32], impl Fn(usize) -> bool),
        mut each: impl FnMut(Range<usize>, &Media, &Crossing),
    ) {
        let mut first = rays.start;
        while first < rays.end {
            let (media, end) = media.run(first);
            let (part, is_entering) = (parts[first], is_outside(first));
            let mut others = first + 1..rays.end.min(end);
            let next = others.find(|i| (parts[*i] != part) | (is_outside(*i) != is_entering));
            let same = first..next.unwrap_or(others.end);
            first = same.end;
            let crossing = self.across(media, Medium::new(part, surface), is_entering);
            each(same, media, crossing);
        }
    }
}

/// The media around rays, side by side: neighbours that share theirs store them once, and nothing is stored as long as all rays
/// are in empty space.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// Media, each with the number of the ray behind the last one that is in them.
    runs: Vec<(Media, usize)>,
    count: usize,
}

impl Surroundings {
    /// That many rays in empty space.
    pub fn empty(count: usize) -> Self {
        Self {
            runs: Vec::new(),
            count,
        }
    }

    /// Forgets all of them.
    pub fn clear(&mut self) {
        self.runs.clear();
        self.count = 0;
    }

    /// Whether all rays are in empty space.
    pub fn are_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// The media around ray number `i`.
    pub fn at(&self, i: usize) -> &Media {
        self.run(i).0
    }

    /// The media around ray number `i`, and the number of the first ray behind it that is known to be in others, if any is.
    fn run(&self, i: usize) -> (&Media, usize) {
        let run = self.runs.partition_point(|(_, end)| *end <= i);
        let run = self.runs.get(run).map(|(media, end)| (media, *end));
        run.unwrap_or((&Media::EMPTY, usize::MAX))
    }

    /// Adds those of the rays of others with these numbers.
    pub fn pick(&mut self, others: &Self, numbers: impl ExactSizeIterator<Item = u32>) {
        if others.are_empty() {
            return self.push_all(&Media::EMPTY, numbers.len());
        }
        for number in numbers {
            self.push(others.at(number as usize));
        }
    }

    /// Adds those of a ray.
    pub fn push(&mut self, media: &Media) {
        self.push_all(media, 1);
    }

    /// Adds those of so many rays, all of them in the same.
    pub fn push_all(&mut self, media: &Media, rays: usize) {
        if rays == 0 {
            return;
        }
        let before = self.count;
        self.count += rays;
        match self.runs.last_mut() {
            Some((last, end)) if last.is_same(media) => *end = self.count,
            None if media.is_empty() => {}
            last => {
                if last.is_none() && before > 0 {
                    self.runs.push((Media::EMPTY, before));
                }
                self.runs.push((media.clone(), self.count));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn medium(part: u32, ior: f64) -> Medium {
        Medium {
            part,
            material: 100 + part as usize,
            ior,
            absorb: DVec3::splat(f64::from(part)),
        }
    }

    fn indices(crossing: &Crossing) -> (f64, f64) {
        (crossing.n1, crossing.n2)
    }

    #[test]
    fn surroundings_are_those_that_were_pushed() {
        let wet = Media::default().entering(medium(2, 1.333)).beyond;
        let mut all = Surroundings::empty(2);
        assert!(all.are_empty());
        all.push_all(&Media::EMPTY, 0);
        all.push_all(&wet, 2);
        for media in [&Media::EMPTY, &wet] {
            all.push(media);
        }
        let is_wet = [0, 1, 2, 3, 4, 5].map(|i| !all.at(i).is_empty());
        assert_eq!(is_wet, [false, false, true, true, false, true]);
        assert!(all.at(6).is_empty() && !all.are_empty());
        all.clear();
        all.push(&Media::EMPTY);
        assert!(all.are_empty() && all.at(0).is_empty());
    }

    #[test]
    fn water_in_glass_bends_by_both_indices() {
        let (glass, water) = (medium(1, 1.5), medium(2, 1.333));
        let outer = Media::default().entering(glass);
        let inner = outer.beyond.entering(water);
        let back = inner.beyond.leaving(water);
        let out = back.beyond.leaving(glass);
        assert_eq!(indices(&outer), (1.0, 1.5));
        assert_eq!(indices(&inner), (1.5, 1.333));
        assert_eq!(indices(&back), (1.333, 1.5));
        assert_eq!(indices(&out), (1.5, 1.0));
        assert!(out.beyond.innermost().is_none());
    }

    #[test]
    fn leaving_an_outer_solid_inside_an_inner_one_changes_nothing() {
        let (glass, water) = (medium(1, 1.5), medium(2, 1.333));
        let both = Media::default().entering(glass).beyond.entering(water);
        let left = both.beyond.leaving(glass);
        assert_eq!(indices(&left), (1.333, 1.333));
        assert_eq!(left.beyond.innermost(), Some(&water));
        assert_eq!(indices(&left.beyond.leaving(water)), (1.333, 1.0));
    }

    #[test]
    fn overlapping_solids_of_one_material_are_one() {
        let (a, b) = (medium(1, 1.5), medium(2, 1.5));
        let both = Media::default().entering(a).beyond.entering(b);
        let left = both.beyond.leaving(a);
        assert_eq!((both.n1, both.n2), (1.5, 1.5));
        assert_eq!(indices(&left), (1.5, 1.5));
        assert_eq!(indices(&left.beyond.leaving(b)), (1.5, 1.0));
    }

    #[test]
    fn a_ray_that_begins_inside_leaves_into_empty_space() {
        let glass = medium(1, 1.5);
        let out = Media::default().leaving(glass);
        assert_eq!(indices(&out), (1.5, 1.0));
        assert!(out.beyond.innermost().is_none());
        let water = Media::default().entering(medium(2, 1.333)).beyond;
        assert_eq!(indices(&water.leaving(glass)), (1.5, 1.333));
    }

    #[test]
    fn another_part_of_the_same_material_can_be_left() {
        let entry = medium(1, 1.5);
        let exit = Medium { part: 7, ..entry };
        let out = Media::default().entering(entry).beyond.leaving(exit);
        assert!(out.beyond.innermost().is_none());
    }

    #[test]
    fn absorption_is_that_of_the_innermost() {
        let media = Media::default();
        assert_eq!(media.absorb(), DVec3::ZERO);
        let inner = media
            .entering(medium(1, 1.5))
            .beyond
            .entering(medium(2, 1.3));
        assert_eq!(inner.beyond.absorb(), DVec3::splat(2.0));
    }
}
