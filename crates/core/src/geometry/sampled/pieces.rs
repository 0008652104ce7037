// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The surface of a convex primitive with faces or a straight side.

use std::f64::consts::{PI, TAU};

use super::mesh::{area_vector, point};
use super::SurfaceSample;
use crate::geometry::primitive::{Mantle, Patch};
use crate::math::{orthonormal_pair, DAffine3, DMat3, DVec3};
use crate::sampling::uniform_disc;

/// The pieces of a surface, placed in the world.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    pieces: Vec<Piece>,
    area: f64,
}

#[derive(Clone, Debug)]
struct Piece {
    form: Form,
    area: f64,
}

#[derive(Clone, Debug)]
enum Form {
    Triangle {
        corners: [DVec3; 3],
        normal: DVec3,
    },
    /// All centre + a·x + b·y with x² + y² ≤ 1.
    Ellipse {
        centre: DVec3,
        axes: [DVec3; 2],
        normal: DVec3,
    },
    Side(Side),
}

impl Pieces {
    /// `None` if nothing has an area.
    pub fn new(patches: &[Patch], to_world: DAffine3) -> Option<Self> {
        let pieces: Vec<Piece> = patches.iter().flat_map(|patch| place(patch, to_world)).collect();
        let area: f64 = pieces.iter().map(|piece| piece.area).sum();
        (area.is_finite() && area > 0.0).then_some(Self { pieces, area })
    }

    pub fn area(&self) -> f64 {
        self.area
    }

    pub fn area_vectors(&self) -> Vec<DVec3> {
        let of = |piece: &Piece| match &piece.form {
            Form::Triangle { normal, .. } | Form::Ellipse { normal, .. } => {
                vec![*normal * piece.area]
            }
            Form::Side(side) => side.area_vectors(),
        };
        self.pieces.iter().flat_map(of).collect()
    }

    pub fn sample(&self, u: [f64; 3]) -> SurfaceSample {
        choose(|| self.pieces.iter(), self.area, u)
    }

    /// Only from the pieces that may face `from`.
    pub fn sample_from(&self, from: DVec3, u: [f64; 3]) -> Option<SurfaceSample> {
        let area = self.area_facing(from);
        let facing = || self.pieces.iter().filter(move |piece| piece.may_face(from));
        (area > 0.0).then(|| choose(facing, area, u))
    }

    /// The density per mm² of [`Self::sample_from`] where the outward unit normal is `normal`.
    pub fn density_from(&self, from: DVec3, normal: DVec3) -> f64 {
        let area = self.area_facing(from);
        if area <= 0.0 {
            return 0.0;
        }
        self.pieces
            .iter()
            .find_map(|piece| match &piece.form {
                Form::Side(side) => Some(piece.area * side.density(side.own_normal(normal)?)),
                _ => None,
            })
            .unwrap_or(1.0)
            / area
    }

    fn area_facing(&self, from: DVec3) -> f64 {
        self.pieces.iter().filter(|piece| piece.may_face(from)).map(|piece| piece.area).sum()
    }
}

/// A point of one of `pieces`, chosen by their areas, which add up to `area`.
fn choose<'a, I>(pieces: impl Fn() -> I, area: f64, [u, v, w]: [f64; 3]) -> SurfaceSample
where
    I: Iterator<Item = &'a Piece>,
{
    let mut left = u * area;
    let mut chosen = None;
    for piece in pieces() {
        chosen = Some(piece);
        if left < piece.area {
            break;
        }
        left -= piece.area;
    }
    let nowhere = SurfaceSample { position: DVec3::ZERO, normal: DVec3::ZERO, pdf: 0.0 };
    chosen.map_or(nowhere, |piece| piece.sample([v, w], area))
}

impl Piece {
    /// A point of the piece, with its share of `area` in the density.
    fn sample(&self, u: [f64; 2], area: f64) -> SurfaceSample {
        match &self.form {
            Form::Triangle { corners, normal } => {
                SurfaceSample { position: point(corners, u), normal: *normal, pdf: 1.0 / area }
            }
            Form::Ellipse { centre, axes: [a, b], normal } => {
                let [x, y] = uniform_disc(u);
                let position = *centre + *a * x + *b * y;
                SurfaceSample { position, normal: *normal, pdf: 1.0 / area }
            }
            Form::Side(side) => {
                let sample = side.sample(u);
                SurfaceSample { pdf: sample.pdf * self.area / area, ..sample }
            }
        }
    }

    /// False only if `from` is behind all of it.
    fn may_face(&self, from: DVec3) -> bool {
        match &self.form {
            Form::Triangle { corners: [place, ..], normal }
            | Form::Ellipse { centre: place, normal, .. } => normal.dot(from - *place) > 0.0,
            Form::Side(_) => true,
        }
    }
}

