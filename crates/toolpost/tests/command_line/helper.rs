//! Steps that other processes do: the same bytes, whatever becomes of such a process; and no process that nobody waits for.

use app::helper::Launcher;
use geom::ending::{Ended, Helper, Take};
use geom::region::{Cap, Region};
use geom::{Element, Vec2};
use glass::picture::{self, Manner, Plane, Setting};
use image::{DynamicImage, GrayAlphaImage, ImageFormat, LumaA};
use std::io::{Cursor, Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

const TOOLPOST: &str = env!("CARGO_BIN_EXE_toolpost");

/// A launcher that counts what it has done.
#[derive(Debug)]
struct Counted(Launcher, AtomicUsize);

impl Counted {
    fn by(program: &str, arguments: &[&str]) -> Arc<Counted> {
        let arguments = arguments.iter().map(Into::into);
        Arc::new(Counted(Launcher::new(program, arguments), AtomicUsize::new(0)))
    }

    fn done(&self) -> usize {
        self.1.load(Ordering::Relaxed)
    }
}

impl Helper for Counted {
    fn help(&self, step: &'static str, asked: &[u8], take: &mut Take<'_>) -> bool {
        let is_done = self.0.help(step, asked, take);
        self.1.fetch_add(is_done.into(), Ordering::Relaxed);
        is_done
    }
}

/// Strokes, every other one an arc, at places that a generator of numbers draws: many cross.
fn strokes(count: u32, mut seed: u64) -> Vec<Region> {
    let mut number = || {
        // Knuth's MMIX.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / (1_u64 << 31) as f64
    };
    let stroke = |i: u32| {
        let from = Vec2::new(number(), number()) * f64::from(count).sqrt();
        let center = from + Vec2::new(number() - 0.5, 0.1);
        let sweep = 5.0 * (number() - 0.5);
        let end = center + Vec2::from_angle(sweep).rotate(from - center);
        let arc = Element::arc(from, end, center, sweep);
        let middle = if i.is_multiple_of(2) { arc } else { Element::line(from, end) };
        Region::stroke(&middle, 0.1 + 0.2 * number(), Cap::Round).unwrap()
    };
    (0..count).map(stroke).collect()
}

#[test]
fn a_helper_unites_subtracts_and_offsets_to_the_same_bits() {
    let helper = Counted::by(TOOLPOST, &["helper"]);
    let work = Ended::default().with_helper(Some(helper.clone()));
    for seed in 0..4 {
        let (first, second) = (strokes(900, seed), strokes(700, seed + 100));
        let made = || {
            let all = Region::union_of(&first).unwrap();
            let other = Region::union_of(&second).unwrap();
            [all.offset(0.05), all.difference(&other), all.xor(&other)]
                .map(|region| format!("{:?}", region.unwrap()))
        };
        assert!(work.run(made).unwrap() == made(), "{seed}");
    }
    // What is done to the smaller ones is not long.
    assert!(helper.done() >= 12, "{}", helper.done());
}

fn setting(invert: bool) -> Setting {
    let (manner, sheets) = (Manner::Dither, (1, None));
    Setting { plane: Plane::Xz, width: None, manner, invert, sheets }
}

/// A picture of 720,000 pixels.
fn picture(format: ImageFormat) -> Vec<u8> {
    let pixel = |x: u32, y: u32| LumaA([(x * y + x) as u8, (x + y) as u8]);
    let picture = DynamicImage::from(GrayAlphaImage::from_fn(900, 800, pixel));
    let mut bytes = Cursor::new(Vec::new());
    let picture = if format == ImageFormat::Png { picture } else { picture.to_rgb8().into() };
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

#[test]
fn a_helper_decodes_pictures_to_the_same_bits_and_says_the_same_of_those_that_are_none() {
    let helper = Counted::by(TOOLPOST, &["helper"]);
    let work = Ended::default().with_helper(Some(helper.clone()));
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Bmp] {
        let bytes = picture(format);
        for (count, invert) in [(bytes.len(), false), (bytes.len(), true), (bytes.len() / 2, true)]
        {
            let read = || format!("{:?}", picture::read(&bytes[..count], setting(invert), "a.png"));
            assert!(work.run(read).unwrap() == read(), "{format:?} {invert} {count}");
        }
    }
    assert_eq!(helper.done(), 9);
}

#[test]
fn what_no_helper_does_is_done_here() {
    let first = strokes(900, 7);
    let here = format!("{:?}", Region::union_of(&first).unwrap());
    let bytes = picture(ImageFormat::Jpeg);
    let decoded = format!("{:?}", picture::read(&bytes, setting(false), "a.jpg").unwrap());
    let missing = "/nonexistent/toolpost";
    // None, one that ends at once, one that answers what it is asked, one that never ends its answer, the wrong command.
    for (program, arguments) in [
        (missing, &[][..]),
        ("true", &[]),
        ("cat", &[]),
        ("yes", &[]),
        (TOOLPOST, &["machines", "list"]),
    ] {
        let helper = Counted::by(program, arguments);
        let work = Ended::default().with_helper(Some(helper.clone()));
        let made = work.run(|| format!("{:?}", Region::union_of(&first).unwrap())).unwrap();
        assert!(made == here, "{program}");
        let made = work.run(|| picture::read(&bytes, setting(false), "a.jpg").unwrap());
        assert!(format!("{:?}", made.unwrap()) == decoded, "{program}");
        assert_eq!(helper.done(), 0, "{program}");
    }
}

/// Waits until something is so.
fn wait(what: &str, is_so: impl Fn() -> bool) -> Duration {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(60), "{what}");
        thread::sleep(Duration::from_millis(1));
    }
    begun.elapsed()
}

