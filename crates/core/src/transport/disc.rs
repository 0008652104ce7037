// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Disc`]: the part of a surface round a place on which walks from the eye take what landed.
//!
//! What landed near a surface's edge is met on that part of its disc which is on the surface, and has to
//! weigh more there, so that no light is lost. A place that is drawn on the disc is on the surface with the
//! chance p that is this part's share; so the number of places that are drawn until one is has the mean 1/p.
//!
//! Source: T. Booth, "Unbiased Monte Carlo Estimation of the Reciprocal of an Integral", Nuclear Science and
//! Engineering 156(3), 2007.

use std::f64::consts::{PI, TAU};

use rustc_hash::FxHashMap;

use crate::math::{orthonormal_pair, DVec3, IVec3, Ray};
use crate::sampling::PixelSampler;
use crate::scene::{BodyId, Face, Scene};

/// A disc that more photons than these are expected in is made smaller.
const CROWD: f64 = 32.0;
/// What lies farther above or below a surface than this share of a disc's radius is on another one.
const THICKNESS: f64 = 0.25;
/// Surfaces whose normals are farther apart than this cosine are not the same.
const SAME_SURFACE: f64 = 0.9;
/// The most places that are drawn on a disc until one is on its surface.
const MOST_DRAWN: u32 = 64;
/// The most surfaces above one another in one place of a disc that are looked through.
const MOST_LAYERS: usize = 16;
const M2_PER_MM2: f64 = 1e-6;

/// The part of a surface round a place on which walks from the eye take what landed.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    /// Its middle, in mm.
    pub position: DVec3,
    /// The surface's true normal there, out of its body.
    pub normal: DVec3,
    /// The body whose surface it is.
    pub body: BodyId,
    /// In mm.
    pub radius: f64,
    /// Whether it is known to be far from all edges.
    pub is_whole: bool,
}

impl Disc {
    /// How much what landed at `place` counts, per m²: most in the middle, nothing at the rim; 1 over the
    /// disc. Nothing where it is not on the disc.
    pub fn weight(&self, place: DVec3) -> Option<f64> {
        let away = place - self.position;
        let r2 = self.radius * self.radius;
        let d2 = away.length_squared() / r2;
        let is_on = d2 < 1.0 && away.dot(self.normal).abs() < THICKNESS * self.radius;
        is_on.then(|| 2.0 * (1.0 - d2) / (PI * r2 * M2_PER_MM2))
    }

    /// Whether a surface with this normal, out of its body, goes on as the disc's does.
    pub fn is_along(&self, normal: DVec3) -> bool {
        normal.dot(self.normal) > SAME_SURFACE
    }

    /// How much more what landed in its middle has to weigh, so that none is lost beyond an edge: right on
    /// average, and a whole number, that of the places drawn. As much as it does where none of them is on a
    /// surface, which is finer then than its points are known.
    pub fn makes_good(&self, scene: &Scene, mut sampler: PixelSampler) -> u32 {
        if self.is_whole {
            return 1;
        }
        for drawn in (0..MOST_DRAWN).step_by(2) {
            let [a, b, c, d] = sampler.next_4d();
            if self.is_there(scene, [a, b]) {
                return drawn + 1;
            }
            if self.is_there(scene, [c, d]) {
                return drawn + 2;
            }
        }
        1
    }

    /// Whether there is any surface at a place that is drawn on the disc, as often as what landed there
    /// counts, for `u` uniform in the unit square.
    fn is_there(&self, scene: &Scene, [u, v]: [f64; 2]) -> bool {
        self.reaches(scene, (1.0 - (1.0 - u).sqrt()).sqrt(), v)
    }

    /// Whether it reaches beyond an edge in one of four directions, the first of them a `turn` of its own.
    pub fn is_cut(&self, scene: &Scene, turn: f64) -> bool {
        const NEAR_RIM: f64 = 0.9;
        (0..4).any(|side| !self.reaches(scene, NEAR_RIM, turn + 0.25 * f64::from(side)))
    }

    /// Whether there is any surface so far from the middle, in radii, in a direction in turns.
    fn reaches(&self, scene: &Scene, away: f64, turn: f64) -> bool {
        let (tangent, bitangent) = orthonormal_pair(self.normal);
        let (sin, cos) = (TAU * turn).sin_cos();
        let away = self.radius * away;
        let height = THICKNESS * self.radius;
        let above = self.normal * height + (tangent * cos + bitangent * sin) * away;
        let origin = self.position + above;
        let mut ray = Ray { origin, direction: -self.normal, t_max: 2.0 * height };
        for _ in 0..MOST_LAYERS {
            let Some(place) = scene.first_place(&ray) else {
                return false;
            };
            let point = &place.hit.point;
            let is_along = self.is_along(point.normal) || self.is_along(-point.normal);
            let is_own = |face: &Face| face.body == self.body && face.is_entered;
            if is_along && place.faces().iter().any(is_own) {
                // On what something stands, nothing lands.
                let up = Ray::endless(point.leave_along(self.normal), self.normal);
                return scene.opaque_round(&up).is_none();
            }
            ray.origin = point.leave_along(ray.direction);
            ray.t_max -= point.t;
        }
        false
    }
}

/// Where light lands closely and where surfaces end, as other walks have shown: what decides about discs must
/// not be what is met in them.
#[derive(Clone, Debug, Default)]
pub struct Crowd {
    /// How wide its cells are, in mm.
    pub(super) width: f64,
    pub(super) cells: FxHashMap<IVec3, Cell>,
    /// The largest radius of a first disc on each body, as far as any light landed there.
    pub(super) most: FxHashMap<BodyId, f64>,
}

/// What is known of the discs in a cell where light landed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// How much lands per mm² and walk.
    pub density: f64,
    /// Whether discs were seen that reach beyond an edge.
    pub has_edges: bool,
}

impl Crowd {
    /// The largest radius of a disc that is small for its body, and on which no more of so many walks land
    /// than it takes; and whether discs there are known to end before all edges.
    pub(super) fn disc(&self, at: DVec3, body: BodyId, (shrunk, paths): (f64, u32)) -> (f64, bool) {
        let most = self.most.get(&body).map_or(f64::INFINITY, |most| most * shrunk);
        let Some(known) = self.cells.get(&cell(at, self.width)) else {
            return (most, false);
        };
        let uncrowded = (CROWD / (PI * known.density * f64::from(paths))).sqrt();
        (most.min(uncrowded), !known.has_edges)
    }
}

/// The cell of a grid that a place is in.
pub(super) fn cell(position: DVec3, width: f64) -> IVec3 {
    (position / width).floor().as_ivec3()
}
