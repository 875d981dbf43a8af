//! The camera made ready: rays through points of the picture. Knows nothing of pixels' samples, worlds or films.
//!
//! Points of the picture are in pixels, x to the right and y down from the top left corner; the centre of the first pixel is
//! (0.5, 0.5). The frame is right-handed: right = forward × up.

use crate::math::elementary::{sin_cos, sin_cos_degrees, sin_cos_turns, tan};
use crate::scene::{Camera, Projection};
use crate::world::{Footprint, Ray, RayKind};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Two numbers that name a point at the rim of the lens.
pub const RIM: DVec2 = DVec2::X;

/// A camera for a picture of a size.
#[derive(Clone, Debug)]
pub struct View {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Width and height in pixels.
    size: DVec2,
    film: Projected,
    lens_radius: f64,
    /// Distance along `forward` (or along the ray, where the projection is curved) that is sharp.
    focus: f64,
}

/// A projection with what it needs of the field of view.
#[derive(Clone, Copy, Debug)]
enum Projected {
    /// Tangents of half the angles of view, across and up.
    Perspective(DVec2),
    /// Half the width and height in scene units.
    Orthographic(DVec2),
    /// Radians from the axis per half height.
    Fisheye(f64),
    Panorama,
}

/// Why a camera can show nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraFault {
    /// Eye and target coincide.
    #[error("the camera stands where it looks: `eye` and `look_at` are the same point")]
    NoDirection,
    /// Up is the zero vector.
    #[error("the camera's `up` has no length")]
    NoUp,
    /// The angle of view cannot be shown by the projection.
    #[error("a perspective camera's `fov` lies between 0 and 180 degrees, both left out")]
    FieldOfView,
    /// The same for the fisheye.
    #[error("a fisheye camera's `fov` lies above 0 and up to 360 degrees")]
    FisheyeFieldOfView,
    /// Negative or not finite.
    #[error("the camera's `aperture` is 0 or more, and its `focus` more than 0")]
    Lens,
    /// A coordinate is infinite or NaN.
    #[error("the camera's numbers are not all finite")]
    NotFinite,
}

impl View {
    /// A camera for a picture of width × height pixels. An `up` along the line of sight is replaced by the nearest to y, or
    /// to −z where the camera looks down (+z where it looks up): the picture's right is then x where it can be.
    pub fn new(camera: &Camera, size: [u32; 2]) -> Result<View, CameraFault> {
        let sight = camera.look_at - camera.eye;
        check(camera, sight)?;
        let forward = sight.normalize();
        let right = right_of(forward, camera.up.normalize());
        let size = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let distance = sight.length();
        Ok(View {
            eye: camera.eye,
            right,
            up: right.cross(forward),
            forward,
            size,
            film: project(camera, size.x / size.y, distance)?,
            lens_radius: camera.aperture / 2.0,
            focus: camera.focus.unwrap_or(distance),
        })
    }

    /// The ray through a point of the picture and a point of the lens, given by two numbers in [0, 1)²; none where the
    /// projection shows nothing (outside a fisheye's 360°). A pinhole does not look at `lens`.
    #[inline(always)]
    pub fn ray(&self, pixel: DVec2, lens: DVec2) -> Option<Ray> {
        let p = DVec2::new(2.0 * pixel.x / self.size.x - 1.0, 1.0 - 2.0 * pixel.y / self.size.y);
        let (origin, toward) = match self.film {
            // On the spot for a pinhole: it has as many rays as others, and little else to do for them.
            Projected::Perspective(tangent) if !self.has_lens() => {
                (self.eye, self.in_perspective(p, tangent))
            }
            _ => self.line_of_any(p, lens)?,
        };
        let direction = toward.normalize();
        Some(Ray { origin, direction, t_max: f64::INFINITY, kind: RayKind::Camera })
    }

    /// Where the ray through a point of the picture in −1 … 1 starts and where it goes, whatever the projection and the lens.
    #[inline(never)]
    fn line_of_any(&self, p: DVec2, lens: DVec2) -> Option<(DVec3, DVec3)> {
        let (origin, toward) = match self.film {
            Projected::Perspective(tangent) => (self.eye, self.in_perspective(p, tangent)),
            Projected::Orthographic(half) => {
                (self.eye + self.in_frame(p.x * half.x, p.y * half.y, 0.0), self.forward)
            }
            Projected::Fisheye(scale) => (self.eye, self.fisheye(p, scale)?),
            Projected::Panorama => (self.eye, self.panorama(p)),
        };
        Some(if self.has_lens() { self.through_lens(origin, toward, lens) } else { (origin, toward) })
    }

