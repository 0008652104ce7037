// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Emitter`]: what shines from a body's surface.

use super::angular::AngularLaw;
use crate::math::DVec3;
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

/// The light that leaves a body's surface on its outward side: that of its geometric normal.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// The number of the body that shines.
    pub body: u32,
    /// The light group that its light is counted to.
    pub group: usize,
    /// Its spectral radiance: along the normal for a cosine law, on average for a table.
    pub radiance: SpectralTable,
    /// How that depends on direction.
    pub law: AngularLaw,
    /// Whether its flux was given, and not its radiance in air: then the basic radiance L/n² inside
    /// a medium of index n is `radiance`/n².
    pub per_n2: bool,
}

impl Emitter {
    /// The emitter whose surface, of `area` in mm², sends out the given spectral `flux` in W/nm.
    pub fn with_flux(
        body: u32,
        group: usize,
        flux: &SpectralTable,
        law: AngularLaw,
        area: f64,
    ) -> Self {
        const MM2_PER_M2: f64 = 1e6;
        let radiance = flux.scaled(MM2_PER_M2 / law.etendue(area));
        Self { body, group, radiance, law, per_n2: true }
    }

    /// The spectral radiance that leaves along the unit vector `direction_out`, at a place with the
    /// outward unit `normal`; nothing on the back. In a medium see `per_n2`.
    pub fn radiance(
        &self,
        normal: DVec3,
        direction_out: DVec3,
        wavelengths: SampledWavelengths,
    ) -> SampledSpectrum {
        let cos = normal.dot(direction_out);
        if cos <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        self.radiance.at(wavelengths) * self.law.factor(cos, direction_out)
    }
}
