//! Floor 1: every primitive, combinator and modifier, declared once.
//!
//! To add an entry, write its declaration (`declaration::entry!`) with its mathematics in a file of its own, and its
//! name into one of the lists below: first those that are compiled for every type of number, then those that are
//! recorded as graphs. The script's word, its error messages, the reference and the laws follow.

mod blend;
mod blends;
mod bounds;
mod combination;
pub(crate) mod declaration;
mod enclosure;
mod facts;
mod function;
mod modifier;
mod modifiers;
mod periodic;
mod plane_geometry;
mod primitive;
mod profiles;
mod runs;
mod solids;
mod space_geometry;

pub use blend::{Blend, Manner};
pub use blends::{
    Chamfer, Circular, Cubic, Engrave, Exponential, Fillet, Groove, Hard, Morph, Pipe, Smooth,
    Stairs, Tongue, Xor,
};
pub use bounds::Bounds;
pub use combination::{Combination, Operation};
pub use declaration::{
    AXES, Argument, Axis, Declaration, Declared, Kind, Parameter, Parametric, Range, written,
};
pub use facts::{Class, Traits};
pub use function::Function;
pub use modifier::{Modifier, Placing, Similarity};
pub use modifiers::{
    Bend, Elongate, Extrude, Mirror, MirroredRepeat, Offset, Polar, Repeat, Revolve, Rotate, Scale,
    Shear, Shell, Taper, Translate, Twist, Warp,
};
pub use primitive::Primitive;
pub use profiles::{
    Arc, Bezier, Circle, Cross2, Egg, Ellipse, Heart, Moon, Parallelogram, Pie, Polygon, Polyline,
    Rectangle, RegularPolygon, Rhombus2, Ring, Segment, Star, Trapezoid, Triangle2, Vesica2,
};
pub use solids::{
    Blob, BoxFrame, CappedCone, CappedTorus, Capsule, Cone, Cuboid, CutSphere, Cylinder,
    Dodecahedron, Ellipsoid, Gyroid, Helix, Icosahedron, Julia, Lens, Link, Mandelbulb, Menger,
    Octahedron, Plane, Prism, Pyramid, Quad, Rhombus, Rod, RoundCone, SchwarzD, SchwarzP,
    Sierpinski, Slab, SolidAngle, Sphere, Superellipsoid, Tetrahedron, Torus, Triangle, Tube,
    Vesica,
};

declaration::list!($
    /// Any primitive of the catalogue.
    AnyPrimitive, with_primitive, with_compiled_primitive, with_recorded_primitive:
    Sphere, Ellipsoid, Cuboid, Plane, Triangle, Cylinder, Cone, Capsule, Torus, BoxFrame, Slab, CappedCone,
    Circle, Rectangle, Polygon, Polyline;
    recorded Link, Rod, RoundCone, CappedTorus, CutSphere, SolidAngle, Lens, Vesica, Rhombus, Prism, Pyramid,
    Tetrahedron, Octahedron, Dodecahedron, Icosahedron, Quad, Tube, Helix,
    Ring, Segment, Ellipse, RegularPolygon, Star, Triangle2, Trapezoid, Parallelogram, Rhombus2, Bezier, Arc,
    Pie, Vesica2, Moon, Egg, Heart, Cross2,
    Gyroid, SchwarzP, SchwarzD, Superellipsoid, Menger, Sierpinski, Julia, Mandelbulb, Blob
);

declaration::list!($
    /// Any modifier of the catalogue.
    AnyModifier, with_modifier, with_compiled_modifier, with_recorded_modifier:
    Translate, Rotate, Scale, Mirror, Repeat, Twist, Offset, Shell, Extrude, Revolve;
    recorded Bend, Taper, Shear, Elongate, Polar, MirroredRepeat, Warp
);

declaration::list!($
    /// Any blend of the catalogue.
    AnyBlend, with_blend, with_compiled_blend, with_recorded_blend:
    Hard, Smooth, Cubic, Circular;
    recorded Exponential, Chamfer, Fillet, Stairs, Xor, Morph, Pipe, Engrave, Groove, Tongue
);
