//! Laws of light, with expected values in closed form.

mod stage;

use fieldstone::scene::{Falloff, Fog, Light, Material, Shadow, Source, Term};
use fieldstone::shade::{Census, FAINTEST, Whitted, reflected_share};
use fieldstone::trace::{Ray, Rays};
use glam::DVec3;
use stage::*;

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b} to {tolerance}");
}

fn sun(toward: DVec3) -> Light {
    Light {
        source: Source::Directional {
            toward: toward.normalize(),
        },
        radiance: DVec3::ONE,
    }
}

fn lamp(position: [f64; 3], falloff: Falloff) -> Light {
    Light {
        source: Source::Point {
            position: DVec3::from_array(position),
            falloff,
        },
        radiance: DVec3::ONE,
    }
}

/// The unit vector at this angle from straight up.
fn tilted(degrees: f64) -> DVec3 {
    let a = degrees.to_radians();
    DVec3::new(a.sin(), a.cos(), 0.0)
}

/// A ray straight down onto the origin.
fn down() -> Ray {
    ray(DVec3::new(0.0, 10.0, 0.0), DVec3::NEG_Y)
}

/// Only ray of the last wave.
fn last_ray(stage: &Stage) -> Ray {
    let traced = stage.traced.lock().unwrap();
    let wave = traced.last().unwrap();
    assert_eq!(wave.len(), 1);
    wave[0]
}

// Direct light

#[test]
fn diffuse_light_falls_with_the_cosine() {
    for degrees in [0.0, 20.0, 45.0, 60.0, 89.0] {
        let stage = Stage::new(vec![(ground(0.0), matt())]);
        let (light, _) = see(&scene(vec![sun(tilted(degrees))]), &stage, down());
        close(light.x, degrees.to_radians().cos(), 1e-15);
    }
}

#[test]
fn lights_add() {
    let stage = Stage::new(vec![(ground(0.0), matt())]);
    let lights = vec![sun(tilted(60.0)), sun(tilted(-60.0)), sun(DVec3::Y)];
    close(see(&scene(lights), &stage, down()).0.x, 2.0, 1e-15);
}

#[test]
fn light_from_behind_adds_nothing_and_asks_nothing() {
    let stage = Stage::new(vec![(ground(0.0), matt())]);
    let (light, census) = see(&scene(vec![sun(tilted(100.0))]), &stage, down());
    assert_eq!((light, census.shadow), (DVec3::ZERO, 0));
}

#[test]
fn inverse_square_of_the_distance() {
    let stage = Stage::new(vec![(ground(0.0), matt())]);
    for height in [0.5, 1.0, 3.0] {
        let light = lamp([0.0, height, 0.0], Falloff::InverseSquare);
        let (seen, _) = see(&scene(vec![light]), &stage, down());
        close(seen.x * height * height, 1.0, 1e-13);
    }
}

#[test]
fn surfaces_seen_from_inside_are_lit_from_inside() {
    let stage = Stage::new(vec![(ball([0.0; 3], 2.0), matt())]);
    let inside = ray(DVec3::ZERO, DVec3::NEG_Y);
    let light = lamp([0.0, 1.0, 0.0], Falloff::None);
    close(see(&scene(vec![light]), &stage, inside).0.x, 1.0, 1e-12);
}

// Shadows

#[test]
fn no_surface_shadows_itself_where_it_faces_the_light() {
    for degrees in 1..90 {
        let light = sun(tilted(f64::from(degrees)));
        for (solid, top) in [
            (ground(0.0), 0.0),
            (ball([0.0; 3], 1.0), 1.0),
            (ball([0.0; 3], 1e6), 1e6),
        ] {
            let stage = Stage::new(vec![(solid, matt())]);
            let from = ray(DVec3::new(0.0, top + 1.0, 0.0), DVec3::NEG_Y);
            let (seen, _) = see(&scene(vec![light]), &stage, from);
            close(seen.x, f64::from(degrees).to_radians().cos(), 1e-9);
        }
    }
}

