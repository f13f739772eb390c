//! Laws of pictures: what must not change a bit, and what the channels say, on marched and analytic shapes.

use fieldstone::catalogue::*;
use fieldstone::output::{Metadata, picture, save};
use fieldstone::render::{Channel, Film, Progress, RenderOptions, Rendered, View, render};
use fieldstone::scene::{
    Camera, Falloff, Fog, Light, Material, Method, Node, Projection, Sampling, Scene, Shadow, Sky,
    Source, Term,
};
use fieldstone::shade::{Census, Surfaces, Whitted};
use fieldstone::trace::{
    Occlusions, Outcome, Outcomes, Paint, RayColumns, Rays, Visibility, World,
};
use glam::DVec3;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

fn leaf(primitive: AnyPrimitive) -> Arc<Node> {
    Node::primitive(primitive).expect("a valid primitive")
}

fn moved(child: Arc<Node>, by: [f64; 3]) -> Arc<Node> {
    Node::modifier(AnyModifier::Translate(Translate::new(by)), child).expect("a valid modifier")
}

fn sphere(radius: f64, at: [f64; 3]) -> Arc<Node> {
    moved(leaf(AnyPrimitive::Sphere(Sphere::new(radius))), at)
}

fn material(reflect: f64, refract: f64) -> Arc<Material> {
    Arc::new(Material {
        color: Term::Constant(DVec3::new(0.7, 0.4, 0.2)),
        reflect: Term::Constant(reflect),
        refract: Term::Constant(refract),
        fresnel: refract > 0.0,
        shadow: if refract > 0.0 {
            Shadow::Tinted
        } else {
            Shadow::Opaque
        },
        ..Material::default()
    })
}

/// A mirror, a glass torus and a blend over a ground, two lights, sky and thin fog; lengths times `scale`.
fn scene(scale: f64) -> Scene {
    let s = |x: f64| x * scale;
    let torus = leaf(AnyPrimitive::Torus(Torus::new(s(0.8), s(0.3))));
    let blend = Node::combination(
        Combination {
            operation: Operation::Union,
            blend: AnyBlend::Smooth(Smooth::new(s(0.4))),
        },
        vec![
            sphere(s(0.6), [s(0.1), s(0.7), s(-1.0)]),
            sphere(s(0.5), [s(0.8), s(1.0), s(-1.0)]),
        ],
    )
    .expect("a valid blend");
    let ground = leaf(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], 0.0)));
    let mut scene = Scene {
        shown: vec![
            ground.painted(material(0.1, 0.0)),
            moved(torus, [0.0, s(0.31), s(1.0)]).painted(material(0.1, 0.8)),
            blend.painted(material(0.0, 0.0)),
            sphere(s(0.7), [s(-1.6), s(0.7), 0.0]).painted(material(0.8, 0.0)),
        ],
        lights: vec![
            Light {
                source: Source::Point {
                    position: DVec3::new(5.0, 8.0, 3.0) * scale,
                    falloff: Falloff::None,
                },
                radiance: DVec3::splat(0.7),
            },
            Light {
                source: Source::Directional {
                    toward: DVec3::new(-1.0, 2.0, 1.0).normalize(),
                },
                radiance: DVec3::splat(0.4),
            },
        ],
        camera: Camera {
            eye: DVec3::new(0.0, 2.0, 6.0) * scale,
            at: DVec3::new(0.0, 0.6, 0.0) * scale,
            ..Camera::default()
        },
        sky: Sky {
            horizon: DVec3::new(0.8, 0.85, 0.9),
            zenith: DVec3::new(0.2, 0.4, 0.8),
        },
        fog: Some(Fog {
            color: DVec3::splat(0.8),
            density: 0.02 / scale,
        }),
        ..Scene::default()
    };
    scene.settings.size = [75, 50];
    scene
}

fn rendered(scene: &Scene, options: &RenderOptions) -> Rendered {
    let world = World::new(scene).expect("a world");
    render(scene, &world, options)
}

fn everything() -> RenderOptions<'static> {
    RenderOptions {
        channels: &Channel::ALL,
        ..RenderOptions::default()
    }
}

/// A world that never says that a beam is empty.
struct Vague(World);

