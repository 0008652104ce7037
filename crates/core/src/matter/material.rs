// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Material`]: the optics of a surface or body, and its terms in Hall's shading model.

use super::albedo::AlbedoTable;
use super::bsdf::{Bsdf, Diffuse, Facet, Glossy, LacqueredMetal, Reflector, Transmitter};
use super::finish::Finish;
use super::fresnel::dielectric_reflectance;
use super::lacquer::Lacquer;
use crate::math::DVec3;
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable, LANES};

/// A transparent body.
#[derive(Clone, Debug)]
pub struct Dielectric {
    /// The refractive index n(λ).
    pub index: SpectralTable,
    /// The index at 587.56 nm (helium d), for directions that all lanes share.
    pub index_d: f64,
    /// The Napierian absorption coefficient in mm⁻¹.
    pub absorption: SpectralTable,
    /// What makes it turbid; a clear body has none.
    pub scattering: Option<Scattering>,
}

/// Particles spread evenly in a body, which scatter by [`super::henyey_greenstein`].
#[derive(Clone, Debug)]
pub struct Scattering {
    /// The scattering coefficient in mm⁻¹.
    pub coefficient: SpectralTable,
    /// g, the mean cosine of the deflection, in (−1, 1).
    pub anisotropy: f64,
}

impl Dielectric {
    /// The index that steers a group of lanes: `n_d` for all lanes, else the mean of the group's.
    pub fn steering_index(
        &self,
        wavelengths: SampledWavelengths,
        lanes: &std::ops::Range<usize>,
    ) -> f64 {
        if lanes.len() == LANES {
            return self.index_d;
        }
        let row = self.index.at(wavelengths);
        row.0[lanes.clone()].iter().sum::<f64>() / lanes.len() as f64
    }
}

/// Two reflectances in squares.
#[derive(Clone, Debug)]
pub struct Checker {
    /// The diffuse reflectance of the first square, which starts at the origin.
    pub first: SpectralTable,
    /// The diffuse reflectance of its neighbours.
    pub second: SpectralTable,
    /// The side of a square, in mm.
    pub square: f64,
}

impl Checker {
    /// The reflectance at a point of the world.
    pub fn at(&self, point: DVec3) -> &SpectralTable {
        // A point within rounding of a plane through the origin is on one side of it.
        let cell = |x: f64| (x / self.square + 1e-6).floor() as i64;
        let sum = cell(point.x) + cell(point.y) + cell(point.z);
        if sum.rem_euclid(2) == 0 {
            &self.first
        } else {
            &self.second
        }
    }
}

/// What a surface does with light.
#[derive(Clone, Debug)]
pub enum Optics {
    /// A transparent body.
    Dielectric(Dielectric),
    /// A metal with n and k, bare or lacquered.
    Conductor {
        /// n(λ).
        n: SpectralTable,
        /// k(λ).
        k: SpectralTable,
        /// What the metal's reflectance is multiplied with.
        factor: f64,
        /// A coat that follows the metal's surface.
        lacquer: Option<Lacquer>,
    },
    /// A mirror of measured reflectance.
    Mirror(SpectralTable),
    /// A matt surface.
    Diffuse(SpectralTable),
    /// A matt surface of two reflectances.
    Checker(Checker),
    /// A thin matt sheet that light passes: it walks on in the medium that it came from.
    Transmitter {
        /// The diffuse reflectance of either side.
        reflectance: SpectralTable,
        /// The diffuse transmittance.
        transmittance: SpectralTable,
    },
    /// A dielectric coat over an opaque matt base.
    Glossy {
        /// The coat's index n(λ).
        index: SpectralTable,
        /// The base's diffuse reflectance.
        base: SpectralTable,
    },
}

/// The weights and spectra of Hall's model, eqs. (3) and (4).
#[derive(Clone, Debug)]
pub struct HallTerms {
    /// `k_sr`, the weight of reflection.
    pub reflection_weight: f64,
    /// `k_st`, the weight of transmission.
    pub transmission_weight: f64,
    /// `k_sa`, the weight of ambient light.
    pub ambient_weight: f64,
    /// n, the highlight exponent.
    pub highlight_exponent: f64,
    /// `F_sr` in place of the material's own.
    pub specular_reflectance: Option<SpectralTable>,
    /// `F_st` in place of 1 − `F_sr`.
    pub specular_transmittance: Option<SpectralTable>,
    /// `F_sa`, the reflectance that answers ambient light, in place of the material's diffuse one.
    pub ambient_reflectance: Option<SpectralTable>,
}

/// A material of the scene.
#[derive(Clone, Debug)]
pub struct Material {
    /// The physics.
    pub optics: Optics,
    /// How rough the surface is, and where. Hall's method takes all surfaces as smooth.
    pub finish: Finish,
    /// Its terms in the founding method.
    pub hall: HallTerms,
}