#[test]
fn thin_plates_cast_shadows_from_close_by() {
    let sheet = Solid::Slab {
        normal: DVec3::Y,
        low: 1e-9,
        high: 1e-9 + 1e-3,
    };
    let stage = Stage::new(vec![(ground(0.0), matt()), (sheet, matt())]);
    let from = ray(DVec3::new(0.0, 1e-10, 0.0), DVec3::NEG_Y);
    let (seen, _) = see(&scene(vec![sun(DVec3::Y)]), &stage, from);
    assert_eq!(seen, DVec3::ZERO);
}

#[test]
fn a_lamp_is_shadowed_by_what_is_before_it_and_not_by_what_is_behind() {
    let light = lamp([0.0, 3.0, 0.0], Falloff::None);
    for (height, seen) in [(1.5, 0.0), (4.5, 1.0)] {
        let stage = Stage::new(vec![
            (ground(0.0), matt()),
            (ball([0.0, height, 0.0], 0.5), matt()),
        ]);
        let from = ray(DVec3::new(3.0, 3.0, 0.0), DVec3::new(-1.0, -1.0, 0.0));
        close(see(&scene(vec![light]), &stage, from).0.x, seen, 1e-12);
    }
}

#[test]
fn what_stands_at_the_lamp_casts_no_shadow() {
    let ceiling = Solid::Slab {
        normal: DVec3::Y,
        low: 3.0,
        high: 4.0,
    };
    let stage = Stage::new(vec![(ground(0.0), matt()), (ceiling, matt())]);
    let light = lamp([0.3, 3.0, 0.2], Falloff::None);
    let from = ray(DVec3::new(1.0, 1.0, 0.0), DVec3::new(-1.0, -1.0, 0.0));
    assert!(see(&scene(vec![light]), &stage, from).0.x > 0.9);
}

fn shadowed_by(occluder: Material) -> DVec3 {
    let stage = Stage::new(vec![
        (ground(0.0), matt()),
        (ball([0.0, 2.0, 0.0], 1.0), occluder),
    ]);
    let from = ray(DVec3::new(3.0, 3.0, 0.0), DVec3::new(-1.0, -1.0, 0.0));
    see(&scene(vec![sun(DVec3::Y)]), &stage, from).0
}

#[test]
fn glass_casts_a_full_shadow_unless_it_says_otherwise() {
    assert_eq!(shadowed_by(clear(1.5)), DVec3::ZERO);
    let none = Material {
        shadow: Shadow::None,
        ..matt()
    };
    assert_eq!(shadowed_by(none), DVec3::ONE);
}

#[test]
fn tinted_shadow_is_refract_at_each_surface_times_absorption() {
    let absorb = DVec3::new(0.0, 0.25, 1.0);
    let tinted = Material {
        refract: number(0.9),
        absorb: Term::Constant(absorb),
        shadow: Shadow::Tinted,
        ..clear(1.5)
    };
    let law = absorb.map(|a| 0.81 * (-2.0 * a).exp());
    assert!(shadowed_by(tinted).abs_diff_eq(law, 1e-12));
}

#[test]
fn tinted_shadows_stop_at_what_is_opaque_behind() {
    let tinted = Material {
        shadow: Shadow::Tinted,
        ..clear(1.5)
    };
    let stage = Stage::new(vec![
        (ground(0.0), matt()),
        (ball([0.0, 2.0, 0.0], 1.0), tinted),
        (ball([0.0, 9.0, 0.0], 1.0), matt()),
    ]);
    let from = ray(DVec3::new(3.0, 3.0, 0.0), DVec3::new(-1.0, -1.0, 0.0));
    let seen = |light| see(&scene(vec![light]), &stage, from).0;
    assert_eq!(seen(sun(DVec3::Y)), DVec3::ZERO);
    let between = seen(lamp([0.0, 6.0, 0.0], Falloff::None));
    assert!(between.abs_diff_eq(DVec3::ONE, 1e-12), "{between}");
}

#[test]
fn a_lamp_inside_tinted_glass_shines_through_the_glass_around_it() {
    let tinted = Material {
        shadow: Shadow::Tinted,
        absorb: Term::Constant(DVec3::splat(0.5)),
        ..clear(1.5)
    };
    let stage = Stage::new(vec![
        (ground(0.0), matt()),
        (ball([0.0, 2.0, 0.0], 1.0), tinted),
    ]);
    let from = ray(DVec3::new(3.0, 3.0, 0.0), DVec3::new(-1.0, -1.0, 0.0));
    let light = lamp([0.0, 2.0, 0.0], Falloff::None);
    close(
        see(&scene(vec![light]), &stage, from).0.x,
        (-0.5f64).exp(),
        1e-12,
    );
}