impl Surfaces for Vague {
    fn nearest(&self, rays: &Rays, visibility: Visibility, found: &mut Outcomes) {
        Surfaces::nearest(&self.0, rays, visibility, found);
    }

    fn occluded(&self, rays: &RayColumns, numbers: &[u32], found: &mut Occlusions) {
        Surfaces::occluded(&self.0, rays, numbers, found);
    }

    fn paints(&self, part: u32, point: DVec3) -> Vec<Paint<'_>> {
        Surfaces::paints(&self.0, part, point)
    }

    fn materials(&self) -> &[Arc<Material>] {
        Surfaces::materials(&self.0)
    }

    fn sole(&self, part: u32) -> Option<usize> {
        Surfaces::sole(&self.0, part)
    }
}

#[test]
fn empty_blocks_are_as_if_their_rays_were_traced() {
    let channels = [&Channel::ALL[..], &[Channel::Depth], &[Channel::Beauty]];
    let mut missed = 0;
    for k in 0..24 {
        let mut scene = scene(1.0);
        scene.settings.samples = [1, 3][k % 2];
        scene.settings.size = [[75, 50], [64, 33]][k / 2 % 2];
        scene.fog = scene.fog.filter(|_| k % 3 == 0);
        if k % 4 < 2 {
            scene.sky = Sky::uniform(DVec3::new(0.1, 0.2, 0.3));
        }
        if k % 5 > 1 {
            scene.shown.remove(0);
        }
        if k % 7 < 3 {
            scene.camera.projection = Projection::Orthographic { height: 7.0 };
        }
        if k > 15 {
            scene.settings.method = Method::Sphere;
        }
        let options = RenderOptions {
            channels: channels[k % 3],
            ..everything()
        };
        let told = rendered(&scene, &options);
        let world = Vague(World::new(&scene).expect("a world"));
        let asked = render(&scene, &world, &options);
        assert_eq!(told.film, asked.film, "{k}");
        let (told, asked) = (told.statistics, asked.statistics);
        assert_eq!((told.rays, told.primary), (asked.rays, asked.primary));
        assert_eq!(
            (told.steps, told.evaluations),
            (asked.steps, asked.evaluations)
        );
        missed += told.primary.misses;
    }
    assert!(missed > 20_000, "{missed}");
}

#[test]
fn film_and_counts_do_not_depend_on_threads_or_tiles() {
    let mut scene = scene(1.0);
    scene.settings.samples = 2;
    let reference = rendered(&scene, &everything());
    for (threads, tile) in [(1, 64), (2, 64), (3, 64), (7, 16), (1, 16), (2, 17), (3, 1)] {
        let other = rendered(
            &scene,
            &RenderOptions {
                threads,
                tile,
                ..everything()
            },
        );
        assert_eq!(
            other.film, reference.film,
            "{threads} threads, tiles of {tile}"
        );
        let (a, b) = (&other.statistics, &reference.statistics);
        assert_eq!((a.rays, a.primary, &a.steps), (b.rays, b.primary, &b.steps));
        assert_eq!(a.evaluations, b.evaluations);
    }
}

