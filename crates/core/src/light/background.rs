// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What a ray sees that leaves the scene: an even or graded surround, and soft boxes.

use crate::math::{DVec3, Ray};
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

/// The surround behind the soft boxes.
#[derive(Clone, Debug)]
pub enum Base {
    /// The same in all directions.
    Constant(SpectralTable),
    /// From straight below to straight above, linear in the direction's y.
    Gradient {
        /// Spectral radiance from +y.
        zenith: SpectralTable,
        /// Spectral radiance from −y.
        nadir: SpectralTable,
    },
}

/// A luminous rectangle, seen from its front.
#[derive(Clone, Debug)]
pub struct SoftBox {
    /// Its centre, in mm.
    pub centre: DVec3,
    /// From the centre to the middle of the right edge.
    pub half_width: DVec3,
    /// From the centre to the middle of the upper edge.
    pub half_height: DVec3,
    /// Spectral radiance of its middle.
    pub radiance: SpectralTable,
    /// The share of the half width and half height over which it fades out: 0 hard, 1 from the
    /// middle on.
    pub edge_softness: f64,
}

impl SoftBox {
    /// The distance and brightness (0..1) with which a ray meets the front.
    fn meet(&self, ray: &Ray) -> Option<(f64, f64)> {
        let normal = self.half_width.cross(self.half_height);
        let along = normal.dot(ray.direction);
        if along >= 0.0 {
            return None;
        }
        let t = normal.dot(self.centre - ray.origin) / along;
        let from_centre = ray.at(t) - self.centre;
        let across = |half: DVec3| from_centre.dot(half).abs() / half.length_squared();
        let (x, y) = (across(self.half_width), across(self.half_height));
        (t > 0.0 && x < 1.0 && y < 1.0).then(|| (t, self.fade(x) * self.fade(y)))
    }

    fn fade(&self, across: f64) -> f64 {
        if across <= 1.0 - self.edge_softness {
            return 1.0;
        }
        let s = (1.0 - across) / self.edge_softness;
        s * s * (3.0 - 2.0 * s)
    }
}

/// All that lies beyond the scene.
#[derive(Clone, Debug)]
pub struct Background {
    /// The surround.
    pub base: Base,
    /// The soft boxes before it.
    pub soft_boxes: Vec<SoftBox>,
}

impl Background {
    /// The spectral radiance that arrives against `ray`: the nearest soft box's, faded into what is
    /// behind it at its edges.
    pub fn radiance(&self, ray: &Ray, wavelengths: SampledWavelengths) -> SampledSpectrum {
        let mut met: Vec<(f64, f64, &SoftBox)> = self
            .soft_boxes
            .iter()
            .filter_map(|soft_box| soft_box.meet(ray).map(|(t, share)| (t, share, soft_box)))
            .collect();
        met.sort_by(|a, b| b.0.total_cmp(&a.0));
        met.into_iter().fold(self.base(ray.direction, wavelengths), |behind, (_, share, front)| {
            behind * (1.0 - share) + front.radiance.at(wavelengths) * share
        })
    }

    fn base(&self, direction: DVec3, wavelengths: SampledWavelengths) -> SampledSpectrum {
        match &self.base {
            Base::Constant(radiance) => radiance.at(wavelengths),
            Base::Gradient { zenith, nadir } => {
                let up = 0.5 * (direction.y + 1.0);
                zenith.at(wavelengths) * up + nadir.at(wavelengths) * (1.0 - up)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::LANES;

    fn table(value: f64) -> SpectralTable {
        SpectralTable::from_ascending(&[value; LANES]).unwrap()
    }

    fn value(background: &Background, ray: &Ray) -> f64 {
        background.radiance(ray, SampledWavelengths { phase: 0 }).0[3]
    }

    fn soft_box(z: f64, radiance: f64, edge_softness: f64) -> SoftBox {
        SoftBox {
            centre: DVec3::new(0.0, 0.0, z),
            half_width: -DVec3::X * 2.0,
            half_height: DVec3::Y,
            radiance: table(radiance),
            edge_softness,
        }
    }

    #[test]
    fn a_gradient_is_halfway_at_the_horizon() {
        let base = Base::Gradient { zenith: table(3.0), nadir: table(1.0) };
        let background = Background { base, soft_boxes: vec![] };
        for (direction, expected) in [(DVec3::Y, 3.0), (DVec3::X, 2.0), (-DVec3::Y, 1.0)] {
            assert_eq!(value(&background, &Ray::endless(DVec3::ZERO, direction)), expected);
        }
    }

    #[test]
    fn a_soft_box_covers_what_is_behind_it_from_its_front_only() {
        let soft_boxes = vec![soft_box(20.0, 9.0, 0.0), soft_box(10.0, 5.0, 0.0)];
        let background = Background { base: Base::Constant(table(1.0)), soft_boxes };
        let towards =
            |x: f64, y: f64| Ray::endless(DVec3::ZERO, DVec3::new(x, y, 10.0).normalize());
        assert_eq!(value(&background, &towards(0.0, 0.0)), 5.0);
        assert_eq!(value(&background, &towards(1.99, 0.99)), 5.0);
        assert_eq!(value(&background, &towards(2.01, 0.0)), 1.0);
        let from_behind = Ray::endless(DVec3::new(0.0, 0.0, 30.0), -DVec3::Z);
        assert_eq!(value(&background, &from_behind), 1.0);
    }

    #[test]
    fn a_soft_edge_fades_without_a_step() {
        let background = Background {
            base: Base::Constant(table(0.0)),
            soft_boxes: vec![soft_box(10.0, 1.0, 1.0)],
        };
        let at = |x: f64| value(&background, &Ray::endless(DVec3::new(x, 0.0, 0.0), DVec3::Z));
        assert_eq!(at(0.0), 1.0);
        assert!((at(1.0) - 0.5).abs() < 1e-12);
        assert!(at(1.999) < 1e-5);
    }
}