    /// How large a pixel is where: of a perspective at the corners of the picture, where a distance from the eye shows largest.
    pub fn footprint(&self) -> Footprint {
        let (per_distance, constant) = match self.film {
            Projected::Perspective(tangent) => {
                let corner = 1.0 / (1.0 + tangent.length_squared()).sqrt();
                (2.0 * tangent.y / self.size.y * corner, 0.0)
            }
            Projected::Orthographic(half) => (0.0, 2.0 * half.y / self.size.y),
            Projected::Fisheye(scale) => (2.0 * scale / self.size.y, 0.0),
            Projected::Panorama => ((TAU / self.size.x).min(PI / self.size.y), 0.0),
        };
        Footprint { eye: self.eye, per_distance, constant }
    }

    /// True where rays of one pixel differ by where they pass the lens.
    #[inline]
    pub fn has_lens(&self) -> bool {
        self.lens_radius > 0.0
    }

    #[inline]
    fn in_frame(&self, x: f64, y: f64, z: f64) -> DVec3 {
        self.right * x + self.up * y + self.forward * z
    }

    #[inline]
    fn in_perspective(&self, p: DVec2, tangent: DVec2) -> DVec3 {
        self.in_frame(p.x * tangent.x, p.y * tangent.y, 1.0)
    }

    fn fisheye(&self, p: DVec2, scale: f64) -> Option<DVec3> {
        let p = DVec2::new(p.x * self.size.x / self.size.y, p.y);
        let r = p.length();
        let angle = r * scale;
        if angle > PI {
            return None;
        }
        let (s, c) = sin_cos(angle);
        let side = if r > 0.0 { p * (s / r) } else { DVec2::ZERO };
        Some(self.in_frame(side.x, side.y, c))
    }

    fn panorama(&self, p: DVec2) -> DVec3 {
        let ((sx, cx), (sy, cy)) = (sin_cos(p.x * PI), sin_cos(p.y * PI / 2.0));
        self.in_frame(sx * cy, sy, cx * cy)
    }

    /// Where a ray passes the lens, and toward where from there: `toward` times the focus leads from the origin to the point that stays sharp.
    fn through_lens(&self, origin: DVec3, toward: DVec3, lens: DVec2) -> (DVec3, DVec3) {
        let (s, c) = sin_cos_turns(lens.y);
        let r = self.lens_radius * lens.x.sqrt();
        let offset = self.right * (r * c) + self.up * (r * s);
        (origin + offset, toward * self.focus - offset)
    }
}

fn check(camera: &Camera, sight: DVec3) -> Result<(), CameraFault> {
    let focus = camera.focus.unwrap_or(1.0);
    let finite =
        sight.is_finite() && camera.up.is_finite() && (camera.fov + camera.aperture + focus).is_finite();
    match () {
        () if !finite => Err(CameraFault::NotFinite),
        () if sight == DVec3::ZERO => Err(CameraFault::NoDirection),
        () if camera.up == DVec3::ZERO => Err(CameraFault::NoUp),
        () if camera.aperture < 0.0 || focus <= 0.0 => Err(CameraFault::Lens),
        () => Ok(()),
    }
}

fn project(camera: &Camera, aspect: f64, distance: f64) -> Result<Projected, CameraFault> {
    let fov = camera.fov;
    let half_frame = || {
        let t = half_tangent(fov);
        DVec2::new(t * aspect, t)
    };
    match camera.projection {
        Projection::Perspective | Projection::Orthographic if !(fov > 0.0 && fov < 180.0) => {
            Err(CameraFault::FieldOfView)
        }
        Projection::Fisheye if !(fov > 0.0 && fov <= 360.0) => Err(CameraFault::FisheyeFieldOfView),
        Projection::Perspective => Ok(Projected::Perspective(half_frame())),
        Projection::Orthographic => Ok(Projected::Orthographic(half_frame() * distance)),
        Projection::Fisheye => Ok(Projected::Fisheye((fov / 2.0).to_radians())),
        Projection::Panorama => Ok(Projected::Panorama),
    }
}

