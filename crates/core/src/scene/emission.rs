// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Emission`]: what is said of a body that shines, before its surface is known.

use super::body::BodyId;
use crate::geometry::SampledSurface;
use crate::light::{AngularLaw, DirectionGrid, Emitter, IntensityError, IntensityTable};
use crate::math::DMat3;
use crate::spectrum::SpectralTable;

/// How strongly a body shines.
#[derive(Clone, Debug)]
pub enum Strength {
    /// Its spectral radiance in air, in W·m⁻²·sr⁻¹·nm⁻¹: along the normal, or for a table the mean.
    Radiance(SpectralTable),
    /// The spectral flux of the whole body, in W/nm, whatever medium it is in.
    Flux(SpectralTable),
}

/// Into which directions a body shines.
#[derive(Clone, Debug)]
pub enum Distribution {
    /// The same radiance in all.
    Lambert,
    /// cosⁿ⁻¹ θ from the normal.
    Cosine {
        /// n ≥ 0.
        exponent: f64,
    },
    /// By a table of luminous intensity.
    Intensity {
        /// Relative intensities.
        grid: DirectionGrid,
        /// The orthonormal axes x, y and z of the table, in the world.
        frame: DMat3,
    },
}

/// What a body sends out from its surface.
#[derive(Clone, Debug)]
pub struct Emission {
    /// The light group that its light is counted to.
    pub group: usize,
    /// How strongly.
    pub strength: Strength,
    /// Where to.
    pub distribution: Distribution,
}

impl Emission {
    /// The emitter that it makes of a body with the given surface.
    pub(super) fn on(
        self,
        body: BodyId,
        surface: &SampledSurface,
    ) -> Result<Emitter, IntensityError> {
        let law = match self.distribution {
            Distribution::Lambert => AngularLaw::Lambert,
            Distribution::Cosine { exponent } => AngularLaw::Cosine { exponent },
            Distribution::Intensity { grid, frame } => {
                let table = IntensityTable::new(grid, frame, surface.area_vectors())?;
                AngularLaw::Table(Box::new(table))
            }
        };
        Ok(match self.strength {
            Strength::Radiance(radiance) => {
                Emitter { body, group: self.group, radiance, law, per_n2: false }
            }
            Strength::Flux(flux) => {
                Emitter::with_flux(body, self.group, &flux, law, surface.area())
            }
        })
    }
}
