//! What a picture must not depend on: what is passed over on the way, and the instructions of the processor.

use fieldstone::field::Level;
use fieldstone::lang::load;
use fieldstone::render::{Channel, Film, RenderOptions, Rendered, render};
use fieldstone::scene::{Method, Scene};
use fieldstone::trace::{SceneTracer, World};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The longer side of pictures, in pixels.
const SIDE: u32 = 72;

/// What is compared.
const CHANNELS: [Channel; 4] = [
    Channel::Beauty,
    Channel::Depth,
    Channel::Normal,
    Channel::Verdict,
];

/// What lines begin with that are meant for another process.
const MARK: &str = "digest: ";

/// All scenes of some folders of the repository, the largest crowd aside.
fn scripts(folders: &[&str]) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let entries = |folder: &&str| std::fs::read_dir(root.join(folder)).expect("a folder");
    let files = folders
        .iter()
        .flat_map(entries)
        .map(|e| e.expect("an entry"));
    let mut found: Vec<PathBuf> = files
        .map(|file| file.path())
        .filter(|path| path.extension().is_some_and(|e| e == "sdf"))
        .filter(|path| path.file_stem().is_some_and(|stem| stem != "s5b"))
        .collect();
    found.sort();
    assert!(found.len() > 8, "only {} scenes", found.len());
    found
}

/// A scene by the default method, made small.
fn small(path: &Path) -> Scene {
    let mut scene = match load(path, &[], &SceneTracer::default()) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{}: {error}", path.display()),
    };
    let settings = &mut scene.settings;
    let longest = settings.size[0].max(settings.size[1]);
    settings.size = settings.size.map(|n| (n * SIDE / longest).max(1));
    settings.samples = settings.samples.min(2);
    settings.method = Method::Auto;
    scene
}

fn picture(scene: &Scene, world: &World) -> Rendered {
    let options = RenderOptions {
        channels: &CHANNELS,
        ..RenderOptions::default()
    };
    render(scene, world, &options)
}

/// Empty blocks, beams and cones that miss a part, leaves that have no say: leaving them out changes no bit.
#[test]
fn pruning_changes_no_picture() {
    let mut evaluations = [0, 0];
    for path in scripts(&["examples", "benches/scenes", "tests/golden"]) {
        let scene = small(&path);
        let world = || World::new(&scene).expect("a world");
        let pruned = picture(&scene, &world());
        let whole = picture(&scene, &world().without_pruning());
        assert!(pruned.film == whole.film, "{}", path.display());
        evaluations[0] += pruned.statistics.evaluations;
        evaluations[1] += whole.statistics.evaluations;
    }
    // Rays that are spared nothing come into more parts.
    assert!(evaluations[1] > evaluations[0], "{evaluations:?}");
}

/// A number from all bits of a film, by FNV-1a.
fn digest(film: &Film) -> u64 {
    let numbers = film.planes().iter().flat_map(|plane| &plane.values);
    numbers.fold(0xcbf2_9ce4_8422_2325, |digest, number| {
        (digest ^ u64::from(number.to_bits())).wrapping_mul(0x0100_0000_01b3)
    })
}

/// What [`processors_change_no_picture`] asks in processes of their own: the instructions are chosen once for each.
#[test]
#[ignore = "is run by another test"]
fn digests() {
    for path in scripts(&["examples", "benches/scenes"]) {
        let scene = small(&path);
        let world = World::new(&scene).expect("a world");
        let digest = digest(&picture(&scene, &world).film);
        println!("{MARK}{} {digest:016x}", path.display());
    }
}

/// The instructions that every processor has, AVX2 and AVX-512, as far as this one has them, make the same pictures, to the bit
/// of each number.
#[test]
fn processors_change_no_picture() {
    let program = std::env::current_exe().expect("this test");
    let digests = |level: &str| {
        let output = Command::new(&program)
            .args(["--exact", "digests", "--ignored", "--nocapture"])
            .env("FIELDSTONE_SIMD", level)
            .output()
            .expect("this test runs");
        assert!(output.status.success(), "{level}");
        let text = String::from_utf8(output.stdout).expect("words");
        let lines = text.lines().filter_map(|line| line.strip_prefix(MARK));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    let [least, rest @ ..] = Level::ALL.map(|(level, _)| digests(level));
    assert!(least.len() > 20, "only {} pictures", least.len());
    rest.iter().for_each(|level| assert_eq!(*level, least));
}