/// A helper that first notes its number, and keeps what it is asked.
#[cfg(unix)]
fn noted(folder: &Path) -> Arc<Counted> {
    let script = format!(
        "echo $$ > {folder}/new; mv {folder}/new {folder}/number; exec {TOOLPOST} helper",
        folder = folder.display()
    );
    Counted::by("sh", &["-c", &script])
}

/// A tangle that is united for some seconds.
#[cfg(unix)]
fn tangle() -> Vec<Region> {
    let stroke = |i: i32| {
        let at = f64::from(i % 500);
        let (from, to) = (Vec2::new(at, -1.0), Vec2::new(at, 501.0));
        let turned = |place: Vec2| if i < 500 { place } else { Vec2::new(place.y, place.x) };
        Region::stroke(&Element::line(turned(from), turned(to)), 0.1, Cap::Square).unwrap()
    };
    (0..1000).map(stroke).collect()
}

#[cfg(unix)]
#[test]
fn a_helper_is_killed_when_the_work_is_ended() {
    let folder = tempfile::tempdir().unwrap();
    let ended = Ended::default();
    let work = ended.with_helper(Some(noted(folder.path())));
    let number = folder.path().join("number");
    thread::scope(|scope| {
        let made = scope.spawn(|| work.run(|| Region::union_of(&tangle()).unwrap()).is_none());
        wait("no helper", || number.is_file());
        thread::sleep(Duration::from_millis(50));
        ended.end();
        let begun = Instant::now();
        assert!(made.join().unwrap());
        assert!(begun.elapsed() < Duration::from_secs(1), "{:?}", begun.elapsed());
    });
    // It is waited for, so that nothing of it is left.
    let number = std::fs::read_to_string(number).unwrap();
    assert!(!is_there(number.trim()));
}

/// Whether there is a process of this number.
#[cfg(unix)]
fn is_there(number: &str) -> bool {
    let kill = Command::new("kill").args(["-0", number]).stderr(Stdio::null()).status();
    kill.unwrap().success()
}

/// What a helper is asked to unite a tangle.
#[cfg(unix)]
fn asked() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("asked");
    let ended = Ended::default();
    // The shell keeps the way of the answer open.
    let script = format!("cat > {}; :", path.display());
    let work = ended.with_helper(Some(Counted::by("sh", &["-c", &script])));
    thread::scope(|scope| {
        scope.spawn(|| work.run(|| Region::union_of(&tangle()).unwrap()));
        // It ends with a block of no bytes.
        let is_all = || {
            let bytes = std::fs::read(&path).unwrap_or_default();
            bytes.len() > 8 && bytes[bytes.len() - 8..].starts_with(&[0; 4])
        };
        wait("nothing is asked", is_all);
        ended.end();
    });
    std::fs::read(path).unwrap()
}

#[cfg(unix)]
#[test]
fn a_helper_ends_with_who_has_asked_and_refuses_what_is_damaged() {
    let helper = || {
        let mut command = Command::new(TOOLPOST);
        let command = command.arg("helper").stdin(Stdio::piped()).stdout(Stdio::piped());
        command.stderr(Stdio::piped()).spawn().unwrap()
    };
    let asked = asked();
    // Whoever has asked says nothing more: the helper goes on until the pipe is closed.
    let mut child = helper();
    let mut pipe = child.stdin.take().unwrap();
    pipe.write_all(&asked).unwrap();
    thread::sleep(Duration::from_millis(100));
    assert_eq!(child.try_wait().unwrap(), None, "too fast for this test");
    drop(pipe);
    let begun = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(begun.elapsed() < Duration::from_secs(1), "{:?}", begun.elapsed());
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
    // It refuses what is damaged or cut off, more than one step, and another version.
    let mut damaged = asked.clone();
    damaged[asked.len() / 2] ^= 4;
    let other = [&[9, 0, 0, 0][..], &0xCBF4_3926_u32.to_le_bytes(), b"123456789"].concat();
    let twice = [&asked[..], &asked].concat();
    let noise: Vec<u8> = (0..100_000_u32).map(|i| (i.wrapping_mul(i) >> 7) as u8).collect();
    let cut = &asked[..asked.len() - 1];
    for bytes in [&damaged[..], &other, &twice, &noise, cut, &[]] {
        let mut child = helper();
        let mut pipe = child.stdin.take().unwrap();
        // It may be gone before it has read all.
        let _ = pipe.write_all(bytes);
        let begun = Instant::now();
        let is_cut = bytes.len() < asked.len();
        let held = if is_cut {
            drop(pipe);
            None
        } else {
            Some(pipe)
        };
        let mut said = Vec::new();
        child.stdout.take().unwrap().read_to_end(&mut said).unwrap();
        child.stderr.take().unwrap().read_to_end(&mut said).unwrap();
        assert_eq!((child.wait().unwrap().code(), said.len()), (Some(1), 0));
        assert!(begun.elapsed() < Duration::from_secs(1), "{:?}", begun.elapsed());
        drop(held);
    }
}
