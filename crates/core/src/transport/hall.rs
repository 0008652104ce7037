// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The founding method: spectral backward ray tracing with Hall's shading model, specular terms.
//!
//! Per wavelength, at every surface that a ray from the eye meets after b mm in a body:
//!
//! - eq. (2) the light gathered so far on the way back is t(λ)^b times what arrives;
//! - eq. (3), where the ray leaves a body: `k_st`·`I_l`·`F_st`·(L·N)ⁿ for each light beyond it;
//! - eq. (4), where it meets a surface: `k_sr`·`I_l`·`F_sr`·(L·N)ⁿ for each light on its own side;
//! - both with `k_sa`·`I_a`·`F_sa` for the ambient light;
//! - `k_sr`·`F_sr` times what the traced mirror ray brings and `k_st`·`F_st` times what the refracted ray
//!   brings, with total internal reflection beyond the critical angle.
//!
//! Source: R. Hall, D. Greenberg, "A Testbed for Realistic Image Synthesis", IEEE CG&A 3(8), 1983;
//! in this spectral form for lamps, Lee et al., IEEK summer conference 2002(4), 327–330.

use std::ops::Range;

use crate::math::{DVec2, DVec3, Ray};
use crate::matter::{dielectric_reflectance, reflect, refract, Dielectric, HallTerms, Material};
use crate::sampling::PixelSampler;
use crate::scene::{Face, Interior, LostRay, Scene};
use crate::spectrum::{SampledSpectrum, SampledWavelengths, LANES};

use super::meeting::Meeting;
use super::shadow::transmittance_towards;
use super::tally::Tally;

/// How far the method follows rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HallSettings {
    /// How many reflections and refractions are followed.
    pub max_depth: u32,
    /// A branch of which no lane weighs this much is not followed.
    pub contribution_limit: f64,
    /// Into how many groups of neighbouring lanes a dispersive refraction splits a ray: 1 lets all
    /// lanes share the direction of `n_d`, [`LANES`] gives each lane its own.
    pub dispersion_groups: usize,
    /// Whether surfaces between a point and a light dim or block it.
    pub shadows: bool,
}

/// A highlight below this share of the contribution limit is left out. Lights can be far brighter
/// than what rays bring, and a step in a highlight's tail would show where a missing ray does not.
const LEAST_HIGHLIGHT: f64 = 0.01;

/// One sample's tree of rays.
pub struct HallWalk<'a> {
    scene: &'a Scene,
    settings: HallSettings,
    wavelengths: SampledWavelengths,
    sampler: PixelSampler,
    tally: &'a mut Tally,
    radiance: SampledSpectrum,
}

/// One branch of the tree.
struct Branch {
    ray: Ray,
    throughput: SampledSpectrum,
    interior: Interior,
    /// The lanes that it carries.
    lanes: Range<usize>,
    depth: u32,
}

impl<'a> HallWalk<'a> {
    /// The spectral radiance that arrives at the eye against `ray`, which starts in `interior`.
    pub fn radiance(
        scene: &'a Scene,
        settings: HallSettings,
        wavelengths: SampledWavelengths,
        sampler: PixelSampler,
        tally: &'a mut Tally,
        (ray, interior): (Ray, Interior),
    ) -> SampledSpectrum {
        let radiance = SampledSpectrum::ZERO;
        let mut walk = Self { scene, settings, wavelengths, sampler, tally, radiance };
        let throughput = SampledSpectrum::ONE;
        walk.follow(Branch { ray, throughput, interior, lanes: 0..LANES, depth: 0 });
        walk.radiance
    }

    fn follow(&mut self, mut branch: Branch) {
        loop {
            self.tally.eye_rays += 1;
            let Some(place) = self.scene.first_place(&branch.ray) else {
                return self.reach_background(&branch);
            };
            let hit = place.hit;
            let medium = self.scene.medium(&branch.interior);
            if let Some(body) = medium {
                let absorption = body.absorption.at(self.wavelengths);
                branch.throughput *= absorption.transmittance(hit.point.t);
            }
            let meeting = Meeting::new(hit, branch.ray.direction);
            let material = self.scene.material_of(hit.body);
            if material.dielectric().is_none() {
                return self.shade_opaque(&branch, &meeting, material);
            }
            let mut is_lost = false;
            let beyond = branch.interior.through(place.faces(), |body, cause| {
                self.tally.lose(body, cause);
                is_lost = true;
            });
            if let Some(face) = self.scene.interface(&branch.interior, &beyond) {
                return self.shade_interface(&branch, &meeting, face, beyond);
            }
            branch.interior = beyond;
            if is_lost && self.was_followed_too_far(&mut branch) {
                return;
            }
            branch.ray.origin = hit.point.leave_along(branch.ray.direction);
        }
    }

