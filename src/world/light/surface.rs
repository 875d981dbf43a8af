//! Surfaces that emit, as lights: a sphere by the solid angle it fills, everything else by area.
//!
//! A flat surface and a mesh emit from the side that their normal leaves. A closed solid emits from both, so that a point
//! inside a glowing sphere is lit. Of a surface that is there only in part, that part emits; a closed solid then shows its far side too.

use super::emission::{Departure, sphere};
use super::pieces::{Curved, Piece, PiecePoint, sphere_uv};
use super::reach::Extent;
use super::{LightEnd, LightSample, SurfacePoint, cosine_hemisphere, frame, to_frame};
use crate::geometry::mesh::Mesh;
use crate::math::Affine;
use crate::math::elementary::sin_cos_turns;
use crate::math::error::gamma;
use crate::scene::{Cone, Rgb, Texture};
use crate::world::emitter::{Emitter, EmitterShape};
use crate::world::shape::{Uv, upright};
use crate::world::texture::{self, Sampled, TexturePoint};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A surface that emits.
#[derive(Debug)]
pub struct AreaLight {
    form: Form,
    extent: Extent,
    emission: Texture,
    opacity: Texture,
    local_from_world: Affine,
}

#[derive(Debug)]
enum Form {
    /// A sphere that is one in the world.
    Sphere { center: DVec3, radius: f64 },
    /// Pieces, the sums of their weights up to each (the last is the total), whether all are flat, and how to tell inside from outside.
    Pieces { pieces: Vec<Piece>, sums: Vec<f64>, flat: bool, solid: Option<Solid> },
}

/// A closed surface, by its inside in its own space.
#[derive(Clone, Debug)]
enum Solid {
    Sphere { center: DVec3, radius: f64 },
    Box(DVec3, DVec3),
    Cone(Cone),
    Torus(crate::scene::Torus),
}

impl AreaLight {
    /// An emitter as a light. None where it has no area or emits nothing anywhere.
    pub fn new(emitter: &Emitter) -> Option<AreaLight> {
        let layers = emitter.material.layers();
        if layers.emit.is(Rgb::ZERO) || layers.opacity.is(Rgb::ZERO) {
            return None;
        }
        let form = form_of(emitter)?;
        Some(AreaLight {
            extent: extent_of(&form),
            form,
            emission: layers.emit.clone(),
            opacity: layers.opacity.clone(),
            local_from_world: emitter.world_from_local.inverse(),
        })
    }

    /// Light toward a point from a point of the surface chosen by u. `normal` is the receiver's, on the side that is lit; `dimming` is
    /// what a distance leaves of the radiance.
    #[inline]
    pub(super) fn sample(
        &self,
        at: DVec3,
        normal: DVec3,
        u: DVec2,
        dimming: impl Fn(f64) -> f64,
    ) -> Option<LightSample> {
        match &self.form {
            Form::Sphere { center, radius } => self.by_sphere(at, normal, (*center, *radius), u, dimming),
            Form::Pieces { pieces, sums, solid, .. } => {
                let (piece, share, u) = choose(pieces, sums, u);
                let shown = match solid {
                    Some(_) if !self.opacity.is(Rgb::ONE) => Shown::Both,
                    Some(solid) if solid.contains(self.local_from_world.point(at)) => Shown::Inner,
                    _ => Shown::Outer,
                };
                self.by_piece(at, piece.point(u), share, shown, dimming)
            }
        }
    }

    /// Whether the density of a choice is known where a ray meets the surface: not of curved pieces.
    #[inline]
    pub(super) fn knows_density(&self) -> bool {
        match &self.form {
            Form::Sphere { .. } => true,
            Form::Pieces { flat, .. } => *flat,
        }
    }

