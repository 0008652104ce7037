// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The surface of a mesh: its triangles, by their areas.

use std::collections::HashMap;

use super::SurfaceSample;
use crate::math::DVec3;
use crate::sampling::{uniform_triangle, Choice};

#[derive(Clone, Debug)]
pub(super) struct Mesh {
    corners: Vec<[DVec3; 3]>,
    by_area: Choice,
}

impl Mesh {
    /// `None` if no triangle has an area.
    pub fn new(corners: Vec<[DVec3; 3]>) -> Option<Self> {
        let by_area = Choice::new(corners.iter().map(|t| area_vector(t).length()))?;
        Some(Self { corners, by_area })
    }

    pub fn area(&self) -> f64 {
        self.by_area.total()
    }

    pub fn sample(&self, [u, v, w]: [f64; 3]) -> SurfaceSample {
        let corners = &self.corners[self.by_area.pick(u).0];
        SurfaceSample {
            position: point(corners, [v, w]),
            normal: area_vector(corners).normalize_or_zero(),
            pdf: 1.0 / self.area(),
        }
    }

    /// One vector for all triangles that face almost the same way: within 1/128 of a right angle.
    pub fn area_vectors(&self) -> Vec<DVec3> {
        let mut by_normal: HashMap<[i16; 3], usize> = HashMap::new();
        let mut sums: Vec<DVec3> = Vec::new();
        for triangle in &self.corners {
            let area = area_vector(triangle);
            let cell = (area.normalize_or_zero() * 128.0).round().to_array().map(|c| c as i16);
            let at = *by_normal.entry(cell).or_insert(sums.len());
            if at == sums.len() {
                sums.push(area);
            } else {
                sums[at] += area;
            }
        }
        sums
    }
}

/// The normal of a triangle, as long as its area.
pub(super) fn area_vector([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (*b - *a).cross(*c - *a) / 2.0
}

/// The point of a triangle for `u` uniform in the unit square, uniform by area.
pub(super) fn point([a, b, c]: &[DVec3; 3], u: [f64; 2]) -> DVec3 {
    let [_, second, third] = uniform_triangle(u);
    *a + (*b - *a) * second + (*c - *a) * third
}