/// tan(fov/2), exactly 1 at 90°.
fn half_tangent(fov: f64) -> f64 {
    let (s, c) = sin_cos_degrees(fov);
    // tan(a/2) = sin a / (1 + cos a), which is exact where the sine and cosine are.
    if c > -0.5 { s / (1.0 + c) } else { tan((fov / 2.0).to_radians()) }
}

/// Unit forward × up. Where they are parallel to rounding (both are unit vectors with errors below 4u, so a cross product
/// shorter than 8u says nothing), the axis nearest to perpendicular, x first, made perpendicular.
fn right_of(forward: DVec3, up: DVec3) -> DVec3 {
    let right = forward.cross(up);
    if right.length() > 4.0 * f64::EPSILON {
        return right.normalize();
    }
    let axis = if forward.x.abs() <= forward.z.abs() || forward.x.abs() <= forward.y.abs() {
        DVec3::X
    } else {
        DVec3::Z
    };
    (axis - forward * axis.dot(forward)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{SourceId, Span};

    fn camera(projection: Projection, fov: f64) -> Camera {
        Camera {
            label: None,
            eye: DVec3::ZERO,
            look_at: -DVec3::Z,
            up: DVec3::Y,
            fov,
            projection,
            aperture: 0.0,
            focus: None,
            span: Span { source: SourceId(0), start: 0, end: 0 },
        }
    }

    fn direction(view: &View, x: f64, y: f64) -> DVec3 {
        view.ray(DVec2::new(x, y), DVec2::splat(0.5)).expect("inside the picture").direction
    }

    #[test]
    fn angles_land_at_their_tangents_not_their_sines() {
        let view = View::new(&camera(Projection::Perspective, 90.0), [100, 100]).unwrap();
        for (degrees, column) in [(0.0, 50.000000), (10.0, 58.816349), (20.0, 68.198512), (30.0, 78.867513)] {
            let (s, c) = sin_cos_degrees(degrees);
            let found = direction(&view, column, 50.0);
            assert!((found - DVec3::new(s, 0.0, -c)).length() < 1e-8, "{degrees}°: {found}");
        }
    }

    #[test]
    fn asked_for_angles_are_given_at_the_edges() {
        for fov in [60.0, 90.0, 120.0, 170.0] {
            let view = View::new(&camera(Projection::Perspective, fov), [64, 48]).unwrap();
            let (top, bottom) = (direction(&view, 32.0, 0.0), direction(&view, 32.0, 48.0));
            let found = crate::math::elementary::acos(top.dot(bottom)).to_degrees();
            assert!((found - fov).abs() < 1e-6, "{found} for {fov}");
            assert!(top.y > 0.0, "the first row is at the top");
        }
    }

    /// Where a point falls in the picture, by the definition of the perspective.
    fn image(view: &View, p: DVec3) -> DVec2 {
        let d = p - view.eye;
        let Projected::Perspective(t) = view.film else { panic!("a perspective") };
        let (x, y) =
            (d.dot(view.right) / d.dot(view.forward) / t.x, d.dot(view.up) / d.dot(view.forward) / t.y);
        DVec2::new((x + 1.0) / 2.0 * view.size.x, (1.0 - y) / 2.0 * view.size.y)
    }

    #[test]
    fn straight_lines_stay_straight_and_pixels_square() {
        let mut c = camera(Projection::Perspective, 70.0);
        (c.eye, c.look_at) = (DVec3::new(1.0, 2.0, 7.0), DVec3::new(0.3, -0.2, 0.1));
        let view = View::new(&c, [640, 360]).unwrap();
        let (a, b) = (DVec3::new(-3.0, -1.0, 0.5), DVec3::new(2.5, 3.0, -4.0));
        let (p, q) = (image(&view, a), image(&view, b));
        for i in 0..=10 {
            let m = a.lerp(b, f64::from(i) / 10.0);
            let at = image(&view, m);
            let off = (q - p).perp_dot(at - p) / (q - p).length();
            assert!(off.abs() < 1e-9, "{off} pixels from the line");
            let back = direction(&view, at.x, at.y);
            assert!(back.cross((m - c.eye).normalize()).length() < 1e-13, "the ray goes back to the point");
        }
        let step = |dx: f64, dy: f64| {
            let o = direction(&view, 320.0, 180.0);
            let d = direction(&view, 320.0 + dx, 180.0 + dy);
            (d / d.dot(o) - o).length()
        };
        assert!((step(1.0, 0.0) - step(0.0, 1.0)).abs() < 1e-15);
    }

    #[test]
    fn orthographic_height_follows_the_distance() {
        let mut c = camera(Projection::Orthographic, 90.0);
        c.look_at = -3.0 * DVec3::Z;
        let view = View::new(&c, [200, 100]).unwrap();
        let at = |x, y| view.ray(DVec2::new(x, y), DVec2::ZERO).unwrap();
        assert_eq!(at(0.0, 0.0).origin, DVec3::new(-6.0, 3.0, 0.0));
        assert_eq!(at(200.0, 100.0).origin, DVec3::new(6.0, -3.0, 0.0));
        assert_eq!(at(17.0, 30.0).direction, -DVec3::Z);
    }

    #[test]
    fn fisheye_is_equidistant_and_ends_at_180_degrees_from_the_axis() {
        let view = View::new(&camera(Projection::Fisheye, 180.0), [100, 100]).unwrap();
        for (column, degrees) in [(50.0, 0.0), (75.0, 45.0), (100.0, 90.0)] {
            let (s, c) = sin_cos_degrees(degrees);
            assert!((direction(&view, column, 50.0) - DVec3::new(s, 0.0, -c)).length() < 1e-14);
        }
        let all = View::new(&camera(Projection::Fisheye, 360.0), [100, 100]).unwrap();
        assert!(all.ray(DVec2::new(1.0, 1.0), DVec2::ZERO).is_none());
    }

    #[test]
    fn panorama_goes_all_round() {
        let view = View::new(&camera(Projection::Panorama, 40.0), [200, 100]).unwrap();
        for (x, y, d) in [
            (100.0, 50.0, -DVec3::Z),
            (150.0, 50.0, DVec3::X),
            (50.0, 50.0, -DVec3::X),
            (0.0, 50.0, DVec3::Z),
            (13.0, 0.0, DVec3::Y),
        ] {
            assert!((direction(&view, x, y) - d).length() < 1e-15, "{x}, {y}");
        }
    }

    #[test]
    fn lens_rays_meet_at_the_focus() {
        let mut c = camera(Projection::Perspective, 40.0);
        (c.aperture, c.focus) = (0.5, Some(4.0));
        let view = View::new(&c, [64, 48]).unwrap();
        let meets = |lens| {
            let r = view.ray(DVec2::new(11.0, 40.0), lens).unwrap();
            r.origin + r.direction * ((-4.0 - r.origin.z) / r.direction.z)
        };
        let (a, b) = (meets(DVec2::new(0.9, 0.1)), meets(DVec2::new(0.3, 0.7)));
        assert!((a - b).length() < 1e-14);
    }

    #[test]
    fn looking_along_up_still_gives_a_frame() {
        for sight in [-DVec3::Y, DVec3::Y] {
            let mut c = camera(Projection::Perspective, 40.0);
            c.look_at = sight;
            let view = View::new(&c, [64, 64]).unwrap();
            assert_eq!((view.right, view.up), (DVec3::X, DVec3::X.cross(sight)));
        }
    }

    #[test]
    fn cameras_that_show_nothing_say_why() {
        let fault = |change: fn(&mut Camera)| {
            let mut c = camera(Projection::Perspective, 40.0);
            change(&mut c);
            View::new(&c, [64, 64]).unwrap_err()
        };
        assert_eq!(fault(|c| c.look_at = c.eye), CameraFault::NoDirection);
        assert_eq!(fault(|c| c.fov = 180.0), CameraFault::FieldOfView);
        assert_eq!(fault(|c| c.fov = 0.0), CameraFault::FieldOfView);
        assert_eq!(fault(|c| c.up = DVec3::ZERO), CameraFault::NoUp);
        assert_eq!(fault(|c| c.aperture = -1.0), CameraFault::Lens);
        assert_eq!(fault(|c| c.eye.x = f64::NAN), CameraFault::NotFinite);
    }
}