    /// Density per solid angle of [`AreaLight::sample`] toward a point of the surface. None for curved pieces, whose
    /// density at a point is not known.
    pub(super) fn density(&self, at: DVec3, normal: DVec3, wi: DVec3, met: &SurfacePoint) -> Option<f64> {
        match &self.form {
            Form::Sphere { center, radius } => Some(match side(*center, *radius, at, normal) {
                Side::Outside(sin2) => 1.0 / (TAU * gap(sin2)),
                Side::Inside => wi.dot(normal).max(0.0) / PI,
                Side::Itself => 0.0,
            }),
            Form::Pieces { sums, flat, .. } => {
                let cosine = wi.dot(met.normal).abs();
                flat.then(|| (met.point - at).length_squared() / (cosine * sums[sums.len() - 1]))
            }
        }
    }

    /// A point chosen by u from which light leaves.
    pub(super) fn departure(&self, u: DVec2) -> Option<Departure> {
        let (at, uv, area, closed) = match &self.form {
            Form::Sphere { center, radius } => {
                let normal = sphere(u);
                let error = (center.abs() + DVec3::splat(*radius)) * gamma(12);
                let at = SurfacePoint { point: *center + normal * *radius, error, normal };
                (at, sphere_uv(self.local_from_world.vector(normal)), 4.0 * PI * radius * radius, true)
            }
            Form::Pieces { pieces, sums, solid, .. } => {
                let (piece, share, u) = choose(pieces, sums, u);
                let chosen = piece.point(u);
                (chosen.at, chosen.uv, chosen.area / share, solid.is_some())
            }
        };
        (area > 0.0 && area.is_finite()).then_some((at, uv, area, closed))
    }

    /// Its area, roughly where it is curved.
    pub(super) fn area(&self) -> f64 {
        match &self.form {
            Form::Sphere { radius, .. } => 4.0 * PI * radius * radius,
            Form::Pieces { sums, .. } => sums[sums.len() - 1],
        }
    }

    /// As it is seen from afar.
    pub(super) fn extent(&self) -> &Extent {
        &self.extent
    }

    /// Its radiance, less what is not there of it; patterns count as 1.
    pub(super) fn typical(&self) -> Rgb {
        let of = |texture: &Texture| match texture {
            Texture::Constant(value) => *value,
            Texture::Pattern(_) => Rgb::ONE,
        };
        of(&self.emission) * of(&self.opacity)
    }

    #[inline]
    fn by_piece(
        &self,
        at: DVec3,
        chosen: PiecePoint,
        share: f64,
        shown: Shown,
        dimming: impl Fn(f64) -> f64,
    ) -> Option<LightSample> {
        let to = chosen.at.point - at;
        let squared = to.length_squared();
        let distance = squared.sqrt();
        let wi = to / distance;
        let facing = chosen.at.normal.dot(wi);
        let cosine = match shown {
            Shown::Outer => -facing,
            Shown::Inner => facing,
            Shown::Both => facing.abs(),
        };
        if !(cosine > 0.0 && wi.is_finite()) {
            return None;
        }
        let solid_angle = cosine * chosen.area / (share * squared);
        let weight = self.emitted(&chosen.at, chosen.uv.into(), distance) * (solid_angle * dimming(distance));
        let (pdf, end) = (Some(1.0 / solid_angle), LightEnd::Surface(chosen.at));
        weight.is_finite().then_some(LightSample { wi, weight, pdf, end })
    }

