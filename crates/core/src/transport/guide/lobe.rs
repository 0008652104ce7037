// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Lobe`]: light that arrives from about one place, or one direction.

use std::f64::consts::{PI, TAU};

use crate::math::{orthonormal_pair, DVec3};

/// Where a lobe's light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Origin {
    /// A point, in mm: what is seen moves as one moves.
    Point(DVec3),
    /// So far away that only the direction counts.
    Far(DVec3),
}

impl Origin {
    /// The unit vector from `place` to it.
    pub fn from(&self, place: DVec3) -> DVec3 {
        match *self {
            Self::Point(point) => (point - place).try_normalize().unwrap_or(DVec3::Z),
            Self::Far(direction) => direction,
        }
    }
}

/// Directions spread round that of an origin: in the plane square to it, at the distance 1, with the
/// density s²/(π(s² + r²)²). Half of them are within r = s; its tails are so long that light which
/// was missed when the lobe was learned is still found (Student's t in two dimensions, ν = 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lobe {
    pub origin: Origin,
    /// s².
    pub spread2: f64,
}

impl Lobe {
    /// A direction for `u` uniform in the unit square.
    pub fn sample(&self, place: DVec3, [u, v]: [f64; 2]) -> DVec3 {
        let axis = self.origin.from(place);
        let r = (self.spread2 * u / (1.0 - u)).sqrt();
        let ((sin, cos), (x, y)) = ((TAU * v).sin_cos(), orthonormal_pair(axis));
        (axis + (x * cos + y * sin) * r).normalize()
    }

    /// The density of `sample`, per steradian.
    pub fn pdf(&self, place: DVec3, direction: DVec3) -> f64 {
        let axis = self.origin.from(place);
        let cos = axis.dot(direction);
        if cos <= 0.0 {
            return 0.0;
        }
        // r² by the chord, which keeps its digits where r is small.
        let r2 = axis.cross(direction).length_squared() / (cos * cos);
        let sum = self.spread2 + r2;
        self.spread2 / (PI * sum * sum * cos * cos * cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec2;
    use crate::sampling::{uniform_sphere, PixelSequence};

    #[test]
    fn a_lobe_s_density_is_that_of_its_directions() {
        let place = DVec3::new(1.0, 2.0, -3.0);
        for origin in
            [Origin::Far(DVec3::new(0.6, 0.0, 0.8)), Origin::Point(DVec3::new(4.0, 0.0, 9.0))]
        {
            for spread2 in [0.01, 0.3, 4.0] {
                let lobe = Lobe { origin, spread2 };
                let (n, mut inside, mut sum) = (1 << 16, 0, 0.0);
                for i in 0..n {
                    let [u, v, w, x] = PixelSequence::Sobol.sampler(5, 0, i).first_4d();
                    let drawn = lobe.sample(place, [u, v]);
                    let r2 = drawn.dot(origin.from(place)).powi(-2) - 1.0;
                    inside += u32::from(r2 < spread2);
                    // A smooth function's integral over the sphere by both ways of drawing.
                    let even = uniform_sphere(DVec2::new(w, x));
                    sum += lobe.pdf(place, even) * 4.0 * PI;
                }
                assert!((f64::from(inside) / f64::from(n) - 0.5).abs() < 0.01, "{inside}");
                let whole = sum / f64::from(n);
                assert!((whole - 1.0).abs() < 0.03, "{origin:?} {spread2}: {whole}");
            }
        }
    }
}
