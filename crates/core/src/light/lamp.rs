// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The lights of Hall's model: small or far, with a spectral strength that does not fall off.

use crate::math::{DVec2, DVec3};
use crate::sampling::uniform_sphere;
use crate::spectrum::SpectralTable;

/// Where a light is.
#[derive(Clone, Copy, Debug)]
pub enum LightShape {
    /// A point.
    Point {
        /// Where it is.
        position: DVec3,
    },
    /// Endlessly far away.
    Directional {
        /// The unit direction in which its light travels.
        travels: DVec3,
    },
    /// A small sphere, of which each sample sees another point.
    Sphere {
        /// Its centre.
        centre: DVec3,
        /// Its radius in mm.
        radius: f64,
    },
}

/// A light.
#[derive(Clone, Debug)]
pub struct Light {
    /// Where it is.
    pub shape: LightShape,
    /// `I_l`(λ): the spectral radiance of a perfect reflector that faces the light.
    pub strength: SpectralTable,
}

/// The way to a light from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// The unit vector L towards the light.
    pub direction: DVec3,
    /// How far it is, in mm.
    pub distance: f64,
}

impl Light {
    /// The way from `point` to the light, for `u` uniform in the unit square.
    pub fn seen_from(&self, point: DVec3, u: DVec2) -> LightSample {
        let towards = |target: DVec3| {
            let way = target - point;
            let distance = way.length();
            LightSample { direction: way / distance, distance }
        };
        match self.shape {
            LightShape::Point { position } => towards(position),
            LightShape::Directional { travels } => {
                LightSample { direction: -travels, distance: f64::INFINITY }
            }
            LightShape::Sphere { centre, radius } => towards(centre + uniform_sphere(u) * radius),
        }
    }

    /// Whether samples of it differ, so that it draws random numbers.
    pub fn is_sampled(&self) -> bool {
        matches!(self.shape, LightShape::Sphere { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::LANES;

    fn light(shape: LightShape) -> Light {
        let strength = SpectralTable::from_ascending(&[1.0; LANES]).unwrap();
        Light { shape, strength }
    }

    #[test]
    fn the_way_to_a_light_points_at_it_and_is_as_long() {
        let point = light(LightShape::Point { position: DVec3::new(0.0, 3.0, 4.0) });
        let sample = point.seen_from(DVec3::ZERO, DVec2::ZERO);
        assert_eq!(sample.distance, 5.0);
        assert_eq!(sample.direction, DVec3::new(0.0, 0.6, 0.8));
        let sun = light(LightShape::Directional { travels: -DVec3::Y });
        assert_eq!(sun.seen_from(DVec3::ONE, DVec2::ZERO).direction, DVec3::Y);
    }

    #[test]
    fn samples_of_a_sphere_light_lie_on_it() {
        let centre = DVec3::new(10.0, 0.0, 0.0);
        let sphere = light(LightShape::Sphere { centre, radius: 2.0 });
        for u in [DVec2::ZERO, DVec2::new(0.3, 0.8), DVec2::splat(0.99)] {
            let sample = sphere.seen_from(DVec3::ZERO, u);
            let reached = sample.direction * sample.distance;
            assert!((reached.distance(centre) - 2.0).abs() < 1e-13);
        }
    }
}