    /// From outside by the solid angle that the sphere fills, written so that it keeps its digits however small the sphere
    /// (Pharr, Jakob & Humphreys §6.2.4); from inside, where every direction ends on it, by the cosine law.
    fn by_sphere(
        &self,
        at: DVec3,
        normal: DVec3,
        (center, radius): (DVec3, f64),
        u: DVec2,
        dimming: impl Fn(f64) -> f64,
    ) -> Option<LightSample> {
        let to = center - at;
        let squared = to.length_squared();
        let side = side(center, radius, at, normal);
        let (wi, pdf, distance) = if let Side::Outside(sin2) = side {
            let gap = gap(sin2);
            let x = gap * u.x; // 1 − cos of the angle from the axis
            let (s, c) = sin_cos_turns(u.y);
            let sine2 = x * (2.0 - x);
            let r = sine2.sqrt();
            let away = squared.sqrt();
            let wi = to_frame(to / away, DVec3::new(r * c, r * s, 1.0 - x));
            let half_chord = (radius * radius - squared * sine2).max(0.0).sqrt();
            (wi, 1.0 / (TAU * gap), away * (1.0 - x) - half_chord)
        } else if side == Side::Itself {
            return None;
        } else {
            let local = cosine_hemisphere(u);
            let wi = to_frame(normal, local);
            let b = wi.dot(to);
            let half_chord = (b * b + (radius * radius - squared)).max(0.0).sqrt();
            (wi, local.z / PI, b + half_chord)
        };
        let n = (at + wi * distance - center).normalize_or(-wi);
        let error = (center.abs() + DVec3::splat(radius)) * gamma(12);
        let point = SurfacePoint { point: center + n * radius, error, normal: n };
        let emitted = self.emitted(&point, Uv::Around(self.local_from_world.vector(n)), distance);
        let weight = emitted * (dimming(distance) / pdf);
        let end = LightEnd::Surface(point);
        weight.is_finite().then_some(LightSample { wi, weight, pdf: Some(pdf), end })
    }

    /// Its radiance at a point, less what is not there of it; nothing where a pattern of it has no value.
    #[inline]
    pub(super) fn emitted(&self, at: &SurfacePoint, uv: Uv, distance: f64) -> Rgb {
        self.told(at, uv, distance).unwrap_or(Rgb::ZERO)
    }

    /// The same, or which pattern has none.
    #[inline]
    pub(super) fn told(&self, at: &SurfacePoint, uv: Uv, distance: f64) -> Sampled<Rgb> {
        match (&self.emission, &self.opacity) {
            (Texture::Constant(radiance), Texture::Constant(opacity)) => Ok(*radiance * *opacity),
            _ => {
                let local_point = self.local_from_world.point(at.point);
                let (point, normal, t) = (at.point, at.normal, distance);
                let point = TexturePoint { local_point, uv, point, normal, t, worn: None };
                Ok(texture::colour(&self.emission, &point)? * texture::opacity(&self.opacity, &point)?)
            }
        }
    }
}

/// The sides of a surface that shine on a point.
#[derive(Clone, Copy)]
enum Shown {
    Outer,
    Inner,
    Both,
}

/// Where a point lies that a sphere shines on.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    /// Outside, with the squared sine of the angle that the sphere fills.
    Outside(f64),
    Inside,
    /// On the sphere, facing away from it.
    Itself,
}

/// Of a point on the sphere's own surface rounding would say now this, now that: its normal knows.
fn side(center: DVec3, radius: f64, at: DVec3, normal: DVec3) -> Side {
    let to = center - at;
    let squared = to.length_squared();
    let rounding = (center.length() + radius) * gamma(32);
    if (squared - radius * radius).abs() <= 2.0 * radius * rounding {
        if to.dot(normal) > 0.0 { Side::Inside } else { Side::Itself }
    } else if squared > radius * radius {
        Side::Outside(radius * radius / squared)
    } else {
        Side::Inside
    }
}

/// 1 − cos of the angle that a sphere fills, from the squared sine: no digit is lost however small it is.
fn gap(sin2: f64) -> f64 {
    sin2 / (1.0 + (1.0 - sin2).sqrt())
}

/// The piece that u.x falls on, the share of the choice it has, and u with the digits that the choice left.
fn choose<'a>(pieces: &'a [Piece], sums: &[f64], u: DVec2) -> (&'a Piece, f64, DVec2) {
    if let [piece] = pieces {
        return (piece, 1.0, u);
    }
    let total = sums[sums.len() - 1];
    // Below the total, so that the piece found has a share.
    let at = (u.x * total).min(total.next_down());
    let i = sums.partition_point(|s| *s <= at);
    let before = if i == 0 { 0.0 } else { sums[i - 1] };
    let weight = sums[i] - before;
    let rest = ((at - before) / weight).clamp(0.0, 1.0);
    (&pieces[i], weight / total, DVec2::new(rest, u.y))
}

