// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Receivers`]: where the flux that leaves a lamp is caught.
//!
//! A goniometer's receiver goes round a centre, at a distance d or so far away that only directions
//! count. Flux belongs to the direction, from the centre, in which it goes through the sphere of
//! radius d; a receiver's reading is the flux through it over its solid angle, which is E·d².

mod cells;
mod map;
mod spots;
mod sums;

use crate::math::{DMat3, DVec3, Ray};
use crate::spectrum::{SampledSpectrum, SampledWavelengths, LANES};

pub use cells::DirectionCells;
pub use map::PlaneMap;
pub use spots::{Spot, Spots};
pub use sums::{GroupSums, Xyz};

/// Where flux is caught: on a sphere by direction, on a plane by place.
///
/// The direction (H, V) is (sin H cos V, sin V, cos H cos V) in the frame.
#[derive(Clone, Debug)]
pub struct Receivers {
    /// Columns: the lamp's right as an observer before it sees it, up, and the lamp's axis.
    pub frame: DMat3,
    /// The middle of the sphere, in mm.
    pub centre: DVec3,
    /// The radius of the sphere in mm; `None` for the far field.
    pub distance: Option<f64>,
    /// Cells of an H–V grid.
    pub cells: Option<DirectionCells>,
    /// Round receivers.
    pub spots: Spots,
    /// Pixels of a plane.
    pub map: Option<PlaneMap>,
    /// Spectral bands per lane of each spot and of the flux as a whole; 0 for none.
    pub spot_bands: usize,
    /// Spectral bands per lane of each cell of the grid; 0 for none.
    pub cell_bands: usize,
}

impl Receivers {
    /// Whether the sphere holds a whole box.
    pub fn reach_round(&self, [lo, hi]: [DVec3; 2]) -> bool {
        self.distance.is_none_or(|distance| self.farthest([lo, hi]) < distance)
    }

    /// How far the farthest corner of a box is from the centre.
    pub fn farthest(&self, [lo, hi]: [DVec3; 2]) -> f64 {
        (self.centre - lo).abs().max((hi - self.centre).abs()).length()
    }

    /// The unit direction in the frame in which a ray goes out through the sphere.
    fn direction(&self, ray: &Ray) -> Option<DVec3> {
        let Some(distance) = self.distance else {
            return Some(self.frame.transpose() * ray.direction);
        };
        let from = ray.origin - self.centre;
        let along = from.dot(ray.direction);
        let inside = distance * distance - (from - ray.direction * along).length_squared();
        let t = inside.max(0.0).sqrt() - along;
        let crosses = inside > 0.0 && t > 0.0;
        crosses.then(|| self.frame.transpose() * (from + ray.direction * t) / distance)
    }

    /// Add a part of a path's flux, whose tristimulus values are `xyz`, to what its ray meets.
    pub fn catch(
        &self,
        sums: &mut GroupSums,
        ray: &Ray,
        (flux, xyz): (SampledSpectrum, [f64; 3]),
        (wavelengths, phases): (SampledWavelengths, usize),
    ) {
        let phase = (wavelengths.phase, phases);
        sums.out.add(xyz);
        add_bands(&mut sums.out_bands, 0, self.spot_bands, flux, phase);
        if let Some(pixel) = self.map.as_ref().and_then(|map| map.pixel(ray)) {
            sums.map[pixel].add(xyz);
        }
        let Some(direction) = self.direction(ray) else {
            return;
        };
        let (h, v) = angles(direction);
        if let Some(cell) = self.cells.as_ref().and_then(|cells| cells.find(h, v)) {
            sums.cells[cell].add(xyz);
            add_bands(&mut sums.cell_bands, cell, self.cell_bands, flux, phase);
        }
        for spot in self.spots.around(direction, h, v) {
            sums.spots[spot].add(xyz);
            add_bands(&mut sums.spot_bands, spot, self.spot_bands, flux, phase);
        }
    }
}

/// H and V in rad of a unit direction in the frame.
fn angles(direction: DVec3) -> (f64, f64) {
    (direction.x.atan2(direction.z), direction.y.clamp(-1.0, 1.0).asin())
}

/// Add a spectral flux to the bands of receiver number `at`.
fn add_bands(
    bands: &mut [f64],
    at: usize,
    per_lane: usize,
    flux: SampledSpectrum,
    (phase, phases): (usize, usize),
) {
    if per_lane == 0 {
        return;
    }
    let part = phase * per_lane / phases;
    let own = &mut bands[at * per_lane * LANES..(at + 1) * per_lane * LANES];
    for (lane, value) in flux.0.into_iter().enumerate() {
        own[lane * per_lane + part] += value;
    }
}

#[cfg(test)]
mod tests;