// Mirrors

#[test]
fn facing_mirrors_give_a_geometric_series_up_to_the_depth() {
    let glowing = Material {
        color: Term::Constant(DVec3::ONE),
        ambient: number(0.25),
        ..mirror(0.9)
    };
    let room = |normal: DVec3| Solid::Slab {
        normal,
        low: 1.0,
        high: 2.0,
    };
    for depth in [0, 1, 5, 12] {
        let stage = Stage::new(vec![
            (room(DVec3::Z), glowing.clone()),
            (room(DVec3::NEG_Z), glowing.clone()),
        ]);
        let between = ray(DVec3::ZERO, DVec3::new(0.1, 0.0, 1.0));
        let (light, census) = see(&under_sky(1.0, depth), &stage, between);
        let series = 0.25 * (1.0 - 0.9f64.powi(depth as i32 + 1)) / (1.0 - 0.9);
        close(light.x, series, 1e-14);
        assert_eq!((census.reflected, census.too_deep), (u64::from(depth), 1));
    }
}

#[test]
fn parallel_mirrors_advance_by_a_constant() {
    let wall = |normal| Solid::Slab {
        normal,
        low: 1.0,
        high: 2.0,
    };
    let stage = Stage::new(vec![
        (wall(DVec3::Z), mirror(1.0)),
        (wall(DVec3::NEG_Z), mirror(1.0)),
    ]);
    let start = ray(DVec3::ZERO, DVec3::new(0.3, 0.0, 1.0));
    see(&under_sky(1.0, 20), &stage, start);
    let traced = stage.traced.lock().unwrap();
    for (k, wave) in traced.iter().enumerate().skip(1) {
        close(wave[0].origin.x, 0.3 * (2.0 * k as f64 - 1.0), 1e-11);
    }
}

#[test]
fn a_corner_of_three_mirrors_sends_light_back() {
    let wall = |normal: DVec3| {
        let solid = Solid::Slab {
            normal,
            low: f64::NEG_INFINITY,
            high: 0.0,
        };
        (solid, mirror(1.0))
    };
    let stage = Stage::new(vec![wall(DVec3::X), wall(DVec3::Y), wall(DVec3::Z)]);
    let incoming = ray(DVec3::new(1.0, 2.0, 3.0), DVec3::new(-0.31, -0.57, -0.83));
    let (light, census) = see(&under_sky(1.0, 8), &stage, incoming);
    assert_eq!(last_ray(&stage).direction, -incoming.direction);
    assert_eq!((light, census.reflected), (DVec3::ONE, 3));
}

#[test]
fn weight_below_a_512th_is_left_out() {
    for (share, rays) in [(FAINTEST, 1), (FAINTEST * 0.999, 0)] {
        let stage = Stage::new(vec![(ground(0.0), mirror(share))]);
        let (light, census) = see(&under_sky(1.0, 8), &stage, down());
        assert_eq!((census.reflected, census.too_faint), (rays, 1 - rays));
        assert_eq!(light.x, share * rays as f64);
    }
}

// Glass

fn slab(low: f64, high: f64) -> Solid {
    Solid::Slab {
        normal: DVec3::Y,
        low,
        high,
    }
}

#[test]
fn slab_of_glass_leaves_light_parallel_and_displaced() {
    for degrees in [0.0, 10.0, 45.0, 80.0] {
        let stage = Stage::new(vec![(slab(-1.0, 0.0), clear(1.5))]);
        let a = f64::to_radians(degrees);
        let direction = -tilted(degrees);
        let (light, census) = see(&under_sky(1.0, 8), &stage, ray(-direction * 2.0, direction));
        let out = last_ray(&stage);
        let b = (a.sin() / 1.5).asin();
        let shift = (a - b).sin() / b.cos();
        assert!(out.direction.abs_diff_eq(direction, 1e-14));
        close(out.origin.cross(direction).length(), shift, 1e-12);
        assert_eq!((light, census.refracted), (DVec3::ONE, 2));
        if degrees == 45.0 {
            close(shift, 0.3291, 5e-5);
        }
    }
}

