//! Pictures as people have them: decoded to the numbers that their files mean, missing ones said at their name.

use ogee::diag::{Code, SourceId, Span};
use ogee::math::colour::srgb_decode;
use ogee::scene::assets::image::{Image, Reading};
use ogee::scene::assets::{AssetCache, DiskLoader, Loader};
use ogee::scene::{Filter, ImagePattern, Material, Pattern, PatternKind, Texture, Wrap};
use ogee::world::texture::{TexturePoint, colour, load_pictures};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const SPAN: Span = Span { source: SourceId(0), start: 3, end: 9 };

/// The folder of test data; none, said aloud, where it is not given.
#[expect(clippy::print_stdout, reason = "a skipped test says so")]
fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("OGEE_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: OGEE_DATA does not name the folder of test data");
    }
    folder
}

fn picture(path: &Path) -> Arc<Image> {
    AssetCache::new(&DiskLoader).image(path).expect("a picture of the data")
}

fn diffuse(path: &Path) -> Material {
    let image = ImagePattern {
        path: path.to_owned(),
        wrap: Wrap::Repeat,
        filter: Filter::Nearest,
        colour: true,
        span: SPAN,
        picture: Default::default(),
    };
    let pattern = Pattern { kind: PatternKind::Image(image), transform: None, span: SPAN };
    Material { diffuse: Texture::Pattern(Arc::new(pattern)), layers: None, span: SPAN }
}

#[test]
fn pictures_of_every_depth_are_decoded() {
    let Some(folder) = data() else { return };
    let size = |name: &str| {
        let image = picture(&folder.join(name));
        (image.width(), image.height(), image.is_transparent())
    };
    assert_eq!(size("meshes/teapot-mcguire/default.png"), (128, 128, false));
    assert_eq!(size("meshes/scrub-pine/LushPine.png"), (512, 512, true));
    assert_eq!(size("meshes/scrub-pine/Piney.jpg"), (383, 400, false));
    assert_eq!(size("textures/MetalPlates006_Roughness.png"), (1024, 1024, false));
    assert_eq!(size("hdr/constant.hdr"), (60, 40, false));
    assert!(picture(&folder.join("textures/MetalPlates006_Normal.png")).looks_like_normals());
    assert!(!picture(&folder.join("textures/MetalPlates006_Color.png")).looks_like_normals());
    assert!(!picture(&folder.join("textures/Wood047_Color.png")).looks_like_normals());
}

#[test]
fn a_one_bit_palette_gives_its_colours_and_not_its_indices() {
    let Some(folder) = data() else { return };
    let image = picture(&folder.join("meshes/teapot-mcguire/default.png"));
    let seen: Vec<[f64; 4]> = (0..128).map(|x| image.texel(x, x, Reading::Data)).collect();
    assert!(seen.iter().any(|t| t[0] > 0.5), "{:?}", seen[0]);
}

#[test]
fn light_of_a_constant_environment_is_one_everywhere() {
    let Some(folder) = data() else { return };
    let image = picture(&folder.join("hdr/constant.hdr"));
    for (x, y) in [(0, 0), (59, 39), (31, 7)] {
        assert_eq!(image.texel(x, y, Reading::Colour), [1.0; 4]);
    }
    let bright = picture(&folder.join("hdr/venice_sunset_1k.hdr"));
    let texels = (0..512).flat_map(|y| (0..1024).map(move |x| (x, y)));
    let most = texels.map(|(x, y)| bright.texel(x, y, Reading::Colour)[0]).fold(0.0, f64::max);
    assert!((6000.0..7000.0).contains(&most), "{most}");
}

/// Counts what is read.
struct Counting(AtomicUsize);

impl Loader for Counting {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        self.0.fetch_add(1, Ordering::Relaxed);
        DiskLoader.read(path)
    }
    fn exists(&self, path: &Path) -> bool {
        DiskLoader.exists(path)
    }
}

fn two_texels(folder: &Path) -> PathBuf {
    let path = folder.join("two.png");
    let rows =
        image::RgbImage::from_fn(
            1,
            2,
            |_, y| if y == 0 { image::Rgb([255; 3]) } else { image::Rgb([128, 0, 0]) },
        );
    rows.save(&path).expect("a picture for the test");
    path
}

#[test]
fn many_materials_of_one_picture_read_it_once_and_from_below() {
    let folder = tempfile::tempdir().unwrap();
    let path = two_texels(folder.path());
    let materials: Vec<Material> = (0..50).map(|_| diffuse(&path)).collect();
    let loader = Counting(AtomicUsize::new(0));
    let cache = AssetCache::new(&loader);
    assert!(load_pictures(&materials, &cache).is_empty());
    assert_eq!(loader.0.load(Ordering::Relaxed), 1);
    let at = |v| TexturePoint { uv: glam::DVec2::new(0.5, v).into(), ..TexturePoint::default() };
    let bottom = colour(&materials[49].diffuse, &at(0.25)).unwrap();
    assert_eq!(bottom.to_array(), [srgb_decode(128.0 / 255.0), 0.0, 0.0]);
    assert_eq!(colour(&materials[0].diffuse, &at(0.75)).unwrap().to_array(), [1.0; 3]);
}

#[test]
fn threads_that_ask_at_once_share_one_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = two_texels(folder.path());
    let loader = Counting(AtomicUsize::new(0));
    let cache = AssetCache::new(&loader);
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| cache.image(&path).expect("the picture"));
        }
    });
    assert_eq!(loader.0.load(Ordering::Relaxed), 1);
}

#[test]
fn a_picture_that_cannot_be_had_is_said_at_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.png");
    std::fs::write(&broken, b"\x89PNG\r\n\x1a\nand nothing more").unwrap();
    for (path, code) in [(folder.path().join("lost.png"), Code::FileNotFound), (broken, Code::BadImage)] {
        let cache = AssetCache::new(&DiskLoader);
        let materials = [diffuse(&path), diffuse(&path)];
        let faults = load_pictures(&materials, &cache);
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!((faults[0].code, faults[0].span), (code, Some(SPAN)));
        assert!(colour(&materials[0].diffuse, &TexturePoint::default()).is_err());
    }
}