#[test]
fn adaptive_samples_are_those_of_pixels_that_differ_from_a_neighbour() {
    let channels = [Channel::Beauty, Channel::Depth, Channel::Object];
    let of = |samples, sampling, threads, tile| {
        let mut scene = scene(1.0);
        scene.settings.samples = samples;
        scene.settings.sampling = sampling;
        let options = RenderOptions {
            channels: &channels,
            threads,
            tile,
            ..RenderOptions::default()
        };
        rendered(&scene, &options)
    };
    let one = of(1, Sampling::Even, 1, 64);
    let all = of(9, Sampling::Even, 1, 64);
    let some = of(9, Sampling::Adaptive, 1, 64);
    assert_eq!(some.film.planes().len(), channels.len());
    let [width, height] = [one.film.width(), one.film.height()];
    let pixel = |film: &Film, [i, j]: [u32; 2]| channels.map(|c| film.at(c, i, j).to_vec());
    let (mut refined, mut errors) = (0, [0.0; 2]);
    for here in (0..height).flat_map(|j| (0..width).map(move |i| [i, j])) {
        let [single, whole, adaptive] = [&one, &all, &some].map(|done| pixel(&done.film, here));
        let right = [(here[0] + 1).min(width - 1), here[1]];
        let is_edge = pixel(&one.film, right)[2] != single[2];
        assert!(
            adaptive == whole || adaptive == single && !is_edge,
            "{here:?}"
        );
        refined += u64::from(adaptive == whole && adaptive != single);
        for (error, shown) in errors.iter_mut().zip([&single, &adaptive]) {
            let away = shown[0].iter().zip(&whole[0]).map(|(a, b)| (a - b).abs());
            *error += f64::from(away.sum::<f32>());
        }
    }
    let counted = some.statistics.refined_pixels;
    let pixels = u64::from(width * height);
    assert!(
        counted >= refined && counted < pixels / 2,
        "{counted} of {pixels}"
    );
    assert_eq!(some.statistics.rays.primary, pixels + 9 * counted);
    // What is left of the difference between 1 and 9 samples is less than a tenth.
    assert!(errors[1] < 0.1 * errors[0], "{errors:?}");
    for (threads, tile) in [(2, 64), (3, 16), (7, 33)] {
        let other = of(9, Sampling::Adaptive, threads, tile);
        assert_eq!(other.film, some.film, "{threads} threads, tiles of {tile}");
        assert_eq!(other.statistics.rays, some.statistics.rays);
        assert_eq!(other.statistics.evaluations, some.statistics.evaluations);
    }
}

#[test]
fn one_adaptive_sample_is_one_sample() {
    let mut scene = scene(1.0);
    let even = rendered(&scene, &everything());
    scene.settings.sampling = Sampling::Adaptive;
    let adaptive = rendered(&scene, &everything());
    assert_eq!(adaptive.film, even.film);
    assert_eq!(adaptive.statistics.rays, even.statistics.rays);
}

#[test]
fn scaling_everything_by_a_power_of_two_keeps_the_picture() {
    let beauty = |scale| rendered(&scene(scale), &RenderOptions::default()).film;
    let one = beauty(1.0);
    for k in [-40, 40] {
        assert_eq!(beauty(2f64.powi(k)), one, "2^{k}");
    }
}

#[test]
fn every_ray_has_an_answer_and_light() {
    let picture = rendered(&scene(1.0), &everything());
    let s = &picture.statistics;
    assert_eq!((s.primary.unknown, s.unknown_secondary), (0, 0));
    assert_eq!(s.unknown_pixels, 0);
    let beauty = picture.film.plane(Channel::Beauty).unwrap();
    assert!(beauty.values.iter().all(|x| x.is_finite() && *x >= 0.0));
}

#[test]
fn counts_add_up() {
    let mut scene = scene(1.0);
    scene.settings.samples = 3;
    let s = rendered(&scene, &everything()).statistics;
    assert_eq!(s.rays.primary, 75 * 50 * 3);
    let p = s.primary;
    assert_eq!(p.hits + p.misses + p.unknown, s.rays.primary);
    let rays: u64 = s.steps.histogram.iter().map(|(_, rays)| rays).sum();
    assert_eq!(rays, s.rays.primary);
    assert!(s.rays.shadow > 0 && s.rays.reflected > 0 && s.rays.refracted > 0);
}

/// One ball of radius 1 at the origin, seen from (0, 0, 4), by light from the camera.
fn lone_ball(projection: Projection) -> Scene {
    let mut scene = Scene {
        shown: vec![sphere(1.0, [0.0; 3])],
        lights: vec![Light {
            source: Source::Directional { toward: DVec3::Z },
            radiance: DVec3::ONE,
        }],
        camera: Camera {
            eye: DVec3::new(0.0, 0.0, 4.0),
            at: DVec3::ZERO,
            projection,
            ..Camera::default()
        },
        ..Scene::default()
    };
    scene.settings.size = [101, 101];
    scene
}

fn at(film: &Film, channel: Channel, i: u32, j: u32) -> f64 {
    f64::from(film.at(channel, i, j)[0])
}