#[test]
fn ball_of_glass_deviates_by_twice_the_bend() {
    let stage = Stage::new(vec![(ball([0.0; 3], 1.0), clear(1.5))]);
    let incoming = ray(DVec3::new(-5.0, 0.5, 0.0), DVec3::X);
    see(&under_sky(1.0, 8), &stage, incoming);
    let deviation = last_ray(&stage).direction.angle_between(DVec3::X);
    let law = 2.0 * (30.0 - (0.5f64 / 1.5).asin().to_degrees());
    close(law, 21.057, 1e-3);
    close(deviation.to_degrees(), law, 1e-10);
}

#[test]
fn paraxial_light_meets_at_the_focus_of_a_ball() {
    let stage = Stage::new(vec![(ball([0.0; 3], 1.0), clear(1.5))]);
    let height = 1e-4;
    see(
        &under_sky(1.0, 8),
        &stage,
        ray(DVec3::new(-5.0, height, 0.0), DVec3::X),
    );
    let out = last_ray(&stage);
    let focus = out.origin.x - out.origin.y * out.direction.x / out.direction.y;
    close(focus, 1.5, 1e-6);
}

#[test]
fn sines_times_indices_stay_through_any_stack() {
    // Glass around water around diamond, entered at 40 degrees.
    let stage = Stage::new(vec![
        (slab(-5.0, 0.0), clear(1.5)),
        (slab(-4.0, -1.0), clear(1.333)),
        (slab(-3.0, -2.0), clear(2.42)),
    ]);
    let incoming = ray(tilted(40.0) * 3.0, -tilted(40.0));
    see(&under_sky(1.0, 8), &stage, incoming);
    let traced = stage.traced.lock().unwrap();
    let sines: Vec<f64> = traced
        .iter()
        .map(|wave| wave[0].direction.x.abs())
        .collect();
    let indices = [1.0, 1.5, 1.333, 2.42, 1.333, 1.5, 1.0];
    assert_eq!(sines.len(), indices.len());
    for (sine, index) in sines.iter().zip(indices) {
        close(sine * index, 40f64.to_radians().sin(), 1e-14);
    }
}

#[test]
fn light_at_50_degrees_passes_from_glass_into_water() {
    // It enters a ball of glass head on, and meets a slab of water inside, tilted by 50 degrees.
    let normal = tilted(50.0);
    let water = Solid::Slab {
        normal,
        low: -1.0,
        high: 0.0,
    };
    let stage = Stage::new(vec![
        (ball([0.0; 3], 5.0), clear(1.5)),
        (water, clear(1.333)),
    ]);
    let (_, census) = see(&under_sky(1.0, 3), &stage, down());
    assert_eq!((census.refracted, census.reflected), (3, 0));
    let inside = stage.traced.lock().unwrap()[2][0].direction;
    let sine = normal.cross(inside).length();
    close(sine, 1.5 * 50f64.to_radians().sin() / 1.333, 1e-14);
}

/// What a clear ball sends on where light meets, from inside at `degrees`, a slab of air.
fn at_the_slab_of_air(degrees: f64, material: Material) -> Census {
    let air = Solid::Slab {
        normal: tilted(degrees),
        low: -1.0,
        high: 0.0,
    };
    let stage = Stage::new(vec![(ball([0.0; 3], 5.0), material), (air, clear(1.0))]);
    let (light, census) = see(&under_sky(1.0, 2), &stage, down());
    assert!(light.is_finite());
    census
}

#[test]
fn light_is_reflected_totally_from_the_critical_angle_on() {
    let critical = (1.0f64 / 1.5).asin().to_degrees();
    for off in [-1.0, -1e-3, -1e-7] {
        let census = at_the_slab_of_air(critical + off, clear(1.5));
        assert_eq!((census.refracted, census.reflected), (2, 0), "{off}");
    }
    for off in [1e-7, 1e-3, 1.0] {
        let census = at_the_slab_of_air(critical + off, clear(1.5));
        assert_eq!((census.refracted, census.reflected), (1, 1), "{off}");
    }
    at_the_slab_of_air(critical, clear(1.5));
}

