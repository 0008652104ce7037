// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Surfaces given by equations, in double precision.
//!
//! Every closed primitive is convex: a line meets it in one interval, so that entering and leaving
//! come from one formula. Before that formula is used the ray's origin is moved to the point of the
//! line nearest to the primitive's centre, so that a far camera costs no digits.

mod cone;
mod cylinder;
mod patch;
mod plane;
mod polyhedron;
mod sphere;

use thiserror::Error;

use super::bvh::overlap;
use super::surface_point::SurfacePoint;
use crate::math::{gamma, largest_component, DAffine3, DMat3, DVec3, Ray};

pub(super) use patch::{Mantle, Patch};

pub use cone::Cone;
pub use cylinder::Cylinder;
pub use plane::{Disc, Plane};
pub use polyhedron::ConvexPolyhedron;
pub use sphere::Sphere;

/// A surface given by an equation, in its own frame.
#[derive(Clone, Debug)]
pub enum Shape {
    /// |x| = r.
    Sphere(Sphere),
    /// A triangular pyramid or a box: the points inside some half-spaces.
    Polyhedron(ConvexPolyhedron),
    /// A capped cylinder.
    Cylinder(Cylinder),
    /// A capped cone.
    Cone(Cone),
    /// An endless plane.
    Plane(Plane),
    /// A flat disc.
    Disc(Disc),
}

/// Why a primitive cannot be made.
#[derive(Debug, Error, PartialEq)]
pub enum PrimitiveError {
    /// A length that must be positive and finite is not.
    #[error("{what} must be positive and finite, not {value}")]
    NotPositive {
        /// Which length.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A direction of no length.
    #[error("{0} must be a direction of finite, non-zero length")]
    NoDirection(&'static str),
    /// Four points in one plane.
    #[error("the four points of a tetrahedron lie in one plane")]
    Flat,
    /// A transform that cannot be undone.
    #[error("the transform squeezes space flat, or is not finite")]
    Singular,
}

/// One crossing of a line with a closed primitive, in the primitive's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The line's parameter.
    pub t: f64,
    /// The outward normal, of any length.
    pub normal: DVec3,
}

/// A primitive placed in the world.
#[derive(Clone, Debug)]
pub struct Primitive {
    shape: Shape,
    to_world: DAffine3,
    to_local: DAffine3,
    normal_to_world: DMat3,
    bounds: Option<[DVec3; 2]>,
}

impl Primitive {
    /// Place `shape` in the world.
    ///
    /// # Errors
    /// The transform has no inverse.
    pub fn new(shape: Shape, to_world: DAffine3) -> Result<Self, PrimitiveError> {
        let to_local = to_world.inverse();
        if !(to_world.is_finite() && to_local.is_finite()) {
            return Err(PrimitiveError::Singular);
        }
        let normal_to_world = to_local.matrix3.transpose();
        let patches = shape.patches();
        let bounds = patches.map(|patches| {
            let boxes = patches.iter().map(|patch| patch.bounds(&to_world));
            let [lo, hi] = boxes.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], patch::join);
            let rounding = DVec3::splat(1e-9 * lo.abs().max(hi.abs()).max_element());
            [lo - rounding, hi + rounding]
        });
        Ok(Self { shape, to_world, to_local, normal_to_world, bounds })
    }

    /// Whether a ray from `origin` may meet the primitive's box before `t_max`; `inverse` is 1 over
    /// each component of its direction.
    pub fn may_be_met(&self, origin: DVec3, inverse: DVec3, t_max: f64) -> bool {
        self.bounds.is_none_or(|[lo, hi]| {
            let (a, b) = ((lo - origin) * inverse, (hi - origin) * inverse);
            let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
            enter <= leave && leave >= 0.0 && enter <= t_max
        })
    }

    /// The first point where `ray` meets the primitive.
    pub fn closest_hit(&self, ray: &Ray) -> Option<SurfacePoint> {
        let origin = self.to_local.transform_point3(ray.origin);
        let direction = self.to_local.transform_vector3(ray.direction);
        let (centre, _) = self.shape.bounding_sphere();
        let shift = (centre - origin).dot(direction) / direction.length_squared();
        let near = origin + direction * shift;
        let accept = |crossing: &Crossing| {
            let t = crossing.t + shift;
            t > 0.0 && t < ray.t_max
        };
        let crossing = match &self.shape {
            Shape::Sphere(sphere) => first(sphere.crossings(near, direction), accept),
            Shape::Polyhedron(body) => first(body.crossings(near, direction), accept),
            Shape::Cylinder(cylinder) => first(cylinder.crossings(near, direction), accept),
            Shape::Cone(cone) => first(cone.crossings(near, direction), accept),
            Shape::Plane(plane) => plane.crossing(near, direction).filter(accept),
            Shape::Disc(disc) => disc.crossing(near, direction).filter(accept),
        }?;
        let local = self.shape.on_surface(near + direction * crossing.t);
        let position = self.to_world.transform_point3(local);
        Some(SurfacePoint {
            t: crossing.t + shift,
            position,
            normal: (self.normal_to_world * crossing.normal).normalize(),
            error: self.position_error(local, position),
        })
    }

    /// A bound on the distance between a hit's position and the surface the routines see.
    ///
    /// A local point is right to γ₈ of the shape's reach (it is put back onto the surface), the
    /// transform there and back adds γ₄ of the absolute sizes of what it sums, each way, and the
    /// next ray's own shift and crossing repeat it all once: eight times γ₁₆ of the sum covers it.
    fn position_error(&self, local: DVec3, position: DVec3) -> f64 {
        let (centre, radius) = self.shape.bounding_sphere();
        let reach = if radius.is_finite() { largest_component(centre) + radius } else { 0.0 };
        let local_size = reach.max(largest_component(local));
        let stretch = largest_component(self.to_world.matrix3.x_axis)
            .max(largest_component(self.to_world.matrix3.y_axis))
            .max(largest_component(self.to_world.matrix3.z_axis));
        let world_size = largest_component(position) + largest_component(self.to_world.translation);
        8.0 * gamma(16) * (local_size * stretch + world_size)
    }

    /// The pieces of its surface in its own frame; `None` for an endless plane.
    pub(super) fn patches(&self) -> Option<Vec<Patch>> {
        self.shape.patches()
    }

    /// Where it stands.
    pub(super) fn placement(&self) -> DAffine3 {
        self.to_world
    }

    /// A bound of [`SurfacePoint::error`] for all its points, if it has an end.
    pub(super) fn largest_error(&self) -> f64 {
        let (centre, radius) = self.shape.bounding_sphere();
        let farthest = self.bounds().map_or(DVec3::ZERO, |(lo, hi)| lo.abs().max(hi.abs()));
        self.position_error(centre.abs() + DVec3::splat(radius), farthest)
    }

    /// The primitive's box in the world; `None` for an endless plane.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        self.bounds.map(|[lo, hi]| (lo, hi))
    }

    /// Whether its surface may come within `reach` mm of something in the box from `lo` to `hi`.
    pub fn may_touch(&self, [lo, hi]: [DVec3; 2], reach: f64) -> bool {
        let plane = match &self.shape {
            Shape::Plane(plane) => Some(plane),
            Shape::Disc(disc) => Some(&disc.plane),
            _ => None,
        };
        let (centre, half) = ((lo + hi) / 2.0, (hi - lo) / 2.0);
        let straddles = plane.is_none_or(|plane| {
            let normal = (self.normal_to_world * plane.normal).normalize();
            let height = normal.dot(centre - self.to_world.transform_point3(plane.point));
            height.abs() <= normal.abs().dot(half) + reach
        });
        let grown = [lo - DVec3::splat(reach), hi + DVec3::splat(reach)];
        straddles && self.bounds().is_none_or(|(from, to)| overlap([from, to], grown))
    }

    /// Whether the primitive encloses a volume.
    pub fn is_closed(&self) -> bool {
        !matches!(self.shape, Shape::Plane(_) | Shape::Disc(_))
    }

    /// The point in the primitive's own frame, for patterns.
    pub fn local_point(&self, position: DVec3) -> DVec3 {
        self.to_local.transform_point3(position)
    }
}