#[test]
fn channels_say_what_a_ball_is() {
    let ball = lone_ball(Projection::Orthographic { height: 4.0 });
    let film = rendered(&ball, &everything()).film;
    for (i, j) in [(50, 50), (60, 40), (30, 55), (50, 74)] {
        let [x, y] = [0.04 * (f64::from(i) - 50.0), 0.04 * (50.0 - f64::from(j))];
        let z = (1.0 - x * x - y * y).sqrt();
        assert!((at(&film, Channel::Depth, i, j) - (4.0 - z)).abs() < 1e-6);
        let normal = film.at(Channel::Normal, i, j).to_vec();
        for (n, expected) in normal.iter().zip([x, y, z]) {
            assert!((f64::from(*n) - expected).abs() < 1e-6);
        }
        assert_eq!(at(&film, Channel::Verdict, i, j), 1.0);
        assert_eq!(at(&film, Channel::Object, i, j), 0.0);
        // Lambert and Phong under light from the eye: R.V = cos(2a) with cos(a) = z.
        let gray = at(&film, Channel::Color, i, j);
        let shine = (2.0 * z * z - 1.0).max(0.0).powi(32);
        let seen = 0.1 * gray + 0.8 * gray * z + 0.2 * shine;
        assert!((at(&film, Channel::Beauty, i, j) - seen).abs() < 1e-6);
    }
    assert_eq!(at(&film, Channel::Depth, 0, 0), f64::INFINITY);
    assert_eq!(at(&film, Channel::Verdict, 0, 0), 0.0);
    assert_eq!(at(&film, Channel::Object, 0, 0), -1.0);
}

#[test]
fn no_convex_shape_shadows_itself() {
    let shapes = [
        Node::modifier(AnyModifier::Offset(Offset::new(0.3)), sphere(0.7, [0.0; 3])).unwrap(),
        leaf(AnyPrimitive::Ellipsoid(Ellipsoid::new([1.0, 0.3, 0.6]))),
        leaf(AnyPrimitive::Cuboid(Cuboid::new([1.2, 0.9, 1.0], 0.1))),
        leaf(AnyPrimitive::Cylinder(Cylinder::new(0.7, 1.0, 0.0))),
        sphere(1.0, [0.0; 3]),
    ];
    let matt = Arc::new(Material {
        color: Term::Constant(DVec3::ONE),
        ambient: Term::Constant(0.0),
        diffuse: Term::Constant(1.0),
        specular: Term::Constant(0.0),
        ..Material::default()
    });
    for (shape, method) in shapes
        .iter()
        .flat_map(|s| [(s, Method::Auto), (s, Method::Sphere)])
    {
        for degrees in [5, 40, 80, 120] {
            let a = f64::from(degrees).to_radians();
            let toward = DVec3::new(a.sin(), 0.0, a.cos());
            let mut scene = lone_ball(Projection::Orthographic { height: 2.4 });
            // Of one part alone no shadow rays would be traced.
            let grain = sphere(1e-3, [100.0, 0.0, 0.0]);
            scene.shown = vec![shape.painted(matt.clone()), grain];
            scene.lights[0].source = Source::Directional { toward };
            scene.settings.method = method;
            let both = rendered(&scene, &everything());
            assert!(both.statistics.rays.shadow > 0);
            let film = both.film;
            scene.shown.pop();
            let alone = rendered(&scene, &everything());
            let is_spared = method == Method::Auto;
            assert_eq!(alone.statistics.rays.shadow == 0, is_spared);
            assert_eq!(alone.film.planes()[0], film.planes()[0]);
            for (i, j) in (0..101).flat_map(|i| (0..101).map(move |j| (i, j))) {
                if at(&film, Channel::Verdict, i, j) != 1.0 {
                    continue;
                }
                let n = film.at(Channel::Normal, i, j);
                let n = DVec3::new(f64::from(n[0]), f64::from(n[1]), f64::from(n[2]));
                let seen = at(&film, Channel::Beauty, i, j);
                let lambert = n.dot(toward).max(0.0);
                assert!(
                    (seen - lambert).abs() < 1e-6,
                    "{} by {method:?}, light at {degrees}, pixel {i} {j}: {seen}, not {lambert}",
                    shape.kind()
                );
            }
        }
    }
}

