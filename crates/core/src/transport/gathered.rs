// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Gathered`]: the light that one sample's walk brings to the eye.

use crate::scene::Scene;
use crate::spectrum::{SampledSpectrum, SampledWavelengths};

/// The light that one sample's walk brings to the eye.
#[derive(Clone, Debug)]
pub struct Gathered {
    /// The spectral radiance, of all light groups together.
    pub radiance: SampledSpectrum,
    /// X, Y and Z of each light group, in cd/m²; empty where nobody asked for layers.
    pub layers: Vec<[f64; 3]>,
    /// The part of the radiance that was found where it had landed.
    pub landed: SampledSpectrum,
    /// The share of the walk that met what landed, by what is sent on there.
    pub met: f64,
}

impl Gathered {
    /// Nothing yet, with sums for `layers` light groups.
    pub fn new(layers: usize) -> Self {
        Self {
            radiance: SampledSpectrum::ZERO,
            layers: vec![[0.0; 3]; layers],
            landed: SampledSpectrum::ZERO,
            met: 0.0,
        }
    }

    /// Forget everything, for the next sample.
    pub fn clear(&mut self) {
        self.radiance = SampledSpectrum::ZERO;
        self.layers.fill([0.0; 3]);
        (self.landed, self.met) = (SampledSpectrum::ZERO, 0.0);
    }

    /// Add light of one group.
    pub fn add(
        &mut self,
        scene: &Scene,
        wavelengths: SampledWavelengths,
        group: usize,
        radiance: SampledSpectrum,
    ) {
        self.radiance += radiance;
        if let Some(layer) = self.layers.get_mut(group) {
            for (sum, value) in layer.iter_mut().zip(scene.tristimulus(radiance, wavelengths)) {
                *sum += value;
            }
        }
    }
}