impl Material {
    /// The transparent body's optics, if it is one.
    pub fn dielectric(&self) -> Option<&Dielectric> {
        match &self.optics {
            Optics::Dielectric(dielectric) => Some(dielectric),
            _ => None,
        }
    }

    /// The diffuse reflectance at a point: that of the base below a coat, none for smooth matter.
    pub fn diffuse_reflectance(
        &self,
        point: DVec3,
        wavelengths: SampledWavelengths,
    ) -> Option<SampledSpectrum> {
        match &self.optics {
            Optics::Diffuse(reflectance) | Optics::Transmitter { reflectance, .. } => {
                Some(reflectance.at(wavelengths))
            }
            Optics::Checker(checker) => Some(checker.at(point).at(wavelengths)),
            Optics::Glossy { base, .. } => Some(base.at(wavelengths)),
            Optics::Dielectric(_) | Optics::Conductor { .. } | Optics::Mirror(_) => None,
        }
    }

    /// The mirror-like reflectance of an opaque surface seen through a medium of index
    /// `medium_index`; none for matt surfaces and for transparent bodies.
    pub fn opaque_specular_reflectance(
        &self,
        cos_i: f64,
        medium_index: SampledSpectrum,
        wavelengths: SampledWavelengths,
    ) -> Option<SampledSpectrum> {
        match &self.optics {
            Optics::Conductor { n, k, factor, lacquer } => {
                let metal = (n, k, *factor);
                let facet = metal_facet(metal, lacquer.as_ref(), medium_index, wavelengths);
                Some(facet.reflectance(cos_i))
            }
            Optics::Mirror(reflectance) => Some(reflectance.at(wavelengths)),
            Optics::Glossy { index, .. } => {
                let eta = index.at(wavelengths) / medium_index;
                Some(eta.map(|eta| dielectric_reflectance(cos_i, eta)))
            }
            Optics::Dielectric(_)
            | Optics::Diffuse(_)
            | Optics::Checker(_)
            | Optics::Transmitter { .. } => None,
        }
    }

    /// The GGX width α of a face by its outward geometric normal; 0 where it is smooth.
    pub fn alpha_at(&self, normal: DVec3) -> f64 {
        self.finish.alpha_at(normal)
    }

    /// The roughness of a face by its outward geometric normal; none where it is smooth.
    pub fn roughness_at(&self, normal: DVec3) -> Option<&AlbedoTable> {
        self.finish.table_at(normal)
    }

    /// What the surface does with light at a point of the world, met from a medium of index
    /// `medium_index`. `normal` is the outward geometric one.
    ///
    /// A transparent body is taken as met from outside; [`Bsdf::interface`] knows both sides.
    pub fn bsdf(
        &self,
        position: DVec3,
        normal: DVec3,
        medium_index: SampledSpectrum,
        wavelengths: SampledWavelengths,
    ) -> Bsdf<'_> {
        let roughness = self.roughness_at(normal);
        let reflector = |facet| Bsdf::Reflector(Reflector::new(facet, roughness));
        match &self.optics {
            Optics::Dielectric(body) => {
                Bsdf::interface(body.index.at(wavelengths) / medium_index, roughness)
            }
            Optics::Conductor { n, k, factor, lacquer } => {
                reflector(metal_facet((n, k, *factor), lacquer.as_ref(), medium_index, wavelengths))
            }
            Optics::Mirror(reflectance) => reflector(Facet::Measured(reflectance.at(wavelengths))),
            Optics::Diffuse(reflectance) => {
                Bsdf::Diffuse(Diffuse::new(reflectance.at(wavelengths)))
            }
            Optics::Checker(checker) => {
                Bsdf::Diffuse(Diffuse::new(checker.at(position).at(wavelengths)))
            }
            Optics::Transmitter { reflectance, transmittance } => Bsdf::Transmitter(
                Transmitter::new(reflectance.at(wavelengths), transmittance.at(wavelengths)),
            ),
            Optics::Glossy { index, base } => {
                let eta = index.at(wavelengths) / medium_index;
                Bsdf::Glossy(Glossy::new(eta, base.at(wavelengths), roughness))
            }
        }
    }
}

