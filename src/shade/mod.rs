//! Floor 5: the Whitted pipeline, by waves: rays to light.

mod attenuation;
mod census;
mod features;
mod fresnel;
mod gain;
mod highlight;
mod light;
mod lighting;
mod lit;
mod looks;
mod medium;
mod offset;
mod onward;
mod palette;
mod phong;
mod reflect;
mod refract;
mod shadow;
mod sky;
mod surface;
mod surfaces;
mod wave;
mod whitted;

pub use attenuation::sight;
pub use census::{Census, Tracing};
pub use features::Features;
pub use fresnel::reflected_share;
pub use reflect::reflected;
pub use refract::refracted;
pub use surface::Surface;
pub use surfaces::Surfaces;
pub use whitted::{FAINTEST, Received, Whitted};
