//! References are slow, so what they say of a scene is kept on the disk.
//!
//! The name of a file is a hash of all that its content depends on: the scene in full, what was asked for, and the
//! program, by the bytes of its executable file; so another program never reads it. Its content counts only if the hash of both,
//! which stands before it, is right. Whatever goes wrong here costs time and nothing else.

use crate::output;
use crate::render::Truth;
use crate::scene::{Fault, Scene};
use std::ffi::OsString;
use std::fmt;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::SystemTime;

/// The variable that says where references are kept; `off` for nowhere.
const VARIABLE: &str = "FIELDSTONE_CACHE";

/// How the files end.
const ENDING: &str = "reference";

/// How many bytes are kept at most; what was not used for longest goes first.
const MOST_BYTES: u64 = 256 << 20;

/// As [`Truth::of`], from the disk if it is known there.
///
/// # Errors
/// As [`Truth::of`].
pub fn truth(scene: &Scene, wants_picture: bool) -> Result<Truth, Fault> {
    let folder = folder(|name| std::env::var_os(name));
    let (Some(folder), Some(program)) = (folder, program()) else {
        return Truth::of(scene, wants_picture);
    };
    let key = key(scene, wants_picture, program);
    let path = folder.join(format!("{key:032x}.{ENDING}"));
    if let Some(truth) = kept(&path, key) {
        return Ok(truth);
    }
    let truth = Truth::of(scene, wants_picture)?;
    keep(&path, key, &truth.to_bytes());
    Ok(truth)
}

/// Where references are kept, by the environment; none for nowhere.
fn folder(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let given = |name: &str| variable(name).filter(|value| !value.is_empty());
    if let Some(chosen) = given(VARIABLE) {
        return (chosen != "off").then(|| chosen.into());
    }
    // Source: XDG base directory specification; on Windows, local data.
    let home = || given("HOME").map(|home| PathBuf::from(home).join(".cache"));
    let standard = ["XDG_CACHE_HOME", "LOCALAPPDATA"]
        .into_iter()
        .find_map(given);
    let folder = standard.map(PathBuf::from).or_else(home)?;
    // A relative path would depend on where the command is called.
    folder.is_absolute().then(|| folder.join("fieldstone"))
}

/// The hash of this program's file.
fn program() -> Option<u128> {
    static PROGRAM: OnceLock<Option<u128>> = OnceLock::new();
    *PROGRAM.get_or_init(|| {
        let bytes = fs::read(std::env::current_exe().ok()?).ok()?;
        Some(hash(&bytes))
    })
}

/// Two hashes of 64 bits with different starts, as one number.
#[derive(Default)]
struct Hash([DefaultHasher; 2]);

impl Hash {
    fn new() -> Self {
        let mut hash = Self::default();
        hash.0[1].write_u8(1);
        hash
    }

    fn write(&mut self, bytes: &[u8]) {
        self.0.iter_mut().for_each(|half| half.write(bytes));
    }

    fn value(&self) -> u128 {
        let [a, b] = self.0.each_ref().map(|half| u128::from(half.finish()));
        a << 64 | b
    }
}

impl fmt::Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.write(text.as_bytes());
        Ok(())
    }
}

fn hash(bytes: &[u8]) -> u128 {
    let mut hash = Hash::new();
    hash.write(bytes);
    hash.value()
}

fn key(scene: &Scene, wants_picture: bool, program: u128) -> u128 {
    let mut hash = Hash::new();
    hash.write(&program.to_le_bytes());
    hash.write(&[u8::from(wants_picture)]);
    scene.describe(&mut hash).expect("a hash takes everything");
    hash.value()
}

/// The hash that stands before the content of a file.
fn seal(key: u128, content: &[u8]) -> [u8; 16] {
    let mut hash = Hash::new();
    hash.write(&key.to_le_bytes());
    hash.write(content);
    hash.value().to_le_bytes()
}

/// What is kept in this file for `key`, if it is whole.
fn kept(path: &Path, key: u128) -> Option<Truth> {
    let bytes = fs::read(path).ok()?;
    let (head, content) = bytes.split_first_chunk::<16>()?;
    if *head != seal(key, content) {
        return None;
    }
    let truth = Truth::from_bytes(content)?;
    // It was used now, so it goes later.
    let _ = File::options()
        .append(true)
        .open(path)
        .and_then(|file| file.set_modified(SystemTime::now()));
    Some(truth)
}

/// Keeps this content for `key`, and makes room for it. Where that is impossible, nothing is kept.
fn keep(path: &Path, key: u128, content: &[u8]) {
    let is_small = content.len() as u64 <= MOST_BYTES / 4;
    if let Some(folder) = path.parent().filter(|_| is_small)
        && fs::create_dir_all(folder).is_ok()
    {
        let _ = output::write(path, &[&seal(key, content), content].concat());
        make_room(folder, MOST_BYTES);
    }
}