#[test]
fn total_reflection_takes_the_refracted_share() {
    // A ray inside of a clear half-space, under a grazing boundary, with a glowing floor below.
    let glass = Material {
        refract: number(0.7),
        reflect: number(0.2),
        ..clear(1.5)
    };
    let floor = Material {
        color: Term::Constant(DVec3::ONE),
        ambient: number(1.0),
        ..black()
    };
    let stage = Stage::new(vec![(ground(0.0), glass), (ground(-2.0), floor)]);
    let from = DVec3::new(0.0, -1.0, 0.0);
    let (light, _) = see(&under_sky(0.0, 1), &stage, ray(from, tilted(60.0)));
    close(light.x, 0.9, 1e-14);
    let (light, _) = see(&under_sky(0.0, 1), &stage, ray(from, tilted(20.0)));
    close(light.x, 0.2, 1e-14);
}

#[test]
fn clear_glass_vanishes_under_an_even_sky() {
    let glass = Material {
        fresnel: true,
        ..clear(1.5)
    };
    for height in [0.0, 0.3, 0.6, 0.9, 0.99] {
        let stage = Stage::new(vec![(ball([0.0; 3], 1.0), glass.clone())]);
        let from = ray(DVec3::new(-5.0, height, 0.0), DVec3::X);
        let (light, census) = see(&under_sky(1.0, 64), &stage, from);
        // What is missing are the rays that were left out, each below a 512th.
        let missing = (census.too_faint + census.too_deep) as f64 * FAINTEST;
        let range = 1.0 - missing - 1e-12..=1.0 + 1e-12;
        assert!(range.contains(&light.x), "{height}: {light} in {range:?}");
    }
}

#[test]
fn fresnel_divides_the_sum_of_both_shares() {
    let glass = Material {
        fresnel: true,
        refract: number(0.5),
        reflect: number(0.3),
        ..clear(1.5)
    };
    let stage = Stage::new(vec![(ground(0.0), glass)]);
    let mut scene = under_sky(0.0, 8);
    scene.sky.zenith = DVec3::ONE;
    scene.sky.horizon = DVec3::ONE;
    let (both, _) = see(&scene, &stage, down());
    close(both.x, 0.8, 1e-15);
    let sent: usize = stage.traced.lock().unwrap()[1..].iter().map(Vec::len).sum();
    assert_eq!(sent, 2, "a reflected and a refracted ray");
}

#[test]
fn opaque_varnish_reflects_by_fresnel_and_transmits_nothing() {
    let varnish = Material {
        fresnel: true,
        reflect: number(1.0),
        ..black()
    };
    for degrees in [0.0, 50.0, 85.0] {
        let stage = Stage::new(vec![(ground(0.0), varnish.clone())]);
        let from = ray(tilted(degrees), -tilted(degrees));
        let (light, census) = see(&under_sky(1.0, 8), &stage, from);
        let share = reflected_share(degrees.to_radians().cos(), 1.0, 1.5);
        close(light.x, share, 1e-14);
        assert_eq!(census.refracted, 0);
    }
}

#[test]
fn a_camera_inside_glass_sees_out_as_from_glass() {
    let stage = Stage::new(vec![(ball([0.0; 3], 2.0), clear(1.5))]);
    let from = ray(DVec3::new(0.0, 1.0, 0.0), DVec3::X);
    let (light, _) = see(&under_sky(1.0, 8), &stage, from);
    assert_eq!(light, DVec3::ONE);
    // It meets the ball at 30 degrees.
    let bend = last_ray(&stage).direction.angle_between(DVec3::X);
    close(bend, (1.5f64 * 0.5).asin() - 30f64.to_radians(), 1e-14);
}

// What light loses on its way

