// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What a ray sees that leaves the scene: a surround, suns in it, and soft boxes before it.

mod aim;
mod image;
mod map;
mod sky;
mod soft_box;
mod sun;

use self::aim::Aim;
use crate::math::{DVec3, Ray};
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

pub use image::{ImageError, ImageMap};
pub use sky::{Sky, SkyModel, CIE_GENERAL_SKIES};
pub use soft_box::SoftBox;
pub use sun::Sun;

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
    /// A sky over ground.
    Sky(Sky),
    /// A picture.
    Image(ImageMap),
}

/// All that lies beyond the scene.
#[derive(Clone, Debug)]
pub struct Background {
    base: Base,
    base_group: usize,
    soft_boxes: Vec<SoftBox>,
    suns: Vec<Sun>,
    aim: Aim,
}

impl Background {
    /// A surround, counted to the light group `base_group`, with soft boxes before it and suns in
    /// it. The inner product with `luminosity` is the luminance by which it is sampled.
    pub fn new(
        base: Base,
        base_group: usize,
        soft_boxes: Vec<SoftBox>,
        suns: Vec<Sun>,
        luminosity: &SpectralTable,
    ) -> Self {
        let aim = Aim::new(&base, &soft_boxes, &suns, luminosity);
        Self { base, base_group, soft_boxes, suns, aim }
    }

    /// Whether it sends nothing.
    pub fn is_dark(&self) -> bool {
        let Base::Constant(even) = &self.base else {
            return false;
        };
        let is_zero = |phase| even.at(SampledWavelengths { phase }).max() <= 0.0;
        self.soft_boxes.is_empty() && self.suns.is_empty() && (0..even.phases()).all(is_zero)
    }

    /// The spectral radiance that arrives against `ray`: the sum of all that
    /// [`arriving`](Self::arriving) tells.
    pub fn radiance(&self, ray: &Ray, wavelengths: SampledWavelengths) -> SampledSpectrum {
        let mut sum = SampledSpectrum::ZERO;
        self.arriving(ray, wavelengths, |_, radiance| sum += radiance);
        sum
    }

    /// Tell `each` the light group and the spectral radiance of all that arrives against `ray`: the
    /// nearest soft box, faded at its edges into what is behind it, and so on to the suns and the
    /// surround. A group may be told more than once.
    pub fn arriving(
        &self,
        ray: &Ray,
        wavelengths: SampledWavelengths,
        mut each: impl FnMut(usize, SampledSpectrum),
    ) {
        let mut met: Vec<(f64, f64, &SoftBox)> = self
            .soft_boxes
            .iter()
            .filter_map(|soft_box| soft_box.meet(ray).map(|(t, share)| (t, share, soft_box)))
            .collect();
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut seen_through = 1.0;
        for (_, share, front) in met {
            each(front.group, front.radiance.at(wavelengths) * (seen_through * share));
            seen_through *= 1.0 - share;
        }
        if seen_through == 0.0 {
            return;
        }
        for sun in self.suns.iter().filter(|sun| sun.covers(ray.direction)) {
            each(sun.group, sun.radiance.at(wavelengths) * seen_through);
        }
        each(self.base_group, self.base(ray.direction, wavelengths) * seen_through);
    }

    fn base(&self, direction: DVec3, wavelengths: SampledWavelengths) -> SampledSpectrum {
        match &self.base {
            Base::Constant(radiance) => radiance.at(wavelengths),
            Base::Gradient { zenith, nadir } => {
                let up = 0.5 * (direction.y + 1.0);
                zenith.at(wavelengths) * up + nadir.at(wavelengths) * (1.0 - up)
            }
            Base::Sky(sky) => sky.radiance(direction, wavelengths),
            Base::Image(image) => image.radiance(direction, wavelengths),
        }
    }

    /// How often a walk at `from` should [`aim`](Self::aim) instead of following the surface's own
    /// choice: 0 where nothing stands out (an even or graded surround, an overcast sky, soft boxes
    /// seen from behind), else ½.
    pub fn aim_share(&self, from: DVec3) -> f64 {
        if self.aim.is_any_seen(&self.soft_boxes, from) {
            0.5
        } else {
            0.0
        }
    }

    /// A direction from `from` towards what is bright, for `u` uniform in the unit cube; `None` where
    /// [`aim_share`](Self::aim_share) is 0.
    pub fn aim(&self, from: DVec3, u: [f64; 3]) -> Option<DVec3> {
        self.aim.direction(&self.soft_boxes, &self.suns, from, u)
    }

    /// The density, per sr, with which [`aim`](Self::aim) from the origin of `ray` chooses its
    /// direction, whatever else may be in the way; also where targets overlap.
    pub fn aim_pdf(&self, ray: &Ray) -> f64 {
        self.aim.density(&self.soft_boxes, &self.suns, ray)
    }
}

#[cfg(test)]
mod tests;