/// The facets of a metal of n, k and factor, seen from a medium.
fn metal_facet(
    (n, k, factor): (&SpectralTable, &SpectralTable, f64),
    lacquer: Option<&Lacquer>,
    medium_index: SampledSpectrum,
    wavelengths: SampledWavelengths,
) -> Facet {
    let (n, k) = (n.at(wavelengths), k.at(wavelengths));
    match lacquer.map(|lacquer| lacquer.at(wavelengths)) {
        None => Facet::Metal { n: n / medium_index, k: k / medium_index, factor },
        Some(lacquer) => Facet::Lacquered(LacqueredMetal { lacquer, medium_index, n, k, factor }),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    fn table(value: f64) -> SpectralTable {
        SpectralTable::from_ascending(&[value; LANES]).unwrap()
    }

    #[test]
    fn a_checker_changes_from_square_to_square_and_not_within_rounding_of_its_plane() {
        let checker = Checker { first: table(0.1), second: table(0.9), square: 10.0 };
        let value =
            |x, y, z| checker.at(DVec3::new(x, y, z)).at(SampledWavelengths { phase: 0 }).0[0];
        assert_eq!(value(5.0, 0.0, 5.0), 0.1);
        assert_eq!(value(15.0, 0.0, 5.0), 0.9);
        assert_eq!(value(15.0, 0.0, -5.0), 0.1);
        assert_eq!(value(5.0, -1e-12, 5.0), 0.1);
    }

    const AIR: SampledSpectrum = SampledSpectrum::ONE;
    const FIRST: SampledWavelengths = SampledWavelengths { phase: 0 };

    fn material(optics: Optics, finish: Finish) -> Material {
        let hall = HallTerms {
            reflection_weight: 1.0,
            transmission_weight: 1.0,
            ambient_weight: 0.0,
            highlight_exponent: 1.0,
            specular_reflectance: None,
            specular_transmittance: None,
            ambient_reflectance: None,
        };
        Material { optics, finish, hall }
    }

    #[test]
    fn a_mirror_reflects_the_same_by_both_methods_and_dimmer_under_dyed_lacquer() {
        let metal = |lacquer| {
            let (n, k) = (table(1.015), table(6.627));
            material(Optics::Conductor { n, k, factor: 0.9, lacquer }, Finish::SMOOTH)
        };
        let lacquer = Lacquer { index: table(1.5), optical_depth: table(0.5) };
        let seen = [metal(None), metal(Some(lacquer))].map(|metal| {
            let by_hall = metal.opaque_specular_reflectance(0.7, AIR, FIRST);
            let bsdf = metal.bsdf(DVec3::ZERO, DVec3::Z, AIR, FIRST);
            assert!(!bsdf.scatters());
            assert_eq!(bsdf.mirror(0.7), by_hall);
            by_hall.unwrap().0[0]
        });
        assert!((seen[0] - 0.9 * 0.9153).abs() < 0.01, "{seen:?}");
        assert!(seen[1] < 0.5 * seen[0], "{seen:?}");
    }

    #[test]
    fn a_textured_body_is_rough_in_front_and_smooth_behind() {
        let roughness = Arc::new(AlbedoTable::new(0.2).unwrap());
        let finish = Finish::rough(roughness).facing(DVec3::Z, 0.2);
        let (index, base) = (table(1.49), table(0.3));
        let body = material(Optics::Glossy { index, base }, finish);
        let mirror = |normal| body.bsdf(DVec3::ZERO, normal, AIR, FIRST).mirror(0.5);
        assert_eq!(body.alpha_at(DVec3::Z), 0.2);
        assert_eq!(body.alpha_at(-DVec3::Z), 0.0);
        assert_eq!(mirror(DVec3::Z), None);
        assert_eq!(mirror(-DVec3::Z).unwrap().0[0], dielectric_reflectance(0.5, 1.49));
    }

    #[test]
    fn hall_sees_a_sheet_that_lets_light_through_as_matt() {
        let (reflectance, transmittance) = (table(0.4), table(0.5));
        let sheet = material(Optics::Transmitter { reflectance, transmittance }, Finish::SMOOTH);
        let seen = sheet.diffuse_reflectance(DVec3::ZERO, FIRST).unwrap();
        assert_eq!(seen.0[0], 0.4);
        assert_eq!(sheet.opaque_specular_reflectance(0.5, AIR, FIRST), None);
        let bsdf = sheet.bsdf(DVec3::ZERO, DVec3::Z, AIR, FIRST);
        assert!((bsdf.eval(DVec3::Z, -DVec3::Z).0[0] - 0.5 / std::f64::consts::PI).abs() < 1e-15);
        assert_eq!(bsdf.albedo(DVec3::Z).0[0], 0.9);
    }

    #[test]
    fn glass_met_from_water_has_the_ratio_of_both_indices() {
        let (index, absorption) = (table(1.5), table(0.0));
        let glass = Dielectric { index, index_d: 1.5, absorption, scattering: None };
        let glass = material(Optics::Dielectric(glass), Finish::SMOOTH);
        let bsdf = glass.bsdf(DVec3::ZERO, DVec3::Z, SampledSpectrum::splat(1.333), FIRST);
        let expected = dielectric_reflectance(0.6, 1.5 / 1.333);
        assert_eq!(bsdf.mirror(0.6).unwrap().0[0], expected);
    }
}