/// A patch, placed in the world; mirroring placements keep normals outward.
fn place(patch: &Patch, to_world: DAffine3) -> Vec<Piece> {
    let normals = to_world.matrix3.inverse().transpose();
    match patch {
        Patch::Polygon(corners) => {
            let [first, rest @ ..] = corners.as_slice() else { return Vec::new() };
            let triangle = |pair: &[DVec3]| {
                let local = [*first, pair[0], pair[1]];
                let corners = local.map(|corner| to_world.transform_point3(corner));
                let normal = (normals * area_vector(&local)).normalize_or_zero();
                let area = area_vector(&corners).length();
                Piece { form: Form::Triangle { corners, normal }, area }
            };
            rest.windows(2).map(triangle).collect()
        }
        Patch::Disc { centre, normal, radius } => {
            let (x, y) = orthonormal_pair(*normal);
            let axes = [x, y].map(|axis| to_world.transform_vector3(axis * *radius));
            let area = PI * axes[0].cross(axes[1]).length();
            let normal = (normals * *normal).normalize();
            let centre = to_world.transform_point3(*centre);
            vec![Piece { form: Form::Ellipse { centre, axes, normal }, area }]
        }
        Patch::Mantle(mantle) => {
            let side = Side::new(*mantle, to_world);
            vec![Piece { area: side.area, form: Form::Side(side) }]
        }
        // A sphere is sampled as a whole, by `Ellipsoid`.
        Patch::Sphere { .. } => Vec::new(),
    }
}

/// The side of a cylinder or cone, stretched or not.
#[derive(Clone, Debug)]
struct Side {
    mantle: Mantle,
    to_world: DAffine3,
    /// M⁻ᵀ·|det M|: takes a unit normal n to n·(dA in the world per dA before).
    cofactors: DMat3,
    area: f64,
}

impl Side {
    /// Steps around for its area: enough for a side that is stretched a hundredfold.
    const STEPS: usize = 4096;

    fn new(mantle: Mantle, to_world: DAffine3) -> Self {
        let stretch = to_world.matrix3.determinant().abs();
        let cofactors = to_world.matrix3.inverse().transpose() * stretch;
        let mut side = Self { mantle, to_world, cofactors, area: 0.0 };
        let areas =
            side.around(Self::STEPS).map(|(normal, area)| (cofactors * normal).length() * area);
        side.area = areas.sum();
        side
    }

    /// The local normals of even steps around, with their areas before stretching.
    fn around(&self, steps: usize) -> impl Iterator<Item = (DVec3, f64)> + use<> {
        let (mantle, area) = (self.mantle, self.local_area() / steps as f64);
        let (x, y) = orthonormal_pair(mantle.axis);
        (0..steps).map(move |step| {
            let (sin, cos) = (TAU * (step as f64 + 0.5) / steps as f64).sin_cos();
            (mantle.normal(x * cos + y * sin), area)
        })
    }

    fn local_area(&self) -> f64 {
        PI * (self.mantle.radii[0] + self.mantle.radii[1]) * self.mantle.slant()
    }

    fn area_vectors(&self) -> Vec<DVec3> {
        self.around(256).map(|(normal, area)| self.cofactors * normal * area).collect()
    }

    /// A point of it, uniform by area before stretching, with its density per mm².
    fn sample(&self, [u, v]: [f64; 2]) -> SurfaceSample {
        let [lower, upper] = self.mantle.radii;
        // The area below a share s of the way is r₀·s + (r₁ − r₀)·s²/2: solve it for s, in a form
        // that also holds for equal radii.
        let root = (lower * lower + u * (upper * upper - lower * lower)).max(0.0).sqrt();
        let along = u * (lower + upper) / (lower + root);
        let (x, y) = orthonormal_pair(self.mantle.axis);
        let (sin, cos) = (TAU * v).sin_cos();
        let radial = x * cos + y * sin;
        let normal = self.mantle.normal(radial);
        SurfaceSample {
            position: self.to_world.transform_point3(self.mantle.point(along, radial)),
            normal: (self.cofactors * normal).normalize(),
            pdf: self.density(normal),
        }
    }

    /// The density per mm² in the world of its points with the local unit `normal`.
    fn density(&self, normal: DVec3) -> f64 {
        1.0 / (self.local_area() * (self.cofactors * normal).length())
    }

    /// The local unit normal of a world normal, if it is one of the side and not of an end.
    fn own_normal(&self, world: DVec3) -> Option<DVec3> {
        let local = (self.to_world.matrix3.transpose() * world).normalize();
        let cos = local.dot(self.mantle.axis);
        let own = (self.mantle.radii[0] - self.mantle.radii[1]) / self.mantle.slant();
        let is_below = cos < (own - 1.0) / 2.0;
        let is_above = self.mantle.radii[1] > 0.0 && cos > f64::midpoint(own, 1.0);
        (!is_below && !is_above).then_some(local)
    }
}
