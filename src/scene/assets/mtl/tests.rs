use super::maps::parse;
use super::*;
use crate::diag::SourceId;
use crate::scene::assets::Loader;
use crate::scene::{Fresnel, PatternKind, Rgb, Texture};
use std::collections::BTreeMap;
use std::io;

const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };

/// Files in memory.
struct Memory(BTreeMap<PathBuf, Vec<u8>>);

impl Loader for Memory {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.0.get(path).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
    }
    fn exists(&self, path: &Path) -> bool {
        self.0.contains_key(path)
    }
    fn list(&self, folder: &Path) -> Vec<String> {
        let here = self.0.keys().filter(|p| p.parent() == Some(folder));
        here.filter_map(|p| Some(p.file_name()?.to_str()?.to_owned())).collect()
    }
}

fn png(rgba: [u8; 4]) -> Vec<u8> {
    let mut bytes = io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(1, 1, image::Rgba(rgba))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

fn load_from(files: &[(&str, &[u8])], libraries: &[&str], names: &[&str]) -> Found {
    let files = files.iter().map(|(name, bytes)| (PathBuf::from(name), bytes.to_vec())).collect();
    let memory = Memory(files);
    load(&AssetCache::new(&memory), Path::new("m/a.obj"), libraries, names, SPAN)
}

fn only(text: &str) -> Material {
    let found = load_from(&[("m/a.mtl", text.as_bytes())], &["a.mtl"], &["a"]);
    assert_eq!(found.warning, None);
    found.materials[0].as_ref().clone()
}

fn constant(texture: &Texture) -> Rgb {
    match texture {
        Texture::Constant(c) => *c,
        Texture::Pattern(_) => panic!("a constant was expected"),
    }
}

#[test]
fn options_come_off_map_names() {
    let map = parse("-bm 3 normal map.jpg");
    assert_eq!((map.name, map.bump), ("normal map.jpg", 3.0));
    let map = parse("-o 0.5 -s 2 3 1 -clamp on -blendu off wood.png");
    assert_eq!((map.name, map.clamp), ("wood.png", true));
    assert_eq!((map.offset, map.scale), ([0.5, 0.0], [2.0, 3.0]));
    assert_eq!(parse("-mm 0.1 0.9 2.png").name, "2.png");
    assert_eq!(parse("plain.png").name, "plain.png");
    assert_eq!(parse("-bm").name, "");
}

#[test]
fn a_line_that_tobj_would_refuse_costs_only_itself() {
    let text =
        "newmtl a\nKd spectral x.rfl\nKs 0.5\nNs many\nillum 2 # shiny\nd -halo 0.25\nmap_Kd\nNi nan\nNs 10";
    let made = only(text);
    assert_eq!(constant(&made.diffuse), Rgb::splat(0.8) / 1.3);
    assert_eq!(constant(&made.layers().opacity), Rgb::splat(0.25));
    assert_eq!(constant(&made.layers().ior), Rgb::splat(1.5));
}

#[test]
fn no_material_returns_more_light_than_it_gets() {
    let made = only("newmtl a\nKd 0.9 0.5 0\nKs 0.9 0.5 0.5\nNs 40");
    let sum = constant(&made.diffuse) + constant(&made.layers().specular);
    assert!(sum.max_element() <= 1.0 + f64::EPSILON, "{sum}");
    let ratio = constant(&made.diffuse).x / constant(&made.layers().specular).x;
    assert!((ratio - 1.0).abs() < 1e-15);
}

#[test]
fn models_of_illumination_are_mirror_and_glass() {
    let mirror = only("newmtl a\nKd 0 0 0\nKs 0.95 0.95 0.95\nillum 5");
    assert_eq!(constant(&mirror.layers().reflect), Rgb::splat(0.95));
    assert_eq!(mirror.layers().fresnel, Fresnel::Schlick);
    let glass = only("newmtl a\nKd 0.1 0.1 0.1\nKs 0.3 0.3 0.3\nNi 2.5\nillum 7");
    assert_eq!(constant(&glass.layers().transmit), Rgb::ONE);
    assert_eq!(constant(&glass.layers().ior), Rgb::splat(2.5));
    assert_eq!(constant(&glass.diffuse), Rgb::ZERO);
    assert_eq!(glass.layers().fresnel, Fresnel::Exact);
}

#[test]
fn d_wins_over_tr_and_tr_means_its_complement() {
    assert_eq!(constant(&only("newmtl a\nTr 0.25").layers().opacity), Rgb::splat(0.75));
    assert_eq!(constant(&only("newmtl a\nd 1\nTr 1").layers().opacity), Rgb::ONE);
}

#[test]
fn metals_and_emitters_are_kept() {
    let metal = only("newmtl a\nKd 0.9 0.6 0.2\nPm 1\nPr 0.5\nKe 2 0 0");
    assert_eq!(constant(&metal.layers().metal), Rgb::new(0.9, 0.6, 0.2));
    assert_eq!(constant(&metal.diffuse), Rgb::ZERO);
    assert_eq!(constant(&metal.layers().roughness), Rgb::splat(0.25));
    assert_eq!(constant(&metal.layers().emit), Rgb::new(2.0, 0.0, 0.0));
}

#[test]
fn a_picture_with_alpha_cuts_out_what_it_shows() {
    let text = b"newmtl a\nmap_Kd c:\\textures\\LEAF.png";
    let see_through = png([10, 20, 30, 0]);
    let found = load_from(&[("m/A.MTL", text), ("m/leaf.png", &see_through)], &["a.mtl"], &["A"]);
    assert_eq!(found.warning, None);
    let Texture::Pattern(opacity) = &found.materials[0].layers().opacity else { panic!("no pattern") };
    let PatternKind::Image(picture) = &opacity.kind else { panic!("no picture") };
    assert_eq!(
        picture.picture.get().unwrap().texel(0, 0, crate::scene::assets::image::Reading::Data)[3],
        0.0
    );
}

#[test]
fn what_is_missing_is_said_once_for_all() {
    let text = b"newmtl a\nmap_Kd gone.png\nnewmtl b\nmap_Kd gone.png";
    let found = load_from(&[("m/b.mtl", text)], &["lost.mtl", "b.mtl other\\ name.mtl"], &["a", "b", "c"]);
    let message = found.warning.unwrap().message;
    for part in ["`lost.mtl`", "`other name.mtl`", "`gone.png`", "`c`"] {
        assert_eq!(message.matches(part).count(), 1, "{message}");
    }
    assert_eq!(found.index_of_name, [0, 1, UNKNOWN]);
}