#[test]
fn clear_solids_vanish_under_an_even_sky() {
    // All light gets out in the end: a ray that is lost at a boundary would be seen.
    let shapes = [
        sphere(1.0, [0.0; 3]),
        Node::modifier(AnyModifier::Offset(Offset::new(0.3)), sphere(0.7, [0.0; 3])).unwrap(),
        leaf(AnyPrimitive::Ellipsoid(Ellipsoid::new([1.0, 0.5, 0.8]))),
        leaf(AnyPrimitive::Torus(Torus::new(0.7, 0.3))),
        leaf(AnyPrimitive::Cuboid(Cuboid::new([1.2, 0.9, 1.0], 0.0))),
    ];
    let clear = Arc::new(Material {
        color: Term::Constant(DVec3::ZERO),
        ambient: Term::Constant(0.0),
        diffuse: Term::Constant(0.0),
        specular: Term::Constant(0.0),
        refract: Term::Constant(1.0),
        ..Material::default()
    });
    for (shape, method) in shapes
        .iter()
        .flat_map(|s| [(s, Method::Auto), (s, Method::Sphere)])
    {
        let mut scene = lone_ball(Projection::Perspective { fov: 0.6 });
        scene.camera.eye = DVec3::new(1.0, 2.0, 3.0);
        scene.shown = vec![shape.painted(clear.clone())];
        scene.sky = Sky::uniform(DVec3::ONE);
        scene.settings.depth = 64;
        scene.settings.method = method;
        let result = rendered(&scene, &everything());
        let beauty = result.film.plane(Channel::Beauty).unwrap();
        let dark = beauty.values.iter().filter(|x| **x != 1.0).count() as u64;
        let s = &result.statistics;
        let case = format!("{} by {method:?}", shape.kind());
        assert_eq!(s.primary.unknown + s.unknown_secondary, 0, "{case}");
        // Rays that run around inside of an ellipsoid, or enter by a rounded edge, may stay for ever.
        assert_eq!(dark, 3 * s.rays.too_deep, "{case}");
        assert!(s.rays.too_deep <= 2, "{case}");
    }
}

#[test]
fn a_ball_covers_the_area_of_its_silhouette() {
    // tan of the half angle is 1 / sqrt(15); pixels are 2 tan(fov/2) / 400 apart.
    let fov = 40f64.to_radians();
    let mut ball = lone_ball(Projection::Perspective { fov });
    ball.settings.size = [401, 401];
    let film = rendered(&ball, &everything()).film;
    let hits = film.plane(Channel::Verdict).unwrap().values.iter();
    let hits: f64 = hits.map(|v| f64::from(*v)).sum();
    let radius = 200.0 / ((fov / 2.0).tan() * 15f64.sqrt());
    let area = std::f64::consts::PI * radius * radius;
    // Gauss's circle: the count is off by less than the circumference, in practice by its square root.
    assert!(
        (hits - area).abs() < 4.0 * radius.sqrt(),
        "{hits} of {area}"
    );
}

#[test]
fn more_samples_converge_to_the_covered_share() {
    // A bright half-space that covers the lower half of the middle row.
    let mut half = lone_ball(Projection::Orthographic { height: 1.0 });
    let bright = Arc::new(Material {
        color: Term::Constant(DVec3::ONE),
        ambient: Term::Constant(1.0),
        diffuse: Term::Constant(0.0),
        specular: Term::Constant(0.0),
        ..Material::default()
    });
    let bar = leaf(AnyPrimitive::Cuboid(Cuboid::new([9.0, 2.0, 2.0], 0.0)));
    half.shown = vec![moved(bar, [0.0, -1.0, 0.0]).painted(bright)];
    half.settings.size = [3, 3];
    half.settings.samples = 256;
    let film = rendered(&half, &everything()).film;
    for i in 0..3 {
        assert!((at(&film, Channel::Beauty, i, 1) - 0.5).abs() < 0.02);
    }
}

#[test]
fn seeds_move_samples_and_one_sample_has_none() {
    let beauty = |samples, seed| {
        let mut scene = scene(1.0);
        (scene.settings.samples, scene.settings.seed) = (samples, seed);
        rendered(&scene, &RenderOptions::default()).film
    };
    assert_eq!(beauty(1, 1), beauty(1, 2));
    assert_ne!(beauty(2, 1), beauty(2, 2));
}

