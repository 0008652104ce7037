// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`PlaneMap`]: a rectangle of a plane, in pixels.

use crate::math::{DVec3, Ray};

/// A rectangle that catches what falls on its front.
#[derive(Clone, Debug)]
pub struct PlaneMap {
    /// Its middle, in mm.
    pub centre: DVec3,
    /// From the middle to the right edge, in mm, seen from the front.
    pub half_width: DVec3,
    /// From the middle to the upper edge, in mm; square to `half_width`.
    pub half_height: DVec3,
    /// Pixels along a row, and rows from the top.
    pub size: [usize; 2],
}

impl PlaneMap {
    /// How many pixels it has.
    pub fn len(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The area of one pixel in m².
    pub fn pixel_area(&self) -> f64 {
        let area = 4.0 * self.half_width.cross(self.half_height).length() * 1e-6;
        area / self.len() as f64
    }

    /// The pixel in which a ray meets its front.
    pub(super) fn pixel(&self, ray: &Ray) -> Option<usize> {
        let normal = self.half_width.cross(self.half_height);
        let towards = -normal.dot(ray.direction);
        let height = normal.dot(ray.origin - self.centre);
        if towards <= 0.0 || height <= 0.0 {
            return None;
        }
        let at = ray.at(height / towards) - self.centre;
        let x = at.dot(self.half_width) / self.half_width.length_squared();
        let y = at.dot(self.half_height) / self.half_height.length_squared();
        if x.abs() >= 1.0 || y.abs() >= 1.0 {
            return None;
        }
        let [width, height] = self.size;
        let column = ((0.5 + 0.5 * x) * width as f64) as usize;
        let row = ((0.5 - 0.5 * y) * height as f64) as usize;
        Some(row.min(height - 1) * width + column.min(width - 1))
    }
}