    /// Count a surface passed without effect as a step, so that no defect makes an endless walk.
    fn was_followed_too_far(&mut self, branch: &mut Branch) -> bool {
        branch.depth += 1;
        let too_far = branch.depth > self.settings.max_depth;
        self.tally.cut_by_depth += u64::from(too_far);
        too_far
    }

    fn reach_background(&mut self, branch: &Branch) {
        if let Some(body) = branch.interior.filling(&self.scene.bodies) {
            self.tally.lose(body, LostRay::EndedInside);
        }
        let arriving = self.scene.background.radiance(&branch.ray, self.wavelengths);
        self.radiance += branch.throughput * arriving;
    }

    /// Eqs. (3) and (4) and the traced rays at the boundary of a transparent body.
    fn shade_interface(
        &mut self,
        branch: &Branch,
        meeting: &Meeting,
        face: Face,
        beyond: Interior,
    ) {
        let terms = &self.scene.material_of(face.body).hall;
        let here = self.scene.medium(&branch.interior);
        let there = self.scene.medium(&beyond);
        let eta = self.index(there) / self.index(here);
        let own_sr = terms.specular_reflectance.as_ref().map(|table| table.at(self.wavelengths));
        let own_st = terms.specular_transmittance.as_ref().map(|table| table.at(self.wavelengths));
        // Total reflection, unless a refracted ray is found.
        let (mut f_sr, mut f_st) = (SampledSpectrum::ONE, SampledSpectrum::ZERO);
        let mut refracted = Vec::with_capacity(1);
        for lanes in self.groups(branch, here, there) {
            let steered = self.steering(there, &lanes) / self.steering(here, &lanes);
            let Some(wo) = refract(meeting.wi, meeting.normal, steered) else {
                continue;
            };
            // Lanes that share directions share them on both sides. At the angle in the thinner
            // body each has its own reflectance, and none is locked in where the others get out.
            let outer = if steered < 1.0 { -wo.dot(meeting.normal) } else { meeting.cos_i };
            for j in lanes.clone() {
                let contrast = eta.0[j].max(1.0 / eta.0[j]);
                f_sr.0[j] =
                    own_sr.map_or_else(|| dielectric_reflectance(outer, contrast), |f| f.0[j]);
                f_st.0[j] = own_st.map_or(1.0 - f_sr.0[j], |f| f.0[j]);
            }
            refracted.push((meeting.on_far_side(wo), lanes));
        }
        self.add_highlights(branch, meeting, terms, f_sr, branch.interior, 1.0);
        if !face.is_entered {
            self.add_highlights(branch, meeting, terms, f_st, beyond, -1.0);
        }
        self.add_ambient(branch, terms, None);
        for (wo, lanes) in refracted {
            let weight = branch.throughput * f_st * terms.transmission_weight;
            self.branch_off(branch, meeting, wo, weight.only(lanes.clone()), beyond, lanes);
        }
        self.reflect(branch, meeting, terms, f_sr);
    }

    /// Eq. (4) and the mirror ray at an opaque surface.
    fn shade_opaque(&mut self, branch: &Branch, meeting: &Meeting, material: &Material) {
        let terms = &material.hall;
        let medium_index = self.index(self.scene.medium(&branch.interior));
        let replaced = terms.specular_reflectance.as_ref().map(|t| t.at(self.wavelengths));
        let specular = material
            .opaque_specular_reflectance(meeting.cos_i, medium_index, self.wavelengths)
            .map(|own| replaced.unwrap_or(own));
        let diffuse = material.diffuse_reflectance(meeting.hit.point.position, self.wavelengths);
        match (specular, diffuse) {
            (Some(f_sr), base) => {
                let below = base.map(|base| base * (SampledSpectrum::ONE - f_sr));
                self.add_highlights(branch, meeting, terms, f_sr, branch.interior, 1.0);
                if let Some(below) = below {
                    let matt = HallTerms { highlight_exponent: 1.0, ..terms.clone() };
                    self.add_highlights(branch, meeting, &matt, below, branch.interior, 1.0);
                }
                self.add_ambient(branch, terms, below);
                self.reflect(branch, meeting, terms, f_sr);
            }
            (None, Some(matt)) => {
                let f_sr = replaced.unwrap_or(matt);
                self.add_highlights(branch, meeting, terms, f_sr, branch.interior, 1.0);
                self.add_ambient(branch, terms, Some(matt));
            }
            (None, None) => {}
        }
    }