#[test]
fn progress_counts_every_tile_once() {
    let seen = Mutex::new(Vec::new());
    let note = |progress: Progress| seen.lock().unwrap().push((progress.done, progress.tiles));
    let options = RenderOptions {
        tile: 16,
        progress: Some(&note),
        ..RenderOptions::default()
    };
    rendered(&scene(1.0), &options);
    let mut seen = seen.into_inner().unwrap();
    seen.sort_unstable();
    let all: Vec<_> = (1..=20).map(|done| (done, 20)).collect();
    assert_eq!(seen, all);
}

#[test]
fn a_cancelled_rendering_ends_early_and_says_so() {
    let cancel = AtomicBool::new(false);
    let stop = |progress: Progress| {
        if progress.done == 3 {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let options = RenderOptions {
        threads: 1,
        tile: 16,
        progress: Some(&stop),
        cancel: Some(&cancel),
        ..RenderOptions::default()
    };
    let result = rendered(&scene(1.0), &options);
    assert!(result.cancelled);
    assert_eq!(result.statistics.rays.primary, 3 * 256);
}

#[test]
fn channels_that_are_not_asked_for_cost_nothing() {
    let options = RenderOptions {
        channels: &[Channel::Depth, Channel::Depth],
        ..RenderOptions::default()
    };
    let result = rendered(&scene(1.0), &options);
    assert_eq!(result.film.planes().len(), 1);
    let rays = result.statistics.rays;
    assert_eq!(rays.shadow + rays.reflected + rays.refracted, 0);
}

#[test]
fn every_channel_becomes_a_file_that_reads_back() {
    let folder = std::env::temp_dir().join(format!("fieldstone-render-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let film = rendered(&scene(1.0), &everything()).film;
    let metadata = Metadata {
        source: "scene.sdf".into(),
        ..Metadata::default()
    };
    let saved = save(&film, &folder.join("out.png"), &metadata).unwrap();
    assert_eq!(saved.len(), Channel::ALL.len());
    for file in &saved {
        let read = image::open(&file.path).unwrap().to_rgb8();
        assert_eq!(read, picture(&film, file.channel).unwrap().image);
        assert_eq!(file.not_a_number, 0);
    }
    assert!(folder.join("out.evaluations.png").exists());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn statistics_are_written_with_their_schema() {
    let statistics = rendered(&scene(1.0), &everything()).statistics;
    let json = serde_json::to_value(&statistics).unwrap();
    assert_eq!(json["schema"], 1);
    assert_eq!(json["rays"]["primary"], 75 * 50);
    assert!(json["milliseconds"]["trace"].is_number());
}

/// Lanes read whole groups of rows: behind the last ray lies what was there before.
#[test]
fn light_does_not_depend_on_what_lies_behind_the_last_ray() {
    let scene = scene(1.0);
    let world = World::new(&scene).expect("a world");
    let whitted = Whitted::new(&scene, &world);
    let view = View::new(&scene.camera, scene.settings.size);
    let light = |rays: &Rays, mut outcomes: Outcomes| -> Vec<[f64; 3]> {
        let mut census = Census::default();
        whitted.meet_first((rays, true), &mut census, &mut outcomes);
        assert!(census.hits > 0);
        let light = whitted.light(rays, &outcomes, &mut census).radiance;
        (0..rays.len()).map(|i| light.row(i)).collect()
    };
    for count in [1, 31, 33, 50, 64, 75] {
        let pixels: Vec<[u32; 2]> = (0..count).map(|column| [column, 30]).collect();
        let rays = view.rays(&pixels);
        let mut behind = Rays::with_capacity(128);
        behind.resize(128);
        for column in behind.columns_mut() {
            column.fill(f64::NAN);
        }
        behind.resize(rays.len());
        for (column, source) in behind.columns_mut().into_iter().zip(rays.columns()) {
            column.copy_from_slice(source);
        }
        let next = behind.lanes()[0].get(rays.len());
        assert_eq!(next.is_some_and(|x| x.is_nan()), !count.is_multiple_of(32));
        let nowhere = Outcome {
            t: f64::NAN,
            error: f64::NAN,
            point: DVec3::NAN,
            normal: DVec3::NAN,
            ..Outcome::NOTHING
        };
        let nowhere = (0..128).map(|_| nowhere).collect();
        let expected = light(&rays, Outcomes::default());
        assert_eq!(light(&behind, nowhere), expected, "{count} rays");
    }
}