fn extent_of(form: &Form) -> Extent {
    match form {
        Form::Sphere { center, radius } => {
            Extent { center: *center, radius: *radius, area: PI * radius * radius, normal: None }
        }
        Form::Pieces { pieces, sums, .. } => {
            let total = sums[sums.len() - 1];
            let middles = pieces.iter().map(|piece| piece.point(DVec2::splat(0.5)));
            let center = middles.map(|p| p.at.point * p.area).sum::<DVec3>() / total;
            let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
            let around = pieces.iter().flat_map(|piece| corners.map(|u| piece.point(u).at.point));
            let radius = around.map(|p| (p - center).length()).fold(0.0, f64::max);
            // What is convex and closed shows a quarter of its area on average (Cauchy).
            let (area, normal) = match pieces.as_slice() {
                [one] if !matches!(one, Piece::Curved { .. }) => {
                    (total, Some(one.point(DVec2::splat(0.5)).at.normal))
                }
                _ => (total / 4.0, None),
            };
            Extent { center, radius, area, normal }
        }
    }
}

fn form_of(emitter: &Emitter) -> Option<Form> {
    let place = &emitter.world_from_local;
    // A solid angle holds the near side alone.
    let is_opaque = emitter.material.layers().opacity.is(Rgb::ONE);
    let pieces = match &emitter.shape {
        EmitterShape::Sphere { center, radius } => match similarity(&place.linear) {
            Some(scale) if is_opaque => {
                return Some(Form::Sphere { center: place.point(*center), radius: radius * scale });
            }
            _ => vec![curved(Curved::Sphere { center: *center, radius: *radius }, place)],
        },
        EmitterShape::Disc(d) => vec![ellipse(d.center, d.normal, d.radius, place)],
        EmitterShape::Rect(r) => vec![parallelogram(r.center, r.a, r.b, place)],
        EmitterShape::Box(min, max) => box_faces(*min, *max, place),
        EmitterShape::Cone(cone) => cone_pieces(cone, place),
        EmitterShape::Torus(torus) => {
            let (x, y) = frame(torus.axis);
            vec![curved(Curved::Torus { torus: *torus, x, y }, place)]
        }
        EmitterShape::Triangle(t) => vec![triangle(t.vertices, t.uvs, place)],
        EmitterShape::Mesh(mesh, faces) => faces.iter().map(|f| face(mesh, *f as usize, place)).collect(),
    };
    let solid = solid_of(&emitter.shape);
    let mut total = 0.0;
    let (pieces, sums): (Vec<_>, Vec<_>) = pieces
        .into_iter()
        .filter_map(|piece| {
            let weight = piece.weight();
            (weight > 0.0 && weight.is_finite()).then(|| {
                total += weight;
                (piece, total)
            })
        })
        .unzip();
    let flat = !pieces.iter().any(|piece| matches!(piece, Piece::Curved { .. }));
    (!pieces.is_empty()).then_some(Form::Pieces { pieces, sums, flat, solid })
}

/// The factor of a map that keeps angles; none for one that does not. Scales and rotations composed keep the columns' lengths
/// equal to a few roundings and perpendicular to as many.
fn similarity(linear: &DMat3) -> Option<f64> {
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let size = x.length_squared();
    let small = size * gamma(64);
    let near = |a: f64| a.abs() <= small;
    let same = near(y.length_squared() - size) && near(z.length_squared() - size);
    (same && near(x.dot(y)) && near(y.dot(z)) && near(z.dot(x))).then(|| size.sqrt())
}

fn curved(shape: Curved, place: &Affine) -> Piece {
    Piece::Curved { shape, place: Box::new(*place) }
}