    /// The term k·`I_l`·F·(L·N)ⁿ of every light on one side: `side` is 1 for the branch's own
    /// (`k_sr`) and −1 for the far one (`k_st`). `interior` is what the way to the light starts in.
    fn add_highlights(
        &mut self,
        branch: &Branch,
        meeting: &Meeting,
        terms: &HallTerms,
        f: SampledSpectrum,
        interior: Interior,
        side: f64,
    ) {
        let k = if side > 0.0 { terms.reflection_weight } else { terms.transmission_weight };
        let scene = self.scene;
        let weight = branch.throughput * f * k;
        for light in &scene.lights {
            let u = if light.is_sampled() { self.sampler.next_2d() } else { DVec2::ZERO };
            let way = light.seen_from(meeting.hit.point.position, u);
            let cosine = side * way.direction.dot(meeting.normal);
            let faces = side * meeting.side() * way.direction.dot(meeting.hit.point.normal) > 0.0;
            let highlight = cosine.max(0.0).powf(terms.highlight_exponent);
            let least = self.settings.contribution_limit * LEAST_HIGHLIGHT;
            if !faces || weight.max() * highlight <= least {
                continue;
            }
            let arriving = if self.settings.shadows {
                let from = (&meeting.hit.point, interior);
                transmittance_towards(scene, self.wavelengths, from, way, self.tally)
            } else {
                SampledSpectrum::ONE
            };
            let strength = light.strength.at(self.wavelengths);
            self.radiance += weight * strength * arriving * highlight;
        }
    }

    /// The term `k_sa`·`I_a`·`F_sa`.
    fn add_ambient(&mut self, branch: &Branch, terms: &HallTerms, own: Option<SampledSpectrum>) {
        let f_sa = terms.ambient_reflectance.as_ref().map(|table| table.at(self.wavelengths));
        if let Some(f_sa) = f_sa.or(own) {
            let ambient = self.scene.ambient.at(self.wavelengths);
            self.radiance += branch.throughput * ambient * f_sa * terms.ambient_weight;
        }
    }

    fn reflect(
        &mut self,
        branch: &Branch,
        meeting: &Meeting,
        terms: &HallTerms,
        f_sr: SampledSpectrum,
    ) {
        let wo = meeting.on_near_side(reflect(meeting.wi, meeting.normal));
        let weight = branch.throughput * f_sr * terms.reflection_weight;
        self.branch_off(branch, meeting, wo, weight, branch.interior, branch.lanes.clone());
    }

    /// Follow a new branch, unless it is too deep or weighs too little.
    fn branch_off(
        &mut self,
        from: &Branch,
        meeting: &Meeting,
        wo: DVec3,
        throughput: SampledSpectrum,
        interior: Interior,
        lanes: Range<usize>,
    ) {
        let heaviest = throughput.max();
        if heaviest <= 0.0 {
            return;
        }
        if heaviest < self.settings.contribution_limit {
            self.tally.cut_by_contribution += 1;
        } else if from.depth >= self.settings.max_depth {
            self.tally.cut_by_depth += 1;
        } else {
            let ray = Ray::endless(meeting.hit.point.leave_along(wo), wo);
            self.follow(Branch { ray, throughput, interior, lanes, depth: from.depth + 1 });
        }
    }

    /// The groups of lanes that a refraction steers apart.
    fn groups(
        &self,
        branch: &Branch,
        here: Option<&Dielectric>,
        there: Option<&Dielectric>,
    ) -> impl Iterator<Item = Range<usize>> {
        let is_dispersive = |medium: Option<&Dielectric>| {
            medium.is_some_and(|body| {
                let row = body.index.at(self.wavelengths).0;
                row.iter().any(|n| *n != row[0])
            })
        };
        let splits = branch.lanes.len() == LANES && (is_dispersive(here) || is_dispersive(there));
        let count = if splits { self.settings.dispersion_groups } else { 1 };
        let (first, size) = (branch.lanes.start, branch.lanes.len() / count);
        (0..count).map(move |g| first + g * size..first + (g + 1) * size)
    }

    fn steering(&self, medium: Option<&Dielectric>, lanes: &Range<usize>) -> f64 {
        medium.map_or(1.0, |body| body.steering_index(self.wavelengths, lanes))
    }

    fn index(&self, medium: Option<&Dielectric>) -> SampledSpectrum {
        medium.map_or(SampledSpectrum::ONE, |body| body.index.at(self.wavelengths))
    }
}