/// Removes references, the longest unused first, until the others have no more than so many bytes.
fn make_room(folder: &Path, most: u64) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    let mut files: Vec<(SystemTime, u64, PathBuf)> = entries
        .flatten()
        .filter(|entry| entry.path().extension().is_some_and(|e| e == ENDING))
        .filter_map(|entry| {
            let data = entry.metadata().ok()?;
            Some((data.modified().ok()?, data.len(), entry.path()))
        })
        .collect();
    files.sort();
    let mut bytes: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
    for (_, length, path) in files {
        if bytes <= most {
            return;
        }
        let _ = fs::remove_file(path);
        bytes -= length;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyPrimitive, Sphere};
    use crate::scene::{Node, Settings};
    use std::time::Duration;

    fn scene(radius: f64) -> Scene {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(radius))).unwrap();
        Scene {
            shown: vec![ball],
            settings: Settings {
                size: [5, 4],
                ..Settings::default()
            },
            ..Scene::default()
        }
    }

    /// A folder that goes away again.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let name = format!("fieldstone-cache-{name}-{}", std::process::id());
            let path = std::env::temp_dir().join(name);
            let _ = fs::remove_dir_all(&path);
            Self(path)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn the_environment_says_where() {
        let of = |pairs: &[(&str, &str)]| {
            let pairs: Vec<(String, OsString)> = pairs
                .iter()
                .map(|(name, value)| ((*name).into(), (*value).into()))
                .collect();
            folder(move |name| {
                let found = pairs.iter().find(|(known, _)| known == name);
                found.map(|(_, value)| value.clone())
            })
        };
        assert_eq!(of(&[("HOME", "/h")]), Some("/h/.cache/fieldstone".into()));
        let both = [("HOME", "/h"), ("XDG_CACHE_HOME", "/c")];
        assert_eq!(of(&both), Some("/c/fieldstone".into()));
        assert_eq!(of(&[("HOME", "/h"), (VARIABLE, "/x")]), Some("/x".into()));
        assert_eq!(of(&[("HOME", "/h"), (VARIABLE, "off")]), None);
        assert_eq!(of(&[("XDG_CACHE_HOME", "relative")]), None);
        assert_eq!(of(&[]), None);
    }

    #[test]
    fn keys_differ_by_scene_question_and_program() {
        let plain = key(&scene(1.0), false, 1);
        assert_eq!(plain, key(&scene(1.0), false, 1));
        let others = [
            key(&scene(1.0f64.next_up()), false, 1),
            key(&scene(1.0), true, 1),
            key(&scene(1.0), false, 2),
        ];
        assert!(!others.contains(&plain));
    }

    #[test]
    fn what_is_damaged_or_foreign_is_not_trusted() {
        let folder = Folder::new("damaged");
        let path = folder.0.join("a.reference");
        let truth = Truth::of(&scene(1.0), false).unwrap();
        keep(&path, 7, &truth.to_bytes());
        let whole = fs::read(&path).unwrap();
        let found = kept(&path, 7).expect("it is whole");
        assert_eq!(found.hits().outcomes, truth.hits().outcomes);
        assert!(kept(&path, 8).is_none(), "that of another scene");
        for place in [0, 15, 16, whole.len() / 2, whole.len() - 1] {
            let mut bytes = whole.clone();
            bytes[place] ^= 1;
            fs::write(&path, bytes).unwrap();
            assert!(kept(&path, 7).is_none(), "byte {place}");
        }
        fs::write(&path, &whole[..whole.len() - 1]).unwrap();
        assert!(kept(&path, 7).is_none());
        fs::write(&path, "not ours").unwrap();
        assert!(kept(&path, 7).is_none());
        assert!(kept(&folder.0.join("b.reference"), 7).is_none());
    }

    #[test]
    fn room_is_made_by_age() {
        let folder = Folder::new("room");
        fs::create_dir_all(&folder.0).unwrap();
        for (age, name) in [
            (3, "a.reference"),
            (2, "b.reference"),
            (1, "c.reference"),
            (9, "d.txt"),
        ] {
            let path = folder.0.join(name);
            fs::write(&path, [0; 100]).unwrap();
            let then = SystemTime::now() - Duration::from_secs(60 * age);
            File::options()
                .append(true)
                .open(&path)
                .unwrap()
                .set_modified(then)
                .unwrap();
        }
        make_room(&folder.0, 200);
        let mut left: Vec<String> = fs::read_dir(&folder.0)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        assert_eq!(left, ["b.reference", "c.reference", "d.txt"]);
    }
}