fn parallelogram(center: DVec3, a: DVec3, b: DVec3, place: &Affine) -> Piece {
    let normal = place.normal(a.cross(b)).normalize_or_zero();
    let (a, b) = (place.vector(a), place.vector(b));
    Piece::Parallelogram { center: place.point(center), a, b, normal, area: 4.0 * a.cross(b).length() }
}

fn ellipse(center: DVec3, normal: DVec3, radius: f64, place: &Affine) -> Piece {
    let (a, b) = upright(normal);
    let (a, b) = (place.vector(a * radius), place.vector(b * radius));
    let (normal, area) = (place.normal(normal).normalize_or_zero(), PI * a.cross(b).length());
    Piece::Ellipse { center: place.point(center), a, b, normal, area }
}

fn triangle([p, q, r]: [DVec3; 3], uvs: Option<[DVec2; 3]>, place: &Affine) -> Piece {
    let normal = place.normal((q - p).cross(r - p)).normalize_or_zero();
    let edges = [place.vector(q - p), place.vector(r - p)];
    let area = edges[0].cross(edges[1]).length() / 2.0;
    Piece::Triangle { corner: place.point(p), edges, normal, uvs, area }
}

fn face(mesh: &Mesh, index: usize, place: &Affine) -> Piece {
    let corners = mesh.triangles[index].map(|i| i as usize);
    let uvs = (!mesh.uvs.is_empty()).then(|| corners.map(|i| mesh.uvs[i]));
    triangle(corners.map(|i| mesh.positions[i]), uvs, place)
}

fn box_faces(min: DVec3, max: DVec3, place: &Affine) -> Vec<Piece> {
    let (c, h) = (min + (max - min) / 2.0, (max - min) / 2.0);
    let face = |n: DVec3| {
        let (u, v) = upright(n);
        parallelogram(c + n * h, u * h.dot(u.abs()), v * h.dot(v.abs()), place)
    };
    [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|n| [face(n), face(-n)]).collect()
}

fn cone_pieces(cone: &Cone, place: &Affine) -> Vec<Piece> {
    let axis = (cone.to - cone.from).normalize_or_zero();
    let (x, y) = frame(axis);
    vec![
        curved(Curved::Side { cone: *cone, x, y }, place),
        ellipse(cone.from, -axis, cone.radii[0], place),
        ellipse(cone.to, axis, cone.radii[1], place),
    ]
}

fn solid_of(shape: &EmitterShape) -> Option<Solid> {
    match shape {
        EmitterShape::Sphere { center, radius } => Some(Solid::Sphere { center: *center, radius: *radius }),
        EmitterShape::Box(min, max) => Some(Solid::Box(*min, *max)),
        EmitterShape::Cone(cone) => Some(Solid::Cone(*cone)),
        EmitterShape::Torus(torus) => Some(Solid::Torus(*torus)),
        EmitterShape::Disc(_)
        | EmitterShape::Rect(_)
        | EmitterShape::Triangle(_)
        | EmitterShape::Mesh(..) => None,
    }
}

/// True where a surface emits from both sides: the closed solids.
pub fn emits_inward(shape: &EmitterShape) -> bool {
    solid_of(shape).is_some()
}

impl Solid {
    fn contains(&self, p: DVec3) -> bool {
        match self {
            Solid::Sphere { center, radius } => p.distance_squared(*center) < radius * radius,
            Solid::Box(min, max) => p.cmpgt(*min).all() && p.cmplt(*max).all(),
            Solid::Cone(cone) => {
                let axis = cone.to - cone.from;
                let s = (p - cone.from).dot(axis) / axis.length_squared();
                let r = cone.radii[0] + (cone.radii[1] - cone.radii[0]) * s;
                (0.0..1.0).contains(&s) && (p - cone.from - axis * s).length_squared() < r * r
            }
            Solid::Torus(torus) => {
                let d = p - torus.center;
                let h = d.dot(torus.axis);
                let ring = (d - torus.axis * h).length() - torus.radii[0];
                ring * ring + h * h < torus.radii[1] * torus.radii[1]
            }
        }
    }
}