impl Shape {
    /// The pieces of its surface; `None` for an endless plane.
    fn patches(&self) -> Option<Vec<Patch>> {
        match self {
            Self::Sphere(sphere) => Some(sphere.patches()),
            Self::Polyhedron(body) => Some(body.patches()),
            Self::Cylinder(cylinder) => Some(cylinder.patches()),
            Self::Cone(cone) => Some(cone.patches()),
            Self::Disc(disc) => Some(disc.patches()),
            Self::Plane(_) => None,
        }
    }

    /// Centre and radius of a sphere round the shape, in its own frame.
    fn bounding_sphere(&self) -> (DVec3, f64) {
        match self {
            Self::Sphere(sphere) => sphere.bounding_sphere(),
            Self::Polyhedron(body) => body.bounding_sphere(),
            Self::Cylinder(cylinder) => cylinder.bounding_sphere(),
            Self::Cone(cone) => cone.bounding_sphere(),
            Self::Plane(plane) => (plane.point, f64::INFINITY),
            Self::Disc(disc) => disc.bounding_sphere(),
        }
    }

    /// Put a computed point back onto the surface, where the equation makes that easy.
    fn on_surface(&self, point: DVec3) -> DVec3 {
        match self {
            Self::Sphere(sphere) => sphere.project(point),
            _ => point,
        }
    }
}

fn first(interval: Option<[Crossing; 2]>, accept: impl Fn(&Crossing) -> bool) -> Option<Crossing> {
    interval?.into_iter().find(accept)
}

/// Check a length.
fn positive(what: &'static str, value: f64) -> Result<f64, PrimitiveError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(PrimitiveError::NotPositive { what, value })
    }
}

/// Check and normalise a direction.
fn unit(what: &'static str, direction: DVec3) -> Result<DVec3, PrimitiveError> {
    direction.try_normalize().ok_or(PrimitiveError::NoDirection(what))
}

/// The real roots t₀ ≤ t₁ of a·t² + 2·b·t + c, without cancellation.
fn roots(a: f64, half_b: f64, c: f64) -> Option<[f64; 2]> {
    let discriminant = half_b * half_b - a * c;
    if discriminant < 0.0 || a == 0.0 {
        return None;
    }
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    let (first, second) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    Some([first.min(second), first.max(second)])
}

#[cfg(test)]
mod tests;