#[test]
fn absorption_goes_with_the_way_inside() {
    let absorb = DVec3::new(0.0, 0.3, 2.0);
    let colored = Material {
        absorb: Term::Constant(absorb),
        ..clear(1.5)
    };
    for degrees in [0.0, 45.0] {
        let stage = Stage::new(vec![(slab(-1.0, 0.0), colored.clone())]);
        let from = ray(tilted(degrees), -tilted(degrees));
        let (light, _) = see(&under_sky(1.0, 8), &stage, from);
        let way = 1.0 / (f64::to_radians(degrees).sin() / 1.5).asin().cos();
        assert!(light.abs_diff_eq(absorb.map(|a| (-a * way).exp()), 1e-13));
    }
}

#[test]
fn nothing_passes_an_endless_absorber() {
    let colored = Material {
        absorb: Term::Constant(DVec3::new(0.0, 0.5, 0.5)),
        ..clear(1.5)
    };
    let stage = Stage::new(vec![(ground(0.0), colored)]);
    let (light, _) = see(&under_sky(1.0, 8), &stage, down());
    assert_eq!(light, DVec3::new(1.0, 0.0, 0.0));
}

/// A scene in fog of this density, white fog before a black sky.
fn foggy(density: f64) -> fieldstone::scene::Scene {
    let mut scene = under_sky(0.0, 8);
    scene.fog = Some(Fog {
        color: DVec3::ONE,
        density,
    });
    scene
}

#[test]
fn fog_weakens_with_the_sum_of_all_segments() {
    // Through a slab and by a mirror onto a glowing ceiling: 1 + the way inside + 2 + 5.
    let glowing = Material {
        color: Term::Constant(DVec3::ONE),
        ambient: number(1.0),
        ..black()
    };
    let stage = Stage::new(vec![
        (slab(-1.0, 0.0), clear(1.5)),
        (slab(-9.0, -3.0), mirror(1.0)),
        (slab(5.0, 6.0), glowing),
    ]);
    let mut scene = foggy(0.05);
    scene.fog = scene.fog.map(|fog| Fog {
        color: DVec3::ZERO,
        ..fog
    });
    let a = 45f64.to_radians();
    let (light, _) = see(&scene, &stage, ray(tilted(45.0), -tilted(45.0)));
    let inside = 1.0 / (a.sin() / 1.5).asin().cos();
    let way = 1.0 + inside + 2.0 / a.cos() + 2.0 / a.cos() + inside + 5.0 / a.cos();
    close(light.x, (-0.05 * way).exp(), 1e-13);
}

#[test]
fn fog_adds_its_colour_for_what_it_takes() {
    let stage = Stage::new(vec![(ground(0.0), black())]);
    let (light, _) = see(&foggy(0.1), &stage, down());
    close(light.x, 1.0 - (-1.0f64).exp(), 1e-15);
}

#[test]
fn fog_covers_the_sky_and_no_fog_does_not() {
    let stage = Stage::new(vec![]);
    let up = ray(DVec3::ZERO, DVec3::Y);
    assert_eq!(see(&foggy(1e-9), &stage, up).0, DVec3::ONE);
    assert_eq!(see(&foggy(0.0), &stage, up).0, DVec3::ZERO);
}

// The pipeline

#[test]
fn depth_zero_is_black_behind_a_mirror() {
    let stage = Stage::new(vec![(ground(0.0), mirror(1.0))]);
    let (light, census) = see(&under_sky(1.0, 0), &stage, down());
    assert_eq!((light, census.too_deep), (DVec3::ZERO, 1));
}

#[test]
fn rays_without_an_answer_show_the_sky_and_are_marked() {
    let stage = Stage::new(vec![(Solid::Riddle, black())]);
    let scene = under_sky(0.5, 8);
    let whitted = Whitted::new(&scene, &stage);
    let mut census = Census::default();
    let rays = Rays::from_iter([down()]);
    let outcomes = whitted.first_hits(&rays, &mut census);
    let light = whitted.light(&rays, &outcomes, &mut census);
    assert_eq!(light.radiance.row(0), [0.5; 3]);
    assert_eq!((light.unknown, census.unknown), (vec![true], 1));
}

#[test]
fn features_that_a_scene_lacks_cost_no_rays() {
    let stage = Stage::new(vec![(ground(0.0), matt())]);
    let (_, census) = see(&scene(vec![]), &stage, down());
    assert_eq!(census.shadow + census.reflected + census.refracted, 0);
    let unlit = Stage::new(vec![(ground(0.0), mirror(0.5))]);
    let (_, census) = see(&scene(vec![sun(DVec3::Y)]), &unlit, down());
    assert_eq!((census.shadow, census.reflected), (0, 1));
}

/// Rays over a scene in which every hit sends two rays, and most two shadow rays.
fn crowd(n: usize) -> (fieldstone::scene::Scene, Stage, Vec<Ray>) {
    let glass = Material {
        fresnel: true,
        reflect: number(0.2),
        refract: number(0.8),
        specular: number(0.5),
        shadow: Shadow::Tinted,
        ..clear(1.5)
    };
    let floor = Material {
        reflect: number(0.5),
        ..Material::default()
    };
    let mut scene = under_sky(0.7, 6);
    scene.lights = vec![
        sun(DVec3::new(1.0, 2.0, 3.0)),
        lamp([0.0, 4.0, 0.0], Falloff::InverseSquare),
    ];
    let stage = Stage::new(vec![
        (ground(-1.0), floor),
        (ball([0.0; 3], 1.0), glass.clone()),
        (ball([1.5, 0.0, -1.0], 1.0), glass),
    ]);
    let aim = |i: usize| {
        let (x, y) = ((i % 211) as f64 / 105.0 - 1.0, (i % 97) as f64 / 96.0 - 0.5);
        ray(DVec3::new(0.0, 0.5, 5.0), DVec3::new(x, y, -4.0))
    };
    (scene, stage, (0..n).map(aim).collect())
}

#[test]
fn light_does_not_depend_on_what_is_traced_together() {
    // Enough rays for many batches of each wave.
    let (scene, stage, rays) = crowd(50_000);
    let whitted = Whitted::new(&scene, &stage);
    let light = |rays: &[Ray]| {
        let mut census = Census::default();
        let rays: Rays = rays.iter().collect();
        let outcomes = whitted.first_hits(&rays, &mut census);
        let light = whitted.light(&rays, &outcomes, &mut census).radiance;
        let light: Vec<[f64; 3]> = (0..rays.len()).map(|i| light.row(i)).collect();
        (light, census)
    };
    let (together, all) = light(&rays);
    let mut sum = Census::default();
    for (some, expected) in rays.chunks(777).zip(together.chunks(777)) {
        let (apart, census) = light(some);
        assert_eq!(apart, expected);
        sum += census;
    }
    let counts = |c: Census| (c.primary, c.shadow, c.reflected, c.refracted, c.evaluations);
    assert_eq!(counts(sum), counts(all));
    assert!(all.refracted > 50_000);
}

#[test]
fn light_does_not_depend_on_what_was_seen_before() {
    let light = |k: usize| {
        let (mut scene, _, rays) = crowd(600);
        let painted = |color: DVec3| Material {
            color: Term::Constant(color),
            ..Material::default()
        };
        // The same numbers of the same rays: other colours, more of them in a picture, fog, or nothing but the sky.
        let color = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::X, DVec3::X][k];
        let mut solids = vec![
            (ground(-1.0), painted(color)),
            (ball([0.0; 3], 1.0), mirror(0.5)),
        ];
        if k == 3 {
            scene.fog = foggy(0.1).fog;
        } else if k == 4 {
            solids.clear();
        }
        let stage = Stage::new(solids);
        let whitted = Whitted::new(&scene, &stage);
        let mut census = Census::default();
        let rays: Rays = rays.iter().collect();
        let outcomes = whitted.first_hits(&rays, &mut census);
        let light = whitted.light(&rays, &outcomes, &mut census).radiance;
        (0..rays.len()).map(|i| light.row(i)).collect::<Vec<_>>()
    };
    // Each thread has a memory of its own, which is empty at first.
    let alone: Vec<_> = (0..5)
        .map(|k| std::thread::scope(|scope| scope.spawn(|| light(k)).join().expect("no panic")))
        .collect();
    for k in [0, 1, 0, 2, 3, 0, 3, 4, 1, 4, 2, 2] {
        assert_eq!(light(k), alone[k], "{k}");
    }
    assert!((1..5).all(|k| alone[k] != alone[0]));
}
